#include "outputs/fuzz.hpp"

#include <gtest/gtest.h>

#include "plain_fabric.hpp"

namespace loopwright {
namespace {

// Round a straight yarn on the x axis the distance from the surface is known.
TEST(LooseFibres, StandOnTheSurfaceAndAreAsManyAsAsked) {
  const Fabric fabric = test::straight_yarn(200, 400);
  const auto rings = tube_rings(fabric, fabric.yarns[0], 2);
  const auto hairs = loose_fibres(rings, 0.5, 12, 10, 3);
  EXPECT_NEAR(static_cast<double>(hairs.size()), 2000, 60);
  double highest = 0;
  for (const Hair& hair : hairs) {
    const auto height = [](const Vec3& p) { return std::hypot(p.y, p.z) - 0.5; };
    EXPECT_NEAR(height(hair.points[0]), 0, 0.01);
    EXPECT_GE(hair.side, 0);
    EXPECT_LT(hair.side, 12);
    EXPECT_NEAR(norm(hair.normal), 1, 1e-9);
    for (const Vec3& p : hair.points) {
      EXPECT_GT(height(p), -0.01);
      highest = std::max(highest, height(p));
    }
  }
  EXPECT_GT(highest, 0.1);
  EXPECT_LT(highest, 0.5 * 0.6);
}

TEST(LooseFibres, AreTheSameForTheSameSeed) {
  const Fabric fabric = test::straight_yarn(10);
  const auto rings = tube_rings(fabric, fabric.yarns[0], 2);
  const auto a = loose_fibres(rings, 0.5, 12, 10, 3), b = loose_fibres(rings, 0.5, 12, 10, 3),
             c = loose_fibres(rings, 0.5, 12, 10, 4);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].points, b[k].points);
  EXPECT_NE(a.front().points, c.front().points);
}

}  // namespace
}  // namespace loopwright
