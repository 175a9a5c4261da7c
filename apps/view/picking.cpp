#include "picking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace loopwright {

Sight line_of_sight(const Camera& camera, double aspect, double x, double y) {
  const double half = camera.height / 2;
  const Vec3 at = camera.target + camera.right() * (x * half * aspect) + camera.up * (y * half);
  if (camera.field_of_view_deg <= 0) return {at + camera.backward * camera.reach, -camera.backward};
  const Vec3 eye = camera.target + camera.backward * camera.eye_distance();
  return {eye, normalized(at - eye)};
}

int loop_span_at(const Fabric& fabric, int yarn, double t) {
  const FabricYarn& of = fabric.yarns[static_cast<std::size_t>(yarn)];
  const double turn = of.segments();
  for (std::size_t i = 0; i < fabric.loops.size(); ++i) {
    const LoopSpan& span = fabric.loops[i];
    if (span.yarn != yarn) continue;
    // spans of a periodic yarn may lie across its seam
    for (const double shift : {0.0, turn, -turn}) {
      if (shift != 0 && !of.periodic) continue;
      if (t + shift >= span.begin && t + shift < span.end) return static_cast<int>(i);
    }
  }
  return -1;
}

std::optional<PickedYarn> yarn_at(const Fabric& fabric, std::array<int, 2> repeats, const Sight& sight,
                                  const std::vector<double>& fed) {
  constexpr int per_segment = 4;
  std::optional<PickedYarn> best;
  double foremost = std::numeric_limits<double>::infinity();
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& yarn = fabric.yarns[y];
    std::vector<Vec3> points = polyline(fabric, yarn, per_segment);
    if (!fed.empty())
      points.resize(std::min(points.size(), static_cast<std::size_t>(std::ceil(per_segment * fed[y]))));
    const double radius = yarn.diameter / 2;
    for (int n = 0; n < repeats[1]; ++n)
      for (int m = 0; m < repeats[0]; ++m) {
        const Vec3 shift = fabric.lattice(m, n);
        for (std::size_t k = 0; k < points.size(); ++k) {
          const Vec3 to = points[k] + shift - sight.from;
          const double along = dot(to, sight.direction), aside = squared_norm(to - sight.direction * along);
          if (along <= 0 || aside > radius * radius) continue;
          // where the line enters the tube, seen as a row of balls
          const double depth = along - std::sqrt(radius * radius - aside);
          if (depth >= foremost) continue;
          foremost = depth;
          best = PickedYarn{
              static_cast<int>(y), static_cast<double>(k) / per_segment, {m, n}, -1, points[k] + shift};
        }
      }
  }
  if (best) best->loop = loop_span_at(fabric, best->yarn, best->t);
  return best;
}

}  // namespace loopwright
