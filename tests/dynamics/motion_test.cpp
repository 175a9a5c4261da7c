// Yarn in motion against closed forms: fall, momenta, waves, the hanging chain, viscosity, order in time.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dynamics/yarn_motion.hpp"

namespace loopwright {
namespace {

constexpr double pi = std::numbers::pi;

struct Scene {
  SplineModel model;
  MotionState state;
};

// One yarn of `segments` segments of length h along x, mass 1 per length, at rest.
Scene straight(int segments, double h, double EA, double B, StretchLaw law = StretchLaw::mean,
               const Blending& blending = uniform_b_spline()) {
  Scene s;
  for (int i = 0; i < segments + 3; ++i) s.state.place.push_back({h * (i - 1), 0, 0});
  s.state.velocity.assign(s.state.place.size(), Vec3{});
  SplineYarn yarn;
  yarn.blending = blending;
  yarn.points = segments + 3;
  yarn.stretch_stiffness = EA;
  yarn.bend_stiffness = B;
  s.model.law = law;
  set_rest_shape(yarn, s.state.place, 0, law);
  set_mass_per_length(yarn, 1, s.state.place);
  s.model.yarns = {yarn};
  s.model.points = yarn.points;
  s.model.held.assign(s.state.place.size(), 0);
  return s;
}

YarnMotion motion_of(const Scene& s, MotionStepper stepper, double tolerance = 1e-9) {
  MotionOptions options;
  options.stepper = stepper;
  options.tolerance = tolerance;
  return YarnMotion(s.model, s.state, {}, options);
}

// Symplectic and implicit Euler fall by g t^2/2 (1 +- 1/n) in n steps; nothing may change the yarn's shape.
TEST(Motion, FreeFall) {
  for (const MotionStepper stepper : {MotionStepper::explicit_euler, MotionStepper::implicit_euler})
    for (const Blending& blending : {uniform_b_spline(), catmull_rom()}) {
      Scene s = straight(9, 1, 100, 1, StretchLaw::mean, blending);
      s.model.gravity = {0.2, -9.81, 0};
      YarnMotion motion = motion_of(s, stepper);
      constexpr int steps = 100;
      for (int k = 0; k < steps; ++k) motion.step(0.01);
      for (std::size_t i = 0; i < s.state.place.size(); ++i) {
        const Vec3 wanted = s.state.place[i] + 0.5 * (1 + 1.0 / steps) * s.model.gravity;
        EXPECT_LT(distance(motion.state().place[i], wanted), 1e-8);
        EXPECT_LT(distance(motion.state().velocity[i], s.model.gravity), 1e-8);
      }
      EXPECT_NEAR(motion.state().time, 1, 1e-12);
    }
}

// In a medium the fall ends at g / drag, approached as exp(-drag t).
TEST(Motion, FallThroughAMedium) {
  Scene s = straight(9, 1, 100, 1);
  s.model.gravity = {0, -2, 0};
  s.model.drag = 4;
  for (const MotionStepper stepper : {MotionStepper::explicit_euler, MotionStepper::implicit_euler}) {
    YarnMotion motion = motion_of(s, stepper);
    for (int k = 0; k < 500; ++k) motion.step(0.001);
    EXPECT_NEAR(motion.state().velocity[4].y, -0.5 * (1 - std::exp(-2)), 1e-3);
    for (int k = 0; k < 5000; ++k) motion.step(0.001);
    EXPECT_NEAR(motion.state().velocity[4].y, -0.5, 1e-6);
  }
}

Scene tumbling(StretchLaw law) {
  Scene s = straight(15, 1, 60, 2, law);
  for (std::size_t i = 0; i < s.state.place.size(); ++i) {
    const double x = s.state.place[i].x;
    s.state.place[i] += Vec3{0, 0.4 * std::sin(x), 0.3 * std::cos(0.6 * x)};
    s.state.velocity[i] = {0.3 + 0.1 * std::cos(x), 0.2 * x, -0.4 + 0.05 * x * x / 7};
  }
  return s;
}

// Nothing from outside: both momenta stay to rounding in the explicit step; the implicit one keeps momentum,
// and loses angular momentum with its step (it damps).
TEST(Motion, MomentaAreKept) {
  for (const StretchLaw law : {StretchLaw::springs, StretchLaw::green, StretchLaw::mean}) {
    const Scene s = tumbling(law);
    YarnMotion motion = motion_of(s, MotionStepper::explicit_euler);
    const Vec3 p = motion.momentum(), l = motion.angular_momentum();
    for (int k = 0; k < 2000; ++k) motion.step(0.002);
    EXPECT_LT(distance(motion.momentum(), p), 1e-10 * norm(p));
    EXPECT_LT(distance(motion.angular_momentum(), l), 1e-10 * norm(l));
    YarnMotion damped = motion_of(s, MotionStepper::implicit_euler);
    for (int k = 0; k < 100; ++k) damped.step(0.01);
    EXPECT_LT(distance(damped.momentum(), p), 1e-6 * norm(p));
    EXPECT_LT(distance(damped.angular_momentum(), l), 0.1 * norm(l));
  }
}

// Turning one way is the same as starting turned: nothing knows the axes.
TEST(Motion, IsTheSameInEveryAttitude) {
  const auto turned = [](const Vec3& v) { return Vec3{-v.z, v.x, -v.y}; };  // a rotation
  Scene s = tumbling(StretchLaw::mean), t = s;
  for (Vec3& v : t.state.place) v = turned(v);
  for (Vec3& v : t.state.velocity) v = turned(v);
  YarnMotion a = motion_of(s, MotionStepper::explicit_euler), b = motion_of(t, MotionStepper::explicit_euler);
  for (int k = 0; k < 300; ++k) a.step(0.002), b.step(0.002);
  for (std::size_t i = 0; i < s.state.place.size(); ++i)
    EXPECT_LT(distance(turned(a.state().place[i]), b.state().place[i]), 1e-9);
}

// First time at which `value` changes its sign, by steps of dt.
template <class Value>
double first_zero(YarnMotion& motion, double dt, const Value& value) {
  double before = value(motion.state());
  for (int k = 0; k < 200000; ++k) {
    motion.step(dt);
    const double now = value(motion.state());
    if (before * now <= 0) return motion.state().time - dt * now / (now - before);
    before = now;
  }
  return 0;
}

// Longitudinal waves run at sqrt(EA / rho): the first mode of a free yarn, cos(pi x / L), is at zero after a
// quarter of its period 2 L / c.
TEST(Motion, LongitudinalWaveSpeed) {
  constexpr double EA = 400, L = 40;
  for (const StretchLaw law : {StretchLaw::springs, StretchLaw::green, StretchLaw::mean}) {
    // springs act between control points, so that the chain has two springs more than the yarn has segments
    Scene s = straight(40, 1, EA, 0, law);
    for (std::size_t i = 0; i < s.state.place.size(); ++i)
      s.state.place[i].x += 1e-4 * std::cos(pi * s.state.place[i].x / L);
    YarnMotion motion = motion_of(s, MotionStepper::explicit_euler);
    const double quarter = first_zero(
        motion, 0.002, [](const MotionState& now) { return now.place[1].x - now.place[41].x + 40; });
    const double c = L / (2 * quarter);
    EXPECT_NEAR(c, std::sqrt(EA), (law == StretchLaw::springs ? 0.05 : 0.003) * std::sqrt(EA));
  }
}

// A stretched yarn is a string: transverse waves run at sqrt(T / rho) with T = EA e and rho = 1 / (1 + e).
TEST(Motion, TransverseWaveSpeedOfAStretchedYarn) {
  constexpr double EA = 400, e = 0.1, L = 40 * (1 + e);
  Scene s = straight(40, 1, EA, 0);
  for (Vec3& p : s.state.place) p.x *= 1 + e;
  for (const std::size_t i : {0, 1, 2}) s.model.held[i] = s.model.held[42 - i] = 1;
  // three held points fix a B-spline's end and its slope; the string moves between the inner ones, nearly
  for (std::size_t i = 3; i < 40; ++i) s.state.place[i].y += 1e-3 * std::sin(pi * (s.state.place[i].x) / L);
  YarnMotion motion = motion_of(s, MotionStepper::explicit_euler);
  const double quarter = first_zero(motion, 0.002, [](const MotionState& now) { return now.place[21].y; });
  const double c = L / (2 * quarter);
  EXPECT_NEAR(c, std::sqrt(EA * e * (1 + e)), 0.06 * c);
}

// Yarn without bending stiffness, hung at two points, comes to rest in a catenary: y = a cosh(x / a) for a
// chain of length S over the span D, with 2 a sinh(D / 2a) = S.
TEST(Motion, HangingChainBecomesACatenary) {
  constexpr int segments = 40;
  Scene s = straight(segments, 1, 1e5, 0);
  // hung up in a parabola whose polygon is a little longer than the chain, its ends 24 of 40 apart
  constexpr double span = 24;
  const auto parabola = [&](double depth) {
    std::vector<Vec3> place;
    for (int i = 0; i < segments + 3; ++i) {
      const double u = (i - 1.0) / segments - 0.5;
      place.push_back({span * u, depth * (4 * u * u - 1), 0});
    }
    return place;
  };
  const auto length = [](const std::vector<Vec3>& place) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < place.size(); ++i) sum += distance(place[i], place[i + 1]);
    return sum;
  };
  double depth = 5;
  while (length(parabola(depth)) < segments + 2.1) depth += 0.01;
  s.state.place = parabola(depth);
  s.model.held.front() = s.model.held.back() = 1;
  s.model.gravity = {0, -1, 0};
  s.model.drag = 1;
  YarnMotion motion = motion_of(s, MotionStepper::implicit_euler, 1e-6);
  for (int k = 0; k < 300; ++k) motion.step(0.5);
  ASSERT_LT(motion.energy().kinetic, 1e-9);
  // From the middle out: the catenary through the yarn's lowest point with its own a = H / (rho g); at arc
  // length q from the lowest point x = a asinh(q / a), y = a (sqrt(1 + (q/a)^2) - 1).
  const CurvePoint low = curve_point(motion.model(), motion.state().place, 0, 20);
  double best = 1e9, a = 0;
  const CurvePoint far = curve_point(motion.model(), motion.state().place, 0, 35);
  for (double trial = 3; trial < 15; trial += 0.001) {
    const double miss = std::abs(trial * std::asinh(15 / trial) - (far.place.x - low.place.x));
    if (miss < best) best = miss, a = trial;
  }
  for (int k = 1; k <= 17; ++k) {
    const CurvePoint p = curve_point(motion.model(), motion.state().place, 0, 20 + k);
    EXPECT_NEAR(p.place.x - low.place.x, a * std::asinh(k / a), 0.04);
    EXPECT_NEAR(p.place.y - low.place.y, a * (std::sqrt(1 + k * k / (a * a)) - 1), 0.04);
  }
  // and the span over the length is that of the whole chain, the loose ends of the spline left out
  EXPECT_NEAR(2 * a * std::sinh((far.place.x - low.place.x) / a), 30, 0.02);
}

