#include "geometry/fit_fabric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/stop.hpp"
#include "geometry/centreline.hpp"
#include "topology/courses.hpp"

namespace loopwright {
namespace {

constexpr std::size_t samples_per_segment = 4;

Centreline centreline_of(const CurveYarn& curve, const Vec3& shift) {
  std::vector<Vec3> points;
  for (const TypePoint& point : curve.points) points.push_back(point.position);
  return curve.periodic ? Centreline::periodic(points, shift) : Centreline::open(points);
}

std::vector<double> cumulative(const std::vector<double>& lengths) {
  std::vector<double> sums{0};
  for (const double length : lengths) sums.push_back(sums.back() + length);
  return sums;
}

// Points of the centreline at equal rest length; `count` steps, the last point only for open yarns.
std::vector<Vec3> equal_samples(const Centreline& line, const std::vector<double>& rest, bool periodic,
                                std::size_t count) {
  std::vector<Vec3> samples;
  std::size_t piece = 0;
  for (std::size_t k = 0; k < count + (periodic ? 0 : 1); ++k) {
    const double at = rest.back() * static_cast<double>(k) / static_cast<double>(count);
    while (piece + 2 < rest.size() && rest[piece + 1] < at) ++piece;
    const double step = rest[piece + 1] - rest[piece];
    samples.push_back(line.position(piece, step > 0 ? std::clamp((at - rest[piece]) / step, 0.0, 1.0) : 0));
  }
  return samples;
}

// Few segments cannot go through everything: interpolation at the knots alone cuts the bends between them and
// may halve the clearance of a crossing. Moves the control points toward the least-squares fit of all samples
// (progressive iterative approximation: every control point takes the mean error of the samples that it acts
// on).
void approach_samples(const Fabric& fabric, const std::vector<Vec3>& samples, FabricYarn& yarn) {
  constexpr int sweeps = 12;
  const std::size_t n = yarn.control_points.size();
  // Weights of the four control points at u = 0, 1/4, 1/2, 3/4 of a segment.
  std::array<std::array<double, 4>, samples_per_segment> weights{};
  for (std::size_t j = 0; j < samples_per_segment; ++j) {
    const double u = static_cast<double>(j) / samples_per_segment, v = 1 - u;
    weights[j] = {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
                  (-3 * u * u * u + 3 * u * u + 3 * u + 1) / 6, u * u * u / 6};
  }
  const Vec3 shift = fabric.lattice(yarn.shift[0], yarn.shift[1]);
  std::vector<Vec3> change(n);
  std::vector<double> weight(n);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    stop_if_told();
    std::fill(change.begin(), change.end(), Vec3{});
    std::fill(weight.begin(), weight.end(), 0);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const std::size_t segment = k / samples_per_segment;
      const std::array<double, 4>& w = weights[k % samples_per_segment];
      Vec3 error = samples[k];
      for (std::size_t i = 0; i < 4; ++i) {
        if (w[i] == 0) continue;
        const std::size_t at = segment + i;
        error -= (at < n ? yarn.control_points[at] : yarn.control_points[at - n] + shift) * w[i];
      }
      for (std::size_t i = 0; i < 4; ++i) {
        if (w[i] == 0) continue;
        const std::size_t at = segment + i < n ? segment + i : segment + i - n;
        change[at] += error * w[i];
        weight[at] += w[i];
      }
    }
    // Ends stay where interpolation put them.
    const std::size_t first = yarn.periodic ? 0 : 2, last = yarn.periodic ? n : n - 2;
    for (std::size_t i = first; i < last; ++i) yarn.control_points[i] += change[i] / weight[i];
  }
}

// Control point k has most weight at parameter k - 1.
void hold_control_points(const CurveYarn& curve, const std::vector<double>& rest, FabricYarn& yarn) {
  const int n = static_cast<int>(yarn.control_points.size());
  yarn.held.assign(yarn.control_points.size(), 0);
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    if (!curve.points[k].held) continue;
    const double t = rest[k] / yarn.segment_rest_length;
    int i = static_cast<int>(std::lround(t)) + 1;
    if (yarn.periodic) i = (i % n + n) % n;
    yarn.held[static_cast<std::size_t>(std::clamp(i, 0, n - 1))] = 1;
  }
  if (yarn.periodic) return;
  // An end is its first three control points; holding the outer two holds its place and leaves its direction
  // free.
  if (curve.points.front().held) yarn.held[0] = yarn.held[1] = 1;
  if (curve.points.back().held) yarn.held[yarn.held.size() - 1] = yarn.held[yarn.held.size() - 2] = 1;
}

