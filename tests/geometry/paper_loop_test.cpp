// The first paper's loop: its table 2, and the numbers that physics.md 1.3 derives from it.
#include "geometry/paper_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "geometry/centreline.hpp"

namespace loopwright {
namespace {

std::array<Vec3, 9> plain_loop(int course, int wale, double r) {
  const Vec3 lower = paper_lower(course, wale, r);
  return paper_loop(lower, paper_upper(lower, r), paper_lower(course, wale - 1, r),
                    paper_lower(course, wale + 1, r), r);
}

Centreline plain_course(Parametrisation parametrisation) {
  const std::array<Vec3, 9> points = plain_loop(0, 0, 1);
  return Centreline::periodic({points.begin(), points.end() - 1}, {8, 0, 0}, parametrisation);
}

TEST(paper_loop, table_2) {
  // x, y and z are the lower binding point's; offsets as printed, in r
  const std::array<Vec3, 9> printed{{{-4, -3, -1.5},
                                     {-1, 0, 0},
                                     {-2, 3.5, 1.5},
                                     {-3, 7, 0},
                                     {0, 10, -1.5},
                                     {3, 7, 0},
                                     {2, 3.5, 1.5},
                                     {1, 0, 0},
                                     {4, -3, -1.5}}};
  const double r = 0.37;
  const std::array<Vec3, 9> points = plain_loop(3, 5, r);
  const Vec3 lower = paper_lower(3, 5, r);
  for (std::size_t k = 0; k < 9; ++k)
    EXPECT_LT(distance(points[k], lower + printed[k] * r), 1e-14) << "T" << k;
}

TEST(paper_loop, neighbours_share_their_sinker_point_and_courses_their_binding_point) {
  EXPECT_EQ(plain_loop(2, 1, 1)[8], plain_loop(2, 2, 1)[0]);
  EXPECT_EQ(paper_upper(paper_lower(1, 4, 1), 1), paper_lower(2, 4, 1));
}

TEST(paper_loop, arc_length_of_the_interpolated_loop) {
  EXPECT_NEAR(plain_course(Parametrisation::chord_length).arc_length(), 35.53, 0.01);
  EXPECT_NEAR(plain_course(Parametrisation::centripetal).arc_length(), 35.51, 0.01);
  EXPECT_NEAR(plain_course(Parametrisation::uniform).arc_length(), 35.51, 0.01);
}

TEST(paper_loop, smallest_distance_of_courses_and_thickness) {
  const auto samples = [](Parametrisation parametrisation) {
    const Centreline line = plain_course(parametrisation);
    std::vector<Vec3> points;
    for (std::size_t k = 0; k < line.pieces(); ++k)
      for (int i = 0; i < 60; ++i) points.push_back(line.position(k, i / 60.0));
    return points;
  };
  const auto gap = [](const std::vector<Vec3>& course) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Vec3& a : course)
      for (const Vec3& b : course)
        for (const double x : {-8.0, 0.0, 8.0}) smallest = std::min(smallest, distance(a, b + Vec3{x, 7, 0}));
    return smallest;
  };
  const std::vector<Vec3> chord = samples(Parametrisation::chord_length);
  EXPECT_NEAR(gap(chord), 1.95, 0.01);
  EXPECT_NEAR(gap(samples(Parametrisation::centripetal)), 1.94, 0.01);
  EXPECT_NEAR(gap(samples(Parametrisation::uniform)), 1.92, 0.01);
  double low = 0, high = 0;
  for (const Vec3& p : chord) {
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  EXPECT_NEAR(high - low, 3.0, 0.01);
}

}  // namespace
}  // namespace loopwright
