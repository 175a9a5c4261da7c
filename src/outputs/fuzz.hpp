// Loose fibres that stand off a yarn: fine curved hairs, which take the look of plastic from a drawn yarn.
#pragma once
#include <cstdint>
#include <vector>

#include "outputs/tube_mesh.hpp"

namespace loopwright {

// A hair as a polyline: `points` of equal count each, in the fabric's coordinates, with the surface normal at
// its root.
struct Hair {
  static constexpr int point_count = 5;
  std::array<Vec3, point_count> points;
  Vec3 normal;
  std::size_t ring = 0;  // that it grows from
  int side = 0;          // 0 .. sides - 1, likewise
};

// About `per_diameter` hairs on each d of length of a tube with the given rings, radius and number of sides.
// They leave at a flat angle along the yarn, rise to at most 0.3 d and taper off; some return
// to the surface. The same `seed` gives the same hairs.
std::vector<Hair> loose_fibres(const std::vector<TubeRing>& rings, double radius, int sides,
                               double per_diameter, std::uint32_t seed);

}  // namespace loopwright
