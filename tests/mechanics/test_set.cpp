// Set yarn: what is bent when it is unloaded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "geometry/interlacing.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

constexpr double pi = 3.14159265358979323846;

FabricYarn arc(double radius, double length, int segments) {
  const double turn = length / segments / radius;  // of a control point to the next
  const double outside = radius * 3 / (2 + std::cos(turn));
  return free_yarn(segments + 3, length / segments, [&](int i) {
    return Vec3{outside * std::sin(turn * (i - 1)), outside * (1 - std::cos(turn * (i - 1))), 0};
  });
}

RelaxOptions alone() {
  RelaxOptions options;
  options.grow_in = false;
  options.plate_room = -1;
  options.tolerance = 1e-7;
  options.model.free = {false, false, false};
  return options;
}

// A ring that keeps the share s of its curvature bears (1 - s)^2 of the energy of straight yarn bent to it,
// pi B / R. Rounding the law's cusp changes that by less than a hundredth at half set.
TEST(SetYarn, RingKeepsTheRestOfItsEnergy) {
  constexpr double radius = 5;
  constexpr int count = 64;
  FabricYarn yarn = free_yarn(count, 2 * pi * radius / count, [&](int i) {
    const double outside = radius * 3 / (2 + std::cos(2 * pi / count)), at = 2 * pi * i / count;
    return Vec3{outside * std::cos(at), outside * std::sin(at), 0};
  });
  yarn.periodic = true;
  Fabric fabric = fabric_of({yarn});
  fabric.periodic = true;
  fabric.width = fabric.height = 100;
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const RelaxResult rest = relax(set_yarn(fabric, share), alone());
    ASSERT_TRUE(rest.converged) << rest.message;
    const double exact = (1 - share) * (1 - share) * pi / radius;
    EXPECT_NEAR(rest.energy.bend, exact, 0.01 * exact + 1e-9) << "set " << share;
  }
}

// Yarn that was set as an arc goes back to that arc, whatever it is bent to: the chord tells.
TEST(SetYarn, OpenYarnGoesBackToTheArcItWasSetIn) {
  constexpr double radius = 6, length = 12;
  constexpr int segments = 24;
  const Fabric was_set = set_yarn(fabric_of({arc(radius, length, segments)}), 1);
  for (const double bent : {4.0, 40.0}) {
    Fabric fabric = fabric_of({arc(bent, length, segments)});
    fabric.yarns[0].natural_curvature = was_set.yarns[0].natural_curvature;
    const RelaxResult rest = relax(fabric, alone());
    ASSERT_TRUE(rest.converged) << rest.message << ", residual " << rest.residual;
    const FabricYarn& yarn = rest.fabric.yarns[0];
    const double chord = distance(position(rest.fabric, yarn, 0), position(rest.fabric, yarn, segments));
    const double exact = 2 * radius * std::sin(length / (2 * radius));
    std::printf("set in an arc of 6, bent to %g: chord %.4f (%.4f), energy %.2g\n", bent, chord, exact,
                rest.energy.bend);
    EXPECT_NEAR(chord, exact, 2e-3 * exact);
    EXPECT_LT(rest.energy.bend, 1e-4 * length / (2 * radius * radius));
  }
}

// Cloth that is set where it lies keeps its size but for the yarn that was squeezed, and little of its
// forces: of its bend energy about (1 - s)^2.
TEST(SetYarn, ClothKeepsItsSizeAndLosesItsForces) {
  const Fabric first = knitted("g", "periodic", "", 17);
  RelaxOptions options;
  const RelaxResult unset = relax(first, options);
  options.set = 0.5;
  const RelaxResult set = relax(first, options);
  ASSERT_TRUE(unset.converged && set.converged) << set.message;
  std::printf("plain set by half: %.4f x %.4f, unset %.4f x %.4f; bend %.4f of %.4f\n", set.fabric.width,
              set.fabric.height, unset.fabric.width, unset.fabric.height, set.energy.bend, unset.energy.bend);
  EXPECT_NEAR(set.fabric.width, unset.fabric.width, 0.03 * unset.fabric.width);
  EXPECT_NEAR(set.fabric.height, unset.fabric.height, 0.03 * unset.fabric.height);
  EXPECT_NEAR(set.energy.bend, 0.25 * unset.energy.bend, 0.03 * unset.energy.bend);
  const InterlacingCheck check = check_interlacings(set.fabric);
  EXPECT_EQ(check.intact, check.expected);
  EXPECT_EQ(set.pass_throughs, 0);

  // Yarn that is set already keeps what it has, and one set yarn sets the piece.
  EXPECT_TRUE(is_set(set.fabric));
  EXPECT_FALSE(is_set(unset.fabric));
  Fabric mixed = unset.fabric;
  mixed.yarns.push_back(set.fabric.yarns[0]);
  EXPECT_TRUE(is_set(mixed));
  const RelaxResult again = relax(set.fabric, options);
  EXPECT_EQ(again.fabric.yarns[0].natural_curvature, set.fabric.yarns[0].natural_curvature);
}

TEST(SetYarn, NonsenseIsRefused) {
  const Fabric fabric = fabric_of({arc(5, 6, 12)});
  EXPECT_THROW(set_yarn(fabric, -0.1), std::invalid_argument);
  EXPECT_THROW(set_yarn(fabric, 1.1), std::invalid_argument);
  EXPECT_THROW(set_yarn(fabric, std::nan("")), std::invalid_argument);
  Fabric wrong = set_yarn(fabric, 0.5);
  wrong.yarns[0].natural_curvature.pop_back();
  EXPECT_THROW(relax(wrong, alone()), std::invalid_argument);
  wrong = set_yarn(fabric, 0.5);
  wrong.yarns[0].natural_curvature[3][2] = std::nan("");
  EXPECT_THROW(relax(wrong, alone()), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
