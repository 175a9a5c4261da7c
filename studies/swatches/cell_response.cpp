#include "cell_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "geometry/find_repeat.hpp"
#include "geometry/fit_fabric.hpp"
#include "geometry/periodic_cell.hpp"

namespace loopwright {
namespace {

constexpr int border_wales = 12;

// Of the measured courses, the border at the left but for its outermost wales.
LoopSelection side_border(const YarnGraph& graph) {
  const LoopSelection inner = measured_loops(graph);
  int from = std::numeric_limits<int>::max(), to = std::numeric_limits<int>::min();
  double first = INFINITY;
  for (std::size_t i = 0; i < inner.size(); ++i) {
    first = std::min(first, graph.loops[i].slot);
    if (inner[i] != 0) from = std::min(from, graph.loops[i].pass), to = std::max(to, graph.loops[i].pass);
  }
  LoopSelection border(inner.size(), 0);
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Loop& loop = graph.loops[i];
    const double wale = loop.slot - first;
    border[i] = loop.pass >= from && loop.pass <= to && wale >= 1 && wale <= border_wales - 2 ? 1 : 0;
  }
  return border;
}

}  // namespace

std::vector<LoadedCell> cell_response(const std::filesystem::path& file, SwatchPart part,
                                      const MachineModel& machine) {
  const Knitting knitting = knit_swatch(file, machine);
  const YarnGraph& graph = knitting.graph;
  const GeometryOptions geometry = make_geometry_options(knitting.program);
  const PlacedPiece piece = place_type_points(graph, geometry);
  const std::optional<FoundRepeat> repeat =
      find_repeat(graph, part == SwatchPart::pattern ? measured_loops(graph) : side_border(graph));
  if (!repeat) throw std::runtime_error("no repeat found");
  const Fabric first = fit_fabric(cut_periodic_cell(graph, geometry, piece, repeat->range), graph, geometry);
  const int wales = repeat->range.wales;
  MachineModel not_pulled = machine;
  not_pulled.hand_pull_N_m = 0;
  const RelaxResult let_go =
      relax_first(first, graph, knitting.program, not_pulled, wales, SwatchWork{}.most_iterations).relaxed;

  const RelaxOptions usual = swatch_options(first, knitting.program, SwatchWork{}.most_iterations);
  const double d = first.diameter_mm * 1e-3, force = force_unit_N(usual.model.material, first.diameter_mm);
  std::vector<LoadedCell> all;
  using Loads = std::array<double, 3>;
  const auto under = [&](const RelaxResult& from, const Loads& load) {
    RelaxOptions options = usual;
    options.grow_in = false;
    options.model.plates = let_go.plates;
    options.model.free.skew = load[2] != 0;
    const double width = from.fabric.width * d / force, height = from.fabric.height * d / force;
    RelaxResult result =
        relax_on(from, options, {load[0] * height, load[1] * width, load[2] * width});
    all.push_back({load[0], load[1], load[2], result.fabric.width * d * 1e3 / wales * measured_wales,
                   result.fabric.height * d * 1e3 / repeat->courses * measured_courses,
                   result.fabric.skew / result.fabric.height, result.converged});
    return result;
  };
  const RelaxResult pulled = under(let_go, {machine.hand_pull_N_m, machine.hand_pull_N_m, 0});
  for (const Loads& load :
       {Loads{}, Loads{1, 0, 0}, Loads{-1, 0, 0}, Loads{3, 0, 0}, Loads{-3, 0, 0}, Loads{0, 1, 0},
        Loads{0, -1, 0}, Loads{0, 3, 0}, Loads{0, -3, 0}, Loads{0, 0, 1}, Loads{0, 0, -1}})
    under(pulled, load);
  return all;
}

}  // namespace loopwright
