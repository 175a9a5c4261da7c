#include "geometry/fabric.hpp"

#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

std::array<double, 4> basis(double u) {
  const double v = 1 - u, u2 = u * u, u3 = u2 * u;
  return {v * v * v / 6, (3 * u3 - 6 * u2 + 4) / 6, (-3 * u3 + 3 * u2 + 3 * u + 1) / 6, u3 / 6};
}

std::array<double, 4> basis_slope(double u) {
  const double v = 1 - u;
  return {-v * v / 2, (3 * u * u - 4 * u) / 2, (-3 * u * u + 2 * u + 1) / 2, u * u / 2};
}

Vec3 blend(const Fabric& fabric, const FabricYarn& yarn, int segment, const std::array<double, 4>& weights) {
  Vec3 p;
  for (int k = 0; k < 4; ++k)
    p += control_point(fabric, yarn, segment + k) * weights[static_cast<std::size_t>(k)];
  return p;
}

}  // namespace

bool is_set(const Fabric& fabric) {
  return std::any_of(fabric.yarns.begin(), fabric.yarns.end(),
                     [](const FabricYarn& yarn) { return !yarn.natural_curvature.empty(); });
}

Vec3 control_point(const Fabric& fabric, const FabricYarn& yarn, int i) {
  const int n = static_cast<int>(yarn.control_points.size());
  if (i >= 0 && i < n) return yarn.control_points[static_cast<std::size_t>(i)];
  const int turns = i >= 0 ? i / n : -((n - 1 - i) / n);
  return yarn.control_points[static_cast<std::size_t>(i - turns * n)] +
         fabric.lattice(turns * yarn.shift[0], turns * yarn.shift[1]);
}

Vec3 position(const Fabric& fabric, const FabricYarn& yarn, double t) {
  int segment = static_cast<int>(std::floor(t));
  if (!yarn.periodic) segment = std::clamp(segment, 0, yarn.segments() - 1);
  return blend(fabric, yarn, segment, basis(t - segment));
}

std::vector<Vec3> polyline(const Fabric& fabric, const FabricYarn& yarn, int per_segment) {
  std::vector<Vec3> points;
  points.reserve(static_cast<std::size_t>(yarn.segments() * per_segment + 1));
  for (int e = 0; e < yarn.segments(); ++e)
    for (int k = 0; k < per_segment; ++k)
      points.push_back(blend(fabric, yarn, e, basis(static_cast<double>(k) / per_segment)));
  points.push_back(blend(fabric, yarn, yarn.segments() - 1, basis(1)));
  return points;
}

double arc_length(const Fabric& fabric, const FabricYarn& yarn) {
  return arc_length(fabric, yarn, 0, yarn.segments());
}

double arc_length(const Fabric& fabric, const FabricYarn& yarn, double begin, double end) {
  constexpr std::array<double, 4> node{0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                       0.93056815579702629};
  constexpr std::array<double, 4> weight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                         0.17392742256872693};
  double length = 0;
  while (begin < end) {
    // from here to the next knot, or to the end
    const int segment = static_cast<int>(std::floor(begin));
    const double stop = std::min(end, segment + 1.0), step = stop - begin;
    for (std::size_t g = 0; g < 4; ++g) {
      const double u = begin - segment + node[g] * step;
      length += step * weight[g] * norm(blend(fabric, yarn, segment, basis_slope(u)));
    }
    begin = stop;
  }
  return length;
}

}  // namespace loopwright
