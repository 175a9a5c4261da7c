#include "experiments/drape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "mechanics/assembly.hpp"

namespace loopwright {
namespace {

// B/d^2 in N, and what is needed to know it.
double force_unit(const Fabric& fabric, const YarnMaterial& material) {
  if (!(material.reference_bend_N_m2 > 0))
    throw std::invalid_argument(
        "weight needs the yarn's bend stiffness: name a material or give the yarn its data");
  return force_unit_N(material, fabric.diameter_mm);
}

// `repeats` of a cell above each other, still one cell.
Fabric stacked(const Fabric& cell, int repeats) {
  Fabric stack = cell;
  stack.yarns.clear();
  stack.loops.clear();
  stack.interlacings.clear();
  for (int n = 0; n < repeats; ++n)
    for (const FabricYarn& yarn : cell.yarns) {
      stack.yarns.push_back(yarn);
      for (Vec3& p : stack.yarns.back().control_points) p += cell.lattice(0, n);
    }
  const auto cell_loops = static_cast<std::int32_t>(cell.loops.size());
  const auto stacked_id = [&](LoopId loop, int n) {
    return LoopId(static_cast<std::int32_t>(loop.position()) + n * cell_loops);
  };
  for (int n = 0; n < repeats; ++n) {
    for (LoopSpan span : cell.loops) {
      span.loop = stacked_id(span.loop, n);
      span.yarn += n * static_cast<int>(cell.yarns.size());
      stack.loops.push_back(span);
    }
    for (PlacedInterlacing i : cell.interlacings) {
      // the child's repeat counts on from the parent's and comes round at the top
      const int repeat = n + i.shift[1], turn = static_cast<int>(std::floor(1.0 * repeat / repeats));
      i.parent = stacked_id(i.parent, n);
      i.child = stacked_id(i.child, repeat - turn * repeats);
      i.shift[1] = turn;
      stack.interlacings.push_back(i);
    }
  }
  stack.height = repeats * cell.height;
  stack.skew = repeats * cell.skew;
  stack.courses = repeats * cell.courses;
  return stack;
}

// Mean height of each course's yarns, from the lowest yarn up.
std::vector<double> levels(const Fabric& fabric) {
  std::vector<double> level;
  for (const FabricYarn& yarn : fabric.yarns) {
    double sum = 0;
    for (const Vec3& p : yarn.control_points) sum += p.y;
    level.push_back(sum / static_cast<double>(yarn.control_points.size()));
  }
  return level;
}

}  // namespace

std::vector<Vec3> weight_loads(const Fabric& fabric, const YarnMaterial& material, const Vec3& acceleration) {
  const double unit = force_unit(fabric, material), d = fabric.diameter_mm * 1e-3;
  constexpr std::array<double, 4> share{1 / 24.0, 11 / 24.0, 11 / 24.0, 1 / 24.0};  // int h_a du
  std::vector<Vec3> loads;
  for (const FabricYarn& yarn : fabric.yarns) {
    if (!(yarn.linear_density_tex > 0))
      throw std::invalid_argument("weight needs the linear density of every yarn");
    const Vec3 per_segment =
        (yarn.linear_density_tex * 1e-6 * yarn.segment_rest_length * d / unit) * acceleration;
    const std::size_t first = loads.size(), nodes = yarn.control_points.size();
    loads.resize(first + nodes);
    for (int e = 0; e < yarn.segments(); ++e)
      for (std::size_t k = 0; k < 4; ++k)
        loads[first + (static_cast<std::size_t>(e) + k) % nodes] += share[k] * per_segment;
  }
  return loads;
}

Vec3 support_force(const Fabric& fabric, const ModelOptions& options, const ContactHistory& history) {
  YarnModel model = build_yarn_model(fabric, options);
  const std::vector<std::uint8_t> held = model.held;
  std::fill(model.held.begin(), model.held.end(), std::uint8_t{0});  // else their forces are not told
  const YarnState state = build_yarn_state(fabric);
  Assembly assembly(model);
  assembly.set_history(history);
  Unknowns gradient;
  BlockMatrix hessian;
  assembly.update_pairs(state, 1.01 * model.contact.outer);
  assembly.hessian(state, gradient, hessian);
  Vec3 sum;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i]) sum += gradient.u[i];
  return force_unit(fabric, options.material) * sum;
}

