#include "experiments/as_knitted.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace loopwright {
namespace {

// The fabric at another width; its points go along.
Fabric at_width(Fabric fabric, double width) {
  const double share = width / fabric.width;
  for (FabricYarn& yarn : fabric.yarns)
    for (Vec3& p : yarn.control_points) p.x *= share;
  fabric.width = width;
  fabric.skew *= share;
  return fabric;
}

void check_history(const Fabric& first, const RelaxOptions& options, const KnittingHistory& history) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(history.machine_width_mm > 0 && std::isfinite(history.machine_width_mm),
          "the width on the machine must be a positive number");
  require(history.take_down_N >= 0 && std::isfinite(history.take_down_N),
          "the take-down must be a number of newtons, 0 or more");
  require(history.flat_gap_mm >= 0 && std::isfinite(history.flat_gap_mm),
          "the gap of the plates must be a number of millimetres, 0 or more");
  require(first.width > 0 && first.height > 0,
          "only a periodic cell or a piece with a frame has a width on the machine");
  require(history.hand_pull_N_m >= 0 && std::isfinite(history.hand_pull_N_m),
          "the pull by hand must be a number of newtons a metre, 0 or more");
  require((history.take_down_N == 0 && history.hand_pull_N_m == 0) ||
              options.model.material.reference_bend_N_m2 > 0,
          "take-down and a pull by hand need the yarn's bend stiffness: name a material or give the yarn its "
          "data");
}

Measures sum(const Measures& a, const Measures& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

}  // namespace

RelaxResult relax_on(const RelaxResult& from, RelaxOptions options, const Measures& load) {
  options.model.load = load;
  options.history = from.history;
  RelaxResult next = relax(from.fabric, options);
  add_counts(next, from);
  next.converged = next.converged && from.converged;
  return next;
}

KnittedRest relax_as_knitted(const Fabric& first, const RelaxOptions& options,
                             const KnittingHistory& history) {
  check_history(first, options, history);
  const double d = first.diameter_mm;
  RelaxOptions knitting = options;
  knitting.model.free.width = false;
  knitting.model.free.height = true;
  if (history.take_down_N > 0)
    knitting.model.load[1] = history.take_down_N / force_unit_N(options.model.material, d);
  if (history.flat_gap_mm > 0) knitting.model.plates = plates_apart(first, history.flat_gap_mm / d);
  KnittedRest rest;
  rest.on_machine = relax(at_width(first, history.machine_width_mm / d), knitting);

  RelaxOptions released = options;
  released.grow_in = false;
  released.model.plates = rest.on_machine.plates;
  const auto on_from = [&](const RelaxResult& from, const Measures& load) {
    released.most_iterations = std::max(1, options.most_iterations - from.newton_iterations);
    return relax_on(from, released, load);
  };
  const Measures own = options.model.load;  // which the cloth bears all the while
  rest.hanging = history.take_down_N > 0 ? on_from(rest.on_machine, knitting.model.load) : rest.on_machine;
  rest.relaxed = on_from(rest.hanging, own);
  if (history.hand_pull_N_m > 0) {
    const double tension =
        history.hand_pull_N_m * d * 1e-3 / force_unit_N(options.model.material, d);  // B/d^3
    const Measures pull{tension * rest.relaxed.fabric.height, tension * rest.relaxed.fabric.width, 0};
    for (const Measures& load : {sum(own, pull), own}) rest.relaxed = on_from(rest.relaxed, load);
  }
  return rest;
}

}  // namespace loopwright
