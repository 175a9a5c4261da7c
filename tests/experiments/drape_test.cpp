// Cloth under its weight: what holds it bears it, and it gives as a stretch test says.
#include "experiments/drape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/rest_hessian.hpp"
#include "experiments/stretch.hpp"
#include "geometry/interlacing.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

struct Cell {
  RelaxResult rest;
  RelaxOptions options;
};

// Yarn of 80 tex, 0.4 mm thick, B = 1e-8 N m^2.
Cell cell_of(const char* courses, double friction) {
  Cell cell;
  cell.options = frictionless();
  cell.options.model.material.reference_bend_N_m2 = 1e-8;
  cell.options.model.material.friction = friction;
  cell.options.model.sample_spacing = 0.1;
  Fabric first = knitted(courses, "periodic", "", 17, 16);
  first.diameter_mm = 0.4;
  for (FabricYarn& yarn : first.yarns) yarn.linear_density_tex = 80;
  cell.rest = friction > 0 ? relax(first, cell.options) : elastic_rest(first, cell.options);
  cell.options.grow_in = false;
  return cell;
}

// Strain along the wales at a pull, the width held, from a stretch test.
double strain_at(const std::vector<StretchPoint>& points, double force) {
  for (std::size_t k = 1; k < points.size(); ++k) {
    const StretchPoint &a = points[k - 1], &b = points[k];
    if (b.wale_force >= force)
      return a.wale_strain +
             (force - a.wale_force) / (b.wale_force - a.wale_force) * (b.wale_strain - a.wale_strain);
  }
  return NAN;
}

TEST(Drape, LoadsAreTheYarnsWeight) {
  const Cell cell = cell_of("g", 0);
  const std::vector<Vec3> loads = weight_loads(cell.rest.fabric, cell.options.model.material, {0, 0, -9.81});
  ModelOptions loaded = cell.options.model;
  loaded.point_loads = loads;
  const double newtons = 17 * 0.4e-3 * 80e-6 * 9.81;  // a loop of 17 d
  EXPECT_NEAR(total_load(cell.rest.fabric, loaded).z, -newtons, 1e-3 * newtons);
  EXPECT_EQ(total_load(cell.rest.fabric, loaded).x, 0);
  Fabric weightless = cell.rest.fabric;
  weightless.yarns[0].linear_density_tex = 0;
  EXPECT_THROW(weight_loads(weightless, cell.options.model.material, {0, 0, -9.81}), std::invalid_argument);
}

// Garter with friction 0.1 at a hundred times its weight, and plain without friction at four hundred: the
// rail bears the weight, and courses away from both ends are stretched as a stretch test says.
TEST(Drape, AHangingStripGivesAsItsStretchCurve) {
  struct Case {
    const char* courses;
    double friction, gravity, to;
    std::size_t first;
  };
  for (const Case& c : {Case{"g\ne", 0.1, 1000, 0.35, 2}, Case{"g", 0, 4000, 0.15, 5}}) {
    SCOPED_TRACE(c.courses);
    const Cell cell = cell_of(c.courses, c.friction);
    StretchTest test;
    test.direction = StretchDirection::wale;
    test.turning_points = {c.to};
    test.free_across = false;
    test.largest_step = 0.005;
    const std::vector<StretchPoint> curve = stretch(cell.rest, cell.options, test).points;
    const HangingStrip strip = hang(cell.rest, cell.options, 16, c.gravity, c.friction > 0 ? 10 : 1);
    ASSERT_TRUE(strip.result.converged) << strip.result.message;
    EXPECT_EQ(strip.result.pass_throughs, 0);
    const InterlacingCheck check = check_interlacings(strip.fabric);
    EXPECT_EQ(check.intact, check.expected);
    EXPECT_EQ(check.expected, 16);
    EXPECT_NEAR(strip.support_N_m, strip.weight_N_m, 1e-3 * strip.weight_N_m);
    double expected = 0;
    for (int k = 0; k < 16; ++k) expected += strain_at(curve, strip.weight_N_m * (k + 0.5) / 16) / 16;
    EXPECT_NEAR(strip.elongation, expected, 0.1 * expected);
    ASSERT_EQ(strip.strain.size(), 15U);
    for (std::size_t k = c.first; k < 13; ++k)
      EXPECT_NEAR(strip.strain[k], strain_at(curve, strip.force_N_m[k]), 0.05 * strip.strain[k]) << k;
  }
}

