// What relax() promises beside its physics: results that repeat, errors that help, runs that can be stopped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "geometry/interlacing.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

std::vector<Vec3> all_points(const Fabric& fabric) {
  std::vector<Vec3> points;
  for (const FabricYarn& yarn : fabric.yarns)
    points.insert(points.end(), yarn.control_points.begin(), yarn.control_points.end());
  return points;
}

class ThreadsReset : public testing::Test {
 protected:
  void TearDown() override { set_thread_count(0); }
};
using RelaxThreads = ThreadsReset;

// Large enough for three chunks of the assembly (3000 control points each) and several of every other loop.
TEST_F(RelaxThreads, EqualToTheLastBitForAnyNumber) {
  const Fabric piece = knitted("g", "held", "28 wales x 28 courses");
  ASSERT_GT(all_points(piece).size(), 9000U);
  RelaxOptions options = frictionless();
  options.model.material.friction = 0.2;
  options.most_iterations = 4;
  std::vector<Vec3> first;
  double energy = 0;
  for (const int threads : {1, 2, 3}) {
    set_thread_count(threads);
    const RelaxResult result = relax(piece, options);
    EXPECT_EQ(result.newton_iterations, 4);
    if (threads == 1) {
      first = all_points(result.fabric);
      energy = result.energy.total();
      EXPECT_NE(first, all_points(piece)) << "nothing moved";
    }
    EXPECT_TRUE(all_points(result.fabric) == first) << threads << " threads";
    EXPECT_EQ(result.energy.total(), energy) << threads << " threads";
  }
}

TEST(Relax, HeldPieceComesToRest) {
  // The yarn of a rib slides from loop to loop through so small a piece unless friction holds it.
  for (const auto& [courses, friction] : {std::pair("g", 0.0), std::pair("g", 0.3), std::pair("ge", 0.3)}) {
    SCOPED_TRACE(courses);
    const Fabric piece = knitted(courses, "held", "6 wales x 6 courses");
    RelaxOptions options = frictionless();
    options.model.material.friction = friction;
    const RelaxResult result = relax(piece, options);
    std::printf("%s friction %.1f: %d steps\n", courses, friction, result.newton_iterations);
    EXPECT_TRUE(result.converged) << courses << ": " << result.message;
    EXPECT_LT(result.residual, 2e-4);
    EXPECT_EQ(result.pass_throughs, 0);
    const InterlacingCheck check = check_interlacings(result.fabric);
    EXPECT_EQ(check.intact, check.expected);
    EXPECT_GT(check.expected, 20);
    EXPECT_GT(min_clearance(result.fabric).distance, 0.7) << "yarns press by a few per cent, not by a third";
    // Held points move with the frame's measures alone: their fractions of it stay.
    for (std::size_t y = 0; y < piece.yarns.size(); ++y)
      for (std::size_t i = 0; i < piece.yarns[y].held.size(); ++i) {
        if (!piece.yarns[y].held[i]) continue;
        const Vec3 &before = piece.yarns[y].control_points[i],
                   &after = result.fabric.yarns[y].control_points[i];
        EXPECT_NEAR(before.x / piece.width, after.x / result.fabric.width, 1e-9);
        EXPECT_NEAR(before.y / piece.height, after.y / result.fabric.height, 1e-9);
        EXPECT_EQ(before.z, after.z);
      }
  }
}

TEST(Relax, ARelaxedClothStays) {
  for (const char* courses : {"g", "ge", "g\ne"}) {
    RelaxOptions options = frictionless();
    const RelaxResult once = relax(knitted(courses, "periodic", ""), options);
    ASSERT_TRUE(once.converged) << once.message;
    options.grow_in = false;
    const RelaxResult twice = relax(once.fabric, options);
    EXPECT_TRUE(twice.converged);
    EXPECT_LE(twice.newton_iterations, 2) << courses;
    EXPECT_NEAR(twice.energy.total(), once.energy.total(), 1e-6 * once.energy.total());
    EXPECT_NEAR(twice.fabric.width, once.fabric.width, 1e-4);
  }
}

TEST(Relax, TurningTheClothChangesNothing) {
  // A free piece of a bent yarn in space, turned by a rotation: the same energies to round-off, step by step.
  const auto bent = [](int i) { return Vec3{1.2 * i, 0.8 * std::sin(0.7 * i), 0.5 * std::cos(1.1 * i)}; };
  RelaxOptions options = frictionless();
  options.plate_room = -1;
  options.most_iterations = 3;
  options.grow_in = false;
  options.model.free = {false, false, false};
  const RelaxResult straight = relax(fabric_of({free_yarn(14, 1.4, bent)}), options);
  const RelaxResult turned =
      relax(fabric_of({free_yarn(14, 1.4,
                                 [&](int i) {
                                   const Vec3 p = bent(i);  // axes permuted: a turn by 120 degrees
                                   return Vec3{p.z, p.x, p.y};
                                 })}),
            options);
  EXPECT_NEAR(straight.energy.total(), turned.energy.total(), 1e-9 * straight.energy.total());
}