// What viscosity takes is drag * 2 K a unit of time; nothing else takes anything.
TEST(Motion, EnergyBalanceWithViscosity) {
  Scene s = tumbling(StretchLaw::mean);
  s.model.drag = 0.8;
  const auto run = [&](double dt) {
    YarnMotion motion = motion_of(s, MotionStepper::explicit_euler);
    const double start = motion.energy().total();
    double taken = 0, power = 2 * s.model.drag * motion.energy().kinetic;
    while (motion.state().time < 2 - 1e-9) {
      motion.step(dt);
      const double now = 2 * s.model.drag * motion.energy().kinetic;
      taken += 0.5 * dt * (power + now);
      power = now;
    }
    return std::array<double, 2>{start - motion.energy().total() - taken, taken};
  };
  const auto coarse = run(0.002), fine = run(0.001);
  EXPECT_GT(coarse[1], 10 * std::abs(coarse[0]));
  EXPECT_LT(std::abs(fine[0]), 2e-3 * fine[1]);
  EXPECT_LT(std::abs(fine[0]), 0.7 * std::abs(coarse[0]));
}

TEST(Motion, EnergyStaysBoundedWithoutViscosity) {
  const Scene s = tumbling(StretchLaw::mean);
  YarnMotion motion = motion_of(s, MotionStepper::explicit_euler);
  const double start = motion.energy().total();
  for (int k = 0; k < 20000; ++k) {
    motion.step(0.002);
    if (k % 100 == 0) {
      ASSERT_NEAR(motion.energy().total(), start, 0.02 * start) << k;
    }
  }
}

