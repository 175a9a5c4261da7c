// A piece of cloth with its first courses on a table and the others over its edge, under its weight.
// study_drape [STRUCTURE [WALES COURSES [FRICTION [SET [SHAKES [MOST]]]]]] prints a table and leaves a
// picture. SET: share of its curvature that the yarn keeps where the flat piece came to rest. SHAKES: how
// often its tip is pushed down and up again before it is loaded, first by a hundred times 3/8 of its weight,
// then by less and less; -1: its contacts forget what they bore, and it comes to rest anew. MOST: the largest
// weight, times that on earth.
#include "experiments/drape.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "experiments/piece_size.hpp"
#include "outputs/image.hpp"
#include "outputs/render.hpp"
#include "outputs/write_fabric.hpp"
#include "pipeline.hpp"

namespace {

using namespace loopwright;

constexpr double earth = 9.81;

// Control points in the model's order.
std::vector<Vec3> points_of(const Fabric& fabric) { return build_yarn_state(fabric).nodes; }

// Holds the control points for which `on` is true; says how many.
template <typename Where>
int hold(Fabric& fabric, const Where& on) {
  int count = 0;
  for (FabricYarn& yarn : fabric.yarns) {
    yarn.held.assign(yarn.control_points.size(), 0);
    for (std::size_t i = 0; i < yarn.held.size(); ++i)
      if (on(yarn.control_points[i])) yarn.held[i] = 1, ++count;
  }
  return count;
}

double mean_height(const Fabric& fabric, const std::vector<std::size_t>& points) {
  const std::vector<Vec3> all = points_of(fabric);
  double sum = 0;
  for (const std::size_t i : points) sum += all[i].z;
  return sum / static_cast<double>(points.size());
}

struct Loaded {
  RelaxResult result;
  ModelOptions model;
};

// Loads that grow in steps, friction keeping its history.
Loaded loaded(const RelaxResult& start, const RelaxOptions& options, const std::vector<Vec3>& loads,
              int steps) {
  RelaxOptions at = options;
  at.history = start.history;
  Loaded end{start, {}};
  for (int step = 1; step <= steps; ++step) {
    at.model.point_loads = loads;
    for (Vec3& f : at.model.point_loads) f = f * (1.0 * step / steps);
    RelaxResult next = relax(end.result.fabric, at);
    next.pass_throughs += end.result.pass_throughs;
    next.newton_iterations += end.result.newton_iterations;
    end.result = std::move(next);
    at.history = end.result.history;
  }
  end.model = at.model;
  return end;
}

// Pushed down and up in turn at these points, by less and less, and let go.
Loaded shaken(const RelaxResult& start, const RelaxOptions& options, const std::vector<std::size_t>& points,
              double force, int times) {
  Loaded end{start, {}};
  const std::size_t all = points_of(start.fabric).size();
  for (int k = 0; k < times; ++k, force *= -0.6) {
    std::vector<Vec3> push(all);
    for (const std::size_t i : points) push[i] = {0, 0, -force / static_cast<double>(points.size())};
    end = loaded(end.result, options, push, 4);
  }
  return loaded(end.result, options, {}, 1);
}

void tell(const char* what, const Loaded& l, double deflection_mm, double overhang_mm) {
  const Vec3 support = support_force(l.result.fabric, l.model, l.result.history),
             load = total_load(l.result.fabric, l.model);
  const InterlacingCheck check = check_interlacings(l.result.fabric);
  std::printf(
      "%-34s load %9.3f support %9.3f uN, deflection %7.4f mm (%.4f of the overhang), %d of %d, p-t %d, %d "
      "steps, residual %.1e\n",
      what, 1e6 * norm(load), 1e6 * norm(support), deflection_mm, deflection_mm / overhang_mm, check.intact,
      check.expected, l.result.pass_throughs, l.result.newton_iterations, l.result.residual);
  std::fflush(stdout);
}

void picture(const Fabric& fabric, const std::string& name, View view) {
  RenderOptions options;
  options.view = view;
  options.width = 1000, options.height = 800;
  write_png(name, render(fabric, options));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string structure = argc > 1 ? argv[1] : "moss";
  const int wales = argc > 3 ? std::stoi(argv[2]) : 6, courses = argc > 3 ? std::stoi(argv[3]) : 14;
  const std::string letters = structure == "plain"    ? "g"
                              : structure == "rib"    ? "ge"
                              : structure == "garter" ? "g\ne"
                                                      : "ge\neg";
  const std::string file = "drape.verm";
  std::ofstream(file)
      << ";!vermiculation-1\n;;Gauge: 10\n;;Bed-Gap: 2 mm\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 6.6 mm\n"
      << ";;Size: " << wales << " wales x " << courses << " courses\n;;Edges: free\n"
      << letters << "\n";
  Diagnostics diagnostics(file);
  PieceRequest request;
  request.friction = argc > 4 ? std::stod(argv[4]) : 0.4;
  const Knitting knitting = knit(file, request, diagnostics);
  if (!diagnostics.ok()) {
    std::cerr << diagnostics;
    return 1;
  }
  const Fabric first = first_geometry(knitting, request);
  RelaxOptions options = relax_options(first, knitting.program, request);
  options.most_iterations = 600;
  options.set = argc > 5 ? std::stod(argv[5]) : 0;
  const int shakes = argc > 6 ? std::stoi(argv[6]) : 0;
  const double most = argc > 7 ? std::stod(argv[7]) : 30;
  RelaxResult flat = relax(first, options);
  std::printf("%s, %d x %d loops, friction %.2f, set %.2f: flat, %d steps, residual %.1e, %s\n",
              structure.c_str(), wales, courses, *request.friction, options.set, flat.newton_iterations,
              flat.residual, flat.message.c_str());
  options.grow_in = false;
  options.plate_room = -1;
  options.tolerance = 1e-6;
  options.most_iterations = 400;

  // The table's edge a third of the way up.
  std::vector<double> heights;
  for (const Vec3& p : points_of(flat.fabric)) heights.push_back(p.y);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double edge = *low + (*high - *low) / 3, top = *high, d_mm = flat.fabric.diameter_mm;
  const double overhang_mm = (top - edge) * d_mm;
  RelaxResult table = flat;
  hold(table.fabric, [&](const Vec3& p) { return p.y < edge; });
  Loaded rest = loaded(table, options, {}, 1);
  std::vector<std::size_t> tip;
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (heights[i] > top - 2) tip.push_back(i);
  tell("on the table, no weight", rest, 0, overhang_mm);
  const YarnMaterial& material = options.model.material;
  const PieceSize size = piece_size(flat.fabric);
  const double width_mm = size.width * d_mm;
  std::printf("width %.2f mm, overhang %.2f mm\n", width_mm, overhang_mm);
  if (shakes > 0) {
    double overhanging = 0;
    const std::vector<Vec3> weight = weight_loads(rest.result.fabric, material, {0, 0, -earth});
    for (std::size_t i = 0; i < weight.size(); ++i)
      if (heights[i] >= edge) overhanging -= weight[i].z;
    rest = shaken(rest.result, options, tip, 37.5 * overhanging, shakes);
    tell(("shaken " + std::to_string(shakes) + " times, let go").c_str(), rest, 0, overhang_mm);
  }
  if (shakes < 0) {
    rest.result.history = {};
    rest = loaded(rest.result, options, {}, 1);
    tell("its contacts forgotten, let go", rest, 0, overhang_mm);
  }
  const double before = mean_height(rest.result.fabric, tip);

  for (const double times : {1.0, 10.0, 30.0}) {
    if (times > most) break;
    std::vector<Vec3> weight = weight_loads(rest.result.fabric, material, {0, 0, -times * earth});
    double overhanging = 0;
    for (std::size_t i = 0; i < weight.size(); ++i)
      if (heights[i] >= edge) overhanging -= weight[i].z;
    const Loaded own = loaded(rest.result, options, weight, 4);
    const double sag = (before - mean_height(own.result.fabric, tip)) * d_mm;
    tell(("own weight, " + std::to_string(static_cast<int>(times)) + " g").c_str(), own, sag, overhang_mm);
    // A beam: q L^4 / (8 delta), q the weight of an area.
    const double d = d_mm * 1e-3, weight_N = overhanging * material.reference_bend_N_m2 / (d * d),
                 rigidity = weight_N / (width_mm * 1e-3) * std::pow(overhang_mm * 1e-3, 3) / (8e-3 * sag);
    std::printf("   flexural rigidity %.4f mN m\n", 1e3 * rigidity);
    // A beam's tip sinks as much under 3/8 of its weight at the tip: q L^4 / 8 = (3/8 q L) L^3 / 3.
    std::vector<Vec3> at_tip(weight.size());
    for (const std::size_t i : tip)
      at_tip[i] = {0, 0, -0.375 * overhanging / static_cast<double>(tip.size())};
    const Loaded pulled = loaded(rest.result, options, at_tip, 4);
    const double tip_sag = (before - mean_height(pulled.result.fabric, tip)) * d_mm;
    tell("   3/8 of what overhangs at the tip", pulled, tip_sag, overhang_mm);
    if (times == 30) picture(own.result.fabric, "drape_table.png", View::left);
  }
  return 0;
}
