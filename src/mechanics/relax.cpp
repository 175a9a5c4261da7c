#include "mechanics/relax.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mechanics/energies/segment_term.hpp"
#include "mechanics/grow_in.hpp"
#include "mechanics/newton.hpp"

namespace loopwright {
namespace {

// Growth need not wait for the last places, the next stage moves them again: a stage ends where nearly all
// forces are below so many times the tolerance.
constexpr double grown_quiet = 50;
// Stages of growth that end early all start about as far from rest, and every shift that is too small costs a
// factor: the next stage starts with this part of what the last one's first step needed.
constexpr double of_first_shift = 0.25;

RelaxResult relax_as_it_is(const Fabric& fabric, const RelaxOptions& options) {
  if (!(options.tolerance > 0) || !std::isfinite(options.tolerance))
    throw std::invalid_argument("the tolerance must be a positive number");
  if (!(options.model.material.contact.core > 0))  // only while yarn grows in may it be less
    throw std::invalid_argument(
        "the contact core must be thinner than the outer diameter, and both positive");
  ModelOptions model_options = options.model;
  if (!fabric.periodic && options.plate_room >= 0 && model_options.plates.stiffness == 0)
    model_options.plates = plates_round(fabric, options.plate_room);

  RelaxResult result;
  YarnState state = build_yarn_state(fabric);
  const YarnModel full = build_yarn_model(fabric, model_options);

  NewtonResult newton_result;
  double shift = 1.0;
  bool grown = !options.grow_in;  // from then on friction keeps its history
  result.history = options.history;
  const auto run = [&](const YarnModel& model, double radius, double tolerance, int iterations) {
    NewtonOptions newton_options;
    newton_options.tolerance = tolerance;
    newton_options.mostly_quiet = grown ? 0 : grown_quiet * tolerance;
    newton_options.most_iterations = std::min(iterations, options.most_iterations - result.newton_iterations);
    newton_options.on_iteration = [&](int i, double residual) {
      if (!options.on_progress) return true;
      return options.on_progress(
          {radius < 1 ? "grow-in" : "relax", result.newton_iterations + i, residual, radius, &state});
    };
    if (!grown && newton_result.quiet) shift = std::max(shift, of_first_shift * newton_result.first_shift);
    newton_result = newton(model, state, newton_options, shift, grown ? &result.history : nullptr);
    shift = std::max(newton_result.shift, 1e-3);
    result.newton_iterations += newton_result.iterations;
    result.linear_iterations += newton_result.linear_iterations;
    result.factorisations += newton_result.factorisations;
    result.spot_iterations += newton_result.spot_iterations;
    result.pass_throughs += newton_result.crossings;
    result.stopped = newton_result.stopped;
  };

  if (options.grow_in) {
    const auto growing_run = [&](const YarnModel& model, double share, double tolerance, int iterations) {
      run(model, share, tolerance, iterations);
      return !result.stopped && result.newton_iterations < options.most_iterations;
    };
    const GrownIn outcome = grow_in(fabric, model_options, full, state, growing_run);
    if (outcome == GrownIn::touching) result.message = "yarns touch in the first geometry";
    if (outcome == GrownIn::jammed)
      result.message = "jammed: the yarn is too thick for the length of its loops";
  }
  grown = true;
  if (!result.stopped && result.message.empty()) run(full, 1, options.tolerance, options.most_iterations);

  result.fabric = with_state(fabric, state);
  result.plates = model_options.plates;
  result.measure_forces = newton_result.measure_forces;
  result.energy = newton_result.energy;
  result.residual = newton_result.residual;
  result.measure_residual = newton_result.measure_residual;
  result.converged = newton_result.converged && result.message.empty() && !result.stopped;
  if (result.message.empty())
    result.message = result.converged ? "converged"
                     : result.stopped ? "stopped"
                                      : "not converged after " + std::to_string(result.newton_iterations) +
                                            " Newton steps";
  return result;
}

}  // namespace

FlatPlates plates_round(const Fabric& fabric, double room) {
  // Yarn goes in by less than a tenth of a diameter.
  constexpr double stiffness = 50;
  double low = INFINITY, high = -INFINITY;
  for (const FabricYarn& yarn : fabric.yarns)
    for (const Vec3& p : yarn.control_points) low = std::min(low, p.z), high = std::max(high, p.z);
  return {stiffness, low - room, high + room};
}

FlatPlates plates_apart(const Fabric& fabric, double gap) {
  const FlatPlates touching = plates_round(fabric, 0);
  const double middle = (touching.low + touching.high) / 2;
  return {touching.stiffness, middle - gap / 2, middle + gap / 2};
}

void add_counts(RelaxResult& to, const RelaxResult& from) {
  to.newton_iterations += from.newton_iterations;
  to.linear_iterations += from.linear_iterations;
  to.factorisations += from.factorisations;
  to.spot_iterations += from.spot_iterations;
  to.pass_throughs += from.pass_throughs;
}

Fabric set_yarn(Fabric fabric, double share) {
  if (!(share >= 0 && share <= 1)) throw std::invalid_argument("the set of yarn must lie between 0 and 1");
  for (FabricYarn& yarn : fabric.yarns) {
    yarn.natural_curvature.clear();
    if (share == 0) continue;
    for (int e = 0; e < yarn.segments(); ++e) {
      SegmentDofs x;
      for (int k = 0; k < 4; ++k) {
        const Vec3 q = control_point(fabric, yarn, e + k);
        for (int c = 0; c < 3; ++c) x[static_cast<std::size_t>(3 * k + c)] = q[c];
      }
      const GaussPoints<double> p = gauss_points(x);
      std::array<double, 4>& curvature = yarn.natural_curvature.emplace_back();
      for (std::size_t g = 0; g < 4; ++g) {
        const double squared = p.D[g] / (p.A[g] * p.A[g]) - p.C[g] * p.C[g] / (p.A[g] * p.A[g] * p.A[g]);
        curvature[g] = share * std::sqrt(std::max(squared, 0.0));
      }
    }
  }
  return fabric;
}

RelaxResult relax(const Fabric& fabric, const RelaxOptions& options) {
  if (!(options.set >= 0 && options.set <= 1))
    throw std::invalid_argument("the set of yarn must lie between 0 and 1");
  RelaxResult first = relax_as_it_is(fabric, options);
  if (is_set(fabric) || options.set == 0 || !first.converged) return first;
  RelaxOptions again = options;
  again.grow_in = false;
  again.history = std::move(first.history);
  again.model.plates = first.plates;
  again.most_iterations = std::max(1, options.most_iterations - first.newton_iterations);
  RelaxResult result = relax_as_it_is(set_yarn(std::move(first.fabric), options.set), again);
  add_counts(result, first);
  return result;
}

}  // namespace loopwright
