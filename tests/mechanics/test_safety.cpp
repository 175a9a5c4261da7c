// No motion carries a yarn through a yarn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/interlacing.hpp"
#include "mechanics/fabrics.hpp"
#include "mechanics/safe_step.hpp"

namespace loopwright {
namespace {

constexpr double range = 1.6, share = 0.7;

struct Motion {
  double scale = 0;
  double least = 0, at_start = 0;  // clearance on the way and at its start, d
};

// The allowed part of a step, followed in small parts with geometry's own search for the smallest distance. A
// crossing needs a distance of zero, and between two parts no distance changes by more than the part's
// motion.
Motion follow(const Fabric& fabric, const Unknowns& step) {
  const YarnModel model = build_yarn_model(fabric, frictionless().model);
  const YarnState state = build_yarn_state(fabric);
  Assembly assembly(model);
  assembly.update_pairs(state, range);
  Motion motion;
  motion.scale = safe_step(model, assembly, state, assembly.moved(state, step, 1), range, 1, share).scale;
  EXPECT_GE(motion.scale, 0);
  EXPECT_LE(motion.scale, 1);
  motion.least = motion.at_start = min_clearance(fabric).distance;
  constexpr int parts = 24;
  for (int k = 1; k <= parts; ++k) {
    const YarnState on_way = assembly.moved(state, step, motion.scale * k / parts);
    EXPECT_GT(on_way.width, 0);
    EXPECT_GT(on_way.height, 0);
    if (fabric.periodic && !(on_way.width > 0 && on_way.height > 0)) return motion;
    motion.least = std::min(motion.least, min_clearance(with_state(fabric, on_way)).distance);
  }
  return motion;
}

Unknowns no_motion(const Fabric& fabric) {
  Unknowns step;
  step.u.resize(build_yarn_state(fabric).nodes.size());
  return step;
}

// Two straight yarns across each other, the second one 1.2 d above the first.
Fabric two_yarns() {
  return fabric_of({free_yarn(9, 1.4,
                              [](int i) {
                                return Vec3{1.4 * (i - 4), 0, 0};
                              }),
                    free_yarn(9, 1.4, [](int i) {
                      return Vec3{0.1, 1.4 * (i - 4), 1.2};
                    })});
}

std::size_t pairs_in(const Fabric& fabric) {
  const YarnModel model = build_yarn_model(fabric, frictionless().model);
  Assembly assembly(model);
  assembly.update_pairs(build_yarn_state(fabric), range);
  return assembly.pairs().size();
}

TEST(SegmentPairs, NeighboursAlongAYarnOnlyWhereTheyCanTouch) {
  // Straight: samples that are near lie too close along the yarn to touch.
  EXPECT_EQ(pairs_in(fabric_of({free_yarn(9, 1.4, [](int i) { return Vec3{1.4 * i, 0, 0}; })})), 0U);
  // On a circle of radius 0.7 d the yarn meets itself.
  EXPECT_GT(
      pairs_in(fabric_of({free_yarn(9, 0.5,
                                    [](int i) {
                                      return Vec3{0.7 * std::cos(0.7 * i), 0.7 * std::sin(0.7 * i), 0.02 * i};
                                    })})),
      0U);
}

// Pairs that cannot have come together since the list was made are passed over: the energy is that of a list
// made anew (summed in its own order), for yarns and lattice moved.
TEST(SegmentPairs, EnergyOfAMovedCellMissesNoContact) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  const Fabric fabric = relax(knitted("ge", "periodic", "", 17, 10), frictionless()).fabric;
  ModelOptions options = frictionless().model;
  options.material.contact.core = -1;  // yarns may be anywhere
  const YarnModel model = build_yarn_model(fabric, options);
  const YarnState state = build_yarn_state(fabric);
  Assembly assembly(model), anew(model);
  assembly.update_pairs(state, range);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Unknowns step = no_motion(fabric);
    for (Vec3& u : step.u) u = 0.15 * Vec3{any(random), any(random), any(random)};
    step.g = {0.1 * any(random), 0.1 * any(random), 0.1 * any(random)};
    const YarnState moved = assembly.moved(state, step, 1);
    anew.update_pairs(moved, range);
    const double contact = anew.energy(moved).contact;
    EXPECT_GT(contact, 0);
    EXPECT_NEAR(assembly.energy(moved).contact, contact, 1e-12 * contact);
  }
}