// The two control points nearest to a place on a yarn.
template <class Visit>
void at_place(const Fabric& fabric, int yarn, double place, const Visit& visit) {
  const auto last = static_cast<int>(fabric.yarns[static_cast<std::size_t>(yarn)].control_points.size()) - 1;
  for (int k = 1; k <= 2; ++k)
    visit(static_cast<std::size_t>(std::clamp(static_cast<int>(place) + k, 0, last)));
}

// A piece as it hangs on the needles: the heads of its last course are held, a comb pulls at the feet of its
// first one (an open first course would slip out of the second), and once it is knitted no plate keeps it
// flat.
TEST(Drape, APieceHangsFromItsLastLoops) {
  for (const char* courses : {"ge", "g\ne"}) {
    SCOPED_TRACE(courses);
    RelaxOptions options = frictionless();
    options.model.material.reference_bend_N_m2 = 1e-8;
    options.model.material.friction = 0.25;
    options.model.free = {false, false, false};
    Fabric first = knitted(courses, "free", "6 wales x 6 courses", 15);
    first.diameter_mm = 0.4;
    std::vector<std::vector<std::uint8_t>> combed;
    for (FabricYarn& yarn : first.yarns) {
      yarn.linear_density_tex = 80;
      yarn.held.assign(yarn.control_points.size(), 0);
      combed.emplace_back(yarn.control_points.size(), std::uint8_t{0});
    }
    int held = 0;
    for (const LoopSpan& loop : first.loops) {
      const auto yarn = static_cast<std::size_t>(loop.yarn);
      if (loop.course == 5)
        at_place(first, loop.yarn, loop.apex, [&](std::size_t k) { first.yarns[yarn].held[k] = 1, ++held; });
      if (loop.course == 0)
        for (const double foot : {loop.begin, loop.end})
          at_place(first, loop.yarn, foot, [&](std::size_t k) { combed[yarn][k] = 1; });
    }
    ASSERT_EQ(held, 12);
    // The yarn's end is tied to the needles too, or it slips out of the last loop.
    for (std::size_t k = 1; k <= 3; ++k)
      first.yarns.back().held.rbegin()[static_cast<std::ptrdiff_t>(k) - 1] = 1;
    std::vector<Vec3> pull;
    for (const std::vector<std::uint8_t>& points : combed)
      for (const std::uint8_t point : points) pull.push_back(point ? Vec3{0, -1, 0} : Vec3{});

    options.model.point_loads = pull;
    RelaxResult piece = relax(first, options);
    ASSERT_TRUE(piece.converged) << piece.message;
    options.grow_in = false;
    options.plate_room = -1;
    options.history = piece.history;
    options.model.point_loads = weight_loads(piece.fabric, options.model.material, {0, -9.81, 0});
    for (std::size_t i = 0; i < pull.size(); ++i) options.model.point_loads[i] += pull[i];
    piece = relax(piece.fabric, options);
    ASSERT_TRUE(piece.converged) << piece.message;
    EXPECT_EQ(piece.pass_throughs, 0);
    const InterlacingCheck check = check_interlacings(piece.fabric);
    EXPECT_EQ(check.expected, 30);
    // Where the yarn turns from the first course to the second, its last loop there and the next one along it
    // share a foot, at which the comb pulls: half a turn of that foot, through no yarn, undoes their
    // crossing.
    for (const int b : check.broken) {
      const PlacedInterlacing& pair = piece.fabric.interlacings[static_cast<std::size_t>(b)];
      EXPECT_EQ(pair.child.position(), pair.parent.position() + 1);
      EXPECT_EQ(pair.parent.position(), 5u);
    }
    const Vec3 borne = support_force(piece.fabric, options.model, piece.history),
               load = total_load(piece.fabric, options.model);
    EXPECT_LT(load.y, 0);
    EXPECT_NEAR(borne.y, -load.y, 1e-3 * -load.y);
    EXPECT_NEAR(borne.x, 0, 1e-3 * -load.y);
    EXPECT_NEAR(borne.z, 0, 1e-3 * -load.y);
  }
}

TEST(Drape, WhatCannotBeIsRefused) {
  Cell cell = cell_of("g\ne", 0);
  EXPECT_THROW(hang(cell.rest, cell.options, 3, 9.81), std::invalid_argument);
  EXPECT_THROW(hang(cell.rest, cell.options, 4, 9.81, 0), std::invalid_argument);
  cell.options.model.material.reference_bend_N_m2 = 0;
  EXPECT_THROW(hang(cell.rest, cell.options, 4, 9.81), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
