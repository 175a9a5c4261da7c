// Yarn that resists twist: closed forms of twisted rods, and cloth of lively yarn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "geometry/interlacing.hpp"
#include "mechanics/fabrics.hpp"
#include "mechanics/linear/cholesky.hpp"
#include "mechanics/linear/dense_cholesky.hpp"

namespace loopwright {
namespace {

constexpr double pi = 3.14159265358979323846;

// Control points of a uniform B-spline whose curve goes round a circle lie outside it.
double outside(double radius, int count) { return radius * 3 / (2 + std::cos(2 * pi / count)); }

// One turn of an endless helix about x, right-handed: cell of `width`, yarn of `length`.
Fabric helix(double width, double length, int count, double liveliness) {
  const double radius = std::sqrt(length * length - width * width) / (2 * pi);
  FabricYarn yarn = free_yarn(count, length / count, [&](int i) {
    const double at = 2 * pi * i / count, r = outside(radius, count);
    return Vec3{width * i / count, r * std::cos(at), r * std::sin(at)};
  });
  yarn.periodic = true;
  yarn.shift = {1, 0};
  yarn.liveliness = liveliness;
  Fabric fabric = fabric_of({yarn});
  fabric.periodic = true;
  fabric.width = width;
  fabric.height = 100;
  return fabric;
}

Fabric ring(double radius, int count, double liveliness) {
  FabricYarn yarn = free_yarn(count, 2 * pi * radius / count, [&](int i) {
    const double at = 2 * pi * i / count, r = outside(radius, count);
    return Vec3{r * std::cos(at), r * std::sin(at), 0};
  });
  yarn.periodic = true;
  yarn.liveliness = liveliness;
  Fabric fabric = fabric_of({yarn});
  fabric.periodic = true;
  fabric.width = fabric.height = 100;
  return fabric;
}

RelaxOptions rod(double twist_stiffness) {
  RelaxOptions options = yarn_alone(1e-8);
  options.model.material.twist_stiffness = twist_stiffness;
  options.model.material.stretch_stiffness = 1e6;
  return options;
}

struct Evaluated {
  YarnModel model;
  EnergyParts energy;
  Unknowns gradient;
  BlockMatrix hessian;
};
Evaluated evaluated(const Fabric& fabric, const RelaxOptions& options) {
  Evaluated e{build_yarn_model(fabric, options.model), {}, {}, {}};
  const YarnState state = build_yarn_state(fabric);
  Assembly assembly(e.model);
  assembly.update_pairs(state, 1.6);
  e.energy = assembly.hessian(state, e.gradient, e.hessian);
  assembly.metric(e.hessian);
  return e;
}

// A helix that climbs at an angle alpha has a twist of psi - 2 pi (1 - sin alpha) / L; the minus is its
// writhe.
TEST(Twist, OfAHelix) {
  constexpr double length = 10, C = 0.7, psi = 0.4;
  for (const double sine : {0.3, 0.6, 0.9}) {
    const Evaluated e = evaluated(helix(sine * length, length, 48, psi), rod(C));
    const double angle = psi * length - 2 * pi * (1 - sine), exact = 0.5 * C / length * angle * angle;
    EXPECT_NEAR(e.energy.twist, exact, 2e-3 * std::abs(exact) + 1e-4) << "sine " << sine;
  }
}

// Force along the axis of a spring whose number of turns stays: U(W) = L/2 (B kappa^2 + C T^2 / L^2) with
// kappa = 2 pi cos(alpha) / L, W = L sin(alpha) (Love's spring, inextensible).
TEST(Twist, SpringPullsAsLovesDoes) {
  constexpr double length = 12, C = 0.8;
  for (const double psi : {0.0, 0.3, 0.6}) {
    const double sine = 0.85;
    RelaxOptions options = rod(C);
    const RelaxResult rest = relax(helix(sine * length, length, 64, psi), options);
    ASSERT_TRUE(rest.converged) << rest.message << " " << rest.residual;
    const double angle = psi * length - 2 * pi * (1 - sine), q = 2 * pi / length;
    const double exact = -q * q * sine + C * angle / length * q;
    std::printf("spring of liveliness %.1f: %.5f (%.5f)\n", psi, rest.measure_forces[0], exact);
    EXPECT_NEAR(rest.measure_forces[0], exact, 0.01 * q * q) << psi;
  }
}

// Greenhill: a straight rod under the couple M and the pull P resists a wave y = cos qx, z = sin qx with B
// q^4 + P q^2 - M q^3, per length and squared amplitude.
TEST(Twist, WaveOfAStraightRod) {
  constexpr double length = 10, C = 0.5, strain = 1e-6;
  constexpr int count = 48;
  for (const double psi : {-2.0, 0.0, 1.0, 3.0}) {
    const Fabric fabric = helix(length * (1 + strain), length, count, psi);
    Fabric straight = fabric;
    for (Vec3& p : straight.yarns[0].control_points) p.y = p.z = 0;
    const Evaluated e = evaluated(straight, rod(C));
    Unknowns wave, product;
    const double q = 2 * pi / length, pull = 1e6 * strain, couple = C * psi;
    for (int i = 0; i < count; ++i)
      wave.u.push_back({0, outside(1, count) * std::cos(2 * pi * i / count),
                        outside(1, count) * std::sin(2 * pi * i / count)});
    multiply(e.hessian, wave, product);
    const double exact = length * (q * q * q * q + pull * q * q - couple * q * q * q);
    std::printf("wave at psi %.1f: %.5f (%.5f)\n", psi, dot(wave, product), exact);
    EXPECT_NEAR(dot(wave, product), exact, 3e-3 * length * q * q * (q * q + pull + std::abs(couple) * q));
  }
}

// Michell: a ring of a straight rod stands a twist of 2 pi sqrt(3) B / C in all.
TEST(Twist, RingLeavesItsPlaneAtMichellsTwist) {
  constexpr double radius = 4, C = 0.6;
  const double critical = std::sqrt(3.0) / (C * radius);  // rad/d
  RelaxOptions options = rod(C);
  options.model.material.stretch_stiffness = 1e4;
  Fabric fabric = relax(ring(radius, 48, 0), options).fabric;
  const auto stands = [&](double psi) {
    fabric.yarns[0].liveliness = psi;
    const Evaluated e = evaluated(fabric, options);
    DenseCholesky factor;
    Unknowns against;
    return factor.factor(e.hessian, 1e-6, against);
  };
  double low = 0.5 * critical, high = 1.5 * critical;
  ASSERT_TRUE(stands(low));
  ASSERT_FALSE(stands(high));
  while (high - low > 1e-4 * critical) (stands((low + high) / 2) ? low : high) = (low + high) / 2;
  std::printf("ring turns over at %.4f of Michell's twist\n", low / critical);
  EXPECT_NEAR(low, critical, 0.01 * critical);
  EXPECT_FALSE(stands(-high));  // either way
}

// The couple of all of a yarn, by the dense and the sparse factor.
TEST(Twist, FactorsKnowTheWholeYarn) {
  RelaxOptions options = rod(0.6);
  options.model.material.stretch_stiffness = 100;
  const Evaluated e = evaluated(relax(helix(8.5, 10, 32, 0.5), options).fabric, options);
  ASSERT_EQ(e.hessian.dyads.size(), 1u);
  Unknowns b, x, back, against;
  for (int i = 0; i < e.model.nodes; ++i)
    b.u.push_back({std::sin(3.0 * i), std::cos(2.0 * i), std::sin(i + 0.3)});
  b.g = {0, 0, 0};
  const auto error = [&](double shift) {
    multiply(e.hessian, shift, x, back);
    axpy(-1, b, back);
    return std::sqrt(dot(back, back) / dot(b, b));
  };
  constexpr double shift = 1e-3;
  DenseCholesky dense;
  ASSERT_TRUE(dense.factor(e.hessian, shift, against));
  dense.solve(b, x);
  EXPECT_LT(error(shift), 1e-8);
  Cholesky sparse;
  ASSERT_TRUE(sparse.factor(e.hessian, shift));
  sparse.solve(b, x);
  EXPECT_LT(error(shift), 1e-8);
}

struct Lean {
  double degrees = 0;
  bool whole = false;
};
Lean lean_of(const std::string& courses, double liveliness, double segments = 12) {
  Fabric first = knitted(courses, "periodic", "", 17, segments);
  for (FabricYarn& yarn : first.yarns) yarn.liveliness = liveliness;
  RelaxOptions options = frictionless();
  options.model.material.twist_stiffness = 0.3;
  options.model.free.skew = true;
  const RelaxResult rest = relax(first, options);
  const InterlacingCheck check = check_interlacings(rest.fabric);
  std::printf("%s at %.2f rad/d, %g segments: %.3f x %.3f, leans %.3f degrees, %d steps, twist %.4f; %s\n",
              courses.c_str(), liveliness, segments, rest.fabric.width, rest.fabric.height,
              std::atan2(rest.fabric.skew, rest.fabric.height) * 180 / pi, rest.newton_iterations,
              rest.energy.twist, rest.message.c_str());
  return {std::atan2(rest.fabric.skew, rest.fabric.height) * 180 / pi,
          rest.converged && rest.pass_throughs == 0 && check.intact == check.expected};
}

// Wales of plain lean the way of the yarn's twist, Z to the right; those of rib and garter stand.
TEST(Twist, WalesOfPlainLeanAndThoseOfRibAndGarterStand) {
  constexpr double lively = 0.1;  // 16 turns in 1000 diameters
  const Lean z = lean_of("g", lively), s = lean_of("g", -lively), balanced = lean_of("g", 0);
  EXPECT_TRUE(z.whole && s.whole && balanced.whole);
  EXPECT_GT(z.degrees, 5);
  EXPECT_NEAR(s.degrees, -z.degrees, 0.01 * z.degrees);
  EXPECT_NEAR(balanced.degrees, 0, 0.01);
  // Forces need more points than sizes: a sixth is lost with 12, a hundredth with 24.
  const Lean fine = lean_of("g", lively, 24), finest = lean_of("g", lively, 48);
  EXPECT_TRUE(fine.whole && finest.whole);
  EXPECT_NEAR(z.degrees, finest.degrees, 0.2 * finest.degrees);
  EXPECT_NEAR(fine.degrees, finest.degrees, 0.02 * finest.degrees);
  for (const char* courses : {"ge", "g\ne"}) {
    const Lean both = lean_of(courses, 2 * lively);
    EXPECT_TRUE(both.whole);
    EXPECT_NEAR(both.degrees, 0, 0.05) << courses;
  }
}

// Courses of Z and S yarn in turn, what mills do against the lean: none is left.
TEST(Twist, CoursesOfOppositeTwistDoNotLean) {
  Fabric first = knitted("g\ng", "periodic", "");
  ASSERT_EQ(first.yarns.size(), 2u);
  first.yarns[0].liveliness = 0.1, first.yarns[1].liveliness = -0.1;
  RelaxOptions options = frictionless();
  options.model.material.twist_stiffness = 0.3;
  options.model.free.skew = true;
  const RelaxResult rest = relax(first, options);
  EXPECT_TRUE(rest.converged) << rest.message;
  EXPECT_NEAR(rest.fabric.skew / rest.fabric.height, 0, 1e-3);
}

TEST(Twist, NonsenseIsRefused) {
  Fabric fabric = helix(8, 10, 32, 0.5);
  RelaxOptions options = rod(-1);
  EXPECT_THROW(relax(fabric, options), std::invalid_argument);
  options = rod(std::nan(""));
  EXPECT_THROW(relax(fabric, options), std::invalid_argument);
  options = rod(1);
  fabric.yarns[0].liveliness = INFINITY;
  EXPECT_THROW(relax(fabric, options), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