TEST(SafeStep, AYarnPushedThroughAnotherStopsBeforeIt) {
  const Fabric fabric = two_yarns();
  for (const double push : {-1.3, -3.0, -50.0}) {
    Unknowns step = no_motion(fabric);
    for (std::size_t i = 9; i < 18; ++i) step.u[i].z = push;
    const Motion motion = follow(fabric, step);
    EXPECT_LT(-push * motion.scale, 0.75 * 1.2) << "the yarns cross at 1.2 d of motion";
    EXPECT_GT(-push * motion.scale, 0.1) << "no progress";
    EXPECT_GT(motion.least, 0.25 * 1.2);
  }
}

// Yarn drawn at four times its length lies between its contact samples, 0.7 d apart here, much nearer than
// they are.
TEST(SafeStep, StretchedYarnIsSeenBetweenItsSamples) {
  Fabric fabric = two_yarns();
  for (FabricYarn& yarn : fabric.yarns) yarn.segment_rest_length = 0.35;
  for (const double gap : {0.1, 0.02})
    for (const double along : {0.0, 0.13, 0.31}) {
      Fabric near = fabric;
      for (Vec3& p : near.yarns[1].control_points) p.z = gap, p.x += along;
      Unknowns step = no_motion(near);
      for (std::size_t i = 9; i < 18; ++i) step.u[i].z = -0.4;
      const Motion motion = follow(near, step);
      EXPECT_LT(0.4 * motion.scale, gap) << along;
      EXPECT_GT(0.4 * motion.scale, 0.2 * gap) << along;
    }
}

TEST(SafeStep, MovingAwayOrTogetherIsFree) {
  const Fabric fabric = two_yarns();
  Unknowns together = no_motion(fabric);
  for (Vec3& u : together.u) u = {40, -30, 20};
  EXPECT_EQ(follow(fabric, together).scale, 1);
  Unknowns still = no_motion(fabric);
  EXPECT_EQ(follow(fabric, still).scale, 1);
}

// Far outside the list of near pairs, and nothing but one yarn moves.
TEST(SafeStep, AFarYarnThrownThroughTheOther) {
  Fabric fabric = two_yarns();
  for (Vec3& p : fabric.yarns[1].control_points) p.z = 5;
  Unknowns step = no_motion(fabric);
  for (std::size_t i = 9; i < 18; ++i) step.u[i].z = -10;
  EXPECT_GT(follow(fabric, step).least, 0.25);
}

// A wavy yarn with its images 4 d apart: no pair is near.
Fabric sparse_cell() {
  FabricYarn yarn = free_yarn(12, 0.9, [](int i) {
    return Vec3{0.8 * i, 0.4 * std::sin(i * std::acos(-1.0) / 6), 0};
  });
  yarn.periodic = true;
  yarn.shift = {1, 0};
  Fabric fabric = fabric_of({yarn});
  fabric.periodic = true;
  fabric.width = 9.6;
  fabric.height = 4;
  return fabric;
}

// The step in which control points stay where they are while a lattice vector moves.
Unknowns lattice_alone(const Fabric& fabric, const Measures& g) {
  const YarnModel model = build_yarn_model(fabric, frictionless().model);
  const YarnState state = build_yarn_state(fabric);
  const auto f = Assembly(model).fractions(state);
  Unknowns step = no_motion(fabric);
  step.g = g;
  for (std::size_t i = 0; i < f.size(); ++i)
    step.u[i] = {-f[i][0] * g[0] - f[i][1] * g[2], -f[i][1] * g[1], 0};
  return step;
}

