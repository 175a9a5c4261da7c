// Loads on a cell's measures, and the history that a fabric off the machine has behind it.
#include "experiments/as_knitted.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "experiments/stretch.hpp"
#include "geometry/interlacing.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

constexpr double bend_stiffness = 1e-8;  // N m^2

RelaxOptions with_friction(double friction) { return loopwright::with_friction(friction, bend_stiffness); }

TEST(Loads, ClothAtRestBearsWhatItIsLoadedWith) {
  const Fabric first = knitted("g", "periodic", "");
  const RelaxOptions options = with_friction(0);
  const RelaxResult relaxed = relax(first, options);
  ASSERT_TRUE(relaxed.converged);
  for (const Measures load : {Measures{0.4, 0, 0}, Measures{0, 0.7, 0}, Measures{0.3, 0.2, 0}}) {
    RelaxOptions loaded = options;
    loaded.grow_in = false;
    loaded.model.load = load;
    const RelaxResult result = relax(relaxed.fabric, loaded);
    ASSERT_TRUE(result.converged);
    EXPECT_NEAR(result.measure_forces[0], load[0], 1e-3);
    EXPECT_NEAR(result.measure_forces[1], load[1], 1e-3);
    EXPECT_GT(result.fabric.width * load[0] + result.fabric.height * load[1],
              relaxed.fabric.width * load[0] + relaxed.fabric.height * load[1]);
    EXPECT_EQ(result.pass_throughs, 0);
  }
}

// The same point of the same curve, whether its strain is prescribed or its force.
TEST(Loads, MeetTheStretchCurve) {
  const RelaxOptions options = with_friction(0);
  const RelaxResult relaxed = relax(knitted("g", "periodic", ""), options);
  StretchTest test;
  test.direction = StretchDirection::wale;
  test.turning_points = {0.1};
  const StretchResult pulled = stretch(relaxed, options, test);
  const double d = relaxed.fabric.diameter_mm * 1e-3, force_unit = bend_stiffness / (d * d);
  RelaxOptions loaded = options;
  loaded.grow_in = false;
  loaded.model.load[1] = pulled.points.back().wale_force * relaxed.fabric.width * d / force_unit;
  const RelaxResult result = relax(relaxed.fabric, loaded);
  ASSERT_TRUE(result.converged);
  EXPECT_NEAR(result.fabric.height / relaxed.fabric.height, 1.1, 2e-3);
  EXPECT_NEAR(result.fabric.width, pulled.fabric.width, 2e-3 * pulled.fabric.width);
}

KnittingHistory history_of(const Fabric& first, double width_share, double take_down_N) {
  KnittingHistory history;
  history.machine_width_mm = width_share * first.width * first.diameter_mm;
  history.take_down_N = take_down_N;
  return history;
}

TEST(AsKnitted, WithoutFrictionTheHistoryIsForgotten) {
  const Fabric first = knitted("g", "periodic", "");
  const RelaxOptions options = with_friction(0);
  const RelaxResult plain = relax(first, options);
  for (const double share : {0.95, 1.1}) {
    const KnittedRest rest = relax_as_knitted(first, options, history_of(first, share, 0.002));
    ASSERT_TRUE(rest.on_machine.converged);
    ASSERT_TRUE(rest.relaxed.converged);
    EXPECT_NEAR(rest.on_machine.fabric.width, share * first.width, 1e-9);
    EXPECT_NEAR(rest.relaxed.fabric.width, plain.fabric.width, 0.01 * plain.fabric.width);
    EXPECT_NEAR(rest.relaxed.fabric.height, plain.fabric.height, 0.01 * plain.fabric.height);
  }
}

