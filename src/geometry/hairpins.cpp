#include "geometry/hairpins.hpp"

#include <optional>

namespace loopwright {
namespace {

// From a fold's corner to where the leg to `before` comes round it; none where it is no fold.
std::optional<Vec3> across_fold(const Vec3& before, const Vec3& corner, const Vec3& after, double radius) {
  constexpr double least_cosine = 0.8;  // between legs that are folded together
  const Vec3 in = normalized(before - corner), out = normalized(after - corner);
  if (!(dot(in, out) > least_cosine)) return std::nullopt;
  const Vec3 apart = in - out;
  // Legs that cover each other lie side by side in the cloth's plane.
  const Vec3 beside = norm(apart) > 1e-6 ? apart : cross(in, Vec3{0, 0, 1});
  if (!(norm(beside) > 0)) return std::nullopt;
  return normalized(beside) * radius;
}

}  // namespace

void open_hairpins(std::vector<Vec3>& way, const Vec3& before, const Vec3& after, double radius) {
  if (const auto apart = across_fold(before, way[0], way[1], radius)) {
    way.insert(way.begin() + 1, way[0] - *apart);
    way[0] += *apart;
  }
  const std::size_t last = way.size() - 1;
  if (const auto apart = across_fold(way[last - 1], way[last], after, radius)) {
    way.push_back(way[last] - *apart);
    way[last] += *apart;
  }
}

}  // namespace loopwright