// Both steps are of first order in time: halving dt halves the error against a run with a much smaller one.
TEST(Motion, OrderInTime) {
  const Scene s = tumbling(StretchLaw::mean);
  const auto end = [&](MotionStepper stepper, int steps) {
    YarnMotion motion = motion_of(s, stepper);
    for (int k = 0; k < steps; ++k) motion.step(0.5 / steps);
    return motion.state().place;
  };
  const auto reference = end(MotionStepper::explicit_euler, 16000);
  const auto error = [&](const std::vector<Vec3>& place) {
    double sum = 0;
    for (std::size_t i = 0; i < place.size(); ++i) sum += squared_norm(place[i] - reference[i]);
    return std::sqrt(sum);
  };
  for (const MotionStepper stepper : {MotionStepper::explicit_euler, MotionStepper::implicit_euler}) {
    const double coarse = error(end(stepper, 250)), fine = error(end(stepper, 500));
    EXPECT_NEAR(std::log2(coarse / fine), 1, 0.15);
  }
}

TEST(Motion, RefusesWhatIsNotSound) {
  Scene s = straight(5, 1, 1, 1);
  s.state.place[2].y = std::nan("");
  EXPECT_THROW(motion_of(s, MotionStepper::implicit_euler), std::invalid_argument);
  s = straight(5, 1, 1, 1);
  s.model.yarns[0].density[1][2] = 0;
  EXPECT_THROW(motion_of(s, MotionStepper::implicit_euler), std::invalid_argument);
  s = straight(5, 1, 1, 1);
  YarnMotion motion = motion_of(s, MotionStepper::implicit_euler);
  EXPECT_THROW(motion.step(0), std::invalid_argument);
  EXPECT_THROW(motion.step(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
