// The softest motions of yarns, whose frequencies and buckling loads are known, and of cells.
#include "experiments/modes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

using std::numbers::pi;

// A straight yarn without ends, pressed to `share` of its length.
constexpr int count = 60;
constexpr double length = 60;

Fabric pressed_yarn(double share) {
  FabricYarn yarn = free_yarn(count, length / count, [&](int i) {
    return Vec3{share * length * i / count, 0, 0};
  });
  yarn.periodic = true;
  yarn.shift = {1, 0};
  Fabric fabric = fabric_of({yarn});
  fabric.periodic = true;
  fabric.width = share * length;
  fabric.height = 50;
  return fabric;
}

// Waves of wave number k on a straight yarn under the load P: lambda M = B k^4 - P k^2 per length as it is,
// and the mass of that length is the rest length. Two of each (sine and cosine) in each of two directions.
TEST(Modes, WavesOfAPressedYarn) {
  for (const double share : {1.0, 0.99995, 0.9999}) {  // Euler's load for one wave: (2 pi/60)^2 = 0.011 B/d^2
    const Fabric fabric = pressed_yarn(share);
    ModelOptions options = frictionless().model;
    options.material.stretch_stiffness = 200;
    const std::vector<Mode> modes = lowest_modes(fabric, options, {.wanted = 8});
    const double P = 200 * (1 - share);
    for (std::size_t wave = 1; wave <= 2; ++wave) {
      const double k = 2 * pi * static_cast<double>(wave) / (share * length);
      const double exact = (k * k * k * k - P * k * k) * share;
      for (std::size_t m = 4 * (wave - 1); m < 4 * wave; ++m) {
        EXPECT_NEAR(modes[m].lambda, exact, 2e-3 * k * k * k * k);
        EXPECT_LT(modes[m].along, 1e-6);
      }
    }
  }
  // the load passes Euler's, (2 pi / length)^2 B, at a strain of 5.5e-5: sign of the lowest mode on both
  // sides
  ModelOptions options = frictionless().model;
  options.material.stretch_stiffness = 200;
  const double euler = std::pow(2 * pi / length, 2) / 200;
  EXPECT_GT(lowest_modes(pressed_yarn(1 - 0.99 * euler), options, {.wanted = 1})[0].lambda, 0);
  EXPECT_LT(lowest_modes(pressed_yarn(1 - 1.01 * euler), options, {.wanted = 1})[0].lambda, 0);
}

// Free bar: six rigid motions left out, then pairs of bending modes, (4.730041 / L)^4 and (7.853205 / L)^4 B.
TEST(Modes, BendingOfAFreeBar) {
  const Fabric fabric = fabric_of({free_yarn(63, 1, [](int i) { return Vec3{i - 31.0, 0, 0}; })});
  std::vector<double> bending;
  for (const Mode& mode : lowest_modes(fabric, frictionless().model, {.wanted = 4})) {
    EXPECT_LT(mode.along, 0.5);
    bending.push_back(mode.lambda);
  }
  const double first = std::pow(4.730041 / 60, 4), second = std::pow(7.853205 / 60, 4);
  ASSERT_EQ(bending.size(), 4U);
  EXPECT_NEAR(bending[0], first, 1e-3 * first);
  EXPECT_NEAR(bending[1], first, 1e-3 * first);
  EXPECT_NEAR(bending[2], second, 1e-3 * second);
  EXPECT_NEAR(bending[3], second, 1e-3 * second);
}

// A clamped yarn pressed beyond its load: straight it is at a saddle with two ways down (any plane), buckled
// it is at rest, but for the plane of the buckle, which may turn round the axis at no cost.
TEST(Modes, BuckledAndStraight) {
  const double share = 0.97;
  FabricYarn straight = free_yarn(53, 1, [&](int i) { return Vec3{share * (i - 26), 0, 0}; });
  hold_ends(straight, 2);
  FabricYarn bent = straight;
  for (std::size_t i = 2; i + 2 < bent.control_points.size(); ++i)
    bent.control_points[i].y = 2 * (1 + std::cos(pi * (static_cast<double>(i) - 26) / 24));
  const std::vector<Mode> before = lowest_modes(fabric_of({straight}), yarn_alone(1e-9).model, {.wanted = 2});
  EXPECT_LT(before[0].lambda, -1e-3);
  EXPECT_NEAR(before[1].lambda, before[0].lambda, 1e-6 * std::abs(before[0].lambda));
  const RelaxResult buckled = relax(fabric_of({bent}), yarn_alone(1e-10));
  ASSERT_TRUE(buckled.converged) << buckled.message;
  const std::vector<Mode> after = lowest_modes(buckled.fabric, yarn_alone(1e-9).model, {.wanted = 2});
  EXPECT_NEAR(after[0].lambda, 0, 1e-6 * std::abs(before[0].lambda));
  double out_of_plane = 0;
  for (const Vec3& u : after[0].shape) out_of_plane += u.x * u.x + u.y * u.y;
  EXPECT_LT(out_of_plane, 1e-6);
  EXPECT_GT(after[1].lambda, 1e-5);
}

