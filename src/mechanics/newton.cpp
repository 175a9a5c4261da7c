#include "mechanics/newton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mechanics/hot_spots.hpp"
#include "mechanics/step_search.hpp"

namespace loopwright {
namespace {

constexpr double least_loose = 0.6;  // how far past contact the pair list reaches at least and at most, in d
constexpr double most_loose = 2.4;
constexpr double least_first_shift = 1e-5;

double largest_force(const Unknowns& g) {
  double largest = 0;
  for (const Vec3& f : g.u) largest = std::max(largest, squared_norm(f));
  return std::sqrt(largest);
}

double largest_measure_force(const Unknowns& g) {
  return std::max({std::abs(g.g[0]), std::abs(g.g[1]), std::abs(g.g[2])});
}

bool is_mostly_quiet(const Unknowns& g, double force) {
  const auto loud = std::count_if(g.u.begin(), g.u.end(),
                                  [&](const Vec3& f) { return !(squared_norm(f) < force * force); });
  // The piece's size is pulled at by all of its yarns at once.
  const double on_size = largest_measure_force(g) / std::sqrt(static_cast<double>(g.u.size()));
  return 200 * static_cast<std::size_t>(loud) <= g.u.size() && on_size < force;
}

// The next shift: smaller after a full step that the quadratic model foretold well, larger after a poor one.
double next_shift(double shift, const TakenStep& taken, double energy) {
  const double predicted = -taken.scale * taken.slope * (1 - 0.5 * taken.scale);
  const double gain = predicted > 0 ? (energy - taken.energy) / predicted : 1;
  if (taken.scale > 0.9 && gain > 0.5) return std::max(taken.raised == 0 ? 0.1 * shift : 0.5 * shift, 1e-9);
  if (taken.scale < 0.1 || gain < 0.1) return std::max(3 * shift, 1e-6);
  return taken.raised == 0 && taken.scale > 0.4 ? 0.5 * shift : shift;
}

}  // namespace

NewtonResult newton(const YarnModel& model, YarnState& state, const NewtonOptions& options,
                    double first_shift, ContactHistory* history) {
  NewtonResult result;
  Assembly assembly(model);
  if (history) assembly.set_history(std::move(*history));
  StepSearch search(model, assembly);
  BlockMatrix hessian;
  Unknowns gradient;
  TakenStep taken;
  const double outer = model.contact.outer;
  const bool has_spots = search.is_large() && may_have_hot_spots(model);
  double shift = first_shift, loose = least_loose;

  for (result.iterations = 0;; ++result.iterations) {
    const double range = outer + loose;
    assembly.update_pairs(state, range);
    if (has_spots && result.iterations < options.most_iterations) {
      assembly.gradient(state, gradient);
      SpotsReport settled = settle_hot_spots(model, gradient, options.tolerance, state, assembly.history());
      result.spot_iterations += settled.iterations;
      if (settled.spots > 0) {
        assembly.set_history(std::move(settled.history));
        assembly.update_pairs(state, range);
      }
    }
    result.energy = assembly.hessian(state, gradient, hessian);
    result.measure_forces = assembly.measure_forces();
    result.residual = largest_force(gradient);
    result.measure_residual = largest_measure_force(gradient);
    result.converged = result.residual < options.tolerance && result.measure_residual < options.tolerance;
    if (options.on_iteration && !options.on_iteration(result.iterations, result.residual))
      result.stopped = true;
    if (result.converged || result.stopped || result.iterations >= options.most_iterations) break;
    result.quiet = search.is_large() && !model.periodic && is_mostly_quiet(gradient, options.mostly_quiet);
    if (result.quiet) break;
    // A large piece that starts near rest needs no large shift, and would take costly steps to be rid of it.
    if (result.iterations == 0 && search.is_large())
      shift = std::min(shift, std::max(result.residual, least_first_shift));

    const double energy = result.energy.total();
    if (!search.take({state, gradient, energy, result.residual, range}, hessian, shift, taken)) break;
    if (result.iterations == 0) result.first_shift = shift;
    if (taken.scale == 0) {
      if (shift > 1e12) break;
      shift = std::max(16 * shift, 1e-3);
      continue;
    }
    shift = next_shift(shift, taken, energy);
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
  result.factorisations = search.solver().factorisations;
  result.linear_iterations = search.solver().iterations;
  return result;
}

}  // namespace loopwright