TEST(AsKnitted, FrictionRemembersTheNeedles) {
  const Fabric first = knitted("g", "periodic", "");
  const RelaxOptions options = with_friction(0.25);
  const KnittedRest narrow = relax_as_knitted(first, options, history_of(first, 0.9, 0));
  const KnittedRest wide = relax_as_knitted(first, options, history_of(first, 1.1, 0));
  ASSERT_TRUE(narrow.relaxed.converged && wide.relaxed.converged);
  const auto aspect = [](const KnittedRest& rest) {
    return rest.relaxed.fabric.width / rest.relaxed.fabric.height;
  };
  EXPECT_GT(std::abs(aspect(wide) / aspect(narrow) - 1), 0.015);
  for (const KnittedRest* rest : {&narrow, &wide}) {
    EXPECT_EQ(check_interlacings(rest->relaxed.fabric).intact, 1);
    EXPECT_EQ(rest->relaxed.pass_throughs, 0);
    EXPECT_GT(rest->relaxed.newton_iterations, rest->on_machine.newton_iterations);
  }
  // Take-down draws the cloth out as long as it is on the needles.
  const KnittedRest pulled = relax_as_knitted(first, options, history_of(first, 1.1, 0.02));
  EXPECT_GT(pulled.on_machine.fabric.height, 1.02 * wide.on_machine.fabric.height);
  const double d = first.diameter_mm * 1e-3;
  EXPECT_NEAR(pulled.on_machine.measure_forces[1] * bend_stiffness / (d * d), 0.02, 1e-4);  // N
  EXPECT_NEAR(pulled.relaxed.measure_forces[1], 0, 1e-3);
}

// Below the needles nothing but the take-down holds the cloth: it draws in, and is longer for it.
TEST(AsKnitted, ClothDrawsInBelowTheNeedles) {
  const Fabric first = knitted("ge", "periodic", "");
  RelaxOptions options = with_friction(0.25);
  options.set = 0.5;
  constexpr double take_down_N = 0.02;
  const KnittedRest rest = relax_as_knitted(first, options, history_of(first, 1.2, take_down_N));
  ASSERT_TRUE(rest.on_machine.converged && rest.hanging.converged && rest.relaxed.converged);
  const double d = first.diameter_mm * 1e-3;
  EXPECT_NEAR(rest.hanging.measure_forces[1] * bend_stiffness / (d * d), take_down_N, 1e-4);
  EXPECT_NEAR(rest.hanging.measure_forces[0], 0, 1e-3);
  EXPECT_LT(rest.hanging.fabric.width, 0.95 * rest.on_machine.fabric.width);
  EXPECT_GT(rest.hanging.fabric.height, 1.02 * rest.on_machine.fabric.height);
  EXPECT_LT(rest.relaxed.fabric.height, rest.hanging.fabric.height);
  // Its yarn keeps the shape in which it was set on the needles.
  for (std::size_t y = 0; y < first.yarns.size(); ++y)
    EXPECT_EQ(rest.hanging.fabric.yarns[y].natural_curvature,
              rest.on_machine.fabric.yarns[y].natural_curvature);
  // Without a take-down there is nothing to hang under.
  const KnittedRest let_go = relax_as_knitted(first, options, history_of(first, 1.2, 0));
  EXPECT_EQ(let_go.hanging.fabric.width, let_go.on_machine.fabric.width);
}

