#include "cell_road.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "experiments/as_knitted.hpp"
#include "geometry/find_repeat.hpp"
#include "geometry/fit_fabric.hpp"
#include "geometry/periodic_cell.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_program.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Knitting knit_swatch(const std::filesystem::path& file, const MachineModel& machine) {
  Diagnostics diagnostics(file.string());
  Knitting knitting;
  knitting.program = read_program(file, diagnostics);
  apply(machine, knitting.program);
  knitting.record = run_machine(knitting.program, diagnostics);
  knitting.graph = build_yarn_graph(knitting.program, knitting.record, diagnostics);
  if (!diagnostics.ok()) throw std::invalid_argument("the programme has errors");
  return knitting;
}

LoopSelection measured_loops(const YarnGraph& graph) {
  std::vector<int> passes;
  double first = INFINITY, last = -INFINITY;
  for (const Loop& loop : graph.loops) {
    passes.push_back(loop.pass);
    first = std::min(first, loop.slot), last = std::max(last, loop.slot);
  }
  std::sort(passes.begin(), passes.end());
  passes.erase(std::unique(passes.begin(), passes.end()), passes.end());
  const auto count = static_cast<int>(passes.size());
  if (count < measured_courses + 2 || last - first + 1 < measured_wales + 2)
    throw std::invalid_argument("the swatch is not larger than 60 wales by 60 courses");
  // The cast-on needs a pass more than its course.
  const int below = (count - measured_courses + 1) / 2;
  const int from = passes[static_cast<std::size_t>(below)],
            to = passes[static_cast<std::size_t>(below + measured_courses - 1)];
  LoopSelection inside(graph.loops.size(), 0);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Loop& loop = graph.loops[i];
    if (loop.pass >= from && loop.pass <= to &&
        std::abs(loop.slot - (first + last) / 2) < measured_wales / 2.0)
      inside[i] = 1;
  }
  return inside;
}

double two_faced_share(const YarnGraph& graph, const Fabric& fabric) {
  if (fabric.loops.empty()) return 0;
  int two_faced = 0;
  for (const LoopSpan& span : fabric.loops) {
    const Loop& loop = graph.loop(span.loop);
    const auto other_face = [&](LoopId id) { return id.valid() && graph.loop(id).side != loop.side; };
    const std::vector<LoopId>& course = graph.yarns[loop.yarn.position()].loops;
    const auto at = static_cast<std::size_t>(loop.order);
    bool found =
        (at > 0 && other_face(course[at - 1])) || (at + 1 < course.size() && other_face(course[at + 1]));
    found = found || std::any_of(loop.parents.begin(), loop.parents.end(), other_face) ||
            std::any_of(loop.children.begin(), loop.children.end(), other_face);
    two_faced += found ? 1 : 0;
  }
  return static_cast<double>(two_faced) / static_cast<double>(fabric.loops.size());
}

double swatch_mass_g(const YarnGraph& graph, const PlacedPiece& piece, const GeometryOptions& options,
                     const MachineModel& machine) {
  double length = 0;  // d
  for (std::size_t y = 0; y < graph.yarns.size(); ++y)
    for (std::size_t k = 0; k < graph.yarns[y].loops.size(); ++k)
      length += rest_length_of(graph.loop(graph.yarns[y].loops[k]), piece.sinkers[y][k],
                               piece.sinkers[y][k + 1], options);
  return length * options.diameter_mm * 1e-3 * machine.linear_density_tex * 1e-3;  // m, g
}

RelaxOptions swatch_options(const Fabric& first, const Program& program, int most_iterations) {
  RelaxOptions options = relax_options(first, program, {});
  options.model.free = {};   // the lattice of a cell, whatever edges the programme has
  options.tolerance = 1e-3;  // sizes do not change in the fourth figure below that
  options.most_iterations = most_iterations;
  return options;
}

