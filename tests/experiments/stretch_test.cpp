// Stretch tests: what must hold of any of them, and what is known of knitted cloth.
#include "experiments/stretch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

struct Cell {
  RelaxResult relaxed;
  RelaxOptions options;
};

Cell plain_cell(double friction) {
  Cell cell;
  cell.options = frictionless();
  cell.options.model.material.friction = friction;
  cell.options.model.material.reference_bend_N_m2 = 1e-8;
  cell.relaxed = relax(knitted("g", "periodic", ""), cell.options);
  return cell;
}

StretchTest pulled(StretchDirection direction, std::vector<double> to) {
  StretchTest test;
  test.direction = direction;
  test.turning_points = std::move(to);
  return test;
}

double force_of(const StretchPoint& point, StretchDirection direction) {
  return direction == StretchDirection::course ? point.course_force
         : direction == StretchDirection::wale ? point.wale_force
                                               : point.shear_force;
}
double strain_of(const StretchPoint& point, StretchDirection direction) {
  return direction == StretchDirection::course ? point.course_strain
         : direction == StretchDirection::wale ? point.wale_strain
                                               : point.shear;
}

TEST(Stretch, WorkIsEnergyWithoutFriction) {
  const Cell cell = plain_cell(0);
  ASSERT_TRUE(cell.relaxed.converged);
  for (const StretchDirection direction :
       {StretchDirection::course, StretchDirection::wale, StretchDirection::shear}) {
    const StretchResult result = stretch(cell.relaxed, cell.options, pulled(direction, {0.2}));
    ASSERT_EQ(result.points.size(), 11U);
    double work = 0;  // per area: force per length times strain
    for (std::size_t k = 1; k < result.points.size(); ++k) {
      const StretchPoint &a = result.points[k - 1], &b = result.points[k];
      EXPECT_TRUE(b.converged);
      EXPECT_EQ(b.pass_throughs, 0);
      EXPECT_EQ(b.interlacings_intact, b.interlacings);
      EXPECT_NEAR(strain_of(b, direction), 0.02 * static_cast<double>(k), 1e-9);
      work += 0.5 * (force_of(a, direction) + force_of(b, direction)) *
              (strain_of(b, direction) - strain_of(a, direction));
    }
    EXPECT_GT(work, 0);
    EXPECT_NEAR(result.points.back().energy, work, 0.02 * work);
    // nothing is felt across, where the size is free
    if (direction != StretchDirection::shear) {
      EXPECT_LT(std::abs(direction == StretchDirection::course ? result.points.back().wale_force
                                                               : result.points.back().course_force),
                1e-3 * force_of(result.points.back(), direction));
    }
  }
}

// Plain cloth gives more along the courses than along the wales, gets narrower when pulled, and pulls across
// where it is not let.
TEST(Stretch, PlainClothIsSofterAlongItsCourses) {
  const Cell cell = plain_cell(0.25);
  const StretchPoint course =
      stretch(cell.relaxed, cell.options, pulled(StretchDirection::course, {0.2})).points.back();
  const StretchPoint wale =
      stretch(cell.relaxed, cell.options, pulled(StretchDirection::wale, {0.2})).points.back();
  EXPECT_GT(wale.wale_force, 1.5 * course.course_force);
  EXPECT_LT(course.wale_strain, -0.02);
  EXPECT_LT(wale.course_strain, -0.02);
  StretchTest held = pulled(StretchDirection::course, {0.2});
  held.free_across = false;
  const StretchPoint both = stretch(cell.relaxed, cell.options, held).points.back();
  EXPECT_EQ(both.wale_strain, 0);
  EXPECT_GT(both.wale_force, 0.05 * both.course_force);
  EXPECT_GT(both.course_force, course.course_force);
}

