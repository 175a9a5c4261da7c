#include "geometry/centreline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace loopwright {
namespace {

const std::vector<Vec3> some_points{{0, 0, 0}, {1, 0.4, 0.2}, {1.5, 2, -0.3}, {3.2, 2.1, 1}, {4, 0, 0.5}};

TEST(centreline, goes_through_its_points_with_continuous_second_derivatives) {
  for (const Parametrisation parametrisation :
       {Parametrisation::chord_length, Parametrisation::centripetal, Parametrisation::uniform}) {
    const Centreline line = Centreline::open(some_points, parametrisation);
    ASSERT_EQ(line.pieces(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LT(distance(line.position(k, 0), some_points[k]), 1e-13);
      EXPECT_LT(distance(line.position(k, 1), some_points[k + 1]), 1e-13);
    }
    for (std::size_t k = 0; k + 1 < 4; ++k) {
      EXPECT_LT(distance(line.derivative(k, 1), line.derivative(k + 1, 0)), 1e-12);
      EXPECT_LT(distance(line.second_derivative(k, 1), line.second_derivative(k + 1, 0)), 1e-12);
    }
    EXPECT_LT(norm(line.second_derivative(0, 0)) + norm(line.second_derivative(3, 1)), 1e-12);
  }
}

TEST(centreline, natural_spline_through_three_points_in_closed_form) {
  // Uniform knots 0, 1, 2, values 0, 1, 0: the middle second derivative m solves 4 m = 6 (0 - 2 + 0), m = -3.
  const Centreline line = Centreline::open({{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, Parametrisation::uniform);
  EXPECT_NEAR(line.second_derivative(0, 1).y, -3, 1e-13);
  EXPECT_NEAR(line.position(0, 0.5).y, 0.5 + 3 * 0.375 / 6, 1e-13);
}

TEST(centreline, derivatives_are_those_of_the_position) {
  const Centreline line = Centreline::open(some_points);
  const double step = 1e-5;
  for (std::size_t k = 0; k < line.pieces(); ++k) {
    const double h = line.knots()[k + 1] - line.knots()[k];
    const Vec3 slope = (line.position(k, 0.4 + step) - line.position(k, 0.4 - step)) / (2 * step * h);
    EXPECT_LT(distance(slope, line.derivative(k, 0.4)), 1e-8);
    const Vec3 bend = (line.derivative(k, 0.4 + step) - line.derivative(k, 0.4 - step)) / (2 * step * h);
    EXPECT_LT(distance(bend, line.second_derivative(k, 0.4)), 1e-8);
  }
}

TEST(centreline, a_periodic_curve_does_not_know_where_it_starts) {
  const Vec3 shift{6, 0, 0.7};
  const Centreline line = Centreline::periodic(some_points, shift);
  std::vector<Vec3> turned(some_points.begin() + 2, some_points.end());
  turned.push_back(some_points[0] + shift);
  turned.push_back(some_points[1] + shift);
  const Centreline other = Centreline::periodic(turned, shift);
  for (const double u : {0.1, 0.5, 0.9}) {
    EXPECT_LT(distance(line.position(3, u), other.position(1, u)), 1e-12);
    EXPECT_LT(distance(line.position(0, u) + shift, other.position(3, u)), 1e-12);
  }
  EXPECT_NEAR(line.arc_length(), other.arc_length(), 1e-12);
}

TEST(centreline, circle_from_sixteen_points) {
  std::vector<Vec3> points;
  for (int k = 0; k < 16; ++k) points.push_back({std::cos(k * M_PI / 8), std::sin(k * M_PI / 8), 0});
  const Centreline line = Centreline::periodic(points, {0, 0, 0});
  EXPECT_NEAR(line.arc_length(), 2 * M_PI, 3e-4);  // fourth order in the step: (pi/8)^4 / 720 of it
  EXPECT_NEAR(norm(line.position(5, 0.5)), 1, 1e-4);
}

TEST(centreline, refuses_points_that_coincide) {
  EXPECT_THROW(Centreline::open({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(Centreline::open({{0, 0, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
