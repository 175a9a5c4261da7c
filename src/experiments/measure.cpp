#include "experiments/measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "experiments/cover.hpp"

namespace loopwright {
namespace {

void require_measurable(const Fabric& fabric) {
  if (fabric.yarns.empty()) throw std::invalid_argument("a fabric without yarn cannot be measured");
  for (const FabricYarn& yarn : fabric.yarns) {
    if (yarn.segments() < 1) throw std::invalid_argument("a yarn without a segment cannot be measured");
    for (const Vec3& point : yarn.control_points)
      if (!is_finite(point)) throw std::invalid_argument("a control point of the fabric is not finite");
  }
}

// Highest and lowest point of the yarns' surfaces; the curve's own extremes lie within 1e-3 d of 16 points a
// segment.
double thickness(const Fabric& fabric) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const FabricYarn& yarn : fabric.yarns)
    for (const Vec3& point : polyline(fabric, yarn, 16)) {
      low = std::min(low, point.z - 0.5 * yarn.diameter);
      high = std::max(high, point.z + 0.5 * yarn.diameter);
    }
  return high - low;
}

double mean_loop_length(const Fabric& fabric) {
  double total = 0;
  int count = 0;
  for (const LoopSpan& span : fabric.loops) {
    if (span.kind == LoopKind::tuck) continue;
    total += arc_length(fabric, fabric.yarns[static_cast<std::size_t>(span.yarn)], span.begin, span.end);
    ++count;
  }
  return count > 0 ? total / count : std::numeric_limits<double>::quiet_NaN();
}

double wale_lean_degrees(const Fabric& fabric) {
  std::map<std::int32_t, Vec3> head;
  for (const LoopSpan& span : fabric.loops)
    head[span.loop.value] = position(fabric, fabric.yarns[static_cast<std::size_t>(span.yarn)], span.apex);
  Vec3 way;
  for (const PlacedInterlacing& each : fabric.interlacings) {
    const auto parent = head.find(each.parent.value), child = head.find(each.child.value);
    if (parent == head.end() || child == head.end()) continue;
    way += child->second + fabric.lattice(each.shift[0], each.shift[1]) - parent->second;
  }
  if (way == Vec3{}) return std::numeric_limits<double>::quiet_NaN();
  return std::atan2(way.x, way.y) * 180 / std::numbers::pi;
}

// What is measured of curves whose loops are not known.
std::vector<LoopSpan> whole_yarns(const Fabric& fabric) {
  std::vector<LoopSpan> spans(fabric.yarns.size());
  for (std::size_t y = 0; y < spans.size(); ++y) {
    spans[y].yarn = static_cast<int>(y);
    spans[y].end = fabric.yarns[y].segments();
  }
  return spans;
}

void measure_yarns(const Fabric& fabric, Measurements& m) {
  double mass = 0;
  bool weighed = true;
  const std::vector<LoopSpan> stretches = fabric.loops.empty() ? whole_yarns(fabric) : fabric.loops;
  for (const LoopSpan& span : stretches) {
    const FabricYarn& piece = fabric.yarns[static_cast<std::size_t>(span.yarn)];
    auto known = std::find_if(m.yarn.begin(), m.yarn.end(), [&](const YarnMeasurement& one) {
      return piece.yarn.valid() && one.yarn == piece.yarn;
    });
    if (known == m.yarn.end()) known = m.yarn.insert(m.yarn.end(), YarnMeasurement{piece.yarn, 0, {}});
    const double length_m = (span.end - span.begin) * piece.segment_rest_length * fabric.diameter_mm * 1e-3;
    known->length_m += length_m;
    m.yarn_m += length_m;
    if (piece.linear_density_tex > 0) {
      const double mass_g = length_m * 1e-3 * piece.linear_density_tex;  // tex: grams per kilometre
      known->mass_g = known->mass_g.value_or(0) + mass_g;
      mass += mass_g;
    } else {
      weighed = false;
    }
  }
  m.yarns = static_cast<int>(m.yarn.size());
  if (!weighed || stretches.empty()) return;
  m.mass_g = mass;
  if (fabric.loops.empty()) return;  // nor is it known what is cloth
  m.areal_density_g_m2 = mass / (m.width_mm * m.height_mm) * 1e6;
  const double tex = mass / m.yarn_m * 1e3;  // the mean one, where yarns differ
  m.tightness_factor = std::sqrt(tex) / (0.1 * m.loop_length_mm);
}

}  // namespace

Measurements measure(const Fabric& fabric) {
  require_measurable(fabric);
  Measurements m;
  m.loops = static_cast<int>(fabric.loops.size());
  m.wales = fabric.wales;
  m.courses = fabric.courses;

  m.width_mm = fabric.width * fabric.diameter_mm;
  m.height_mm = fabric.height * fabric.diameter_mm;
  m.thickness_mm = thickness(fabric) * fabric.diameter_mm;
  // curves of another program come without wales and courses: their spacings are not known
  const auto each = [](double length, double count) {
    return count > 0 ? length / count : std::numeric_limits<double>::quiet_NaN();
  };
  m.wale_spacing_mm = each(m.width_mm, m.wales);
  m.course_spacing_mm = each(m.height_mm, m.courses);
  m.wales_per_cm = 10 / m.wale_spacing_mm;
  m.courses_per_cm = 10 / m.course_spacing_mm;

  m.loop_length_mm = mean_loop_length(fabric) * fabric.diameter_mm;
  m.Kc = m.loop_length_mm / m.course_spacing_mm;
  m.Kw = m.loop_length_mm / m.wale_spacing_mm;
  m.Ks = m.Kc * m.Kw;
  m.wale_lean_degrees = wale_lean_degrees(fabric);
  m.cover_factor = cover_factor(fabric);
  measure_yarns(fabric, m);
  return m;
}

}  // namespace loopwright
