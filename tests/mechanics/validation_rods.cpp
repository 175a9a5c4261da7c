// Single yarns against the theory of thin rods, at control points every fiftieth of their length. What is
// computed is printed, for docs/validation.md.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

using std::numbers::pi;

// Adds force f at the yarn's parameter t (a knot or inside a segment) to the loads of its control points.
void add_force(std::vector<Vec3>& loads, const FabricYarn& yarn, double t, const Vec3& f) {
  const int e = std::min(static_cast<int>(t), yarn.segments() - 1);
  const auto weights = spline_weights(t - e).value;
  for (std::size_t k = 0; k < 4; ++k) loads[static_cast<std::size_t>(e) + k] += weights[k] * f;
}

// A force per rest length: the integral of the spline weights over each segment.
void add_weight(std::vector<Vec3>& loads, const FabricYarn& yarn, const Vec3& per_length) {
  constexpr std::array<double, 4> share{1 / 24.0, 11 / 24.0, 11 / 24.0, 1 / 24.0};
  for (int e = 0; e < yarn.segments(); ++e)
    for (std::size_t k = 0; k < 4; ++k)
      loads[static_cast<std::size_t>(e) + k] += share[k] * yarn.segment_rest_length * per_length;
}

// Points at equal arc lengths along a curve given at u in [0, 1]: count of them, the first at u = 0; closed
// curves leave out the last.
std::vector<Vec3> evenly(const std::function<Vec3(double)>& curve, int count, bool closed) {
  constexpr int fine = 20000;
  std::vector<double> arc(fine + 1, 0);
  for (std::size_t i = 1; i <= fine; ++i)
    arc[i] =
        arc[i - 1] + distance(curve(static_cast<double>(i) / fine), curve(static_cast<double>(i - 1) / fine));
  std::vector<Vec3> points;
  std::size_t at = 0;
  for (int k = 0; k < count; ++k) {
    const double wanted = arc.back() * k / (closed ? count : count - 1);
    while (at < fine && arc[at] < wanted) ++at;
    points.push_back(curve(static_cast<double>(at) / fine));
  }
  return points;
}

double off(double value, double exact) { return 100 * (value / exact - 1); }

// The cantilever of length L with a dead force P across its end: B theta'' = -P cos(theta) with theta = 0 at
// the clamp, theta' = 0 at the tip. Integrated from the tip, whose angle is found by bisection. B = 1.
struct Tip {
  double deflection = 0, reach = 0;
};

