#include "loop_scale/relaxed_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/layout.hpp"
#include "geometry/mend_crossings.hpp"
#include "geometry/type_points.hpp"
#include "loop_scale/cloth_turns.hpp"
#include "loop_scale/layout_start.hpp"
#include "loop_scale/tube_walls.hpp"

namespace loopwright {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// So many wrong interlacings are no sign that a net is not at rest as cloth is.
int few_wrong(const YarnGraph& graph) { return static_cast<int>(graph.loops.size() / 1000); }

// The layout where the net came to rest. A net whose parts are at odds (rows of different heights on the two
// beds) may roll up or fold where cloth could not, so that yarns change places: if fewer interlacings are
// wrong at the sheet, that is the layout.
MendedLayout mended_at_rest_or_sheet(const YarnGraph& graph, const Layout& flat, const FoldedSheet* sheet,
                                     RelaxedLayout& layout) {
  constexpr int most_trials = 400;  // few beside the steps to rest
  const LoopModel& model = layout.model;
  const auto mended = [&](Layout placed) {
    return mended_layout(graph, model.geometry, flat, std::move(placed), most_trials);
  };
  const auto wrong = [&](const Layout& of) { return wrong_interlacings(graph, model.geometry, flat, of); };
  Layout at_rest = placed_layout(graph, model, positions_of(layout.state));
  int left = wrong(at_rest);
  const bool far_off = left > few_wrong(graph);
  MendedLayout result{{}};
  if (!far_off || sheet == nullptr) {
    result = mended(at_rest);
    left = result.wrong;
  }
  if (sheet == nullptr || left == 0) return result;
  Layout at_sheet = placed_layout(graph, model, sheet->places);
  if (wrong(at_sheet) >= left) return far_off ? mended(std::move(at_rest)) : result;
  layout.state = state_at_rest(sheet->places);
  layout.result = sheet->result;
  layout.is_sheet = true;
  return mended(std::move(at_sheet));
}

}  // namespace

LoopModelOptions layout_options() {
  LoopModelOptions options;
  options.shear = 0.1;
  options.fold = 0.25;
  options.bend = 0.1;
  options.passing = 0.25;
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
  const std::vector<Rotation> turns = cloth_turns(graph, model, places);
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
  const LayoutStart start = layout_start(graph, model);
  FoldedSheet sheet{model.start, {}};
  if (!start.places.empty()) sheet = folded_sheet(graph, model, start, settling);
  layout.state = state_at_rest(sheet.places);
  NetKernel kernel(model.net);
  layout.result = settle(kernel, model.net, layout.state, settling);
  const Layout flat = lay_out(graph, model.geometry);
  MendedLayout mended = mended_at_rest_or_sheet(graph, flat, start.places.empty() ? nullptr : &sheet, layout);
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
