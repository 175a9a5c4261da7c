#include "mechanics/linear/step_solver.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/piece_size.hpp"

namespace loopwright {
namespace {

constexpr int dense_nodes = 160;  // below: a sparse factor fills up nearly as much
constexpr int few_nodes = 1000;   // below: factoring costs less than anything cleverer
constexpr int most_inner = 24;    // more products and solves than this cost more than a new factor
constexpr int most_patched = 200;
constexpr int patched_factor = 35;  // iterations that take as long as factoring all patches and coarse spaces
constexpr int most_raises = 60;
constexpr int most_local_raises = 8;

double raised_shift(double shift) { return std::max(4 * shift, 1e-4); }

}  // namespace

StepSolver::StepSolver(const YarnModel& model) : model_(model) {}

StepSolver::Report StepSolver::solve(const BlockMatrix& hessian, const YarnState& state,
                                     const Unknowns& gradient, double accuracy, double& shift, Unknowns& step,
                                     const RaiseAt& raise_at, const std::vector<std::int32_t>& raised) {
  Report report;
  if (model_.nodes > many_nodes && !model_.periodic) {
    report.solved =
        solve_patched(hessian, state, gradient, accuracy, shift, report.raised, step, raise_at, raised);
  } else {
    if (current_ && model_.nodes > few_nodes) {
      const ConjugateGradientResult cg = conjugate_gradient(
          hessian, shift, [this](const Unknowns& r, Unknowns& z) { cholesky_.solve(r, z); }, gradient,
          accuracy, {.most = most_inner}, step);
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
  const bool dense = model_.nodes < dense_nodes;
  Unknowns against;
  // No shift is tried that a direction of an earlier failure speaks against: often half of all factors.
  double too_small = against_.u.empty() ? 0 : shift_against(hessian, against_);
  against_.u.clear();
  for (; raised <= most_raises; ++raised, shift = raised_shift(shift)) {
    if (shift <= too_small) continue;
    ++factorisations;
    if (!(dense ? dense_.factor(hessian, shift, against) : cholesky_.factor(hessian, shift))) {
      if (dense && !against.u.empty()) {
        too_small = shift_against(hessian, against);
        against_ = against;
      }
      continue;
    }
    dense ? dense_.solve(gradient, step) : cholesky_.solve(gradient, step);
    ++iterations;
    current_ = true;
    return true;
  }
  return false;
}

bool StepSolver::solve_patched(const BlockMatrix& hessian, const YarnState& state, const Unknowns& gradient,
                               double accuracy, double& shift, int& raised, Unknowns& step,
                               const RaiseAt& raise_at, const std::vector<std::int32_t>& raised_at) {
  if (!schwarz_.ready()) schwarz_.set_patches(state.nodes, model_.held, hessian, model_.binding_points);
  const auto precondition = [this](const Unknowns& r, Unknowns& z) { schwarz_.solve(r, z); };
  const double digits = std::log(1 / accuracy);
  // Where it was not definite: a larger shift there, or, where that is no small part, everywhere.
  int local = 0;
  const auto raise = [&](const std::vector<std::int32_t>& nodes) {
    if (raise_at && !nodes.empty() && 4 * nodes.size() < hessian.row_start.size() &&
        local < most_local_raises) {
      raise_at(nodes, shift);
      ++local;
      return;
    }
    ++raised, shift = raised_shift(shift);
  };
  // First with the factor at hand, until a new one and its iterations would take less than what is left. What
  // was reached by then is gone on from.
  ConjugateGradientLimits limits{.most = most_patched};
  // A preconditioner that does not know of the weights costs more than the patches where they are.
  if (current_ && !raised_at.empty()) current_ = schwarz_.factor_round(raised_at, hessian, shift);
  if (current_) {
    limits.patience = patched_factor + static_cast<int>(usual_ * digits);
    const ConjugateGradientResult cg =
        conjugate_gradient(hessian, shift, precondition, gradient, accuracy, limits, step);
    iterations += cg.iterations;
    if (cg.converged) return true;
    limits.patience = -1;
    limits.go_on = !cg.indefinite;
    if (cg.indefinite) raise(cg.bent);
  }
  for (; raised <= most_raises; limits.go_on = false) {
    ++factorisations;
    const int before = schwarz_.iterations;
    current_ = schwarz_.factor(hessian, shift);
    for (; !current_ && raise_at && local < most_local_raises; ++local) {
      const std::vector<std::int32_t> nodes = schwarz_.indefinite();
      if (nodes.empty() || 4 * nodes.size() > hessian.row_start.size()) break;
      raise_at(nodes, shift);
      current_ = schwarz_.factor_again(hessian, shift);
    }
    iterations += schwarz_.iterations - before;
    if (!current_) {
      ++raised, shift = raised_shift(shift);
      continue;
    }
    const ConjugateGradientResult cg =
        conjugate_gradient(hessian, shift, precondition, gradient, accuracy, limits, step);
    iterations += cg.iterations;
    if (cg.reduction < 1) usual_ = cg.iterations / std::log(1 / cg.reduction);
    if (!cg.indefinite) return true;  // not quite converged is still a good direction
    raise(cg.bent);
  }
  return false;
}

}  // namespace loopwright
