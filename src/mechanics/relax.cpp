#include "mechanics/relax.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mechanics/newton.hpp"

namespace loopwright {
namespace {

// Smallest distance of contact samples of yarns that may touch, in units of their mean diameter; at most
// `most`.
double smallest_clearance(const YarnModel& model, const YarnState& state, double most) {
  std::vector<Vec3> extended;
  SamplePlaces places;
  std::vector<SegmentPair> pairs;
  expand(model, state, extended);
  place_samples(model, extended, places);
  double largest_diameter = 0;
  for (const YarnModel::Yarn& y : model.yarns) largest_diameter = std::max(largest_diameter, y.diameter);
  find_segment_pairs(model, state, places, most * largest_diameter, pairs);
  double nearest = most;
  for (const SegmentPair& pair : pairs) {
    const double diameter = 0.5 * (model.yarn_of(pair.a).diameter + model.yarn_of(pair.b).diameter);
    if (!pair.same_yarn) nearest = std::min(nearest, std::sqrt(pair.distance2) / diameter);
  }
  return nearest;
}

ModelOptions at_radius(ModelOptions options, double radius) {
  options.material.contact.outer *= radius;
  options.material.contact.core *= radius;
  // A thin frictionless yarn has room to slide into rest states that a thick one cannot leave (moss folded
  // into itself); rubbing while it grows keeps it where the first geometry put it. At full radius the yarn's
  // own friction counts.
  constexpr double least_growing_friction = 0.3;
  options.material.friction = std::max(options.material.friction, least_growing_friction);
  return options;
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

}  // namespace

RelaxResult relax(const Fabric& fabric, const RelaxOptions& options) {
  if (!(options.tolerance > 0) || !std::isfinite(options.tolerance))
    throw std::invalid_argument("the tolerance must be a positive number");
  ModelOptions model_options = options.model;
  if (!fabric.periodic && options.plate_room >= 0 && model_options.plates.stiffness == 0)
    model_options.plates = plates_round(fabric, options.plate_room);

  RelaxResult result;
  YarnState state = build_yarn_state(fabric);
  const YarnModel full = build_yarn_model(fabric, model_options);
  const double outer = full.contact.outer;

  NewtonResult newton_result;
  double shift = 1.0;
  const auto run = [&](const YarnModel& model, double radius, double tolerance, int iterations) {
    NewtonOptions newton_options;
    newton_options.tolerance = tolerance;
    newton_options.most_iterations = std::min(iterations, options.most_iterations - result.newton_iterations);
    newton_options.on_iteration = [&](int i, double residual) {
      if (!options.on_progress) return true;
      return options.on_progress(
          {radius < 1 ? "grow-in" : "relax", result.newton_iterations + i, residual, radius});
    };
    newton_result = newton(model, state, newton_options, shift);
    shift = std::max(newton_result.shift, 1e-3);
    result.newton_iterations += newton_result.iterations;
    result.linear_iterations += newton_result.linear_iterations;
    result.factorisations += newton_result.factorisations;
    result.pass_throughs += newton_result.crossings;
    result.stopped = newton_result.stopped;
  };

  // Grow-in: the yarn starts so thin that its shell is pressed by no more than a quarter, and grows as room
  // is made.
  if (options.grow_in) {
    constexpr double pressed = 0.75;
    double radius = 0;
    while (!result.stopped && result.newton_iterations < options.most_iterations) {
      const double room = smallest_clearance(full, state, 1.5) / (outer * pressed);
      const double next = std::min({1.0, room, radius == 0 ? 1.0 : 1.6 * radius});
      if (next >= 1) break;
      if (!(next > 1e-3)) {
        result.message = "yarns touch in the first geometry: their centrelines are " +
                         std::to_string(room * pressed * outer) + " d apart";
        break;
      }
      radius = std::max(next, radius);
      run(build_yarn_model(fabric, at_radius(model_options, radius)), radius, 0.1, 12);
    }
  }
  if (!result.stopped && result.message.empty()) run(full, 1, options.tolerance, options.most_iterations);

  result.fabric = with_state(fabric, state);
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

}  // namespace loopwright
