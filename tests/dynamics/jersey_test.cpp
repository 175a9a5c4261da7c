// The second paper's jersey stitch: its symmetries, joints, room, and bindings between rows.
#include "dynamics/jersey_stitch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "dynamics/yarn_motion.hpp"

namespace loopwright {
namespace {

const std::vector<JerseyStitch> densities{{1, 4.4, 3.2}, {1, 4.6, 3.5}, {0.5, 2.6, 2.0}, {1, 6, 4.5}};

TEST(JerseyStitch, Symmetries) {
  for (const JerseyStitch& stitch : densities) {
    const std::array<Vec3, 11> p = jersey_points(stitch);
    // 3 to 5 is 1 to 3 turned half round 3 (in the plane), with the same elevations
    for (const std::size_t k : {1, 2}) {
      EXPECT_NEAR(p[6 - k].x + p[k].x, 2 * p[3].x, 1e-12);
      EXPECT_NEAR(p[6 - k].y + p[k].y, 2 * p[3].y, 1e-12);
      EXPECT_NEAR(p[6 - k].z, p[k].z, 1e-12);
    }
    // mirrored about the axis through 5
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_NEAR(p[10 - k].x + p[k].x, 2 * p[5].x, 1e-12);
      EXPECT_NEAR(p[10 - k].y, p[k].y, 1e-12);
      EXPECT_NEAR(p[10 - k].z, p[k].z, 1e-12);
    }
    // three points shared with each neighbour, a wale apart
    for (const std::size_t k : {0, 1, 2})
      EXPECT_LT(distance(p[8 + k], p[k] + Vec3{stitch.wale_spacing, 0, 0}), 1e-12);
  }
}

TEST(JerseyStitch, RowsHave8NPlus3PointsAndJoinSmoothly) {
  for (const int n : {1, 2, 7}) {
    const JerseyPiece piece = jersey_piece({1, 4.6, 3.5}, n, 1, StretchLaw::springs);
    ASSERT_EQ(piece.model.points, 8 * n + 3);
    ASSERT_EQ(piece.model.yarns[0].segments(), 8 * n);
    for (int e = 1; e < 8 * n; ++e) {
      const CurvePoint before = curve_point(piece.model, piece.state.place, 0, e - 1e-9),
                       after = curve_point(piece.model, piece.state.place, 0, e);
      EXPECT_LT(distance(before.place, after.place), 1e-7);
      EXPECT_LT(distance(before.slope, after.slope), 1e-6);
      // Catmull-Rom goes through its points
      EXPECT_LT(distance(after.place, piece.state.place[static_cast<std::size_t>(e) + 1]), 1e-12);
    }
    // every stitch is the first one, wales apart
    for (int k = 1; k < n; ++k)
      for (int e = 0; e < 8; ++e) {
        const Vec3 first = curve_point(piece.model, piece.state.place, 0, e + 0.3).place,
                   kth = curve_point(piece.model, piece.state.place, 0, 8 * k + e + 0.3).place;
        EXPECT_LT(distance(kth, first + Vec3{4.6 * k, 0, 0}), 1e-12);
      }
  }
}

// Rows touch and do not enter each other; legs are in front, heads and sinkers behind (a face stitch).
TEST(JerseyStitch, RowsJustTouch) {
  for (const JerseyStitch& stitch : densities) {
    const JerseyPiece piece = jersey_piece(stitch, 4, 2, StretchLaw::mean);
    double least = std::numeric_limits<double>::infinity();
    constexpr int n = 32 * 20;
    for (int a = 0; a <= n; ++a)
      for (int b = 0; b <= n; ++b)
        least = std::min(least, distance(curve_point(piece.model, piece.state.place, 0, a / 20.0).place,
                                         curve_point(piece.model, piece.state.place, 1, b / 20.0).place));
    EXPECT_NEAR(least, stitch.thickness, 0.01 * stitch.thickness);
    const std::array<Vec3, 11> p = jersey_points(stitch);
    EXPECT_GT(p[3].z, 0.3 * stitch.thickness);
    EXPECT_EQ(p[1].z, -p[3].z);
    EXPECT_EQ(p[5].z, -p[3].z);
  }
}

TEST(JerseyStitch, RefusesStitchesThatAreTooDense) {
  EXPECT_THROW(jersey_points({1, 3.5, 3.5}), std::invalid_argument);
  EXPECT_THROW(jersey_points({1, 4.6, 0.5}), std::invalid_argument);
  EXPECT_THROW(jersey_points({std::nan(""), 4.2, 3.5}), std::invalid_argument);
  EXPECT_THROW(jersey_row({1, 4.6, 3.5}, 0), std::invalid_argument);
}

// The paper's piece, in its own reposed state, with each binding: pulled at one row and let go, it stays
// bound.
TEST(JerseyStitch, PieceStaysBoundInMotion) {
  for (const StretchLaw law : {StretchLaw::springs, StretchLaw::green, StretchLaw::mean})
    for (const bool sliding : {false, true}) {
      JerseyPiece piece = jersey_piece({1, 4.6, 3.5}, 4, 3, law);
      ASSERT_EQ(piece.feet.size(), 16u);
      for (SplineYarn& yarn : piece.model.yarns) {
        yarn.stretch_stiffness = 300;
        yarn.bend_stiffness = 1;
      }
      piece.model.drag = 0.2;
      for (std::size_t i = 0; i < 35; ++i) piece.model.held[i] = 1;  // the first row
      piece.model.gravity = {0, 0.01, 0};
      const Bindings bindings = sliding
                                    ? sliding_bindings(piece.model, piece.state.place, piece.feet, 0.2)
                                    : barycentric_bindings(piece.model, piece.state.place, piece.feet, 100);
      // at least one a foot: two crossings may lead downhill to one nearest approach
      EXPECT_GE(bindings.barycentric.size() + bindings.sliding.size(), 16u);
      for (const MotionStepper stepper : {MotionStepper::explicit_euler, MotionStepper::implicit_euler}) {
        MotionOptions options;
        options.stepper = stepper;
        YarnMotion motion(piece.model, piece.state, bindings, options);
        const double start = motion.energy().total();
        const bool explicit_step = stepper == MotionStepper::explicit_euler;
        for (int k = 0; k < (explicit_step ? 300 : 40); ++k) {
          const StepReport report = motion.step(explicit_step ? 0.004 : 0.5);
          EXPECT_TRUE(report.converged) << k;
        }
        EXPECT_LT(motion.constraint_error(), explicit_step ? 1e-3 : 1e-7) << static_cast<int>(law) << sliding;
        EXPECT_LT(motion.energy().total(), start);
        EXPECT_GT(motion.energy().total(), start - 30);
      }
    }
}

}  // namespace
}  // namespace loopwright
