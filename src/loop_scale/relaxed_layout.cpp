#include "loop_scale/relaxed_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/layout.hpp"
#include "geometry/mend_crossings.hpp"
#include "geometry/type_points.hpp"
#include "loop_scale/metric_start.hpp"
#include "loop_scale/tube_walls.hpp"

namespace loopwright {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// A flat tube laid round a cylinder of its width: the front wall in front, the rear one behind. Where less
// than half the piece is knitted in rounds it is no tube: empty.
std::vector<Vec3> round_start(const YarnGraph& graph, const LoopModel& model) {
  std::size_t in_rounds = 0;
  for (const Round& round : rounds_of(graph, model.points))
    in_rounds += round.one.size() + round.other.size();
  if (2 * in_rounds < graph.loops.size()) return {};
  double left = model.start[0].x, right = left;
  for (const Vec3& p : model.start) left = std::min(left, p.x), right = std::max(right, p.x);
  const double wide = right - left + model.geometry.wale_pitch, radius = wide / std::numbers::pi;
  std::vector<Vec3> places = model.start;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (model.wall[i] == 0) continue;  // flat cloth before or after the tube
    const double share = (places[i].x - left + model.geometry.wale_pitch / 2) / wide;
    const double angle = std::numbers::pi * (1 - share);
    places[i].x = (left + right) / 2 + radius * std::cos(angle);
    places[i].z = model.wall[i] * radius * std::sin(angle);
  }
  return places;
}

// At the edges of a flat tube the map sees neighbours on one side only; in space the course goes on in the
// other wall.
void turn_edges(const YarnGraph& graph, const LoopModel& model, const std::vector<Vec3>& places,
                std::vector<Rotation>& turns) {
  const auto lower = [&](LoopId id) { return at(model.points.lower[id.position()]); };
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    const Loop& loop = graph.loops[k];
    const std::vector<LoopId>& yarn = graph.yarns[loop.yarn.position()].loops;
    const std::size_t order = static_cast<std::size_t>(loop.order);
    if (order == 0 || order + 1 >= yarn.size() || loop.parents.empty()) continue;
    const std::size_t before = lower(yarn[order - 1]), after = lower(yarn[order + 1]), own = lower(LoopId(k));
    const bool over = model.wall[own] * model.wall[before] < 0 || model.wall[own] * model.wall[after] < 0;
    if (!over) continue;
    Vec3 course = places[after] - places[before];
    if (loop.direction == Direction::left) course = -course;
    const Vec3 wale = places[at(model.points.upper[k])] - places[lower(loop.parents.front())];
    turns[k] = mean_rotation({course, wale, {}}, turns[k]);
  }
}

// How the cloth is turned at every binding point, from that of the loops that have their feet there, else
// those that have their heads there. Loops that do not know it take it from those they are drawn through or
// that are drawn through them, else from their neighbours in the yarn.
std::vector<Rotation> turns_of(const YarnGraph& graph, const LoopModel& model,
                               const std::vector<Vec3>& places) {
  std::vector<std::uint8_t> known;
  std::vector<Rotation> turns = model.map.frames(places, &known);
  turn_edges(graph, model, places, turns);
  const auto add = [](Rotation& sum, const Rotation& turn) {
    sum.x += turn.x, sum.y += turn.y, sum.z += turn.z;
  };
  const Rotation nothing{{}, {}, {}};
  for (bool going_on = true; going_on;) {
    going_on = false;
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < graph.loops.size(); ++k) {
      if (known[k] != 0) continue;
      Rotation sum = nothing;
      int count = 0;
      const auto take = [&](LoopId id) {
        if (known[id.position()] == 0) return;
        add(sum, turns[id.position()]);
        ++count;
      };
      const Loop& loop = graph.loops[k];
      for (const std::vector<LoopId>* list : {&loop.parents, &loop.children})
        for (const LoopId id : *list) take(id);
      const std::vector<LoopId>& yarn = graph.yarns[loop.yarn.position()].loops;
      for (const int other : {loop.order - 1, loop.order + 1})
        if (count == 0 && other >= 0 && other < static_cast<int>(yarn.size()) &&
            graph.loop(yarn[static_cast<std::size_t>(other)]).direction == loop.direction)
          take(yarn[static_cast<std::size_t>(other)]);
      if (count == 0) continue;
      turns[k] = mean_rotation(sum, turns[k]);
      found.push_back(k);
    }
    for (const std::size_t k : found) known[k] = 1, going_on = true;
  }
  std::vector<Rotation> at_points;
  for (const BindingPoint& point : model.points.points) {
    const std::vector<LoopId>& loops = point.lower_of.empty() ? point.upper_of : point.lower_of;
    Rotation sum = nothing;
    for (const LoopId id : loops) add(sum, turns[id.position()]);
    at_points.push_back(mean_rotation(sum, turns[loops.front().position()]));
  }
  return at_points;
}

