// What a step of a piece has in common, and that no two points of its yarn move otherwise than that says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "geometry/fabric.hpp"
#include "mechanics/common_motion.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

constexpr double range = 1.6, none_is_enough = 0;

// A held sheet of `lines` straight yarns 2 d apart, in waves along z.
Fabric sheet(int lines) {
  std::vector<FabricYarn> yarns;
  for (int line = 0; line < lines; ++line)
    yarns.push_back(free_yarn(2 * lines, 1.4, [line](int i) {
      return Vec3{1.4 * i, 2.0 * line, 0.5 * std::sin(i)};
    }));
  return fabric_of(std::move(yarns));
}

struct Step {
  YarnModel model;
  YarnState from, to;
};
Step step_of(const Fabric& fabric, const std::function<Vec3(const Vec3&)>& motion) {
  Step step{build_yarn_model(fabric, frictionless().model), build_yarn_state(fabric), {}};
  step.to = step.from;
  for (Vec3& p : step.to.nodes) p += motion(p);
  return step;
}
CommonMotion common_motion(const Step& step, double enough) {
  return common_motion(step.model, step.from, step.to, range, enough);
}

TEST(CommonMotion, AnAffineStepLeavesNothing) {
  const Step step = step_of(sheet(20), [](const Vec3& p) {
    return Vec3{0.1 * p.x - 0.2 * p.y + 3, 0.05 * p.y, 0.01 * p.x};
  });
  const CommonMotion common = common_motion(step, none_is_enough);
  EXPECT_LT(common.loose, 1e-6);
  EXPECT_NEAR(common.in_plane, std::sqrt(0.1 * 0.1 + 0.2 * 0.2 + 0.05 * 0.05 + 0.01 * 0.01), 1e-6);
}

// Edges that draw in, as those of a piece that is let go do: what is left stays the same however large the
// piece is, for the same slope of the motion.
TEST(CommonMotion, EdgesThatDrawInLeaveLittleInAPieceOfAnySize) {
  for (const int lines : {40, 80}) {
    const double side = 2.0 * lines;
    const Step step = step_of(sheet(lines), [side](const Vec3& p) {
      return Vec3{0, 0.03 * side * std::sin(2 * std::numbers::pi * p.y / side), 0};
    });
    const CommonMotion affine = common_motion(step, INFINITY), finer = common_motion(step, none_is_enough);
    EXPECT_GT(affine.loose, 0.01 * side) << "grows with the piece";
    EXPECT_LT(finer.loose, 0.7) << lines;
    EXPECT_LT(finer.far_ratio(range), 0.9 * affine.far_ratio(range)) << lines;
  }
}

// The bound itself: points of the yarn, not control points, at least the range apart.
TEST(CommonMotion, NoTwoPointsMoveFartherApartThanItSays) {
  const Fabric fabric = sheet(24);
  const Step step = step_of(fabric, [](const Vec3& p) {
    return Vec3{0.6 * std::sin(0.13 * p.y + 0.05 * p.x), 1.5 * std::cos(0.1 * p.x) * std::sin(0.08 * p.y),
                0.2 * std::sin(0.9 * p.x)};
  });
  const CommonMotion common = common_motion(step, none_is_enough), affine = common_motion(step, INFINITY);
  ASSERT_LT(common.loose, affine.loose) << "the field is in use";
  const Fabric moved = with_state(fabric, step.to);
  struct Point {
    Vec3 place, motion;
  };
  std::vector<Point> points;
  for (const FabricYarn& yarn : fabric.yarns) {
    const auto y = static_cast<std::size_t>(&yarn - fabric.yarns.data());
    for (double t = 0.1; t < yarn.segments(); t += 1.37) {
      const Vec3 place = position(fabric, yarn, t);
      points.push_back({place, position(moved, moved.yarns[y], t) - place});
    }
  }
  double worst = 0;
  for (const Point& a : points)
    for (const Point& b : points) {
      const double apart = distance(a.place, b.place);
      if (apart < range) continue;
      worst = std::max(worst, distance(a.motion, b.motion) / apart);
      const double allowed =
          common.in_plane * apart + common.across * std::min(apart, common.thickness) + 2 * common.loose;
      ASSERT_LE(distance(a.motion, b.motion), allowed);
    }
  EXPECT_LE(worst, common.far_ratio(range));
  EXPECT_GT(worst, 0.05) << "a step that moves nothing apart proves nothing";
}

}  // namespace
}  // namespace loopwright
