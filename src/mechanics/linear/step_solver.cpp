#include "mechanics/linear/step_solver.hpp"

#include <algorithm>

namespace loopwright {
namespace {

constexpr int dense_nodes = 160;  // below: a sparse factor fills up nearly as much
constexpr int few_nodes = 1000;   // below: factoring costs less than anything cleverer
constexpr int many_nodes = 8000;  // above: a whole factor costs too much, see linear/schwarz.hpp
constexpr int most_inner = 24;    // more products and solves than this cost more than a new factor
constexpr int most_patched = 200;
constexpr int most_raises = 60;

double raised_shift(double shift) { return std::max(4 * shift, 1e-4); }

}  // namespace

StepSolver::StepSolver(const YarnModel& model) : model_(model) {}

StepSolver::Report StepSolver::solve(const BlockMatrix& hessian, const YarnState& state,
                                     const Unknowns& gradient, double accuracy, double& shift,
                                     Unknowns& step) {
  Report report;
  if (model_.nodes > many_nodes && !model_.periodic) {
    report.solved = solve_patched(hessian, state, gradient, accuracy, shift, report.raised, step);
  } else {
    if (current_ && model_.nodes > few_nodes) {
      const ConjugateGradientResult cg = conjugate_gradient(
          hessian, shift, [this](const Unknowns& r, Unknowns& z) { cholesky_.solve(r, z); }, gradient,
          accuracy, most_inner, step);
      iterations += cg.iterations;
      report.solved = cg.converged;
      current_ = cg.converged && cg.iterations <= most_inner / 2;
    }
    if (!report.solved) report.solved = solve_direct(hessian, gradient, shift, report.raised, step);
  }
  for (Vec3& v : step.u) v = -v;
  for (double& v : step.g) v = -v;
  return report;
}

bool StepSolver::solve_direct(const BlockMatrix& hessian, const Unknowns& gradient, double& shift,
                              int& raised, Unknowns& step) {
  for (; raised <= most_raises; ++raised, shift = raised_shift(shift)) {
    ++factorisations;
    const bool dense = model_.nodes < dense_nodes;
    if (!(dense ? dense_.factor(hessian, shift) : cholesky_.factor(hessian, shift))) continue;
    dense ? dense_.solve(gradient, step) : cholesky_.solve(gradient, step);
    ++iterations;
    current_ = true;
    return true;
  }
  return false;
}

bool StepSolver::solve_patched(const BlockMatrix& hessian, const YarnState& state, const Unknowns& gradient,
                               double accuracy, double& shift, int& raised, Unknowns& step) {
  if (!schwarz_.ready()) schwarz_.set_patches(state.nodes, model_.held, hessian, model_.binding_points);
  const auto precondition = [this](const Unknowns& r, Unknowns& z) { schwarz_.solve(r, z); };
  // First with the factor at hand, allowed up to twice its usual number of iterations.
  if (current_) {
    const ConjugateGradientResult cg = conjugate_gradient(hessian, shift, precondition, gradient, accuracy,
                                                          std::min(most_patched, 2 * usual_ + 10), step);
    iterations += cg.iterations;
    if (cg.converged) return true;
  }
  for (; raised <= most_raises; ++raised, shift = raised_shift(shift)) {
    ++factorisations;
    const int before = schwarz_.iterations;
    current_ = schwarz_.factor(hessian, shift);
    iterations += schwarz_.iterations - before;
    if (!current_) continue;
    const ConjugateGradientResult cg =
        conjugate_gradient(hessian, shift, precondition, gradient, accuracy, most_patched, step);
    iterations += cg.iterations;
    usual_ = cg.iterations;
    if (!cg.indefinite) return true;  // not quite converged is still a good direction
  }
  return false;
}

}  // namespace loopwright