// Whether the flat start tears many loops far from what they are joined to: whole stretches of needles were
// moved against the rows before, as in decreases all along the rows.
bool is_torn(const MassSpringNet& net, const std::vector<Vec3>& start) {
  constexpr double far = 2, few = 0.05;
  double torn = 0, warps = 0;
  for (const Spring& spring : net.springs) {
    if (spring.kind != SpringKind::warp) continue;
    warps += 1;
    if (distance(start[at(spring.a)], start[at(spring.b)]) > far * norm(spring.rest)) torn += 1;
  }
  return torn > few * warps;
}

// Whether stitches lie on both sides of the cloth.
bool is_folded(const MassSpringNet& net) {
  return std::any_of(net.springs.begin(), net.springs.end(), [](const Spring& s) { return s.rest.z != 0; });
}

// Such a piece laid out by the lengths of its springs instead of its needles, facing as the flat one does on
// the whole. Empty where that cannot be.
std::vector<Vec3> metric_places(const YarnGraph& graph, const LoopModel& model) {
  std::vector<Vec3> places = metric_start(model.net);
  if (places.empty()) return places;
  Rotation whole{{}, {}, {}};
  for (const Rotation& turn : turns_of(graph, model, places))
    whole.x += turn.x, whole.y += turn.y, whole.z += turn.z;
  whole = mean_rotation(whole, {});
  for (Vec3& place : places) place = whole.transposed(place);
  return places;
}

// A start without folds, and the damping of its sheet over the net's.
struct Start {
  std::vector<Vec3> places;
  double damping = 1;
};

struct FoldedSheet {
  std::vector<Vec3> places;
  SettleResult result;  // of the sheet
};

// From a start without folds to one with them: the piece comes to rest as a sheet, whose springs are as long
// as the folded ones reach along it, then the stitches of the two beds go to their two sides of the sheet.
// Folded from the start, ribs and purls of a piece that still has far to go fold any way.
FoldedSheet folded_sheet(const YarnGraph& graph, const LoopModel& model, const Start& start,
                         const SettleOptions& settling) {
  MassSpringNet sheet = model.net;
  for (Spring& spring : sheet.springs) {
    const Vec3 along{spring.rest.x, spring.rest.y, 0};
    if (norm(along) > 0.1 * norm(spring.rest)) spring.rest = along;
  }
  sheet.damping *= start.damping;
  NetState state = state_at_rest(start.places);
  NetKernel kernel(sheet);
  FoldedSheet result{{}, settle(kernel, sheet, state, settling)};
  std::vector<Vec3>& places = result.places;
  places = positions_of(state);
  const std::vector<Rotation> turns = turns_of(graph, model, places);
  double depth[3] = {0, 0, 0}, count[3] = {0, 0, 0};  // mean z of a wall
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t w = static_cast<std::size_t>(model.wall[i] + 1);
    depth[w] += model.start[i].z;
    count[w] += 1;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t w = static_cast<std::size_t>(model.wall[i] + 1);
    places[i] += turns[i].z * (model.start[i].z - depth[w] / count[w]);
  }
  return result;
}

// Where a piece starts, and how it comes to rest as a sheet before it folds. Nothing for a sheet without
// folds: it starts as it is.
Start start_of(const YarnGraph& graph, const LoopModel& model) {
  Start start;
  start.places = round_start(graph, model);
  if (start.places.empty() && is_torn(model.net, model.start)) start.places = metric_places(graph, model);
  if (start.places.empty() && is_folded(model.net)) {
    start.places = model.start;
    for (std::size_t i = 0; i < start.places.size(); ++i)
      if (model.wall[i] == 0) start.places[i].z = 0;
    // slowly: what overshoots in a plane passes through itself
    start.damping = 5;
  }
  return start;
}

}  // namespace

LoopModelOptions layout_options() {
  LoopModelOptions options;
  options.shear = 0.1;
  options.fold = 0.25;
  options.bend = 0.1;
  return options;
}

SettleOptions layout_settling() {
  SettleOptions options;
  options.tolerance = 2e-4;
  return options;
}

// First curves where the masses are: the type value points are placed anew, round binding points that turn as
// the cloth does, so that every crossing is as the template has it. (The correlation map would carry along
// what the flat layout had to do to loops that were moved far.)
Layout placed_layout(const YarnGraph& graph, const LoopModel& model, const std::vector<Vec3>& places) {
  const std::vector<Rotation> turns = turns_of(graph, model, places);
  MovedPlaces moved;
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    const std::size_t low = at(model.points.lower[k]), high = at(model.points.upper[k]);
    moved.lower.push_back(places[low]);
    moved.upper.push_back(places[high]);
    moved.turn_lower.push_back(turns[low]);
    moved.turn_upper.push_back(turns[high]);
  }
  moved.wall = tube_walls(graph, rounds_of(graph, model.points));
  return moved_layout(graph, model.geometry, lay_out(graph, model.geometry), std::move(moved));
}

