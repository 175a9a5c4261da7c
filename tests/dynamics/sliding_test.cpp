// Sliding bindings against closed forms: a rod that slides on rails, yarn that is drawn over pins.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/loose_yarns.hpp"
#include "dynamics/yarn_motion.hpp"

namespace loopwright {
namespace {

struct Scene {
  SplineModel model;
  MotionState state;
  Bindings bindings;

  int add(const std::vector<Vec3>& points, double EA, double B, bool held) {
    return add_yarn(model, state, points, EA, B, held);
  }
  void bind(YarnPlace a, YarnPlace b, double distance, double friction) {
    SlidingBinding binding;
    binding.a = a;
    binding.b = b;
    binding.distance = distance;
    binding.friction = friction;
    bindings.sliding.push_back(binding);
  }
  YarnMotion motion(MotionStepper stepper) const {
    MotionOptions options;
    options.stepper = stepper;
    options.tolerance = 1e-8;
    options.most_newton = 40;
    return YarnMotion(model, state, bindings, options);
  }
};

// A stiff rod along y, of 12 segments, that lies across two held rails along x.
constexpr double rod_length = 12, gravity = 0.5, friction = 0.3;
constexpr double load = gravity * rod_length;  // on both rails
Scene rod_on_rails() {
  Scene s;
  for (const double y : {-3.5, 3.5}) s.add(line({-6, y, 0}, {1, 0, 0}, 43), 1, 1, true);
  const int rod = s.add(line({0.2, -7, 1}, {0, 1, 0}, 15), 2000, 300, false);
  s.bind({rod, 2.5}, {0, 5.2}, 1, friction);
  s.bind({rod, 9.5}, {1, 5.2}, 1, friction);
  s.model.gravity = {0, 0, -gravity};
  s.model.drag = 3;
  return s;
}
// The rails carry it from a time of 5 on.
Scene rod_at_rest(MotionStepper stepper, double dt) {
  Scene s = rod_on_rails();
  YarnMotion motion = s.motion(stepper);
  while (motion.state().time < 5) motion.step(dt);
  s.state = motion.state();
  s.state.time = 0;
  s.bindings = motion.bindings();
  return s;
}

constexpr MotionStepper steppers[] = {MotionStepper::explicit_euler, MotionStepper::implicit_euler};
double step_of(MotionStepper stepper) { return stepper == MotionStepper::explicit_euler ? 0.002 : 0.01; }

// The middle of the mass of a yarn that is hardly stretched.
Vec3 middle(const YarnMotion& motion, int yarn) {
  const int samples = 10 * motion.model().yarns[static_cast<std::size_t>(yarn)].segments();
  Vec3 sum;
  for (int k = 0; k < samples; ++k)
    sum += curve_point(motion.model(), motion.state().place, yarn, (k + 0.5) / 10).place / samples;
  return sum;
}

// On rails that lean by an angle the rod stays below the friction angle and slides with g (sin - mu cos)
// above it.
TEST(SlidingFriction, InclineHoldsUpToTheFrictionAngle) {
  for (const MotionStepper stepper : steppers)
    for (const double slope : {0.5, 0.95, 1.05, 2.0}) {  // of the friction angle's
      const double angle = std::atan(slope * friction), dt = step_of(stepper);
      YarnMotion motion = rod_at_rest(stepper, dt).motion(stepper);
      while (motion.state().time < 3) {  // without a jerk
        const double now = std::min(1.0, motion.state().time / 2) * angle;
        motion.set_gravity(gravity * Vec3{std::sin(now), 0, -std::cos(now)});
        motion.step(dt);
      }
      if (slope > 1) motion.set_drag(0);
      const double start = motion.state().time, from = middle(motion, 2).x,
                   speed = motion.momentum().x / rod_length;
      while (motion.state().time < start + 4) motion.step(dt);
      const double t = motion.state().time - start, way = middle(motion, 2).x - from,
                   free = 0.5 * gravity * (std::sin(angle) - friction * std::cos(angle)) * t * t;
      if (slope < 1)
        EXPECT_LT(std::abs(way), 0.02) << slope << ": the spring on which it sticks is no longer";
      else
        EXPECT_NEAR(way, speed * t + free, 0.01 * free + 0.015) << slope;
    }
}

// Pushed and let go the rod slows down by mu N, along the rails, along itself or across both, and stops after
// v^2 / (2 mu g); what energy it loses is mu N times its way. (It bends as it comes to hang over a rail,
// which is in the tolerance of 0.03.)
TEST(SlidingFriction, SlowsDownByTheLoadAndStops) {
  constexpr double v = 0.7, stop = v / (friction * gravity);
  constexpr double spring = 0.02 * friction * load;  // what the short springs of sticking may hold
  for (const MotionStepper stepper : steppers)
    for (const Vec3& along : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.6, 0.8, 0}}) {
      const double dt = step_of(stepper);
      Scene s = rod_at_rest(stepper, dt);
      s.model.drag = 0;
      for (std::size_t i = 0; i < s.state.place.size(); ++i)
        s.state.velocity[i] = s.model.held[i] != 0 ? Vec3{} : v * along;
      YarnMotion motion = s.motion(stepper);
      const Vec3 from = middle(motion, 2);
      const double energy = motion.energy().total();
      const auto way = [&] { return dot(middle(motion, 2) - from, along); };
      while (motion.state().time < 0.9 * stop) {
        motion.step(dt);
        const double t = motion.state().time;
        ASSERT_NEAR(way(), v * t - 0.5 * friction * gravity * t * t, 0.03) << along.x << " at " << t;
        ASSERT_NEAR(energy - motion.energy().total(), friction * load * way(), 1.5 * spring) << along.x;
      }
      while (motion.state().time < 2 * stop) motion.step(dt);
      EXPECT_NEAR(way(), 0.5 * v * stop, 0.03) << along.x;
      EXPECT_LT(motion.energy().kinetic, spring);
    }
}