// A load gives the strain at which a strained test reads that force, and is borne exactly.
TEST(Stretch, LoadAndStrainControlMeet) {
  const Cell cell = plain_cell(0);
  for (const StretchDirection direction :
       {StretchDirection::course, StretchDirection::wale, StretchDirection::both, StretchDirection::shear}) {
    const StretchPoint strained =
        stretch(cell.relaxed, cell.options, pulled(direction, {0.08})).points.back();
    StretchTest test = pulled(direction, {force_of(strained, direction)});
    if (direction == StretchDirection::both) test.turning_points = {strained.course_force};
    test.control = StretchControl::load;
    test.largest_step = test.turning_points[0] / 3.5;
    const StretchResult result = stretch(cell.relaxed, cell.options, test);
    ASSERT_EQ(result.points.size(), 5U);
    const StretchPoint& end = result.points.back();
    EXPECT_TRUE(end.converged);
    EXPECT_EQ(end.pass_throughs, 0);
    if (direction == StretchDirection::both) {
      EXPECT_NEAR(end.course_force, test.turning_points[0], 1e-3 * test.turning_points[0]);
      EXPECT_NEAR(end.wale_force, test.turning_points[0], 1e-3 * test.turning_points[0]);
    } else {
      EXPECT_NEAR(force_of(end, direction), test.turning_points[0], 1e-3 * test.turning_points[0]);
      EXPECT_NEAR(strain_of(end, direction), 0.08, 2e-3);
    }
  }
}

// A cloth under a load that stays does not creep: sought again and again, rest is where it was.
TEST(Stretch, ALoadedClothDoesNotCreep) {
  const Cell cell = plain_cell(0.25);
  StretchTest test = pulled(StretchDirection::course, {2, 2, 2, 2, 2});
  test.control = StretchControl::load;
  test.largest_step = 0.5;
  const StretchResult result = stretch(cell.relaxed, cell.options, test);
  ASSERT_EQ(result.points.size(), 9U);
  EXPECT_GT(result.points[4].course_strain, 0.002);
  for (std::size_t k = 5; k < 9; ++k)
    EXPECT_NEAR(result.points[k].course_strain, result.points[4].course_strain,
                0.01 * result.points[4].course_strain);
}

TEST(Stretch, FrictionMakesALoopAndDoesNotCreep) {
  for (const double friction : {0.0, 0.25}) {
    const Cell cell = plain_cell(friction);
    // at 0.1 on the way up, on the way down, and twice in one place at the end
    const StretchResult result =
        stretch(cell.relaxed, cell.options, pulled(StretchDirection::course, {0.1, 0.2, 0.1, 0.1, 0.1}));
    ASSERT_EQ(result.points.size(), 18U);
    const double up = result.points[5].course_force, down = result.points[15].course_force;
    if (friction == 0) {
      EXPECT_NEAR(down, up, 0.01 * up);
    } else {
      EXPECT_LT(down, 0.9 * up);
    }
    EXPECT_NEAR(result.points[16].course_force, down, 0.01 * up);
    EXPECT_NEAR(result.points[17].course_force, down, 0.01 * up);
  }
}

TEST(Stretch, ForcesScaleWithTheYarnsBendStiffness) {
  Cell cell = plain_cell(0);
  const auto force = [&] {
    return stretch(cell.relaxed, cell.options, pulled(StretchDirection::course, {0.04}))
        .points.back()
        .course_force;
  };
  const double once = force();
  cell.options.model.material.reference_bend_N_m2 *= 3;
  EXPECT_NEAR(force(), 3 * once, 1e-9 * once);
}

TEST(Stretch, WhatCannotBeIsRefused) {
  Cell cell = plain_cell(0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& to : {std::vector<double>{}, {-0.95}, {5.5}, {nan}})
    EXPECT_THROW(stretch(cell.relaxed, cell.options, pulled(StretchDirection::wale, to)),
                 std::invalid_argument);
  StretchTest still = pulled(StretchDirection::course, {0.1});
  StretchTest endless = pulled(StretchDirection::course, {1});
  endless.largest_step = 1e-6;
  EXPECT_THROW(stretch(cell.relaxed, cell.options, endless), std::invalid_argument);
  StretchTest heavy = pulled(StretchDirection::course, {nan});
  heavy.control = StretchControl::load;
  EXPECT_THROW(stretch(cell.relaxed, cell.options, heavy), std::invalid_argument);
  still.largest_step = 0;
  EXPECT_THROW(stretch(cell.relaxed, cell.options, still), std::invalid_argument);
  cell.options.model.material.reference_bend_N_m2 = 0;
  EXPECT_THROW(stretch(cell.relaxed, cell.options, pulled(StretchDirection::course, {0.1})),
               std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
