#include "outputs/tube_mesh.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace loopwright {
namespace {

Vec3 any_normal(const Vec3& tangent) {
  // the axis that the tangent is farthest from; z wins ties, so that a course has its first normal out of the
  // cloth
  const double x = std::abs(tangent.x), y = std::abs(tangent.y), z = std::abs(tangent.z);
  const Vec3 axis = z <= x && z <= y ? Vec3{0, 0, 1} : y <= x ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  return normalized(axis - tangent * dot(axis, tangent));
}

// Tangents by central differences of the polyline; the end tangents of a periodic yarn see across the seam.
void set_tangents(std::vector<TubeRing>& rings, bool periodic) {
  const std::size_t n = rings.size();
  for (std::size_t k = 0; k < n; ++k) {
    Vec3 along;
    if (periodic && (k == 0 || k + 1 == n))
      along = (rings[1].centre - rings[0].centre) + (rings[n - 1].centre - rings[n - 2].centre);
    else
      along = rings[k + 1 < n ? k + 1 : k].centre - rings[k > 0 ? k - 1 : k].centre;
    const double length = norm(along);
    rings[k].tangent = length > 0 ? along / length : k > 0 ? rings[k - 1].tangent : Vec3{1, 0, 0};
  }
}

Vec3 reflected(const Vec3& a, const Vec3& mirror) {
  const double scale = squared_norm(mirror);
  return scale > 0 ? a - mirror * (2 * dot(mirror, a) / scale) : a;
}

// Double reflection: the first mirror carries one point onto the next, the second one tangent onto the next.
Vec3 carried_normal(const TubeRing& from, const TubeRing& to) {
  const Vec3 v1 = to.centre - from.centre;
  const Vec3 normal = reflected(from.normal, v1), tangent = reflected(from.tangent, v1);
  const Vec3 carried = reflected(normal, to.tangent - tangent);
  return normalized(carried - to.tangent * dot(carried, to.tangent));
}

void turn(TubeRing& ring, double angle) {
  ring.normal = ring.normal * std::cos(angle) + cross(ring.tangent, ring.normal) * std::sin(angle);
}

void add_cap(TubeMesh& mesh, const Vec3& outward, std::uint32_t first, std::uint32_t sides, bool at_end) {
  const auto normal = static_cast<std::uint32_t>(mesh.normals.size());
  mesh.normals.push_back(outward);
  for (std::uint32_t s = 1; s + 1 < sides; ++s) {
    const std::uint32_t b = first + s + (at_end ? 0 : 1), c = first + s + (at_end ? 1 : 0);
    mesh.triangles.push_back({{first, b, c}, {normal, normal, normal}});
  }
}

}  // namespace

std::vector<TubeRing> tube_rings(const Fabric& fabric, const FabricYarn& yarn, int per_segment) {
  const std::vector<Vec3> points = polyline(fabric, yarn, per_segment);
  std::vector<TubeRing> rings(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    rings[k].centre = points[k];
    rings[k].arc = k == 0 ? 0 : rings[k - 1].arc + distance(points[k], points[k - 1]);
  }
  set_tangents(rings, yarn.periodic);
  rings[0].normal = any_normal(rings[0].tangent);
  for (std::size_t k = 1; k < rings.size(); ++k) rings[k].normal = carried_normal(rings[k - 1], rings[k]);
  if (yarn.periodic) {
    const TubeRing &first = rings.front(), &last = rings.back();
    const double miss =
        std::atan2(dot(cross(last.normal, first.normal), last.tangent), dot(last.normal, first.normal));
    const double length = last.arc > 0 ? last.arc : 1;
    for (TubeRing& ring : rings) turn(ring, miss * ring.arc / length);
  }
  for (TubeRing& ring : rings) ring.binormal = cross(ring.tangent, ring.normal);
  return rings;
}

TubeMesh tube_mesh(const Fabric& fabric, const FabricYarn& yarn, int per_segment, int sides) {
  if (sides < 3 || per_segment < 1)
    throw std::invalid_argument("a tube needs 3 sides and 1 step a segment or more");
  const std::vector<TubeRing> rings = tube_rings(fabric, yarn, per_segment);
  const bool closed = yarn.periodic && yarn.shift == std::array<int, 2>{0, 0};
  const auto n = static_cast<std::uint32_t>(sides);
  const auto drawn = static_cast<std::uint32_t>(closed ? rings.size() - 1 : rings.size());
  // area of a regular polygon: n/2 R^2 sin(2 pi / n) = pi r^2
  const double step = 2 * std::numbers::pi / sides;
  const double radius = yarn.diameter / 2 * std::sqrt(step / std::sin(step));

  TubeMesh mesh;
  mesh.positions.reserve(std::size_t{drawn} * n);
  mesh.normals.reserve(std::size_t{drawn} * n + 2);
  mesh.triangles.reserve(2 * std::size_t{n} * (drawn + 1));
  for (std::uint32_t k = 0; k < drawn; ++k)
    for (int s = 0; s < sides; ++s) {
      const Vec3 out = rings[k].normal * std::cos(step * s) + rings[k].binormal * std::sin(step * s);
      mesh.positions.push_back(rings[k].centre + out * radius);
      mesh.normals.push_back(out);
    }
  const std::uint32_t bands = closed ? drawn : drawn - 1;
  for (std::uint32_t k = 0; k < bands; ++k)
    for (std::uint32_t s = 0; s < n; ++s) {
      const std::uint32_t a = k * n + s, b = k * n + (s + 1) % n;
      const std::uint32_t next = (k + 1) % drawn, c = next * n + s, d = next * n + (s + 1) % n;
      mesh.triangles.push_back({{a, b, d}, {a, b, d}});
      mesh.triangles.push_back({{a, d, c}, {a, d, c}});
    }
  if (!closed) {
    add_cap(mesh, -rings.front().tangent, 0, n, false);
    add_cap(mesh, rings.back().tangent, (drawn - 1) * n, n, true);
  }
  return mesh;
}

}  // namespace loopwright