// Two yarns that cross, bound and in flight: nothing from outside. Momentum stays to rounding in explicit
// steps; without friction angular momentum too, and energy within what such steps do to it; with friction
// energy falls. (Friction acts at the centrelines, a distance apart, and yarn has no twist to take its
// couple.)
TEST(SlidingFriction, FlightKeepsMomentaAndEnergy) {
  for (const double mu : {0.0, 0.3}) {
    Scene s;
    const int a = s.add(line({-6, 0, 0}, {1, 0, 0}, 13), 300, 4, false),
              b = s.add(line({0.3, -6, 1}, {0, 1, 0}, 13), 300, 4, false);
    s.bind({a, 5.3}, {b, 5.1}, 1, mu);
    for (std::size_t i = 0; i < s.state.place.size(); ++i) {
      const Vec3& p = s.state.place[i];
      s.state.velocity[i] = i < 13 ? Vec3{0.3, 0.05 * p.x, 0.2} : Vec3{-0.1, 0.3, 0.02 * p.y + 0.2};
    }
    YarnMotion motion = s.motion(MotionStepper::explicit_euler);
    const Vec3 p = motion.momentum(), l = motion.angular_momentum();
    const double energy = motion.energy().total(), place = motion.bindings().sliding[0].a.t;
    for (int k = 0; k < 5000; ++k) {
      motion.step(0.002);
      ASSERT_LT(distance(motion.momentum(), p), 1e-9 * norm(p));
      ASSERT_LT(motion.constraint_error(), 1e-3);
      ASSERT_LT(motion.energy().total(), 1.005 * energy);
      if (mu > 0) continue;
      ASSERT_LT(distance(motion.angular_momentum(), l), 1e-9 * norm(l));
      ASSERT_GT(motion.energy().total(), 0.995 * energy);
    }
    EXPECT_GT(std::abs(motion.bindings().sliding[0].a.t - place), 1) << "they have slid along each other";
    if (mu > 0) {
      EXPECT_LT(motion.energy().total(), 0.97 * energy);
    }
  }
}

// Yarn drawn over `pins` held pins that turn it by `turn` each, pulled by 1 at one end and by `pull` at the
// other.
struct Pulley {
  static constexpr double h = 0.5, thickness = 0.3, apart = 6, bend = 0.5;
  Scene scene;
  std::array<Vec3, 2> end_direction;