TEST(SafeStep, ALatticeVectorAlone) {
  const Fabric plain = relax(knitted("g", "periodic", ""), frictionless()).fabric;
  for (const Fabric& fabric : {plain, sparse_cell()})
    for (const double change : {-0.6, -1.5, 4.0}) {
      SCOPED_TRACE(testing::Message() << fabric.name << " height " << fabric.height << " change " << change);
      const Motion motion = follow(fabric, lattice_alone(fabric, {0, change * fabric.height, 0}));
      EXPECT_GT(motion.least, 0.2 * motion.at_start);
      EXPECT_GT(motion.scale, 0);
    }
}

TEST(SafeStep, ACellFoldedOntoItself) {
  for (const double change : {-0.9, -2.0}) {
    const Fabric fabric = sparse_cell();
    Unknowns step = no_motion(fabric);
    step.g = {0, change * fabric.height, 0};
    EXPECT_GT(follow(fabric, step).least, 0.2);
    step.g = {change * fabric.width, 0, 0};
    follow(fabric, step);
  }
}

TEST(SafeStep, RandomLargeSteps) {
  std::mt19937_64 random(99);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const char* courses : {"g", "ge", "g\ne"}) {
    const Fabric fabric = relax(knitted(courses, "periodic", "", 17, 10), frictionless()).fabric;
    for (int repeat = 0; repeat < 12; ++repeat) {
      Unknowns step = no_motion(fabric);
      const double size = std::pow(10, any(random));  // 0.1 to 10 d
      for (Vec3& u : step.u) u = size * Vec3{any(random), any(random), any(random)};
      step.g = {size * any(random), size * any(random), size * any(random)};
      const Motion motion = follow(fabric, step);
      EXPECT_GT(motion.scale, 0);
      EXPECT_GT(motion.least, 0.2 * motion.at_start) << courses << " repeat " << repeat << " size " << size;
    }
  }
}

// A yarn laid over another one whose held ends pull it down to below the other.
TEST(Relax, AYarnPulledDownOverAnotherStaysAbove) {
  FabricYarn under = free_yarn(16, 1.38, [](int i) { return Vec3{1.4 * (i - 7.5), 0, 0}; });
  // Shorter than the straight line between its ends: pulled as tight as it will go.
  FabricYarn over = free_yarn(16, 1.1, [](int i) {
    const double y = 1.2 * (i - 7.5);
    return Vec3{0, y, -1.5 + 3.0 * std::exp(-y * y / 12)};
  });
  hold_ends(under, 2);
  hold_ends(over, 2);
  RelaxOptions options = frictionless();
  options.plate_room = -1;
  options.model.free = {false, false, false};
  for (const double stretch_stiffness : {300.0, 3000.0}) {
    SCOPED_TRACE(stretch_stiffness);
    options.model.material.stretch_stiffness = stretch_stiffness;
    const RelaxResult result = relax(fabric_of({under, over}), options);
    EXPECT_TRUE(result.converged) << result.message;
    EXPECT_EQ(result.pass_throughs, 0);
    EXPECT_GT(result.energy.contact, 0.01) << "nothing presses";
    const auto height_at_crossing = [&](std::size_t yarn) {
      double nearest = 1e9, z = 0;
      for (const Vec3& p : polyline(result.fabric, result.fabric.yarns[yarn], 30))
        if (std::hypot(p.x, p.y) < nearest) {
          nearest = std::hypot(p.x, p.y);
          z = p.z;
        }
      return z;
    };
    EXPECT_GT(height_at_crossing(1) - height_at_crossing(0), 0.5) << "through the core";
    EXPECT_LT(height_at_crossing(1) - height_at_crossing(0), 1.0) << "not pressed";
  }
}

}  // namespace
}  // namespace loopwright