// Pulled both ways and let go: with friction a rib stays wider than it came from the needles, plain without
// it goes back (such a rib has two shapes of rest), and neither bears anything in the end.
TEST(AsKnitted, APullByHandLeavesWhatFrictionHolds) {
  for (const double friction : {0.0, 0.25}) {
    const Fabric first = knitted(friction > 0 ? "ge" : "g", "periodic", "");
    const RelaxOptions options = with_friction(friction);
    KnittingHistory history = history_of(first, 1, 0);
    const RelaxResult as_it_came = relax_as_knitted(first, options, history).relaxed;
    history.hand_pull_N_m = 10;
    const RelaxResult pulled = relax_as_knitted(first, options, history).relaxed;
    ASSERT_TRUE(as_it_came.converged && pulled.converged);
    const InterlacingCheck check = check_interlacings(pulled.fabric);
    EXPECT_EQ(check.intact, check.expected);
    EXPECT_EQ(pulled.pass_throughs, 0);
    EXPECT_GT(pulled.newton_iterations, as_it_came.newton_iterations);
    for (const int k : {0, 1}) EXPECT_NEAR(pulled.measure_forces[static_cast<std::size_t>(k)], 0, 1e-3);
    const double wider = pulled.fabric.width / as_it_came.fabric.width - 1;
    std::printf("pulled by hand, friction %.2f: %.4f x %.4f d, was %.4f x %.4f\n", friction,
                pulled.fabric.width, pulled.fabric.height, as_it_came.fabric.width, as_it_came.fabric.height);
    if (friction > 0)
      EXPECT_GT(wider, 0.01);
    else
      EXPECT_NEAR(wider, 0, 0.005);
  }
  const Fabric first = knitted("g", "periodic", "");
  KnittingHistory history = history_of(first, 1, 0);
  history.hand_pull_N_m = -1;
  EXPECT_THROW(relax_as_knitted(first, with_friction(0.25), history), std::invalid_argument);
}

// Cloth that hangs under a load of the caller's bears that load and no more when the hands have let go.
TEST(AsKnitted, APullByHandGivesBackTheLoadThatWasThere) {
  const Fabric first = knitted("g", "periodic", "");
  RelaxOptions options = with_friction(0.25);
  options.model.load = {0.3, 0.2, 0};
  KnittingHistory history = history_of(first, 1, 0);
  history.hand_pull_N_m = 10;
  const RelaxResult pulled = relax_as_knitted(first, options, history).relaxed;
  ASSERT_TRUE(pulled.converged);
  for (const std::size_t k : {0u, 1u}) EXPECT_NEAR(pulled.measure_forces[k], options.model.load[k], 1e-3);
}

TEST(AsKnitted, PlatesKeepARibFlat) {
  const Fabric first = knitted("ge", "periodic", "");
  const RelaxOptions options = with_friction(0.25);
  KnittingHistory history = history_of(first, 1, 0);
  const auto thickness = [](const Fabric& fabric) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const FabricYarn& yarn : fabric.yarns)
      for (int k = 0; k < 4 * yarn.segments(); ++k) {
        const double z = position(fabric, yarn, 0.25 * k).z;
        low = std::min(low, z), high = std::max(high, z);
      }
    return (high - low) * fabric.diameter_mm;
  };
  const KnittedRest free = relax_as_knitted(first, options, history);
  history.flat_gap_mm = 2.6;
  const KnittedRest flat = relax_as_knitted(first, options, history);
  ASSERT_TRUE(free.relaxed.converged && flat.relaxed.converged);
  EXPECT_GT(thickness(free.relaxed.fabric), 3.2);
  EXPECT_LT(thickness(flat.relaxed.fabric), 2.6 + 0.4);
  EXPECT_GT(flat.relaxed.fabric.width, 1.1 * free.relaxed.fabric.width);
}

TEST(AsKnitted, RefusesWhatCannotBe) {
  const Fabric first = knitted("g", "periodic", "");
  RelaxOptions options = with_friction(0);
  KnittingHistory history = history_of(first, 1, 0.01);
  history.machine_width_mm = 0;
  EXPECT_THROW(relax_as_knitted(first, options, history), std::invalid_argument);
  history = history_of(first, 1, -1);
  EXPECT_THROW(relax_as_knitted(first, options, history), std::invalid_argument);
  history = history_of(first, 1, 0.01);
  history.flat_gap_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(relax_as_knitted(first, options, history), std::invalid_argument);
  history.flat_gap_mm = 0;
  options.model.material.reference_bend_N_m2 = 0;
  EXPECT_THROW(relax_as_knitted(first, options, history), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
