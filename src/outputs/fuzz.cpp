#include "outputs/fuzz.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace loopwright {

std::vector<Hair> loose_fibres(const std::vector<TubeRing>& rings, double radius, int sides,
                               double per_diameter, std::uint32_t seed) {
  std::vector<Hair> hairs;
  std::minstd_rand random(seed * 2654435761U + 1U);
  // not std::uniform_real_distribution, which differs between libraries
  const auto uniform = [&random] { return static_cast<double>(random() - 1) / 2147483645.0; };
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
    const double expected = (rings[k + 1].arc - rings[k].arc) * per_diameter;
    const int count = static_cast<int>(expected) + (uniform() < expected - std::floor(expected) ? 1 : 0);
    for (int h = 0; h < count; ++h) {
      const double share = uniform(), turns = uniform(), angle = 2 * std::numbers::pi * turns;
      const Vec3 centre = rings[k].centre * (1 - share) + rings[k + 1].centre * share;
      const Vec3 out = rings[k].normal * std::cos(angle) + rings[k].binormal * std::sin(angle);
      const Vec3 around = cross(rings[k].tangent, out);
      const double length = radius * (0.5 + 1.6 * uniform() * uniform()),
                   height = radius * (0.08 + 0.5 * uniform() * uniform());
      const double forward = uniform() < 0.5 ? -1 : 1, drift = (uniform() - 0.5) * 1.2,
                   curl = (uniform() - 0.5) * 0.9;
      const bool returns = uniform() < 0.4;
      Hair hair;
      hair.normal = out;
      hair.ring = k;
      hair.side = static_cast<int>(turns * sides) % sides;
      for (int i = 0; i < Hair::point_count; ++i) {
        const double s = static_cast<double>(i) / (Hair::point_count - 1);
        const double rise = returns ? std::sin(std::numbers::pi * s) : s * (1.4 - 0.4 * s);
        const double aside = (drift * s + curl * s * s) * length;
        // sideways means round the yarn, or the hair would dip into it
        const Vec3 place = (out * std::cos(aside / radius) + around * std::sin(aside / radius)) *
                           (radius * 0.985 + height * rise);
        hair.points[static_cast<std::size_t>(i)] = centre + place + rings[k].tangent * (forward * length * s);
      }
      hairs.push_back(hair);
    }
  }
  return hairs;
}

}  // namespace loopwright
