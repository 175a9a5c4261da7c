#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "base/vec3.hpp"

namespace loopwright {
namespace {

TEST(Vec3, CrossProductIsRightHandedAndPerpendicular) {
  EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1}));
  EXPECT_EQ(cross({0, 1, 0}, {0, 0, 1}), (Vec3{1, 0, 0}));
  const Vec3 a{1.5, -2, 0.25}, b{-0.5, 3, 4};
  EXPECT_NEAR(dot(cross(a, b), a), 0, 1e-14);
  EXPECT_NEAR(dot(cross(a, b), b), 0, 1e-14);
  // Lagrange's identity.
  EXPECT_NEAR(squared_norm(cross(a, b)) + dot(a, b) * dot(a, b), squared_norm(a) * squared_norm(b), 1e-11);
}

TEST(Vec3, ArithmeticByComponents) {
  constexpr Vec3 a{1, 2, 3}, b{4, -5, 0.5};
  static_assert(a + b == Vec3{5, -3, 3.5});
  static_assert(a - b == Vec3{-3, 7, 2.5});
  static_assert(2 * a == a * 2.0 && -a == -1.0 * a && a / 4 == Vec3{0.25, 0.5, 0.75});
  static_assert(a[0] == 1 && a[1] == 2 && a[2] == 3);
  EXPECT_EQ(dot(a, b), -4.5);
  EXPECT_DOUBLE_EQ(norm({2, 3, 6}), 7);
  EXPECT_DOUBLE_EQ(distance({1, 1, 1}, {3, 4, 7}), 7);
  EXPECT_NEAR(norm(normalized({2, 3, 6})), 1, 1e-15);
  Vec3 c = a;
  c[1] = 9;
  EXPECT_EQ(c, (Vec3{1, 9, 3}));
}

TEST(Vec3, FiniteMeansAllThree) {
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_TRUE(is_finite({1, 2, 3}));
  for (int i = 0; i < 3; ++i)
    for (const double bad : {infinite, -infinite, nan}) {
      Vec3 v{1, 2, 3};
      v[i] = bad;
      EXPECT_FALSE(is_finite(v));
    }
}

TEST(Vec3, IsThreePackedDoublesAndPrints) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  std::ostringstream out;
  out << Vec3{1, -2.5, 0};
  EXPECT_EQ(out.str(), "(1, -2.5, 0)");
}

}  // namespace
}  // namespace loopwright
