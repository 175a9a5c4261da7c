#include "outputs/exchange/yarn_skin.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "geometry/linking.hpp"
#include "outputs/tube_mesh.hpp"

namespace loopwright {
namespace {

std::size_t rings_of(const FabricYarn& yarn, const ExportOptions& options) {
  return static_cast<std::size_t>(yarn.segments()) * static_cast<std::size_t>(options.per_segment) + 1;
}

void add_cap(YarnSkin& skin, const TubeRing& ring, double radius, std::uint32_t number, int sides,
             double scale, bool at_end) {
  const auto first = static_cast<std::uint32_t>(skin.vertices.size());
  const Vec3 outward = at_end ? ring.tangent : -ring.tangent;
  for (int s = 0; s < sides; ++s) {
    const double angle = 2 * std::numbers::pi * s / sides;
    const Vec3 across = ring.normal * std::cos(angle) + ring.binormal * std::sin(angle);
    skin.vertices.push_back({(ring.centre + across * radius) * scale, outward, 0.5 + 0.5 * std::cos(angle),
                             0.5 + 0.5 * std::sin(angle), number});
  }
  for (std::uint32_t s = 1; s + 1 < static_cast<std::uint32_t>(sides); ++s) {
    const std::uint32_t b = first + s + (at_end ? 0 : 1), c = first + s + (at_end ? 1 : 0);
    skin.triangles.push_back({first, b, c});
  }
}

}  // namespace

void check_tube_options(const ExportOptions& options) {
  if (options.sides < 3 || options.per_segment < 1)
    throw std::invalid_argument("a tube needs 3 sides and 1 step a segment or more");
}

std::size_t skin_vertices(const FabricYarn& yarn, const ExportOptions& options) {
  const auto sides = static_cast<std::size_t>(options.sides);
  return rings_of(yarn, options) * (sides + 1) + (is_closed(yarn) ? 0 : 2 * sides);
}

std::size_t skin_triangles(const FabricYarn& yarn, const ExportOptions& options) {
  const auto sides = static_cast<std::size_t>(options.sides);
  return (rings_of(yarn, options) - 1) * 2 * sides + (is_closed(yarn) ? 0 : 2 * (sides - 2));
}

YarnSkin yarn_skin(const Fabric& fabric, const FabricYarn& yarn, const ExportOptions& options) {
  check_tube_options(options);
  const std::vector<TubeRing> rings = tube_rings(fabric, yarn, options.per_segment);
  const double mm = fabric.diameter_mm, step = 2 * std::numbers::pi / options.sides;
  const double radius = yarn.diameter / 2 * std::sqrt(step / std::sin(step));  // as tube_mesh()
  const double circumference = std::numbers::pi * yarn.diameter;

  YarnSkin skin;
  skin.vertices.reserve(skin_vertices(yarn, options));
  skin.triangles.reserve(skin_triangles(yarn, options));
  for (std::size_t k = 0; k < rings.size(); ++k)
    for (int s = 0; s <= options.sides; ++s) {
      // the last vertex of a ring lies on the first one, to the bit
      const double angle = step * (s % options.sides);
      const Vec3 out = rings[k].normal * std::cos(angle) + rings[k].binormal * std::sin(angle);
      skin.vertices.push_back({(rings[k].centre + out * radius) * mm, out,
                               static_cast<double>(s) / options.sides, rings[k].arc / circumference,
                               static_cast<std::uint32_t>(k)});
    }
  const auto around = static_cast<std::uint32_t>(options.sides + 1);
  for (std::uint32_t k = 0; k + 1 < rings.size(); ++k)
    for (std::uint32_t s = 0; s + 1 < around; ++s) {
      const std::uint32_t a = k * around + s, b = a + 1, c = a + around, d = c + 1;
      skin.triangles.push_back({a, b, d});
      skin.triangles.push_back({a, d, c});
    }
  if (!is_closed(yarn)) {
    add_cap(skin, rings.front(), radius, 0, options.sides, mm, false);
    add_cap(skin, rings.back(), radius, static_cast<std::uint32_t>(rings.size() - 1), options.sides, mm,
            true);
  }
  return skin;
}

}  // namespace loopwright
