#include "loop_scale/relaxed_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopwright {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// Loops first .. last of a yarn, neighbours in a course, all in one direction.
struct Run {
  std::size_t yarn = 0, first = 0, last = 0;
};

std::vector<Run> runs_of(const YarnGraph& graph, const BindingPoints& points) {
  std::vector<Run> runs;
  for (std::size_t y = 0; y < graph.yarns.size(); ++y) {
    const std::vector<LoopId>& loops = graph.yarns[y].loops;
    for (std::size_t first = 0; first < loops.size();) {
      std::size_t last = first;
      while (last + 1 < loops.size() && joined_by_weft(points, loops[last], loops[last + 1]) &&
             graph.loop(loops[last]).direction == graph.loop(loops[last + 1]).direction)
        ++last;
      runs.push_back({y, first, last});
      first = last + 1;
    }
  }
  return runs;
}

// Runs in turn on the front and on the back bed, with the yarn going over as a weft spring: rounds of a tube.
struct Round {
  Run one, other;
};

std::vector<Round> rounds_of(const YarnGraph& graph, const BindingPoints& points) {
  std::vector<Round> rounds;
  const std::vector<Run> runs = runs_of(graph, points);
  for (std::size_t k = 0; k + 1 < runs.size(); ++k) {
    const Run &one = runs[k], &other = runs[k + 1];
    if (one.yarn != other.yarn || one.last == one.first || other.last == other.first) continue;
    const std::vector<LoopId>& loops = graph.yarns[one.yarn].loops;
    const auto bed = [&](const Run& run) { return graph.loop(loops[run.first]).side; };
    const auto one_bed = [&](const Run& run) {
      for (std::size_t i = run.first; i <= run.last; ++i)
        if (graph.loop(loops[i]).side != bed(run)) return false;
      return true;
    };
    if (bed(one) == bed(other) || !one_bed(one) || !one_bed(other)) continue;
    if (graph.loop(loops[one.first]).direction == graph.loop(loops[other.first]).direction) continue;
    if (!joined_by_weft(points, loops[one.last], loops[other.first])) continue;
    rounds.push_back({one, other});
    ++k;
  }
  return rounds;
}

// A flat tube laid round a cylinder of its width: what lies on the front bed in front, the rest behind. Where
// less than half the piece is knitted in rounds it is no tube and stays as it is.
std::vector<Vec3> round_start(const YarnGraph& graph, const LoopModel& model) {
  std::size_t in_rounds = 0;
  for (const Round& round : rounds_of(graph, model.points))
    for (const Run& run : {round.one, round.other}) in_rounds += run.last - run.first + 1;
  if (2 * in_rounds < graph.loops.size()) return model.start;
  double left = model.start[0].x, right = left;
  for (const Vec3& p : model.start) left = std::min(left, p.x), right = std::max(right, p.x);
  const double wide = right - left + model.geometry.wale_pitch, radius = wide / std::numbers::pi;
  std::vector<Vec3> places = model.start;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double share = (places[i].x - left + model.geometry.wale_pitch / 2) / wide;
    const double angle = std::numbers::pi * (1 - share);
    const bool front = is_front(model.points.points[i].bed);
    places[i].x = (left + right) / 2 + radius * std::cos(angle);
    places[i].z = (front ? radius : -radius) * std::sin(angle);
  }
  return places;
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

RelaxedLayout relaxed_layout(const YarnGraph& graph, const Program& program, const LoopModelOptions& options,
                             const SettleOptions& settling) {
  RelaxedLayout layout{build_loop_model(graph, program, options), {}, {}, {}};
  LoopModel& model = layout.model;
  layout.state = state_at_rest(round_start(graph, model));
  NetKernel kernel(model.net);
  layout.result = settle(kernel, model.net, layout.state, settling);
  layout.curves = curves_at(model, layout.state);
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
    measure.roundness = norm(area) * 4 * std::numbers::pi / (measure.perimeter * measure.perimeter);
    measures.push_back(measure);
  }
  return measures;
}

}  // namespace loopwright
