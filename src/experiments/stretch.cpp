#include "experiments/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "experiments/deformed.hpp"
#include "geometry/interlacing.hpp"

namespace loopwright {
namespace {

void check_test(const Fabric& fabric, const StretchTest& test) {
  const bool strained = test.control == StretchControl::strain;
  if (test.turning_points.empty())
    throw std::invalid_argument(strained ? "a stretch test needs a strain to go to"
                                         : "a stretch test needs a load to go to");
  for (const double to : test.turning_points) {
    if (strained && !(to > -0.9 && to <= 5))
      throw std::invalid_argument("a strain must lie between -0.9 and 5, that is -90 % and 500 %");
    if (!strained && !(std::abs(to) <= 1e6))
      throw std::invalid_argument("a load must be a number of N/m, at most a million");
  }
  if (!(test.largest_step > 0) || !std::isfinite(test.largest_step))
    throw std::invalid_argument("the step must be a positive number");
  double way = 0;
  for (double from = 0; const double to : test.turning_points) way += std::abs(to - from), from = to;
  if (way / test.largest_step > 1e5)
    throw std::invalid_argument("that is more than 100000 steps: take larger ones");
  if (!(fabric.width > 0) || !(fabric.height > 0))
    throw std::invalid_argument("only a periodic cell or a piece with a frame can be stretched");
  if (test.direction == StretchDirection::shear && !fabric.periodic)
    throw std::invalid_argument("shear is for periodic cells");
}

// All strains, or loads, on the way: equal steps between turning points, none larger than the largest step.
std::vector<double> steps_on_the_way(const StretchTest& test) {
  std::vector<double> all;
  double from = 0;
  for (const double to : test.turning_points) {
    const int steps =
        std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / test.largest_step - 1e-9)));
    for (int k = 1; k <= steps; ++k) all.push_back(from + (to - from) * k / steps);
    from = to;
  }
  return all;
}

FreeMeasures free_measures(const StretchTest& test, const FreeMeasures& usual) {
  if (test.control == StretchControl::load) {
    const bool course = test.direction == StretchDirection::course,
               wale = test.direction == StretchDirection::wale,
               shear = test.direction == StretchDirection::shear;
    return {(wale || shear) ? test.free_across && usual.width : true,
            (course || shear) ? test.free_across && usual.height : true, shear};
  }
  FreeMeasures free{false, false, false};
  if (test.direction == StretchDirection::course) free.height = test.free_across && usual.height;
  if (test.direction == StretchDirection::wale) free.width = test.free_across && usual.width;
  if (test.direction == StretchDirection::shear && test.free_across) {
    free.width = usual.width;
    free.height = usual.height;
  }
  return free;
}

}  // namespace

std::optional<StretchDirection> stretch_direction_named(std::string_view name) {
  if (name == "course") return StretchDirection::course;
  if (name == "wale") return StretchDirection::wale;
  if (name == "both") return StretchDirection::both;
  if (name == "shear") return StretchDirection::shear;
  return std::nullopt;
}

std::size_t point_count(const StretchTest& test) { return 1 + steps_on_the_way(test).size(); }

double usual_load_step(std::span<const double> loads) {
  double largest = 0;
  for (const double load : loads) largest = std::max(largest, std::abs(load));
  return largest > 0 ? largest / 20 : 1;
}

void set_run(StretchPoint& point, const RelaxResult& run) {
  point.residual = run.residual;
  point.newton_iterations = run.newton_iterations;
  point.pass_throughs = run.pass_throughs;
  point.converged = run.converged;
  const InterlacingCheck check = check_interlacings(run.fabric);
  point.interlacings = check.expected, point.interlacings_intact = check.intact;
}

StretchResult stretch(const RelaxResult& relaxed, const RelaxOptions& options, const StretchTest& test,
                      const std::function<bool(const StretchPoint&)>& on_point) {
  const Fabric& start = relaxed.fabric;
  check_test(start, test);
  const double bend_stiffness = options.model.material.reference_bend_N_m2;
  if (!(bend_stiffness > 0))
    throw std::invalid_argument(
        "forces need the yarn's bend stiffness: name a material or give the yarn its data");
  const double d = start.diameter_mm * 1e-3;  // m
  const double force_unit = force_unit_N(options.model.material, start.diameter_mm);
  const double width = start.width * d, height = start.height * d;  // m

  RelaxOptions held = options;
  held.grow_in = false;
  held.model.free = free_measures(test, options.model.free);
  held.model.plates = relaxed.plates;
  held.history = relaxed.history;
  // The rest state again, with the measures held: its energy is the zero of the test.
  RelaxResult at = relax(start, held);
  const auto stored = [](const RelaxResult& r) { return r.energy.stored(); };
  const double energy_at_rest = stored(at);

  StretchResult result;
  const auto add_point = [&] {
    StretchPoint point;
    point.course_strain = at.fabric.width / start.width - 1;
    point.wale_strain = at.fabric.height / start.height - 1;
    point.shear = (at.fabric.skew - start.skew) / start.height;
    point.course_force = at.measure_forces[0] * force_unit / height;
    point.wale_force = at.measure_forces[1] * force_unit / width;
    point.shear_force = at.measure_forces[2] * force_unit / width;
    point.energy = (stored(at) - energy_at_rest) * bend_stiffness / d / (width * height);
    set_run(point, at);
    point.min_clearance = min_clearance(at.fabric).distance;
    result.points.push_back(point);
    return !on_point || on_point(point);
  };

  if (!add_point()) result.stopped = true;
  const bool course = test.direction == StretchDirection::course || test.direction == StretchDirection::both;
  const bool wale = test.direction == StretchDirection::wale || test.direction == StretchDirection::both;
  const bool shear = test.direction == StretchDirection::shear;
  for (const double step : steps_on_the_way(test)) {
    if (result.stopped || at.stopped) break;
    const Fabric& now = at.fabric;
    held.history = std::move(at.history);
    if (test.control == StretchControl::load) {
      held.model.load = {course ? step * height / force_unit : 0, wale ? step * width / force_unit : 0,
                         shear ? step * width / force_unit : 0};
      at = relax(now, held);
    } else {
      const Fabric moved = deformed(now, course ? start.width * (1 + step) : now.width,
                                    wale ? start.height * (1 + step) : now.height,
                                    shear ? start.skew + step * start.height : now.skew);
      at = relax(moved, held);
    }
    if (!add_point()) result.stopped = true;
  }
  result.stopped = result.stopped || at.stopped;
  result.fabric = at.fabric;
  return result;
}

}  // namespace loopwright
