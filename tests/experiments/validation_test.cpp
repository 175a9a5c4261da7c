// Cloth against reference relaxations made with another model (l/d = 17, no friction; stresses are given as
// stress times l^3 / B, with a noise of 5 % of their own), and a bar in motion. What is computed is printed,
// for docs/validation.md; the whole curves are in studies/validation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "dynamics/yarn_motion.hpp"
#include "experiments/stretch.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

using std::numbers::pi;

constexpr double bend = 1e-8;  // N m^2

RelaxOptions yarn(double friction) { return loopwright::with_friction(friction, bend); }

std::vector<StretchPoint> stretched(const std::string& courses, StretchDirection direction,
                                    std::vector<double> to, double step, double friction = 0) {
  const RelaxOptions options = yarn(friction);
  const RelaxResult rest = relax(knitted(courses, "periodic", "", 17, 24), options);
  EXPECT_TRUE(rest.converged) << rest.message;
  StretchTest test;
  test.direction = direction;
  test.turning_points = std::move(to);
  test.largest_step = step;
  const StretchResult result = stretch(rest, options, test);
  for (const StretchPoint& p : result.points) {
    EXPECT_TRUE(p.converged);
    EXPECT_EQ(p.pass_throughs, 0);
    EXPECT_EQ(p.interlacings_intact, p.interlacings);
  }
  return result.points;
}

double scaled(double force) { return force * std::pow(17e-3, 3) / bend; }

// Strain at which the scaled stress is reached; the last strain if it is not.
double strain_at(const std::vector<StretchPoint>& points, StretchDirection direction, double stress) {
  const bool course = direction == StretchDirection::course;
  const auto force = [&](std::size_t k) {
    return scaled(course ? points[k].course_force : points[k].wale_force);
  };
  const auto strain = [&](std::size_t k) { return course ? points[k].course_strain : points[k].wale_strain; };
  for (std::size_t k = 1; k < points.size(); ++k)
    if (force(k) >= stress)
      return strain(k - 1) +
             (strain(k) - strain(k - 1)) * (stress - force(k - 1)) / (force(k) - force(k - 1));
  return strain(points.size() - 1);
}

TEST(ValidationCloth, PlainAlongItsCourses) {
  const auto points = stretched("g", StretchDirection::course, {0.4}, 0.05);
  for (const auto& [at, stress, across] : {std::array{4.0, 285.3, -0.085}, std::array{8.0, 618.2, -0.173}}) {
    const StretchPoint& p = points[static_cast<std::size_t>(at)];
    std::printf("plain at %.2f: stress l^3/B %.1f (%.1f), across %.4f (%.3f)\n", p.course_strain,
                scaled(p.course_force), stress, p.wale_strain, across);
    EXPECT_NEAR(scaled(p.course_force), stress, 0.05 * stress);
    EXPECT_NEAR(p.wale_strain, across, 0.005);
  }
}

TEST(ValidationCloth, ExtensibilityOfPlainRibAndGarter) {
  using enum StretchDirection;
  const auto give = [](const char* courses, StretchDirection direction, double to, double step) {
    const double strain = strain_at(stretched(courses, direction, {to}, step), direction, 600);
    std::printf("%-4s along the %s: strain %.3f at 600 B/l^3\n",
                courses[0] == 'g' && courses[1] == 0 ? "plain"
                : courses[1] == 'e'                  ? "rib"
                                                     : "garter",
                direction == course ? "courses" : "wales", strain);
    return strain;
  };
  const double plain_x = give("g", course, 0.45, 0.05), rib_x = give("ge", course, 1.45, 0.05),
               garter_x = give("g\ne", course, 0.35, 0.05), plain_y = give("g", wale, 0.16, 0.02),
               rib_y = give("ge", wale, 0.3, 0.02), garter_y = give("g\ne", wale, 0.7, 0.05);
  EXPECT_NEAR(plain_x, 0.389, 0.02);
  EXPECT_NEAR(rib_x, 1.342, 0.04);
  EXPECT_NEAR(garter_x, 0.296, 0.02);
  EXPECT_NEAR(plain_y, 0.133, 0.01);
  // How long a rib is at rest is hardly given either; two ways to bring it there differ by 0.015 here.
  EXPECT_NEAR(rib_y, 0.259, 0.025);
  // The height at which a garter rests is hardly given (see test_periodic_cells.cpp), and strain counts from
  // it.
  EXPECT_GT(garter_y, 2 * rib_y);
  EXPECT_GT(rib_x, 3 * plain_x);
  EXPECT_GT(plain_x, garter_x);
  EXPECT_GT(rib_y, plain_y);
}