KnittedRest relax_first(const Fabric& first, const YarnGraph& graph, const Program& program,
                        const MachineModel& machine, int needles, int most_iterations) {
  const double share = two_faced_share(graph, first);
  KnittingHistory history;
  history.machine_width_mm = needles * 25.4 / machine.gauge_npi;
  history.take_down_N = needles * machine.take_down_N;
  history.flat_gap_mm = (1 - share) * machine.one_layer_mm + share * machine.two_layers_mm;
  history.hand_pull_N_m = machine.hand_pull_N_m;
  return relax_as_knitted(first, swatch_options(first, program, most_iterations), history);
}

SwatchPrediction predict_by_cell(const std::filesystem::path& file, const SwatchWork& work) {
  SwatchPrediction p;
  const MachineModel& machine = work.machine;
  const double start = now_s();
  const Knitting knitting = knit_swatch(file, machine);
  const double knitted = now_s();
  const YarnGraph& graph = knitting.graph;
  const GeometryOptions geometry = make_geometry_options(knitting.program);
  const PlacedPiece piece = place_type_points(graph, geometry);
  p.mass_g = swatch_mass_g(graph, piece, geometry, machine);
  const std::optional<FoundRepeat> repeat = find_repeat(graph, measured_loops(graph));
  p.seconds_knit = knitted - start;
  if (!repeat) {
    p.trouble = "no repeat found";
    return p;
  }
  const Fabric first = fit_fabric(cut_periodic_cell(graph, geometry, piece, repeat->range), graph, geometry);
  p.cell_wales = repeat->range.wales, p.cell_courses = repeat->courses;
  p.loops = static_cast<int>(first.loops.size());
  const double placed = now_s();
  p.seconds_geometry = placed - knitted;

  const RelaxOptions options = swatch_options(first, knitting.program, work.most_iterations);
  const KnittedRest rest =
      relax_first(first, graph, knitting.program, machine, p.cell_wales, work.most_iterations);
  const RelaxResult& relaxed = rest.relaxed;
  p.seconds_relax = now_s() - placed;
  p.newton_iterations = relaxed.newton_iterations;
  p.pass_throughs = relaxed.pass_throughs;
  p.converged = rest.on_machine.converged && relaxed.converged;
  const InterlacingCheck check = check_interlacings(relaxed.fabric);
  p.interlacings = check.expected, p.interlacings_intact = check.intact;
  const InterlacingCheck at_first = check_interlacings(first);
  p.is_certified = at_first.intact == at_first.expected && p.pass_throughs == 0;
  const auto inner = [&](double d, int of_cell, int measured) {
    return d * first.diameter_mm / of_cell * measured;
  };
  p.width_mm = inner(relaxed.fabric.width, p.cell_wales, measured_wales);
  p.height_mm = inner(relaxed.fabric.height, p.cell_courses, measured_courses);
  if (!work.state.empty()) write_state(work.state, saved_state(relaxed, options, 1));

  if (work.stretched) {
    // One load at a time, borne by all courses or all wales of the whole swatch alike.
    constexpr int all_wales = 84, all_courses = 90;
    RelaxOptions loaded = options;
    loaded.grow_in = false;
    loaded.model.plates = relaxed.plates;
    const double load = machine.stretch_load_N / force_unit_N(options.model.material, first.diameter_mm);
    const RelaxResult wide = relax_on(relaxed, loaded, {load / all_courses * p.cell_courses, 0, 0});
    const RelaxResult high = relax_on(relaxed, loaded, {0, load / all_wales * p.cell_wales, 0});
    p.stretched_width_mm = inner(wide.fabric.width, p.cell_wales, measured_wales);
    p.stretched_height_mm = inner(high.fabric.height, p.cell_courses, measured_courses);
    p.stretched_converged = wide.converged && high.converged;
    p.seconds_stretch = now_s() - placed - p.seconds_relax;
  }
  return p;
}

}  // namespace loopwright
