// How far the places of sliding bindings may go: ranges, stops between neighbours, and what that makes of a
// pull.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/loose_yarns.hpp"
#include "dynamics/structures.hpp"
#include "dynamics/yarn_motion.hpp"
#include "geometry/interlacing.hpp"
#include "mechanics/relax.hpp"

namespace loopwright {
namespace {

// First and second derivatives of D, free, with a drag, and with one place or both at the end of a range.
TEST(SlidingRange, DerivativesOfTheDistance) {
  SplineModel model;
  MotionState state;
  std::vector<Vec3> a = line({-3, 0, 1}, {1, 0.2, 0}, 8), b = line({0.1, -3, 0}, {0.3, 1, 0.1}, 8);
  for (std::size_t i = 0; i < 8; ++i) {
    a[i].z -= 0.06 * a[i].x * a[i].x;
    b[i].z += 0.05 * b[i].y * b[i].y;
  }
  add_yarn(model, state, a, 200, 40, false);
  add_yarn(model, state, b, 200, 40, false);
  SlidingBinding free;
  free.a = {0, 2.1};
  free.b = {1, 2.2};
  follow(model, state.place, free);
  SlidingBinding dragged = free, stopped_a = free, stopped_b = free, fixed = free;
  dragged.range_a = {0, 5, free.a.t + 0.3, 0.4};
  dragged.range_b = {0, 5, free.b.t - 0.2, 0.7};
  stopped_a.range_a.high = free.a.t - 0.2;
  stopped_b.range_b.low = free.b.t + 0.15;
  fixed.range_a = stopped_a.range_a;
  fixed.range_b = stopped_b.range_b;
  for (const SlidingBinding& binding : {free, dragged, stopped_a, stopped_b, fixed}) {
    const auto at = [&](const std::vector<Vec3>& place) {
      SlidingBinding moved = binding;
      return follow(model, place, moved);
    };
    const ShortestConnection c = at(state.place);
    EXPECT_EQ(c.free_a, binding.range_a.high > 100 || binding.range_a.drag > 0);
    EXPECT_EQ(c.free_b, binding.range_b.low == 0);
    const auto slope = [](const ShortestConnection& of, std::size_t k, int axis) {
      return (k < 4 ? of.a.weights.value[k] : -of.b.weights.value[k - 4]) * of.normal[axis];
    };
    const auto hessian = distance_hessian(c);
    constexpr double h = 1e-5;
    for (std::size_t k = 0; k < 8; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const auto point = static_cast<std::size_t>(k < 4 ? c.a.first : c.b.first - 4) + k;
        std::vector<Vec3> up = state.place, down = state.place;
        up[point][axis] += h;
        down[point][axis] -= h;
        const ShortestConnection above = at(up), below = at(down);
        EXPECT_NEAR((above.distance - below.distance) / (2 * h), slope(c, k, axis), 1e-8);
        for (std::size_t l = 0; l < 8; ++l)
          for (int other = 0; other < 3; ++other)
            EXPECT_NEAR(
                (slope(above, l, other) - slope(below, l, other)) / (2 * h),
                hessian[3 * k + static_cast<std::size_t>(axis)][3 * l + static_cast<std::size_t>(other)],
                1e-7);
      }
  }
}

// Two rods across a rail, pressed on it and driven towards each other: their places come to a yarn's
// thickness of each other and no nearer, and each rod then leans against its place by the angle of its force.
TEST(SlidingStops, NeighboursStayAThicknessApart) {
  constexpr double press = 0.2, drive = 0.05;  // accelerations
  for (const MotionStepper stepper : {MotionStepper::explicit_euler, MotionStepper::implicit_euler}) {
    SplineModel model;
    MotionState state;
    const int rail = add_yarn(model, state, line({-6, 0, 0}, {1, 0, 0}, 19), 200, 40, true);
    Bindings bindings;
    for (const double x : {0.3, 4.1}) {
      const int rod = add_yarn(model, state, line({x, -3, 1}, {0, 1, 0}, 7), 200, 40, false);
      SlidingBinding binding;
      binding.a = {rod, 2};
      binding.b = {rail, x + 5};
      bindings.sliding.push_back(binding);
    }
    model.gravity = {0, 0, -press};
    model.drag = 1;
    MotionOptions options;
    options.stepper = stepper;
    options.tolerance = 1e-8;
    options.most_newton = 40;
    YarnMotion motion(model, state, bindings, options);
    constexpr double rod_mass = 4;
    std::vector<Vec3> force(state.place.size());
    for (std::size_t i = 19; i < force.size(); ++i) force[i].x = (i < 26 ? 1 : -1) * drive * rod_mass / 7;
    motion.set_force(force);
    const double dt = stepper == MotionStepper::explicit_euler ? 0.005 : 0.2;
    const auto gap = [&] { return motion.bindings().sliding[1].b.t - motion.bindings().sliding[0].b.t; };
    double least = gap();
    while (motion.state().time < 150) {
      EXPECT_TRUE(motion.step(dt).converged);
      least = std::min(least, gap());
    }
    EXPECT_GT(least, 1 - 1e-9);
    EXPECT_NEAR(gap(), 1, 1e-3);
    const double leaning = std::sin(std::atan(drive / press));
    const auto middle = [&](int yarn) { return curve_point(model, motion.state().place, yarn, 2).place.x; };
    EXPECT_NEAR(middle(2) - middle(1), 1 - 2 * leaning, 0.02);
    EXPECT_LT(motion.energy().kinetic, 1e-5);
  }
}

// Two yarns cross at right angles and are pressed on each other beside their binding: nothing holds them
// there until they are near, then a guard does, which lets go when they are pulled apart.
TEST(SlidingGuards, AreSetWhereYarnsComeNearAndOnlyPress) {
  for (const MotionStepper stepper : {MotionStepper::explicit_euler, MotionStepper::implicit_euler}) {
    SplineModel model;
    MotionState state;
    add_yarn(model, state, line({-6, 0, 0}, {1, 0, 0}, 15), 200, 40, true);
    const int rod = add_yarn(model, state, line({1, -3, 1.6}, {0, 1, 0}, 7), 200, 40, false);
    model.drag = 1;
    model.gravity = {0, 0, -0.1};
    Bindings bindings;
    bindings.guarded = {{rod, 0, 1, 3, 4, 8}};
    MotionOptions options;
    options.stepper = stepper;
    options.tolerance = 1e-8;
    options.most_newton = 40;
    YarnMotion motion(model, state, bindings, options);
    const double dt = stepper == MotionStepper::explicit_euler ? 0.005 : 0.1;
    const auto height = [&] { return curve_point(model, motion.state().place, rod, 2).place.z; };
    double lowest = 2;
    while (motion.state().time < 30) {
      EXPECT_TRUE(motion.step(dt).converged);
      lowest = std::min(lowest, height());
    }
    constexpr double rod_weight = 0.4;
    ASSERT_EQ(motion.bindings().sliding.size(), 1u);
    EXPECT_NEAR(motion.bindings().sliding[0].multiplier, -rod_weight, 0.01 * rod_weight);
    EXPECT_NEAR(height(), 1, 1e-3);
    EXPECT_GT(lowest, 0.99);
    motion.set_gravity({0, 0, 0.1});
    while (motion.state().time < 40) EXPECT_TRUE(motion.step(dt).converged);
    EXPECT_GT(height(), 1.5) << "a guard does not pull";
    EXPECT_TRUE(motion.bindings().sliding.empty());
  }
}

// What a loop's binding holds it lets go when it is pulled on harder than it may be.
TEST(SlidingGuards, BindingsPartBeyondTheirPull) {
  for (const double pull : {0.9, 1.1}) {
    SplineModel model;
    MotionState state;
    add_yarn(model, state, line({-6, 0, 0}, {1, 0, 0}, 15), 200, 40, true);
    const int rod = add_yarn(model, state, line({1, -3, 1}, {0, 1, 0}, 7), 200, 40, false);
    model.drag = 1;
    model.gravity = {0, 0, 0.25 * pull};  // on a mass of 4
    SlidingBinding binding;
    binding.a = {rod, 2};
    binding.b = {0, 6};
    binding.most_pull = 1;
    Bindings bindings;
    bindings.sliding = {binding};
    YarnMotion motion(model, state, bindings);
    for (int k = 0; k < 60; ++k) EXPECT_TRUE(motion.step(0.2).converged);
    const double height = curve_point(model, motion.state().place, rod, 2).place.z;
    if (pull < 1)
      EXPECT_NEAR(height, 1, 1e-6);
    else
      EXPECT_GT(height, 2);
  }
}

// Cloth at rest pulled along its courses by 20 or 40 %, its natural shape that at rest (the paper's start) or
// straight: every step comes to its tolerance, no interlacing is lost, and the frame carries about what it
// carries under contact.
TEST(SlidingStops, PlainAndRibArePulledAsUnderContact) {
  struct Case {
    const char* file;
    double set, strain, force_off;
  };
  for (const Case& c : {Case{"plain", 1, 0.4, 0.15},
                        {"plain", 0, 0.2, 0.2},
                        {"rib", 1, 0.2, 0.3},
                        {"garter", 1, 0.2, 0.05}}) {
    const SmallPiece piece = small_piece(std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) /
                                             "examples/structures" / (std::string(c.file) + ".verm"),
                                         "4 wales x 4 courses");
    RelaxOptions options;
    options.model.material = piece.material;
    options.model.material.friction = 0.25;
    const RelaxResult rest = relax(piece.fabric, options);
    ASSERT_TRUE(rest.converged);
    const auto pulled = [&](bool contact) {
      SplineModel model = spline_model(rest.fabric, piece.material, c.set, c.set > 0);
      model.drag = 0.05;
      const MotionState start = motion_state(rest.fabric);
      Bindings bindings;
      std::optional<FabricContact> shells;
      if (contact)
        shells = fabric_contact(rest.fabric, options.model, rest.history);
      else
        bindings = sliding_bindings(model, start.place, feet(rest.fabric), 0.25);
      MotionOptions motion_options;
      motion_options.tolerance = 1e-2;
      motion_options.constraint_tolerance = 1e-6;
      motion_options.most_newton = 25;
      YarnMotion motion(model, start, bindings, motion_options, shells);
      const std::vector<SlideStop> stops = slide_stops(model, bindings.sliding);
      int newton = 0;
      constexpr int steps = 60;  // the last ones at rest
      for (int step = 0; step < steps; ++step) {
        std::vector<Vec3> held = start.place;
        for (Vec3& p : held) p.x *= 1 + c.strain * std::min(step, 40) / 40;
        const StepReport report = motion.step(25, held);
        EXPECT_TRUE(report.converged) << c.file << ", step " << step;
        newton += report.newton;
        for (const SlideStop& stop : stops) {  // guards come after the bindings that were there first
          const SlidingBinding &first = motion.bindings().sliding[stop.first],
                               &second = motion.bindings().sliding[stop.second];
          EXPECT_GT((stop.second_is_a ? second.a : second.b).t - (stop.first_is_a ? first.a : first.b).t,
                    stop.room - 0.01)  // a thickness is not quite the same share of every segment
              << c.file << ", step " << step;
        }
        const InterlacingCheck check = check_interlacings(with_places(rest.fabric, motion.state().place));
        EXPECT_EQ(check.intact, check.expected) << c.file << ", step " << step;
      }
      EXPECT_LT(newton, 25 * steps) << c.file;
      return motion.course_force((1 + c.strain) * rest.fabric.width);
    };
    const double sliding = pulled(false), contact = pulled(true);
    EXPECT_NEAR(sliding, contact, c.force_off * contact) << c.file;
  }
}

}  // namespace
}  // namespace loopwright