// Every mode has the curvature that the Hessian gives along it, for a mass that is integrated here.
TEST(Modes, OfCellsObeyTheirEquation) {
  for (const char* courses : {"g", "ge", "g\ne"}) {
    SCOPED_TRACE(courses);
    const RelaxResult rest = elastic_rest(knitted(courses, "periodic", ""), frictionless());
    ASSERT_TRUE(rest.converged);
    const std::vector<Mode> modes = lowest_modes(rest.fabric, frictionless().model, {.wanted = 5});
    EXPECT_GT(modes[0].lambda, 1e-4) << "not stable";
    for (std::size_t k = 1; k < modes.size(); ++k) EXPECT_GE(modes[k].lambda, modes[k - 1].lambda);
    const RestHessian at = rest_hessian(rest.fabric, frictionless().model, false);
    for (const Mode& mode : modes) {
      Unknowns x{mode.shape, {}}, force;
      multiply(at.hessian, x, force);
      double curvature = 0, square = 0;
      for (std::size_t i = 0; i < x.u.size(); ++i) curvature += dot(x.u[i], force.u[i]);
      EXPECT_NEAR(curvature, mode.lambda, 1e-7 + 1e-6 * mode.lambda);  // as int u^2 = 1
      for (const FabricYarn& yarn : rest.fabric.yarns) {
        FabricYarn moved = yarn;
        const auto first = &yarn - rest.fabric.yarns.data() == 0 ? 0 : rest.fabric.yarns[0].segments();
        for (std::size_t i = 0; i < moved.control_points.size(); ++i)
          moved.control_points[i] = mode.shape[static_cast<std::size_t>(first) + i];
        moved.shift = {0, 0};
        for (int e = 0; e < yarn.segments(); ++e)
          for (std::size_t g = 0; g < 4; ++g)
            square += gauss_weight[g] * yarn.segment_rest_length *
                      squared_norm(position(rest.fabric, moved, e + gauss_node[g]));
      }
      EXPECT_NEAR(square, 1, 1e-9);
    }
  }
}

// Moss of 12 points a loop comes to rest at a saddle that its symmetry hides; sharp_rest finds the way down.
TEST(Modes, ASaddleIsLeft) {
  RelaxOptions options = frictionless();
  RelaxOptions grow = options;
  grow.model.free = {false, false, false};
  grow.tolerance = 0.05;
  options.grow_in = false;
  options.tolerance = 1e-8;
  const RelaxResult saddle = relax(relax(knitted("ge\neg", "periodic", ""), grow).fabric, options);
  ASSERT_TRUE(saddle.converged);
  ASSERT_LT(lowest_modes(saddle.fabric, options.model, {.wanted = 1})[0].lambda, -1e-3);
  EXPECT_THROW(condensed_stiffness(rest_hessian(saddle.fabric, options.model, true)), std::runtime_error);
  const RelaxResult rest = sharp_rest(saddle, options);
  ASSERT_TRUE(rest.converged);
  EXPECT_LT(rest.energy.stored(), saddle.energy.stored());
  EXPECT_GT(lowest_modes(rest.fabric, options.model, {.wanted = 1})[0].lambda, 0);
  EXPECT_EQ(rest.pass_throughs, 0);
}

TEST(Modes, WhatCannotBeIsRefused) {
  const Fabric yarn = fabric_of({free_yarn(5, 1, [](int i) { return Vec3{1.0 * i, 0, 0}; })});
  EXPECT_THROW(lowest_modes(yarn, frictionless().model, {.wanted = 0}), std::invalid_argument);
  EXPECT_THROW(lowest_modes(yarn, frictionless().model, {.wanted = 12}), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
