#include "mechanics/newton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mechanics/linear/step_solver.hpp"
#include "mechanics/safe_step.hpp"

namespace loopwright {
namespace {

constexpr double gap_share = 0.7;    // of the gap of two pieces of yarn that one step may use up
constexpr double least_loose = 0.6;  // how far past contact the pair list reaches at least and at most, in d
constexpr double most_loose = 2.4;
constexpr double enough_decrease = 1e-4;  // Armijo's constant
constexpr int most_cuts = 40;
constexpr double least_first_shift = 1e-5;
constexpr int many_nodes = 8000;

double largest_force(const Unknowns& g) {
  double largest = 0;
  for (const Vec3& f : g.u) largest = std::max(largest, squared_norm(f));
  return std::sqrt(largest);
}

double largest_measure_force(const Unknowns& g) {
  return std::max({std::abs(g.g[0]), std::abs(g.g[1]), std::abs(g.g[2])});
}

// A step cut so that it is safe and lowers the energy. scale = 0: none was found.
struct TakenStep {
  YarnState state;
  SafeStep safe;
  double scale = 0, energy = 0;
  int cuts = 0;
};

TakenStep take_step(const YarnModel& model, Assembly& assembly, const YarnState& state, const Unknowns& step,
                    double energy, double slope, double range) {
  TakenStep taken;
  taken.safe = safe_step(model, assembly, state, assembly.moved(state, step, 1), range, model.contact.outer,
                         gap_share);
  for (double scale = taken.safe.scale; taken.cuts < most_cuts; ++taken.cuts, scale *= 0.5) {
    taken.state = assembly.moved(state, step, scale);
    taken.energy = assembly.energy(taken.state).total();
    if (taken.energy <= energy + enough_decrease * scale * slope + 1e-13 * std::abs(energy)) {
      taken.scale = scale;
      break;
    }
  }
  return taken;
}

// The next shift: smaller after a full step that the quadratic model foretold well, larger after a poor one.
double next_shift(double shift, const TakenStep& taken, double energy, double slope, int raised) {
  const double predicted = -taken.scale * slope * (1 - 0.5 * taken.scale);
  const double gain = predicted > 0 ? (energy - taken.energy) / predicted : 1;
  if (taken.scale > 0.9 && gain > 0.5) return std::max(raised == 0 ? 0.1 * shift : 0.5 * shift, 1e-9);
  if (taken.scale < 0.1 || gain < 0.1) return std::max(3 * shift, 1e-6);
  return raised == 0 && taken.scale > 0.4 ? 0.5 * shift : shift;
}

}  // namespace

NewtonResult newton(const YarnModel& model, YarnState& state, const NewtonOptions& options,
                    double first_shift, ContactHistory* history) {
  NewtonResult result;
  Assembly assembly(model);
  if (history) assembly.set_history(std::move(*history));
  StepSolver solver(model);
  BlockMatrix hessian;
  Unknowns gradient, step;
  const double outer = model.contact.outer;
  double shift = first_shift, loose = least_loose;

  for (result.iterations = 0;; ++result.iterations) {
    const double range = outer + loose;
    assembly.update_pairs(state, range);
    result.energy = assembly.hessian(state, gradient, hessian);
    result.measure_forces = assembly.measure_forces();
    result.residual = largest_force(gradient);
    result.measure_residual = largest_measure_force(gradient);
    result.converged = result.residual < options.tolerance && result.measure_residual < options.tolerance;
    if (options.on_iteration && !options.on_iteration(result.iterations, result.residual))
      result.stopped = true;
    if (result.converged || result.stopped || result.iterations >= options.most_iterations) break;
    // A large piece that starts near rest needs no large shift, and would take costly steps to be rid of it.
    if (result.iterations == 0 && model.nodes > many_nodes)
      shift = std::min(shift, std::max(result.residual, least_first_shift));

    const bool large = model.nodes > many_nodes;
    if (large) assembly.drop_places();
    assembly.metric(hessian);
    hessian.measure_metric = {1, 1, 1};
    const double accuracy = std::clamp(0.3 * result.residual, 1e-3, 0.05);
    const StepSolver::Report solve = solver.solve(hessian, state, gradient, accuracy, shift, step);
    if (!solve.solved) break;
    if (large) hessian = BlockMatrix{};  // much of what is held, and not needed until the next step

    const double energy = result.energy.total(), slope = dot(gradient, step);
    TakenStep taken = take_step(model, assembly, state, step, energy, slope, range);
    if (taken.scale == 0) {
      if (shift > 1e12) break;
      shift = std::max(16 * shift, 1e-3);
      continue;
    }
    shift = next_shift(shift, taken, energy, slope, solve.raised);
    // A step held back by the pair list's reach alone: look farther next time.
    const bool short_sighted = taken.safe.loose_motion * taken.safe.scale > 0.4 * (range - outer) &&
                               taken.safe.pair_ratio * taken.safe.scale < 0.4;
    loose = short_sighted ? std::min(2 * loose, most_loose) : std::max(least_loose, 0.7 * loose);
    // The step as it was taken must be certified; one that is not counts as a possible pass-through.
    if (!taken.safe.surely_apart || !(taken.safe.pair_ratio * taken.scale < 1) ||
        !(taken.safe.loose_motion * taken.scale < 0.5 * (range - outer)))
      ++result.crossings;
    state = std::move(taken.state);
    assembly.accept(state);
  }
  if (history) *history = assembly.history();
  result.shift = shift;
  result.factorisations = solver.factorisations;
  result.linear_iterations = solver.iterations;
  return result;
}

}  // namespace loopwright
