#include "loop_scale/correlation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace loopwright {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// Frame with x along the course and y in the plane of course and wale; nothing if they are parallel.
std::optional<Rotation> frame_of(const Vec3& course, const Vec3& wale) {
  const Vec3 normal = cross(course, wale);
  const double area = norm(normal), sides = norm(course) * norm(wale);
  if (!(area > 1e-6 * sides)) return std::nullopt;
  Rotation frame;
  frame.x = normalized(course);
  frame.z = normal / area;
  frame.y = cross(frame.z, frame.x);
  return frame;
}

double share_along(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 way = to - from;
  const double square = squared_norm(way);
  return square > 1e-18 ? std::clamp(dot(p - from, way) / square, 0.0, 1.0) : 0;
}

// What lies where yarns cross belongs to the binding point of that crossing alone.
double snapped(double share) { return share < 0.25 ? 0 : share > 0.75 ? 1 : share; }

}  // namespace

bool joined_by_weft(const BindingPoints& points, LoopId from, LoopId to) {
  const int a = points.lower[from.position()], b = points.lower[to.position()];
  return a != b && points.upper[from.position()] != b && points.upper[to.position()] != a;
}

CorrelationMap::CorrelationMap(const YarnGraph& graph, const BindingPoints& points,
                               const std::vector<Vec3>& places, const YarnCurves& curves)
    : masses_(points.points.size()) {
  if (places.size() != masses_)
    throw std::invalid_argument("correlation: one place a binding point is needed");
  // a loop's neighbours: in the course along the yarn, in the wale by who is drawn through whom
  const auto lower = [&](LoopId id) { return points.lower[id.position()]; };
  const auto upper = [&](LoopId id) { return points.upper[id.position()]; };
  stencils_.resize(graph.loops.size());
  start_frame_.resize(graph.loops.size());
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    const LoopId id(k);
    const Loop& loop = graph.loops[k];
    const std::vector<LoopId>& yarn = graph.yarns[loop.yarn.position()].loops;
    const auto neighbour = [&](LoopId of, int step) {
      const int order = graph.loop(of).order + step;
      if (order < 0 || order >= static_cast<int>(yarn.size())) return LoopId();
      const LoopId other = yarn[static_cast<std::size_t>(order)];
      // where the yarn turns, as round the edge of a flat tube, the loops were placed as if it went straight
      // on
      const bool turns = graph.loop(other).direction != graph.loop(of).direction;
      return !turns && joined_by_weft(points, of, other) ? other : LoopId();
    };
    LoopId before = neighbour(id, -1), after = neighbour(id, 1);
    // At an end of a course the second neighbour, which lies on the same bed in a 1 x 1 rib.
    if (!before.valid() && after.valid()) {
      if (const LoopId second = neighbour(after, 1); second.valid()) after = second;
    } else if (!after.valid() && before.valid()) {
      if (const LoopId second = neighbour(before, -1); second.valid()) before = second;
    }
    if (!before.valid()) before = id;
    if (!after.valid()) after = id;
    Stencil& stencil = stencils_[k];
    stencil.left = lower(loop.direction == Direction::left ? after : before);
    stencil.right = lower(loop.direction == Direction::left ? before : after);
    stencil.below = loop.parents.empty() ? lower(id) : lower(loop.parents.front());
    stencil.above = upper(id);
    if (loop.parents.empty() && !loop.children.empty()) stencil.above = upper(loop.children.front());
    const std::optional<Rotation> frame = frame_of(places[at(stencil.right)] - places[at(stencil.left)],
                                                   places[at(stencil.above)] - places[at(stencil.below)]);
    if (frame) {
      start_frame_[k] = *frame;
    } else {
      stencil.left = stencil.right;  // never a frame: it keeps its attitude
    }
  }

  first_.push_back(0);
  for (const CurveYarn& curve : curves.yarns) {
    const std::vector<LoopId>& yarn = graph.yarns[curve.yarn.position()].loops;
    for (std::size_t p = 0; p < curve.points.size(); ++p) {
      const TypePoint& point = curve.points[p];
      const std::size_t k = point.loop.position();
      const auto name = [](LoopId id) { return static_cast<std::int32_t>(id.position()); };
      std::array<Entry, 2> ends{Entry{points.lower[k], 1, name(point.loop)}, Entry{0, 0, 0}};
      double share = 0;
      const bool between = point.part == LoopPart::sinker || point.part == LoopPart::span;
      if (!between) {
        ends[1] = {points.upper[k], 0, name(point.loop)};
        share = snapped(share_along(places[at(ends[0].column)], places[at(ends[1].column)], point.position));
      } else {
        // a point between two loops names the one before it, or the nearer one on a float: look at both sides
        const int order = graph.loop(point.loop).order;
        const bool is_after = p + 1 < curve.points.size() && p > 0 && [&] {
          for (std::size_t q = p; q-- > 0;)
            if (curve.points[q].part != LoopPart::sinker && curve.points[q].part != LoopPart::span)
              return curve.points[q].loop != point.loop;
          return true;
        }();
        const int from = is_after ? order - 1 : order;
        if (p > 0 && from >= 0 && from + 1 < static_cast<int>(yarn.size())) {
          const LoopId a = yarn[static_cast<std::size_t>(from)], b = yarn[static_cast<std::size_t>(from) + 1];
          ends[0] = {points.lower[a.position()], 1, name(a)};
          ends[1] = {points.lower[b.position()], 0, name(b)};
          share = share_along(places[at(ends[0].column)], places[at(ends[1].column)], point.position);
        }
      }
      ends[0].weight = 1 - share;
      ends[1].weight = share;
      Vec3 foot;
      for (const Entry& e : ends)
        if (e.weight > 0) {
          entries_.push_back(e);
          foot += places[at(e.column)] * e.weight;
        }
      offset_.push_back(point.position - foot);
      first_.push_back(static_cast<std::int32_t>(entries_.size()));
    }
  }
}