  Pulley(int pins, double turn, double mu) {
    // A polygon with a corner at every pin, in steps of h.
    std::vector<Vec3> corner{{0, 0, 0}};
    std::vector<Vec3> direction;
    for (int k = 0; k <= pins; ++k) {
      const double angle = (0.5 * pins - k) * turn;
      direction.push_back({std::cos(angle), std::sin(angle), 0});
      corner.push_back(corner.back() + (k == 0 || k == pins ? 1.5 : 1) * apart * direction.back());
    }
    std::vector<Vec3> points{corner[0] - h * direction[0]};
    std::vector<double> place;  // of the corners on the yarn
    for (int k = 0; k <= pins; ++k) {
      const double length =
          distance(corner[static_cast<std::size_t>(k)], corner[static_cast<std::size_t>(k) + 1]);
      const int steps = static_cast<int>(std::lround(length / h));
      for (int i = 0; i < steps; ++i)
        points.push_back(corner[static_cast<std::size_t>(k)] +
                         (i * h) * direction[static_cast<std::size_t>(k)]);
      place.push_back(static_cast<double>(points.size()) - 1);
    }
    points.push_back(corner.back());
    points.push_back(corner.back() + h * direction.back());
    const int yarn = scene.add(points, 500, bend, false);
    for (int k = 1; k <= pins; ++k) {
      const double angle = (0.5 * pins - k + 0.5) * turn;
      const Vec3 inward{std::sin(angle), -std::cos(angle), 0};  // the yarn turns round what is below it
      const Vec3 at = corner[static_cast<std::size_t>(k)] + (thickness + 0.17 * h * turn) * inward;
      const int pin = scene.add(line(at - Vec3{0, 0, 2}, {0, 0, 1}, 5), 1, 1, true);
      scene.bind({yarn, place[static_cast<std::size_t>(k) - 1]}, {pin, 1}, thickness, mu);
    }
    end_direction = {-1.0 * direction.front(), direction.back()};
    scene.model.force.assign(static_cast<std::size_t>(scene.model.points), Vec3{});
    scene.model.drag = 1;
  }
  std::vector<Vec3> pulled(double first, double last) const {
    std::vector<Vec3> force(static_cast<std::size_t>(scene.model.points));
    const auto n = static_cast<std::size_t>(scene.model.yarns[0].points);
    for (const std::size_t i : {0, 1, 2}) {
      force[i] = (i == 1 ? 2.0 / 3 : 1.0 / 6) * first * end_direction[0];
      force[n - 1 - i] = (i == 1 ? 2.0 / 3 : 1.0 / 6) * last * end_direction[1];
    }
    return force;
  }
  // T1 / T2 from which yarn slides over one point of contact with friction angle phi: the three forces there
  // are in balance, T1 cos(a1 + phi) = T2 cos(a2 - phi) with the angles a1 + a2 = turn between the strands
  // and the yarn's direction at the point. A stiff yarn's direction turns over sqrt(B / T): a1 / a2 = sqrt(T2
  // / T1).
  static double ratio(double turn, double mu) {
    const double phi = std::atan(mu);
    double r = 1;
    for (int k = 0; k < 100; ++k) {
      const double first = turn / (1 + std::sqrt(r));
      r = std::cos(turn - first - phi) / std::cos(first + phi);
    }
    return r;
  }
};

// Pulled below the ratio the yarn stays, on the short springs of its friction; above it, it runs at a speed,
// in a medium, that grows with what is above the ratio. Many points of little turn are Euler's rope.
TEST(SlidingFriction, CapstanOfPoints) {
  constexpr int pins = 4;
  constexpr double turn = 0.3;
  for (const double mu : {0.0, 0.15, 0.3}) {
    const double ratio = std::pow(Pulley::ratio(turn, mu), pins);
    EXPECT_NEAR(ratio, std::exp(mu * pins * turn), 0.002 * ratio);
    const auto way = [&](double last) {
      const Pulley pulley(pins, turn, mu);
      YarnMotion motion = pulley.scene.motion(MotionStepper::implicit_euler);
      const auto end = [&] { return dot(motion.state().place[20], pulley.end_direction[1]); };
      bool converged = true;
      const auto run = [&](int steps, double from, double to) {
        for (int k = 1; k <= steps; ++k) {
          motion.set_force(pulley.pulled(1, from + (to - from) * k / steps));
          converged = motion.step(0.5).converged && converged;
        }
      };
      run(100, 1, 1);
      run(100, 1, last);
      const double start = end();
      run(200, last, last);
      EXPECT_TRUE(converged) << mu << ", " << last;
      return end() - start;
    };
    if (mu > 0) {
      EXPECT_LT(std::abs(way(0.975 * ratio)), 0.003) << mu;
    }
    const double slow = way(1.05 * ratio), fast = way(1.1 * ratio);
    EXPECT_GT(slow, 0.05) << mu;
    EXPECT_NEAR(1.05 - 0.05 * slow / (fast - slow), 1, 0.01) << mu;
  }
}

}  // namespace
}  // namespace loopwright