Tip cantilever(double length, double force) {
  constexpr int steps = 2000;
  const double h = length / steps;
  const auto from_tip = [&](double angle, Tip& tip) {
    using State = std::array<double, 4>;  // theta, theta', across, along; arc length counted from the tip
    State s{angle, 0, 0, 0};
    const auto rate = [&](const State& v) {
      return State{v[1], -force * std::cos(v[0]), std::sin(v[0]), std::cos(v[0])};
    };
    const auto plus = [](State a, double f, const State& b) {
      for (std::size_t k = 0; k < 4; ++k) a[k] += f * b[k];
      return a;
    };
    for (int i = 0; i < steps; ++i) {
      const State a = rate(s), b = rate(plus(s, h / 2, a)), c = rate(plus(s, h / 2, b)),
                  d = rate(plus(s, h, c));
      for (std::size_t k = 0; k < 4; ++k) s[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
    tip = {s[2], s[3]};
    return s[0];
  };
  double low = 0, high = pi / 2;
  Tip tip;
  for (int i = 0; i < 60; ++i) (from_tip((low + high) / 2, tip) > 0 ? high : low) = (low + high) / 2;
  return tip;
}

// Two cantilevers back to back: the middle control point is held, and by symmetry the yarn is level there.
constexpr int half_segments = 50;
constexpr double half_length = 40;

FabricYarn double_cantilever() {
  constexpr double h = half_length / half_segments;
  FabricYarn yarn = free_yarn(2 * half_segments + 3, h, [](int i) {
    return Vec3{h * (i - 1 - half_segments), 0, 0};
  });
  yarn.held[half_segments + 1] = 1;
  return yarn;
}

Tip tip_of(const Fabric& fabric) {
  const FabricYarn& yarn = fabric.yarns[0];
  const Vec3 middle = position(fabric, yarn, half_segments), end = position(fabric, yarn, 2 * half_segments);
  return {end.y - middle.y, end.x - middle.x};
}

TEST(ValidationRods, CantileverWithAnEndLoad) {
  for (const double load : {0.1, 1.0, 5.0, 10.0}) {  // P L^2 / B
    const FabricYarn yarn = double_cantilever();
    const double P = load / (half_length * half_length);
    RelaxOptions options = yarn_alone(1e-9);
    options.model.point_loads.resize(yarn.control_points.size());
    add_force(options.model.point_loads, yarn, 0, {0, P, 0});
    add_force(options.model.point_loads, yarn, 2 * half_segments, {0, P, 0});
    add_force(options.model.point_loads, yarn, half_segments, {0, -2 * P, 0});
    const RelaxResult result = relax(fabric_of({yarn}), options);
    ASSERT_TRUE(result.converged) << result.message << ", residual " << result.residual;
    const Tip tip = tip_of(result.fabric), exact = cantilever(half_length, P);
    std::printf(
        "cantilever P L^2/B %4.1f: deflection/L %.5f (elastica %.5f, %+.3f %%), reach/L %.5f (%.5f)\n", load,
        tip.deflection / half_length, exact.deflection / half_length, off(tip.deflection, exact.deflection),
        tip.reach / half_length, exact.reach / half_length);
    EXPECT_NEAR(tip.deflection, exact.deflection, 0.002 * exact.deflection);
    EXPECT_NEAR(tip.reach, exact.reach, 0.002 * exact.reach);
    if (load == 0.1) {
      EXPECT_NEAR(tip.deflection, P * std::pow(half_length, 3) / 3, 0.003 * tip.deflection);
    }
  }
}

TEST(ValidationRods, CantileverUnderItsWeight) {
  const FabricYarn yarn = double_cantilever();
  const double q = 0.1 / std::pow(half_length, 3);
  RelaxOptions options = yarn_alone(1e-9);
  options.model.point_loads.resize(yarn.control_points.size());
  add_weight(options.model.point_loads, yarn, {0, -q, 0});
  add_force(options.model.point_loads, yarn, half_segments, {0, 2 * q * half_length, 0});
  const RelaxResult result = relax(fabric_of({yarn}), options);
  ASSERT_TRUE(result.converged) << result.message << ", residual " << result.residual;
  const double deflection = -tip_of(result.fabric).deflection, exact = q * std::pow(half_length, 4) / 8;
  std::printf("cantilever under its weight: deflection/L %.6f (q L^3/8B %.6f, %+.3f %%)\n",
              deflection / half_length, exact / half_length, off(deflection, exact));
  EXPECT_NEAR(deflection, exact, 0.01 * exact);
}

// A closed yarn pressed to an oval opens to the ring: energy 2 pi^2 B / L, which is pi B / R.
TEST(ValidationRods, OvalOpensToARing) {
  constexpr int count = 50;
  constexpr double radius = 8, length = 2 * pi * radius;
  const std::vector<Vec3> oval = evenly(
      [](double u) {
        return Vec3{1.3 * radius * std::cos(2 * pi * u), 0.65 * radius * std::sin(2 * pi * u), 0};
      },
      count, true);
  FabricYarn yarn =
      free_yarn(count, length / count, [&](int i) { return oval[static_cast<std::size_t>(i)]; });
  yarn.periodic = true;
  Fabric fabric = fabric_of({yarn});
  fabric.periodic = true;
  fabric.width = fabric.height = 100;
  const RelaxResult result = relax(fabric, yarn_alone(1e-8));
  ASSERT_TRUE(result.converged) << result.message << ", residual " << result.residual;
  Vec3 middle;
  for (const Vec3& p : result.fabric.yarns[0].control_points) middle += p / count;
  double nearest = 1e9, farthest = 0;
  for (const Vec3& p : polyline(result.fabric, result.fabric.yarns[0], 4)) {
    nearest = std::min(nearest, distance(p, middle));
    farthest = std::max(farthest, distance(p, middle));
  }
  const double exact = 2 * pi * pi / length;
  std::printf("ring from an oval: energy %.6f B/d (pi B/R %.6f, %+.3f %%), radius %.5f to %.5f of %g\n",
              result.energy.bend, exact, off(result.energy.bend, exact), nearest, farthest, radius);
  EXPECT_EQ(result.energy.contact, 0) << "a ring touches itself where it closes";
  EXPECT_NEAR(result.energy.bend, exact, 0.01 * exact);
  EXPECT_NEAR(nearest, radius, 0.002 * radius);
  EXPECT_NEAR(farthest, radius, 0.002 * radius);
}

// Points of a uniform cubic B-spline on a circle lie outside it (see test_closed_forms.cpp); along the axis
// it is straight. Curvature R / (R^2 + c^2), pitch 2 pi c.
TEST(ValidationRods, HelixEnergyAndCurvature) {
  constexpr double R = 3, c = 2, curvature = R / (R * R + c * c);
  const double length = 2 * pi * std::hypot(R, c);
  double last = 1;
  for (const int count : {12, 25, 50, 100}) {
    const double outside = R * 3 / (2 + std::cos(2 * pi / count));
    FabricYarn yarn = free_yarn(count, length / count, [&](int i) {
      return Vec3{2 * pi * c * i / count, outside * std::cos(2 * pi * i / count),
                  outside * std::sin(2 * pi * i / count)};
    });
    yarn.periodic = true;
    yarn.shift = {1, 0};
    Fabric fabric = fabric_of({yarn});
    fabric.periodic = true;
    fabric.width = 2 * pi * c;
    fabric.height = 100;
    const YarnModel model = build_yarn_model(fabric, frictionless().model);
    const YarnState state = build_yarn_state(fabric);
    Assembly assembly(model);
    assembly.update_pairs(state, 1.6);
    const double energy = assembly.energy(state).bend, exact = 0.5 * curvature * curvature * length;
    const double error = std::abs(off(energy, exact));
    // curvature at a knot: (q_(i-1), q_i, q_(i+1)) give p' and p''
    const auto& q = fabric.yarns[0].control_points;
    const Vec3 slope = (q[3] - q[1]) / 2, curve = q[3] - 2 * q[2] + q[1];
    const double there = norm(cross(slope, curve)) / std::pow(norm(slope), 3);
    std::printf("helix, %3d segments a turn: energy %+.3f %%, curvature at a knot %+.3f %%\n", count,
                off(energy, exact), off(there, curvature));
    EXPECT_LT(error, 0.35 * last * (count == 12 ? 100 : 1));
    last = error;
    if (count == 50) {
      EXPECT_LT(error, 1);
      EXPECT_NEAR(there, curvature, 0.01 * curvature);
    }
  }
}

// Pressed together by a share s of its length, one wave of a yarn bears P = B (4 K / L)^2 with
// 1 - s = 2 E / K - 1 (complete elliptic integrals; Love, Mathematical Theory of Elasticity, 4th ed.,
// art. 263). As s -> 0 this is Euler's load, pi^2 B / (L/2)^2 between two points of inflection.
TEST(ValidationRods, EulerLoadAndWhatABuckledYarnBears) {
  constexpr int segments = 50;
  constexpr double length = 40, h = length / segments, euler = 4 * pi * pi / (length * length);
  for (const double shortening : {0.002, 0.1, 0.25, 0.4}) {
    const double span = length * (1 - shortening), rise = length * std::sqrt(shortening) / pi;
    FabricYarn yarn = free_yarn(segments, h, [&](int i) {
      return Vec3{span * i / segments, rise * std::cos(2 * pi * i / segments), 0};
    });
    yarn.periodic = true;
    yarn.shift = {1, 0};
    Fabric fabric = fabric_of({yarn});
    fabric.periodic = true;
    fabric.width = span;
    fabric.height = 100;
    const RelaxResult result = relax(fabric, yarn_alone(1e-8));
    ASSERT_TRUE(result.converged) << result.message << ", residual " << result.residual;
    double low = 0, high = 0.999;  // modulus
    const auto spread = [](double k) { return 2 * std::comp_ellint_2(k) / std::comp_ellint_1(k) - 1; };
    for (int i = 0; i < 80; ++i) (spread((low + high) / 2) > 1 - shortening ? low : high) = (low + high) / 2;
    const double exact = std::pow(4 * std::comp_ellint_1(low) / length, 2);
    const double load = -result.measure_forces[0];
    std::printf("buckled by %.3f of its length: load %.5f of Euler's (elastica %.5f, %+.3f %%)\n", shortening,
                load / euler, exact / euler, off(load, exact));
    EXPECT_NEAR(load, exact, 0.01 * exact);
    if (shortening == 0.002) {
      EXPECT_NEAR(load, euler, 0.01 * euler);
    }
  }
}

// Yarn so long that its bend stiffness hardly counts (B / H a^2 = 3e-4) hangs between two held ends. Between
// places a few d away from them, where a bend at the end has died out (over sqrt(B / T), about 1 d), it is
// the catenary y = a cosh(x / a).
TEST(ValidationRods, Catenary) {
  constexpr int segments = 200, from_end = 8;
  constexpr double length = 200, span = 0.8 * length, depth = 0.2654 * length;
  const std::vector<Vec3> parabola = evenly(
      [](double u) {
        return Vec3{span * (u - 0.5), 4 * depth * u * (u - 1), 0};
      },
      segments + 3, false);
  FabricYarn yarn = free_yarn(segments + 3, 1, [&](int i) { return parabola[static_cast<std::size_t>(i)]; });
  hold_ends(yarn, 3);
  RelaxOptions options = yarn_alone(1e-6);
  options.model.material.stretch_stiffness = 1e5;
  options.model.point_loads.resize(yarn.control_points.size());
  add_weight(options.model.point_loads, yarn, {0, -0.01, 0});
  const RelaxResult result = relax(fabric_of({yarn}), options);
  ASSERT_TRUE(result.converged) << result.message << ", residual " << result.residual;
  const FabricYarn& hung = result.fabric.yarns[0];
  const Vec3 left = position(result.fabric, hung, from_end),
             right = position(result.fabric, hung, segments - from_end),
             lowest = position(result.fabric, hung, segments / 2.0);
  const double hangs = arc_length(result.fabric, hung, from_end, segments - from_end),
               apart = right.x - left.x;
  // span / length = 2 v asinh(1 / 2 v) with v = a / length; sag = a (sqrt(1 + 1 / (2 v)^2) - 1)
  double low = 1e-3, high = 10;
  for (int i = 0; i < 80; ++i) {
    const double v = (low + high) / 2;
    (2 * v * std::asinh(1 / (2 * v)) < apart / hangs ? low : high) = v;
  }
  const double exact = low * (std::sqrt(1 + 1 / (4 * low * low)) - 1), sag = (left.y - lowest.y) / hangs;
  std::printf("catenary: span/length %.5f, a/L %.4f, sag/length %.5f (%.5f, %+.3f %%), %d Newton steps\n",
              apart / hangs, low, sag, exact, off(sag, exact), result.newton_iterations);
  EXPECT_NEAR(apart / hangs, 0.8, 0.03);
  EXPECT_NEAR(sag, exact, 0.005 * exact);
}

TEST(ValidationRods, LoadsThatMakeNoSenseAreRefused) {
  const FabricYarn yarn = double_cantilever();
  RelaxOptions options = yarn_alone(1e-6);
  options.model.point_loads.resize(3);
  EXPECT_THROW(relax(fabric_of({yarn}), options), std::invalid_argument);
  options.model.point_loads.assign(yarn.control_points.size(), Vec3{});
  options.model.point_loads[4].y = std::nan("");
  EXPECT_THROW(relax(fabric_of({yarn}), options), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