// Without friction stress is B / l^3 times a function of strain and l/d alone.
TEST(ValidationCloth, StressGoesWithBOverLoopLengthCubed) {
  Fabric cell = knitted("g", "periodic", "");
  const auto stress = [&](double diameter_mm, double B) {
    RelaxOptions options = yarn(0);
    options.model.material.reference_bend_N_m2 = B;
    cell.diameter_mm = diameter_mm;
    StretchTest test;
    test.turning_points = {0.1};
    test.largest_step = 0.05;
    return stretch(relax(cell, options), options, test).points.back().course_force *
           std::pow(17e-3 * diameter_mm, 3) / B;
  };
  const double first = stress(1, 1e-8);
  EXPECT_NEAR(stress(0.2, 1e-8), first, 1e-9 * first);
  EXPECT_NEAR(stress(3, 7e-8), first, 1e-9 * first);
}

// Work given back over work done in the second cycle: all of it without friction. Friction of so hard a
// yarn needs small steps: 0.30, 0.43, 0.45 and 0.46 come back at steps of 0.02, 0.01, 0.005 and 0.0025.
TEST(ValidationCloth, HysteresisComesFromFriction) {
  for (const double friction : {0.0, 0.25}) {
    const auto points = stretched("g", StretchDirection::course, {0.2, 0, 0.2, 0}, 0.005, friction);
    double done = 0, back = 0;
    for (std::size_t k = 81; k < points.size(); ++k) {
      const double work = 0.5 * (points[k].course_force + points[k - 1].course_force) *
                          (points[k].course_strain - points[k - 1].course_strain);
      (k <= 120 ? done : back) += k <= 120 ? work : -work;
    }
    std::printf("hysteresis, friction %.2f: %.3f of the work comes back\n", friction, back / done);
    if (friction == 0) {
      EXPECT_NEAR(back / done, 1, 0.02);
    } else {
      EXPECT_GT(back / done, 0.3);
      EXPECT_LT(back / done, 0.7);
    }
  }
}

// The first bending frequency of a bar free at both ends, 22.37 / (2 pi L^2) sqrt(B / rho): started in its
// mode, the middle swings through its line after a quarter of the period.
TEST(ValidationMotion, BendingFrequencyOfAFreeBar) {
  constexpr int segments = 50;
  constexpr double B = 1, length = segments, beta = 4.730040744862704;
  const auto mode = [&](double x) {
    const double u = beta * x / length,
                 s = (std::cosh(beta) - std::cos(beta)) / (std::sinh(beta) - std::sin(beta));
    return std::cosh(u) + std::cos(u) - s * (std::sinh(u) + std::sin(u));
  };
  SplineModel model;
  MotionState state;
  for (int i = 0; i < segments + 3; ++i) state.place.push_back({i - 1.0, 0, 0});
  state.velocity.assign(state.place.size(), Vec3{});
  SplineYarn bar;
  bar.blending = uniform_b_spline();
  bar.points = segments + 3;
  bar.stretch_stiffness = 20;
  bar.bend_stiffness = B;
  model.law = StretchLaw::mean;
  set_rest_shape(bar, state.place, 0, model.law);
  set_mass_per_length(bar, 1, state.place);
  model.yarns = {bar};
  model.points = bar.points;
  model.held.assign(state.place.size(), 0);
  for (Vec3& p : state.place) p.y = 0.01 * mode(p.x);
  MotionOptions options;
  options.stepper = MotionStepper::explicit_euler;
  YarnMotion motion(model, state, {}, options);
  // Deflection of the middle against the ends. The start is not quite the mode: two zeros, half a period
  // apart.
  const auto sag = [&] {
    const auto& p = motion.state().place;
    return p[26].y - 0.5 * (p[1].y + p[51].y);
  };
  constexpr double dt = 0.05;
  std::vector<double> zeros;
  double before = sag();
  while (zeros.size() < 3 && motion.state().time < 3000) {
    motion.step(dt);
    const double now = sag();
    if (before * now <= 0) zeros.push_back(motion.state().time - dt * now / (now - before));
    before = now;
  }
  ASSERT_EQ(zeros.size(), 3U);
  const double frequency = 1 / (zeros[2] - zeros[0]), exact = beta * beta / (2 * pi * length * length);
  std::printf("free bar: frequency %.6f (%.6f, %+.2f %%)\n", frequency, exact, 100 * (frequency / exact - 1));
  EXPECT_NEAR(frequency, exact, 0.01 * exact);
}

}  // namespace
}  // namespace loopwright
