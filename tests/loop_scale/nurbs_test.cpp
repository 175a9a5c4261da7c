// NURBS against SciPy's splines (data/make_nurbs_reference.py), against geometry's Centreline, and against
// closed forms.
#include "loop_scale/nurbs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>

#include "geometry/fabric.hpp"
#include "geometry/paper_loop.hpp"

namespace loopwright {
namespace {

struct ReferenceCase {
  std::string name, ends;
  InterpolationOptions options;
  std::vector<Vec3> points;
  Vec3 shift;
  double length = 0;
  std::vector<double> u;
  std::vector<std::array<Vec3, 3>> samples;

  NurbsCurve curve() const {
    return ends == "periodic" ? interpolate_periodic(points, shift, options) : interpolate(points, options);
  }
};

std::vector<ReferenceCase> reference_cases() {
  std::ifstream in(LOOPWRIGHT_SOURCE_DIR "/tests/loop_scale/data/nurbs_reference.txt");
  std::vector<ReferenceCase> cases;
  std::string word, rule;
  const auto vector = [&in] {
    Vec3 v;
    in >> v.x >> v.y >> v.z;
    return v;
  };
  while (in >> word) {
    std::size_t count = 0;
    if (word == "case") {
      ReferenceCase& c = cases.emplace_back();
      in >> c.name >> c.options.degree >> rule >> c.ends;
      c.options.parametrisation = rule == "chord"         ? Parametrisation::chord_length
                                  : rule == "centripetal" ? Parametrisation::centripetal
                                                          : Parametrisation::uniform;
      if (c.ends == "natural") c.options.ends = NurbsEnds::natural;
      continue;
    }
    ReferenceCase& c = cases.back();
    if (word == "length") {
      in >> c.length;
    } else if (word == "shift") {
      c.shift = vector();
    } else if (in >> count; word == "points") {
      for (std::size_t k = 0; k < count; ++k) c.points.push_back(vector());
    } else if (word == "weights") {
      c.options.weights.resize(count);
      for (double& w : c.options.weights) in >> w;
    } else if (word == "samples") {
      for (std::size_t k = 0; k < count; ++k) {
        in >> c.u.emplace_back();
        auto& sample = c.samples.emplace_back();
        for (Vec3& v : sample) v = vector();
      }
    }
  }
  return cases;
}

TEST(nurbs, agrees_with_scipy) {
  const std::vector<ReferenceCase> cases = reference_cases();
  ASSERT_EQ(cases.size(), 13U);
  for (const ReferenceCase& c : cases) {
    SCOPED_TRACE(c.name);
    const NurbsCurve curve = c.curve();
    require_sound(curve);
    ASSERT_EQ(c.u.size(), 13U);
    for (std::size_t k = 0; k < c.u.size(); ++k) {
      const std::vector<Vec3> d = derivatives(curve, c.u[k], 2);
      EXPECT_LT(distance(d[0], c.samples[k][0]), 1e-11);
      EXPECT_LT(distance(d[1], c.samples[k][1]), 1e-10);
      EXPECT_LT(distance(d[2], c.samples[k][2]), 1e-8);
      EXPECT_LT(distance(position(curve, c.u[k]), d[0]), 1e-12);
    }
    EXPECT_NEAR(arc_length(curve), c.length, 1e-9 * c.length);
  }
}

TEST(nurbs, goes_through_its_points) {
  for (const ReferenceCase& c : reference_cases()) {
    const std::vector<double> u = parameters_of(c.points, c.options.parametrisation);
    const NurbsCurve curve = c.curve();
    for (std::size_t k = 0; k < c.points.size(); ++k)
      EXPECT_LT(distance(position(curve, u[k]), c.points[k]), 1e-11) << c.name << " point " << k;
  }
}

TEST(nurbs, natural_and_periodic_curves_are_those_of_the_geometry_stage) {
  for (const ReferenceCase& c : reference_cases()) {
    if (c.ends == "averaged") continue;
    const Centreline line = c.ends == "natural"
                                ? Centreline::open(c.points, c.options.parametrisation)
                                : Centreline::periodic(c.points, c.shift, c.options.parametrisation);
    const NurbsCurve curve = c.curve();
    for (std::size_t k = 0; k < line.pieces(); ++k)
      for (const double s : {0.0, 0.3, 0.9}) {
        const double u = line.knots()[k] + s * (line.knots()[k + 1] - line.knots()[k]);
        EXPECT_LT(distance(position(curve, u), line.position(k, s)), 1e-11) << c.name;
      }
  }
}

TEST(nurbs, periodic_curve_with_weights_repeats_and_interpolates) {
  const ReferenceCase c = reference_cases()[2];
  InterpolationOptions options = c.options;
  options.weights = {1, 2, 1, 0.5, 3, 1, 0.8, 1};
  const NurbsCurve curve = interpolate_periodic(c.points, c.shift, options);
  const std::vector<double> u = parameters_of(c.points, options.parametrisation, &c.shift);
  for (std::size_t k = 0; k < c.points.size(); ++k)
    EXPECT_LT(distance(position(curve, u[k]), c.points[k]), 1e-11);
  EXPECT_LT(distance(position(curve, u.back()), c.points[0] + c.shift), 1e-11);
  for (int order = 1; order <= 2; ++order) {
    const auto k = static_cast<std::size_t>(order);
    EXPECT_LT(
        distance(derivatives(curve, curve.begin(), order)[k], derivatives(curve, curve.end(), order)[k]),
        1e-9);
  }
  // the weights matter: another curve between the points
  EXPECT_GT(distance(position(curve, u[1] / 2), position(c.curve(), u[1] / 2)), 1e-3);
}

// A quarter circle is the textbook rational quadratic.
NurbsCurve full_circle() {
  const double h = std::sqrt(0.5);
  NurbsCurve circle;
  circle.degree = 2;
  circle.knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  circle.control_points = {{1, 0, 0},   {1, 1, 0},  {0, 1, 0},  {-1, 1, 0}, {-1, 0, 0},
                           {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {1, 0, 0}};
  circle.weights = {1, h, 1, h, 1, h, 1, h, 1};
  return circle;
}

TEST(nurbs, circle) {
  const NurbsCurve circle = full_circle();
  for (int k = 0; k <= 40; ++k) {
    const std::vector<Vec3> d = derivatives(circle, 0.1 * k, 2);
    EXPECT_NEAR(norm(d[0]), 1, 1e-14);
    EXPECT_NEAR(norm(cross(d[1], d[2])) / std::pow(norm(d[1]), 3), 1, 1e-12);  // curvature
  }
  EXPECT_NEAR(arc_length(circle), 2 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(arc_length(circle, 0.5, 2.5), std::numbers::pi, 1e-12);
}

// Bernstein form, written out here.
Vec3 bezier_point(const BezierPiece& piece, double t) {
  std::vector<Vec3> p;
  std::vector<double> w = piece.weights;
  for (std::size_t i = 0; i < piece.points.size(); ++i) p.push_back(piece.points[i] * w[i]);
  for (std::size_t level = p.size() - 1; level > 0; --level)
    for (std::size_t i = 0; i < level; ++i) {
      p[i] = p[i] * (1 - t) + p[i + 1] * t;
      w[i] = w[i] * (1 - t) + w[i + 1] * t;
    }
  return p[0] / w[0];
}

TEST(nurbs, bezier_pieces_are_the_curve) {
  std::vector<NurbsCurve> curves{full_circle()};
  for (const ReferenceCase& c : reference_cases()) curves.push_back(c.curve());
  for (const NurbsCurve& curve : curves) {
    const std::vector<BezierPiece> pieces = bezier_pieces(curve);
    EXPECT_DOUBLE_EQ(pieces.front().from, curve.begin());
    EXPECT_DOUBLE_EQ(pieces.back().to, curve.end());
    for (const BezierPiece& piece : pieces)
      for (const double t : {0.0, 0.25, 0.7, 1.0})
        EXPECT_LT(distance(bezier_point(piece, t), position(curve, piece.from + t * (piece.to - piece.from))),
                  1e-11);
  }
}

TEST(nurbs, uniform_pieces_are_the_curve) {
  int converted = 0;
  for (const ReferenceCase& c : reference_cases()) {
    if (c.options.parametrisation != Parametrisation::uniform || c.ends == "averaged") {
      if (c.name != "three_points_natural") {
        EXPECT_THROW(uniform_control_points(c.curve()), std::invalid_argument) << c.name;
      }
      continue;
    }
    ++converted;
    const NurbsCurve curve = c.curve();
    Fabric fabric;
    FabricYarn yarn;
    yarn.control_points = uniform_control_points(curve);
    ASSERT_EQ(yarn.segments(), static_cast<int>(curve.end() - curve.begin()));
    for (int k = 0; k <= 10 * yarn.segments(); ++k)
      EXPECT_LT(distance(position(fabric, yarn, 0.1 * k), position(curve, curve.begin() + 0.1 * k)), 1e-11);
  }
  EXPECT_EQ(converted, 2);
}

TEST(nurbs, the_paper_s_course) {
  // physics of the course: arc length per loop and greatest curvature, derived in paper_loop_test for the C2
  // cubic
  const Vec3 lower = paper_lower(0, 0, 1);
  const std::array<Vec3, 9> t =
      paper_loop(lower, paper_upper(lower, 1), paper_lower(0, -1, 1), paper_lower(0, 1, 1), 1);
  const NurbsCurve curve = interpolate_periodic({t.begin(), t.end() - 1}, {8, 0, 0});
  EXPECT_NEAR(arc_length(curve), 35.53, 0.005);
  double most = 0;
  for (int k = 0; k < 2000; ++k) {
    const double u = curve.begin() + (curve.end() - curve.begin()) * k / 2000;
    const std::vector<Vec3> d = derivatives(curve, u, 2);
    most = std::max(most, norm(cross(d[1], d[2])) / std::pow(norm(d[1]), 3));
  }
  EXPECT_NEAR(most, 0.61, 0.01);
}

TEST(nurbs, refuses_what_it_cannot_do) {
  const std::vector<Vec3> three{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}};
  EXPECT_THROW(interpolate(three), std::invalid_argument);  // a clamped cubic needs four
  EXPECT_THROW(interpolate({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(interpolate({{0, 0, 0}, {1, 0, 0}, {2, NAN, 0}, {3, 0, 0}}), std::invalid_argument);
  InterpolationOptions weighted;
  weighted.weights = {1, 1};
  EXPECT_THROW(interpolate_periodic(three, {3, 0, 0}, weighted), std::invalid_argument);
  NurbsCurve broken = full_circle();
  broken.weights[3] = 0;
  EXPECT_THROW(bezier_pieces(broken), std::invalid_argument);
  EXPECT_THROW(uniform_control_points(full_circle()), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