void add_spans(const CurveYarn& curve, const std::vector<double>& rest, const YarnGraph& graph,
               const std::vector<int>& courses, int yarn_index, double segment,
               std::vector<LoopSpan>& spans) {
  const std::size_t n = curve.points.size();
  std::size_t begin = 0;
  while (begin + 1 < n || (curve.periodic && begin < n)) {
    std::size_t end = begin + 1;
    while (end < n && curve.points[end].part != LoopPart::sinker) ++end;
    if (end == n && !curve.periodic) end = n - 1;
    std::size_t first_head = end, last_head = begin;
    for (std::size_t k = begin; k < end; ++k) {
      if (curve.points[k].part != LoopPart::head) continue;
      first_head = std::min(first_head, k);
      last_head = k;
    }
    const std::size_t apex = (first_head + last_head) / 2;
    LoopSpan span;
    span.loop = curve.points[apex].loop;
    const Loop& loop = graph.loop(span.loop);
    span.yarn = yarn_index;
    span.begin = rest[begin] / segment;
    span.apex = rest[apex] / segment;
    span.end = rest[end] / segment;
    span.at = loop.at;
    span.kind = loop.kind;
    span.side = loop.side;
    span.direction = loop.direction;
    span.course = courses[span.loop.position()];
    span.slot = loop.slot;
    span.bed = loop.bed;
    spans.push_back(span);
    begin = end;
    if (end >= n) break;
  }
}

}  // namespace

std::vector<Vec3> periodic_control_points(const std::vector<Vec3>& samples, const Vec3& shift) {
  // sample k = (q_k + 4 q_(k+1) + q_(k+2)) / 6, unknowns x_k = q_(k+1); q_0 = x_(n-1) - shift
  const std::size_t n = samples.size();
  std::vector<double> lower(n, 1), diagonal(n, 4), upper(n, 1);
  std::vector<Vec3> right = samples;
  for (Vec3& each : right) each *= 6;
  right[0] += shift;
  right[n - 1] -= shift;
  const std::vector<Vec3> x = solve_cyclic_tridiagonal(lower, diagonal, upper, right);
  std::vector<Vec3> control{x[n - 1] - shift};
  control.insert(control.end(), x.begin(), x.end() - 1);
  return control;
}

std::vector<Vec3> open_control_points(const std::vector<Vec3>& samples) {
  const std::size_t n = samples.size();  // samples at t = 0 .. n - 1; control points n + 2
  std::vector<double> lower(n, 1), diagonal(n, 4), upper(n, 1);
  std::vector<Vec3> right = samples;
  for (Vec3& each : right) each *= 6;
  // Zero second derivative at an end means that the control point there lies on the sample.
  diagonal[0] = diagonal[n - 1] = 6;
  upper[0] = lower[n - 1] = 0;
  const std::vector<Vec3> inner = solve_tridiagonal(lower, diagonal, upper, right);
  std::vector<Vec3> control{inner[0] * 2 - inner[1]};
  control.insert(control.end(), inner.begin(), inner.end());
  control.push_back(inner[n - 1] * 2 - inner[n - 2]);
  return control;
}

Fabric fit_fabric(const YarnCurves& curves, const YarnGraph& graph, const GeometryOptions& options,
                  const FitOptions& fit) {
  Fabric fabric;
  fabric.diameter_mm = curves.diameter_mm;
  fabric.periodic = curves.periodic;
  fabric.width = curves.width;
  fabric.height = curves.height;
  fabric.skew = curves.skew;
  fabric.wales = curves.wales;
  fabric.courses = curves.courses;
  fabric.interlacings = curves.interlacings;
  const double wanted = options.loop_length / fit.segments_per_loop;
  const std::vector<int> courses = course_numbers(graph);
  for (const CurveYarn& curve : curves.yarns) {
    stop_if_told();
    FabricYarn yarn;
    yarn.yarn = curve.yarn;
    yarn.carrier = curve.carrier;
    yarn.diameter = curve.diameter;
    yarn.periodic = curve.periodic;
    yarn.shift = curve.shift;
    const std::size_t carrier = curve.carrier.position();
    if (curve.carrier.valid() && carrier < options.yarn_colours.size()) {
      yarn.colour = options.yarn_colours[carrier];
      yarn.linear_density_tex = options.yarn_tex[carrier];
      yarn.liveliness = options.yarn_liveliness[carrier];
    }
    const std::vector<double> rest = cumulative(curve.rest_length);
    const double fewest = curve.periodic ? 6 : 4;
    const std::size_t segments = static_cast<std::size_t>(std::max(fewest, std::round(rest.back() / wanted)));
    yarn.segment_rest_length = rest.back() / static_cast<double>(segments);
    const Vec3 shift = fabric.lattice(curve.shift[0], curve.shift[1]);
    const Centreline line = centreline_of(curve, shift);
    const std::vector<Vec3> knots = equal_samples(line, rest, curve.periodic, segments);
    yarn.control_points = curve.periodic ? periodic_control_points(knots, shift) : open_control_points(knots);
    approach_samples(fabric, equal_samples(line, rest, curve.periodic, segments * samples_per_segment), yarn);
    hold_control_points(curve, rest, yarn);
    add_spans(curve, rest, graph, courses, static_cast<int>(fabric.yarns.size()), yarn.segment_rest_length,
              fabric.loops);
    fabric.yarns.push_back(std::move(yarn));
  }
  return fabric;
}

}  // namespace loopwright