std::vector<Rotation> CorrelationMap::frames(std::span<const Vec3> places,
                                             std::vector<std::uint8_t>* known) const {
  std::vector<Rotation> turned(stencils_.size());
  if (known != nullptr) known->assign(stencils_.size(), 0);
  for (std::size_t k = 0; k < stencils_.size(); ++k) {
    const Stencil& s = stencils_[k];
    const std::optional<Rotation> now =
        frame_of(places[at(s.right)] - places[at(s.left)], places[at(s.above)] - places[at(s.below)]);
    if (!now) continue;
    if (known != nullptr) (*known)[k] = 1;
    const Rotation& old = start_frame_[k];
    turned[k].x = *now * old.transposed({1, 0, 0});
    turned[k].y = *now * old.transposed({0, 1, 0});
    turned[k].z = *now * old.transposed({0, 0, 1});
  }
  return turned;
}

void CorrelationMap::map(std::span<const Vec3> places, std::span<const Rotation> frames,
                         std::vector<Vec3>& q) const {
  q.resize(rows());
  for (std::size_t r = 0; r < rows(); ++r) {
    Vec3 place;
    for (const Entry& e : row(r))
      place += (places[at(e.column)] + frames[at(e.loop)] * offset_[r]) * e.weight;
    q[r] = place;
  }
}

void CorrelationMap::linear(std::span<const Vec3> b, std::vector<Vec3>& out) const {
  out.assign(rows(), Vec3{});
  for (std::size_t r = 0; r < rows(); ++r)
    for (const Entry& e : row(r)) out[r] += b[at(e.column)] * e.weight;
}

void CorrelationMap::transposed(std::span<const Vec3> q, std::vector<Vec3>& out) const {
  out.assign(masses_, Vec3{});
  for (std::size_t r = 0; r < rows(); ++r)
    for (const Entry& e : row(r)) out[at(e.column)] += q[r] * e.weight;
}

YarnCurves moved_curves(const YarnCurves& curves, const std::vector<Vec3>& q) {
  YarnCurves moved = curves;
  std::size_t r = 0;
  for (CurveYarn& yarn : moved.yarns)
    for (TypePoint& point : yarn.points) point.position = q[r++];
  return moved;
}

}  // namespace loopwright
