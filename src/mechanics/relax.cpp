#include "mechanics/relax.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mechanics/contact/sample_clearance.hpp"
#include "mechanics/energies/segment_term.hpp"
#include "mechanics/newton.hpp"

namespace loopwright {
namespace {

// The yarn while it grows in: its shell is whole, its core is smaller than it will be.
ModelOptions with_core(ModelOptions options, double core) {
  options.material.contact.core = core;
  // Without its core a soft shell would let yarns be pressed together until nothing tells them apart.
  constexpr double least_growing_stiffness = 100;
  options.material.contact.stiffness = std::max(options.material.contact.stiffness, least_growing_stiffness);
  // A frictionless yarn can slide into rest states that it cannot leave (moss folded into itself); rubbing
  // while it grows keeps it where the first geometry put it. Afterwards the yarn's own friction counts.
  constexpr double least_growing_friction = 0.3;
  options.material.friction = std::max(options.material.friction, least_growing_friction);
  return options;
}

// Lengths of all segments as they are drawn, in d, in the model's order.
std::vector<double> drawn_lengths(const Fabric& fabric) {
  std::vector<double> lengths;
  for (const FabricYarn& yarn : fabric.yarns)
    for (int e = 0; e < yarn.segments(); ++e) lengths.push_back(arc_length(fabric, yarn, e, e + 1));
  return lengths;
}

FlatPlates plates_round(const Fabric& fabric, double room) {
  double low = 0, high = 0;
  bool first = true;
  for (const FabricYarn& yarn : fabric.yarns)
    for (const Vec3& p : yarn.control_points) {
      low = first ? p.z : std::min(low, p.z);
      high = first ? p.z : std::max(high, p.z);
      first = false;
    }
  return {50, low - room, high + room};
}

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
  const double outer = full.contact.outer;

  NewtonResult newton_result;
  double shift = 1.0;
  bool grown = !options.grow_in;  // from then on friction keeps its history
  result.history = options.history;
  const auto run = [&](const YarnModel& model, double radius, double tolerance, int iterations) {
    NewtonOptions newton_options;
    newton_options.tolerance = tolerance;
    newton_options.most_iterations = std::min(iterations, options.most_iterations - result.newton_iterations);
    newton_options.on_iteration = [&](int i, double residual) {
      if (!options.on_progress) return true;
      return options.on_progress(
          {radius < 1 ? "grow-in" : "relax", result.newton_iterations + i, residual, radius, &state});
    };
    newton_result = newton(model, state, newton_options, shift, grown ? &result.history : nullptr);
    shift = std::max(newton_result.shift, 1e-3);
    result.newton_iterations += newton_result.iterations;
    result.linear_iterations += newton_result.linear_iterations;
    result.factorisations += newton_result.factorisations;
    result.pass_throughs += newton_result.crossings;
    result.stopped = newton_result.stopped;
  };

  // Grow-in: the yarn's hard core grows as room is made, its soft shell is there from the start. It keeps the
  // lengths that it was drawn with until the core is whole, and then goes to its own in small steps: loops
  // drawn too long or too short would drag yarn through whole courses before it can hold itself.
  if (options.grow_in) {
    const std::vector<double> drawn = drawn_lengths(fabric);
    double most_strain = 0;
    for (std::size_t e = 0; e < drawn.size(); ++e)
      most_strain = std::max(most_strain, std::abs(drawn[e] / full.natural_length[e] - 1));
    const auto drawn_in = [&](YarnModel model, double share) {  // 0: lengths as drawn, 1: those of the yarn
      for (std::size_t e = 0; e < drawn.size(); ++e)
        model.natural_length[e] = (1 - share) * drawn[e] + share * full.natural_length[e];
      return model;
    };
    // The core for which the nearest pieces of yarn still have `left` of the shell between them; below zero
    // where they nearly touch: then the law is finite everywhere, and only the safe step parts the yarns.
    constexpr double left = 0.3, strain_a_stage = 0.15, enough_growth = 0.02, least_gap = 0.02,
                     any_growth = 1e-4;
    constexpr int most_stalls = 10;
    int stalls = 0;
    const double core = full.contact.core,
                 length_step = strain_a_stage / std::max(strain_a_stage, most_strain);
    double own_length = 0, core_before = -std::numeric_limits<double>::infinity();
    while (!result.stopped && result.newton_iterations < options.most_iterations) {
      const double nearest = smallest_clearance(full, state, 1.5);
      if (!(nearest > 1e-4)) {
        result.message = "yarns touch in the first geometry";
        break;
      }
      const double core_now = std::min(core, (nearest - left * outer) / (1 - left));
      // A knot drawn too tight opens only with more yarn.
      if (core_now == core || core_now < core_before + enough_growth) own_length += length_step;
      if (core_now == core && own_length >= 1) break;
      // Yarn pressed nearer than the growing law wishes, at its own length: soft yarn in tight loops lies
      // like that, and the true law takes over if no core is in another.
      if (core_now > core_before + any_growth) stalls = 0;
      if (own_length >= 1 && ++stalls > most_stalls) {
        if (!(nearest > core + least_gap * (outer - core)))
          result.message = "jammed: the yarn is too thick for the length of its loops";
        break;
      }
      core_before = core_now;
      const double share = std::clamp(nearest / (core + left * (outer - core)), 0.0, 0.999);
      run(drawn_in(build_yarn_model(fabric, with_core(model_options, core_now)), std::min(own_length, 1.0)),
          share, 0.1, 12);
    }
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

void add_counts(RelaxResult& to, const RelaxResult& from) {
  to.newton_iterations += from.newton_iterations;
  to.linear_iterations += from.linear_iterations;
  to.factorisations += from.factorisations;
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
  const bool is_set = std::any_of(fabric.yarns.begin(), fabric.yarns.end(),
                                  [](const FabricYarn& yarn) { return !yarn.natural_curvature.empty(); });
  if (is_set || options.set == 0 || !first.converged) return first;
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
