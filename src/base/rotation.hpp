// A rotation in space, as the images of the three axes.
#pragma once
#include "base/vec3.hpp"

namespace loopwright {

// Orthonormal; columns are the images of the x, y and z axis.
struct Rotation {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  constexpr Vec3 operator*(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
  constexpr Vec3 transposed(const Vec3& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  constexpr Rotation operator*(const Rotation& b) const { return {*this * b.x, *this * b.y, *this * b.z}; }
};

// The attitude between several, from the sum of their matrices: x as it is, y as near as it can be. Where the
// sum has no direction (opposite attitudes) the result is `otherwise`.
inline Rotation mean_rotation(const Rotation& sum, const Rotation& otherwise) {
  constexpr double least = 1e-3;
  if (!(norm(sum.x) > least)) return otherwise;
  Rotation mean;
  mean.x = normalized(sum.x);
  const Vec3 normal = cross(mean.x, sum.y);
  if (!(norm(normal) > least)) return otherwise;
  mean.z = normalized(normal);
  mean.y = cross(mean.z, mean.x);
  return mean;
}

}  // namespace loopwright