YarnCurves placed_curves(const YarnGraph& graph, const LoopModel& model, const std::vector<Vec3>& places) {
  return build_yarn_curves(graph, model.geometry, lay_out(graph, model.geometry),
                           placed_layout(graph, model, places));
}

RelaxedLayout relaxed_layout(const YarnGraph& graph, const Program& program, const LoopModelOptions& options,
                             const SettleOptions& settling) {
  RelaxedLayout layout{build_loop_model(graph, program, options)};
  LoopModel& model = layout.model;
  const Start start = start_of(graph, model);
  FoldedSheet sheet{model.start, {}};
  if (!start.places.empty()) sheet = folded_sheet(graph, model, start, settling);
  layout.state = state_at_rest(sheet.places);
  NetKernel kernel(model.net);
  layout.result = settle(kernel, model.net, layout.state, settling);
  const Layout flat = lay_out(graph, model.geometry);
  Layout placed = placed_layout(graph, model, positions_of(layout.state));
  const auto wrong = [&](const Layout& of) { return wrong_interlacings(graph, model.geometry, flat, of); };
  // A net whose parts are at odds (rows of different heights on the two beds) may roll up or fold where cloth
  // could not, so that yarns change places. If the sheet has fewer wrong interlacings, it is the layout.
  if (!start.places.empty()) {
    Layout of_sheet = placed_layout(graph, model, sheet.places);
    if (wrong(of_sheet) < wrong(placed)) {
      placed = std::move(of_sheet);
      layout.state = state_at_rest(sheet.places);
      layout.result = sheet.result;
      layout.is_sheet = true;
    }
  }
  constexpr int most_trials = 400;  // few beside the steps to rest
  MendedLayout mended = mended_layout(graph, model.geometry, flat, std::move(placed), most_trials);
  layout.wrong = mended.wrong;
  layout.curves = build_yarn_curves(graph, model.geometry, flat, std::move(mended.layout));
  // the size where it came to rest, as the first geometry counts it
  const auto reach = [](const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high - *low;
  };
  YarnCurves& curves = layout.curves;
  if (curves.wales > 1) curves.width = reach(layout.state.x) * curves.wales / (curves.wales - 1);
  curves.height = reach(layout.state.y);  // from the first lower to the last upper binding points
  return layout;
}

std::vector<CourseMeasure> course_measures(const YarnGraph& graph, const RelaxedLayout& layout) {
  std::vector<CourseMeasure> measures;
  for (const Run& run : runs_of(graph, layout.model.points)) {
    CourseMeasure measure;
    const std::vector<LoopId>& loops = graph.yarns[run.yarn].loops;
    measure.pass = graph.loop(loops[run.first]).pass;
    const auto place = [&](std::size_t i) {
      return layout.state.position(at(layout.model.points.lower[loops[i].position()]));
    };
    for (std::size_t i = run.first; i <= run.last; ++i) {
      ++measure.stitches;
      measure.height += place(i).y;
      if (i > run.first) measure.width += distance(place(i - 1), place(i));
    }
    measure.height /= measure.stitches;
    measures.push_back(measure);
  }
  return measures;
}

std::vector<RoundMeasure> round_measures(const YarnGraph& graph, const RelaxedLayout& layout) {
  std::vector<RoundMeasure> measures;
  for (const Round& round : rounds_of(graph, layout.model.points)) {
    std::vector<Vec3> ring;
    for (const Run& run : {round.one, round.other})
      for (std::size_t i = run.first; i <= run.last; ++i)
        ring.push_back(
            layout.state.position(at(layout.model.points.lower[graph.yarns[run.yarn].loops[i].position()])));
    RoundMeasure measure;
    measure.loops = static_cast<int>(ring.size());
    Vec3 area;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 &p = ring[i], &q = ring[(i + 1) % ring.size()];
      measure.perimeter += distance(p, q);
      area += cross(p - ring[0], q - ring[0]) / 2;
    }
    for (const Vec3& p : ring) measure.centre += p / static_cast<double>(ring.size());
    measure.area = area;
    measure.roundness = norm(area) * 4 * std::numbers::pi / (measure.perimeter * measure.perimeter);
    measures.push_back(measure);
  }
  return measures;
}

double enclosed_volume(const std::vector<RoundMeasure>& rounds) {
  double volume = 0;
  for (std::size_t k = 0; k + 1 < rounds.size(); ++k) {
    const Vec3 way = rounds[k + 1].centre - rounds[k].centre;
    // the next round of the programme may belong to another tube
    if (norm(way) < rounds[k].perimeter / 2)
      volume += std::abs(dot((rounds[k].area + rounds[k + 1].area) / 2, way));
  }
  return volume;
}

}  // namespace loopwright