Vec3 total_load(const Fabric& fabric, const ModelOptions& options) {
  Vec3 sum;
  for (const Vec3& f : options.point_loads) sum += f;
  return force_unit(fabric, options.material) * sum;
}

HangingStrip hang(const RelaxResult& cell, const RelaxOptions& options, int courses, double gravity,
                  int steps) {
  const Fabric& one = cell.fabric;
  const int of_cell = static_cast<int>(std::lround(one.courses));
  if (!one.periodic || of_cell < 1 || courses < of_cell || courses % of_cell != 0)
    throw std::invalid_argument("a strip hangs by whole repeats of a periodic cell");
  if (one.yarns.size() != static_cast<std::size_t>(of_cell))
    throw std::invalid_argument("a hanging strip needs one yarn to a course");
  if (steps < 1) throw std::invalid_argument("the weight must come in one step or more");
  HangingStrip strip;
  strip.courses = courses;
  Fabric fabric = stacked(one, courses / of_cell);
  const double flat_height = fabric.height;

  // The rail: the uppermost points of the topmost course.
  FabricYarn& top = fabric.yarns.back();
  double highest = -INFINITY;
  for (const Vec3& p : top.control_points) highest = std::max(highest, p.y);
  top.held.assign(top.control_points.size(), 0);
  constexpr double rail = 0.1;  // d
  double rail_share = 0, on_rail = 0;
  for (std::size_t i = 0; i < top.held.size(); ++i) {
    top.held[i] = top.control_points[i].y > highest - rail;
    if (top.held[i]) rail_share += top.control_points[i].y / fabric.height, on_rail += 1;
  }
  rail_share /= on_rail;

  RelaxOptions hung = options;
  hung.grow_in = false;
  hung.history.clear();
  hung.model.free = {false, true, false};
  hung.model.point_loads = weight_loads(fabric, options.model.material, {0, -gravity, 0});
  const double unit = force_unit(fabric, options.model.material),
               width_m = fabric.width * fabric.diameter_mm * 1e-3;
  double weight = 0;  // B/d^2
  for (const Vec3& f : hung.model.point_loads) weight -= f.y;
  hung.tolerance =
      std::min(options.tolerance, 1e-3 * weight / static_cast<double>(hung.model.point_loads.size()));
  if (!(hung.tolerance > 1e-12)) hung.tolerance = options.tolerance;
  // With an open lower edge the slope of the energy by the height, all points going along, is the work of the
  // rail alone: the weight at the rail's share of the height. Any other load would pull at the lowest course.
  const std::vector<Vec3> loads = hung.model.point_loads;
  strip.result.fabric = fabric;
  for (int step = 1; step <= steps && !strip.result.stopped; ++step) {
    const double share = static_cast<double>(step) / steps;
    for (std::size_t i = 0; i < loads.size(); ++i) hung.model.point_loads[i] = share * loads[i];
    hung.model.load[1] = share * weight * rail_share;
    RelaxResult next = relax(strip.result.fabric, hung);
    next.newton_iterations += strip.result.newton_iterations;
    next.pass_throughs += strip.result.pass_throughs;
    strip.result = std::move(next);
    hung.history = strip.result.history;
  }
  strip.fabric = strip.result.fabric;

  const double d = fabric.diameter_mm * 1e-3;
  strip.weight_N_m = weight * unit / width_m;
  strip.areal_density_g_m2 = gravity > 0 ? 1000 * strip.weight_N_m / gravity / (flat_height * d) : 0;
  strip.support_N_m = support_force(strip.fabric, hung.model, strip.result.history).y / width_m;
  strip.elongation = strip.fabric.height / flat_height - 1;
  const std::vector<double> flat = levels(fabric), now = levels(strip.fabric);
  for (std::size_t k = 0; k + 1 < flat.size(); ++k) {
    strip.strain.push_back((now[k + 1] - now[k]) / (flat[k + 1] - flat[k]) - 1);
    strip.force_N_m.push_back(strip.weight_N_m * (static_cast<double>(k) + 1) / courses);
  }
  return strip;
}

}  // namespace loopwright
