#include "geometry/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stop.hpp"

namespace loopwright {
namespace {

void mark_held(const YarnGraph& graph, const std::vector<std::uint8_t>& inside, CurveYarn& curve) {
  curve.points.front().held = curve.points.back().held = true;
  for (std::size_t k = 1; k + 1 < curve.points.size(); ++k) {
    TypePoint& point = curve.points[k];
    const Loop& loop = graph.loop(point.loop);
    const auto outside = [&](const std::vector<LoopId>& loops) {
      return std::none_of(loops.begin(), loops.end(), [&](LoopId id) { return inside[id.position()] != 0; });
    };
    const LoopPart before = curve.points[k - 1].part, after = curve.points[k + 1].part;
    if (point.part == LoopPart::head && before == LoopPart::head && after == LoopPart::head) {
      const bool on_needle = loop.children.empty() && loop.fate == LoopFate::held;
      if (on_needle || (!loop.children.empty() && outside(loop.children))) point.held = true;
    }
    // The inner one of the two foot points, where the foot passes through the parents' heads.
    if (point.part == LoopPart::foot && (before == LoopPart::leg || after == LoopPart::leg))
      if (!loop.parents.empty() && outside(loop.parents)) point.held = true;
  }
}

void measure_extent(const YarnGraph& graph, const GeometryOptions& options, const Layout& layout,
                    const std::vector<LoopId>& loops, YarnCurves& curves) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double left = infinity, right = -infinity, bottom = infinity, top = -infinity;
  for (const LoopId id : loops) {
    const Vec3& place = layout.lower[id.position()];
    left = std::min(left, place.x);
    right = std::max(right, place.x);
    bottom = std::min(bottom, place.y);
    top = std::max(top, place.y);
  }
  curves.wales = wales_of(graph, loops);
  curves.courses = courses_of(layout, loops, curves.wales);
  curves.width = (right - left) * (curves.wales > 1 ? curves.wales / (curves.wales - 1) : 1);
  if (curves.wales <= 1) curves.width = options.wale_pitch;
  curves.height = top - bottom + options.course_pitch;
}

}  // namespace

std::vector<YarnRun> whole_yarns(const YarnGraph& graph) {
  std::vector<YarnRun> runs;
  for (std::size_t y = 0; y < graph.yarns.size(); ++y)
    if (!graph.yarns[y].loops.empty())
      runs.push_back({static_cast<int>(y), 0, static_cast<int>(graph.yarns[y].loops.size())});
  return runs;
}

double wales_of(const YarnGraph& graph, const std::vector<LoopId>& loops) {
  std::vector<double> slots;
  for (const LoopId id : loops) slots.push_back(graph.loop(id).slot);
  std::sort(slots.begin(), slots.end());
  double count = 0, last = -std::numeric_limits<double>::infinity();
  for (const double slot : slots) {
    if (slot - last < 0.25) continue;
    count += 1;
    last = slot;
  }
  return count;
}

double courses_of(const Layout& layout, const std::vector<LoopId>& loops, double wales) {
  double overlaid = 0;
  for (const LoopId id : loops) overlaid += layout.overlaid[id.position()];
  const double count = static_cast<double>(loops.size());
  return count / (wales * (1 + overlaid / count));
}

CurveYarn empty_curve(const YarnGraph& graph, const GeometryOptions& options, int yarn) {
  CurveYarn curve;
  curve.yarn = YarnId(yarn);
  curve.carrier = graph.yarns[static_cast<std::size_t>(yarn)].carrier;
  const std::size_t carrier = curve.carrier.position();
  if (curve.carrier.valid() && carrier < options.yarn_diameters.size())
    curve.diameter = options.yarn_diameters[carrier];
  return curve;
}

void append_loop(const Loop& loop, LoopId id, const PlacedSinker& before, const PlacedLoop& placed,
                 const PlacedSinker& after, const GeometryOptions& options, const Vec3& moved,
                 CurveYarn& curve) {
  const std::size_t begin = curve.points.size();
  const auto add = [&](TypePoint point) {
    point.position += moved;
    curve.points.push_back(point);
  };
  for (std::size_t k = before.middle + 1; k < before.points.size(); ++k) add(before.points[k]);
  for (const TypePoint& point : placed.points) add(point);
  for (std::size_t k = 0; k <= after.middle; ++k) add(after.points[k]);
  for (std::size_t k = begin; k < curve.points.size(); ++k)
    if (curve.points[k].part == LoopPart::span) curve.points[k].loop = id;

  // The loop's yarn is shared out as the chords are long, so that the fitted curve is not stretched unevenly.
  double whole = 0;
  for (std::size_t k = begin; k < curve.points.size(); ++k)
    whole += distance(curve.points[k - 1].position, curve.points[k].position);
  const double rest = rest_length_of(loop, before, after, options);
  for (std::size_t k = begin; k < curve.points.size(); ++k)
    curve.rest_length.push_back(rest * distance(curve.points[k - 1].position, curve.points[k].position) /
                                whole);
}

YarnCurves assemble_runs(const YarnGraph& graph, const GeometryOptions& options, const PlacedPiece& piece,
                         const std::vector<YarnRun>& runs) {
  YarnCurves curves;
  curves.diameter_mm = options.diameter_mm;
  std::vector<std::uint8_t> inside(graph.loops.size(), 0);
  std::vector<LoopId> loops;
  for (const YarnRun& run : runs)
    for (int k = run.first; k < run.first + run.count; ++k) {
      loops.push_back(graph.yarns[static_cast<std::size_t>(run.yarn)].loops[static_cast<std::size_t>(k)]);
      inside[loops.back().position()] = 1;
    }
  if (loops.empty()) return curves;
  for (const YarnRun& run : runs) {
    const std::size_t y = static_cast<std::size_t>(run.yarn);
    CurveYarn curve = empty_curve(graph, options, run.yarn);
    const PlacedSinker& first = piece.sinkers[y][static_cast<std::size_t>(run.first)];
    curve.points.push_back(first.points[first.middle]);
    for (int k = run.first; k < run.first + run.count; ++k) {
      stop_if_told();
      const LoopId id = graph.yarns[y].loops[static_cast<std::size_t>(k)];
      append_loop(graph.loop(id), id, piece.sinkers[y][static_cast<std::size_t>(k)],
                  piece.loops[id.position()], piece.sinkers[y][static_cast<std::size_t>(k) + 1], options,
                  Vec3{}, curve);
    }
    mark_held(graph, inside, curve);
    curves.yarns.push_back(std::move(curve));
  }
  for (const Interlacing& interlacing : graph.interlacings) {
    if (inside[interlacing.parent.position()] == 0 || inside[interlacing.child.position()] == 0) continue;
    PlacedInterlacing placed;
    placed.parent = interlacing.parent;
    placed.child = interlacing.child;
    placed.sign = interlacing.sign;
    curves.interlacings.push_back(placed);
  }
  measure_extent(graph, options, piece.layout, loops, curves);
  return curves;
}

}  // namespace loopwright