TEST(Relax, AStoppedRunReturnsWhatItReached) {
  const Fabric cell = knitted("ge", "periodic", "");
  RelaxOptions options = frictionless();
  for (const int stop_at : {0, 3, 15}) {
    int calls = 0, last = -1;
    options.on_progress = [&](const RelaxProgress& progress) {
      EXPECT_GE(progress.newton_iterations, last);
      EXPECT_GT(progress.radius, 0);
      EXPECT_LE(progress.radius, 1);
      EXPECT_TRUE(progress.phase == "grow-in" || progress.phase == "relax") << progress.phase;
      last = progress.newton_iterations;
      return calls++ < stop_at;
    };
    const RelaxResult result = relax(cell, options);
    EXPECT_TRUE(result.stopped);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.message, "stopped");
    EXPECT_EQ(calls, stop_at + 1) << "asked again after it was told to stop";
    EXPECT_EQ(all_points(result.fabric) == all_points(cell), stop_at == 0);
    const InterlacingCheck check = check_interlacings(result.fabric);
    EXPECT_EQ(check.intact, check.expected);
  }
}

TEST(Relax, TooFewIterationsSaySo) {
  RelaxOptions options = frictionless();
  options.most_iterations = 5;
  const RelaxResult result = relax(knitted("g", "periodic", ""), options);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.newton_iterations, 5);
  EXPECT_THAT(result.message, HasSubstr("not converged after 5"));
}

void expect_refused(const Fabric& fabric, const RelaxOptions& options, const std::string& text) {
  try {
    relax(fabric, options);
    ADD_FAILURE() << "accepted, though " << text;
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr(text));
  }
}

TEST(RelaxInput, FabricsThatMakeNoSenseAreRefused) {
  const Fabric good = knitted("g", "periodic", "");
  const RelaxOptions options = frictionless();
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinite, -infinite}) {
    Fabric f = good;
    f.yarns[0].control_points[3].y = bad;
    expect_refused(f, options, "control point");
    f = good;
    f.width = bad;
    expect_refused(f, options, "width");
  }
  for (const double bad : {0.0, -1.0, nan, infinite}) {
    Fabric f = good;
    f.yarns[0].segment_rest_length = bad;
    expect_refused(f, options, "rest length");
    f = good;
    f.yarns[0].diameter = bad;
    expect_refused(f, options, "diameter");
  }
  for (const double bad : {0.0, -3.0}) {
    Fabric f = good;
    f.height = bad;
    expect_refused(f, options, "positive width and height");
  }
  expect_refused(Fabric{}, options, "no yarn");
  Fabric f = good;
  f.yarns[0].control_points.resize(3);
  expect_refused(f, options, "at least 4 control points");
  f = good;
  f.periodic = false;
  expect_refused(f, options, "not periodic");
  f = good;
  f.yarns[0].segment_rest_length = 40;
  expect_refused(f, options, "use more segments per loop");
}

TEST(RelaxInput, YarnDataOutOfRangeAreRefused) {
  const Fabric good = knitted("g", "periodic", "");
  const auto refused = [&](const auto& change, const std::string& text) {
    RelaxOptions options = frictionless();
    change(options);
    expect_refused(good, options, text);
  };
  const double nan = std::nan("");
  for (const double bad : {1.0, 1.2, 0.0, -0.5, nan})
    refused([&](RelaxOptions& o) { o.model.material.contact.core = bad; }, "core");
  for (const double bad : {-0.1, 6.0, nan})
    refused([&](RelaxOptions& o) { o.model.material.friction = bad; }, "friction");
  for (const double bad : {0.0, -1.0, nan}) {
    refused([&](RelaxOptions& o) { o.model.material.stretch_stiffness = bad; }, "stretch stiffness");
    refused([&](RelaxOptions& o) { o.model.material.bend_stiffness = bad; }, "bend stiffness");
    refused([&](RelaxOptions& o) { o.model.material.contact.stiffness = bad; }, "contact stiffness");
    refused([&](RelaxOptions& o) { o.model.sample_spacing = bad; }, "sample spacing");
    refused([&](RelaxOptions& o) { o.tolerance = bad; }, "tolerance");
  }
  for (const double bad : {1.0, 0.5, nan})
    refused([&](RelaxOptions& o) { o.model.material.contact.exponent = bad; }, "exponent");
  refused([&](RelaxOptions& o) { o.model.plates = {50, 1, -1}; }, "plates");
  refused([&](RelaxOptions& o) { o.model.plates = {-1, -1, 1}; }, "plates");
}

}  // namespace
}  // namespace loopwright
