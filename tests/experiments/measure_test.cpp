// Measurements of cloths whose sizes follow from a closed form.
#include "experiments/measure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/cover.hpp"

namespace loopwright {
namespace {

using testing::DoubleNear;

// A periodic cell of straight yarns along x, one every `pitch`, each with one loop span per unit of `loop`.
Fabric straight_yarns(int yarns, double pitch, int loops, double loop) {
  Fabric fabric;
  fabric.periodic = true;
  fabric.diameter_mm = 0.5;
  fabric.width = loops * loop;
  fabric.height = yarns * pitch;
  fabric.wales = loops;
  fabric.courses = yarns;
  for (int y = 0; y < yarns; ++y) {
    FabricYarn yarn;
    yarn.yarn = YarnId(0);  // one yarn in pieces
    yarn.periodic = true;
    yarn.shift = {1, 0};
    yarn.linear_density_tex = 100;
    yarn.segment_rest_length = loop / 4;
    for (int i = 0; i < 4 * loops; ++i) yarn.control_points.push_back({i * loop / 4, (y + 0.3) * pitch, 0});
    for (int i = 0; i < loops; ++i) {
      LoopSpan span;
      span.yarn = y;
      span.begin = 4.0 * i, span.apex = 4.0 * i + 2, span.end = 4.0 * i + 4;
      fabric.loops.push_back(span);
    }
    fabric.yarns.push_back(std::move(yarn));
  }
  return fabric;
}

// Heads that stand a wale to the right of those three courses below, through the cell's border as well.
TEST(Measure, WalesLeanAsTheWayFromHeadToHeadDoes) {
  Fabric fabric = straight_yarns(3, 4, 5, 6);
  EXPECT_TRUE(std::isnan(measure(fabric).wale_lean_degrees));
  for (std::size_t k = 0; k < fabric.loops.size(); ++k) fabric.loops[k].loop = LoopId(k);
  fabric.skew = 6;
  for (std::size_t y = 0; y < 3; ++y) {
    for (Vec3& p : fabric.yarns[y].control_points) p.x += 2.0 * static_cast<double>(y);
    for (std::size_t i = 0; i < 5; ++i)
      fabric.interlacings.push_back(
          {LoopId(5 * y + i), LoopId((5 * y + i + 5) % 15), 1, {0, y == 2 ? 1 : 0}});
  }
  EXPECT_NEAR(measure(fabric).wale_lean_degrees, std::atan2(6, 12) * 180 / std::numbers::pi, 1e-9);
}

TEST(Measure, StraightYarnsHaveTheirPitchLengthAndMass) {
  const Measurements m = measure(straight_yarns(3, 4, 5, 6));
  EXPECT_EQ(m.loops, 15);
  EXPECT_EQ(m.yarns, 1);
  EXPECT_DOUBLE_EQ(m.width_mm, 15);
  EXPECT_DOUBLE_EQ(m.height_mm, 6);
  EXPECT_DOUBLE_EQ(m.wale_spacing_mm, 3);
  EXPECT_DOUBLE_EQ(m.course_spacing_mm, 2);
  EXPECT_DOUBLE_EQ(m.courses_per_cm, 5);
  EXPECT_NEAR(m.thickness_mm, 0.5, 1e-12);
  EXPECT_NEAR(m.loop_length_mm, 3, 1e-12);
  EXPECT_NEAR(m.Kc, 1.5, 1e-12);
  EXPECT_NEAR(m.Kw, 1, 1e-12);
  EXPECT_NEAR(m.Ks, 1.5, 1e-12);
  // 3 yarns of 15 mm at 100 mg/m
  EXPECT_NEAR(m.yarn_m, 0.045, 1e-15);
  ASSERT_TRUE(m.mass_g);
  EXPECT_NEAR(*m.mass_g, 0.0045, 1e-15);
  EXPECT_NEAR(*m.areal_density_g_m2, 50, 1e-9);
  EXPECT_NEAR(*m.tightness_factor, 10 / 0.3, 1e-9);
}

TEST(Measure, UnknownLinearDensityLeavesMassOut) {
  Fabric fabric = straight_yarns(2, 4, 3, 6);
  fabric.yarns[1].linear_density_tex = 0;
  const Measurements m = measure(fabric);
  EXPECT_FALSE(m.mass_g);
  EXPECT_FALSE(m.areal_density_g_m2);
  EXPECT_GT(m.yarn_m, 0);
}

// A uniform cubic B-spline through points on a circle is a circle to fourth order in the angle of a segment,
// of radius (2 + cos) / 3 of that of its control points at the knots.
TEST(Measure, LoopLengthOfACircleAndThickness) {
  constexpr int n = 64;
  const double angle = 2 * std::numbers::pi / n, radius = 3, control = radius * 3 / (2 + std::cos(angle));
  Fabric fabric;
  fabric.wales = fabric.courses = 1;
  fabric.width = fabric.height = 10;
  FabricYarn yarn;
  yarn.periodic = true;  // closes without a shift
  for (int i = 0; i < n; ++i)
    yarn.control_points.push_back({control * std::cos(i * angle), 5, control * std::sin(i * angle)});
  fabric.yarns.push_back(yarn);
  LoopSpan span;
  span.begin = 3.25, span.end = 3.25 + n / 4.0;
  fabric.loops.push_back(span);
  const Measurements m = measure(fabric);
  EXPECT_NEAR(m.loop_length_mm, radius * std::numbers::pi / 2, 1e-5);
  EXPECT_NEAR(m.thickness_mm, 2 * radius + 1, 1e-4);
}

TEST(CoverFactor, StraightYarnsCoverDiameterOverPitch) {
  EXPECT_THAT(cover_factor(straight_yarns(3, 4, 5, 6)), DoubleNear(1.0 / 4, 0.01 / 4));
  EXPECT_THAT(cover_factor(straight_yarns(3, 1.7, 5, 6)), DoubleNear(1.0 / 1.7, 0.01 / 1.7));
  EXPECT_THAT(cover_factor(straight_yarns(2, 0.5, 2, 3)), DoubleNear(1, 0));
}

TEST(CoverFactor, CrossedYarnsCountTheirOverlapOnceAndSkewChangesNothing) {
  Fabric fabric = straight_yarns(1, 5, 2, 2.5);
  FabricYarn up = fabric.yarns[0];
  up.shift = {0, 1};
  for (std::size_t i = 0; i < up.control_points.size(); ++i)
    up.control_points[i] = {1, static_cast<double>(i) * 5 / 8, 1};
  fabric.yarns.push_back(up);
  const double expected = (5 + 5 - 1) / 25.0;
  EXPECT_NEAR(cover_factor(fabric), expected, 0.012);
  // the same cell with another lattice vector of the same lattice along the courses
  fabric.skew = 5;
  fabric.yarns[1].shift = {-1, 1};
  EXPECT_NEAR(cover_factor(fabric), expected, 0.012);
}

TEST(CoverFactor, GridOfALargePieceStaysSmallAndRight) {
  EXPECT_NEAR(cover_factor(straight_yarns(300, 4, 250, 6)), 0.25, 0.25 * 0.06);
}

TEST(Measure, RefusesWhatHasNoSize) {
  EXPECT_THROW(measure(Fabric{}), std::invalid_argument);
  Fabric fabric = straight_yarns(1, 4, 2, 6);
  fabric.yarns[0].control_points[3].y = std::nan("");
  EXPECT_THROW(measure(fabric), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
