// Yarn on yarn: how even the sampled contact is, and Coulomb's law on a drum and on an incline. What is
// computed is printed, for docs/validation.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

using std::numbers::pi;

constexpr double h = 17 / 12.0;  // segments as in cloth: loops of 17 d, 12 segments each

double contact_energy(const Fabric& fabric, const ModelOptions& options) {
  const YarnModel model = build_yarn_model(fabric, options);
  const YarnState state = build_yarn_state(fabric);
  Assembly assembly(model);
  assembly.update_pairs(state, 1.6);
  return assembly.energy(state).contact;
}

// Yarn drawn along another one: energies over all offsets of the samples of both, which repeat with their
// spacing. Ripple: half of the range over the mean. Teeth: the largest force along over the force across.
struct Unevenness {
  double ripple = 0, teeth = 0;
};

Unevenness drawn_along(double distance, double angle, double spacing) {
  ModelOptions options = frictionless().model;
  options.sample_spacing = spacing;
  const double period = h / std::ceil(h / spacing - 1e-9);
  const auto energy = [&](double s, double t, double z) {
    return contact_energy(
        fabric_of({free_yarn(24, h,
                             [&](int i) {
                               return Vec3{h * (i - 11.5) + s, 0, 0};
                             }),
                   free_yarn(9, h,
                             [&](int i) {
                               const double along = h * (i - 4) + 0.123 + t;
                               return Vec3{along * std::cos(angle), along * std::sin(angle), z};
                             })}),
        options);
  };
  constexpr int steps = 16;
  double least = 1e300, most = 0, steepest = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < (angle == 0 ? 1 : steps); ++j) {
      const double s = period * i / steps, t = period * j / steps, e = energy(s, t, distance);
      least = std::min(least, e);
      most = std::max(most, e);
      steepest = std::max(steepest, std::abs(energy(s + 1e-4, t, distance) - e) / 1e-4);
    }
  const double across = (energy(0, 0, distance - 1e-4) - energy(0, 0, distance + 1e-4)) / 2e-4;
  return {(most - least) / (most + least), steepest / across};
}

TEST(ValidationContact, CorrugationOfParallelYarns) {
  for (const double distance : {0.95, 0.9, 0.8, 0.7}) {
    const Unevenness u = drawn_along(distance, 0, ModelOptions{}.sample_spacing);
    std::printf("side by side at %.2f d: ripple %.2e of the energy, teeth %.2e of the force across\n",
                distance, u.ripple, u.teeth);
    EXPECT_LT(u.ripple, 0.01);
    EXPECT_LT(u.teeth, 0.01);
  }
}

// Crossed yarns touch in a disc of radius sqrt(1 - z^2): fewer samples and more ripple the lighter they
// touch.
TEST(ValidationContact, CorrugationOfCrossedYarns) {
  const double usual = ModelOptions{}.sample_spacing;
  for (const double spacing : {0.18, usual})
    for (const double angle : {pi / 2, pi / 4})
      for (const double distance : {0.95, 0.9, 0.8, 0.7}) {
        const Unevenness u = drawn_along(distance, angle, spacing);
        std::printf("crossed at %2.0f degrees, %.2f d, samples every %.2f d: ripple %.2e, teeth %.2e\n",
                    angle * 180 / pi, distance, spacing, u.ripple, u.teeth);
        if (spacing == usual) {
          EXPECT_LT(u.ripple, 0.01);
          EXPECT_LT(u.teeth, 0.01);
        }
      }
}

void add_force(std::vector<Vec3>& loads, std::size_t first_node, const FabricYarn& yarn, double t,
               const Vec3& f) {
  const int e = std::min(static_cast<int>(t), yarn.segments() - 1);
  const auto weights = spline_weights(t - e).value;
  for (std::size_t k = 0; k < 4; ++k) loads[first_node + static_cast<std::size_t>(e) + k] += weights[k] * f;
}

RelaxOptions alone(double friction) {
  RelaxOptions options = frictionless();
  options.model.free = {false, false, false};
  options.model.material.friction = friction;
  options.grow_in = false;
  options.plate_room = -1;
  return options;
}

// A drum: one held ring of yarn. Over its upper half hangs a yarn, at one end a weight, the other end drawn
// down step by step (or given way). In the plane of the ring, plates keep both.
struct Drum {
  static constexpr double radius = 5, contact_radius = radius + 0.97, hanging = 18;
  Fabric fabric;
  RelaxOptions options;
  double weight = 4;

  explicit Drum(double friction) : options(alone(friction)) {
    constexpr int ring_segments = 23;
    const double outside = radius * 3 / (2 + std::cos(2 * pi / ring_segments));
    FabricYarn ring = free_yarn(ring_segments, 2 * pi * radius / ring_segments, [&](int i) {
      return Vec3{outside * std::cos(2 * pi * i / ring_segments),
                  outside * std::sin(2 * pi * i / ring_segments), 0};
    });
    ring.periodic = true;
    ring.held.assign(ring.control_points.size(), 1);
    const int segments = static_cast<int>((2 * hanging + pi * contact_radius) / h);
    FabricYarn yarn = free_yarn(segments + 3, h, [&](int i) {
      const double s = h * (i - 1) - 0.5 * segments * h, arc = 0.5 * pi * contact_radius;
      if (s < -arc) return Vec3{-contact_radius, s + arc, 0};
      if (s > arc) return Vec3{contact_radius, arc - s, 0};
      return contact_radius * Vec3{std::sin(s / contact_radius), std::cos(s / contact_radius), 0};
    });
    for (std::size_t k = 0; k < 3; ++k) yarn.held[yarn.held.size() - 1 - k] = 1;
    fabric = fabric_of({ring, yarn});
    fabric.periodic = true;
    fabric.width = fabric.height = 100;
    options.model.plates = {50, -0.02, 0.02};
    options.model.point_loads.resize(ring.control_points.size() + yarn.control_points.size());
    add_force(options.model.point_loads, ring.control_points.size(), yarn, 0, {0, -weight, 0});
  }

  // Moves the held end down by `way` in `steps`; the tension near it over the weight, mean of the last third.
  // Near: some segments away, since held points fix the strain of the last one.
  double ratio_after(double way, int steps) {
    double sum = 0;
    int counted = 0;
    for (int k = 0; k < steps; ++k) {
      FabricYarn& yarn = fabric.yarns[1];
      for (std::size_t i = 0; i < yarn.held.size(); ++i)
        if (yarn.held[i]) yarn.control_points[i].y -= way / steps;
      RelaxResult result = relax(fabric, options);
      EXPECT_TRUE(result.converged) << result.message << ", residual " << result.residual;
      fabric = result.fabric;
      options.history = std::move(result.history);
      if (3 * k < 2 * steps) continue;
      const FabricYarn& drawn = fabric.yarns[1];
      const int end = drawn.segments();
      const double length = arc_length(fabric, drawn, end - 9, end - 6);
      sum += options.model.material.stretch_stiffness * (length / (3 * h) - 1);
      ++counted;
    }
    return sum / counted / weight;
  }
};

// Yarn that gives way must be let go in small steps: pushed farther than it was stretched it lifts off the
// drum, and contacts that part forget their friction.
TEST(ValidationContact, Capstan) {
  struct Case {
    double friction, way;
    int steps;
  };
  for (const Case& c : {Case{0, 0.8, 10}, {0.25, 0.8, 20}, {0.25, -0.6, 60}, {0.4, 0.8, 20}}) {
    const double ratio = Drum(c.friction).ratio_after(c.way, c.steps),
                 exact = std::exp((c.way > 0 ? 1 : -1) * c.friction * pi);
    std::printf("capstan, half a turn, friction %.2f, %s: %.4f (%.4f, %+.2f %%)\n", c.friction,
                c.way > 0 ? "drawn" : "given way", ratio, exact, 100 * (ratio / exact - 1));
    EXPECT_NEAR(ratio, exact, 0.05 * exact);
  }
}

// A yarn laid across two held rails and pulled at both crossings by a force that leans by `angle` from the
// normal: where its middle has gone along the rails after so many Newton steps.
struct Incline {
  Fabric fabric;
  RelaxOptions options;

  Incline(double friction, double angle) : options(alone(friction)) {
    const auto rail = [](double y) {
      FabricYarn yarn = free_yarn(24, h, [&](int i) { return Vec3{h * (i - 11.5) + 0.2, y, 0}; });
      yarn.held.assign(24, 1);
      return yarn;
    };
    const FabricYarn across = free_yarn(13, h, [](int i) { return Vec3{0, h * (i - 6), 0.94}; });
    constexpr double apart = 3 * h;
    fabric = fabric_of({rail(-apart), rail(apart), across});
    options.model.point_loads.resize(2 * 24 + 13);
    const Vec3 force = 3 * Vec3{std::sin(angle), 0, -std::cos(angle)};
    for (const double t : {2.0, 8.0}) add_force(options.model.point_loads, 48, across, t, force);
    options.most_iterations = 150;
  }
  double way() const { return position(fabric, fabric.yarns[2], 5).x; }
  void rest() {
    RelaxResult result = relax(fabric, options);
    fabric = result.fabric;
    options.history = std::move(result.history);
  }
};

TEST(ValidationContact, SticksOnAnInclineUpToTheFrictionAngle) {
  constexpr double degree = pi / 180;
  for (const double friction : {0.1, 0.25, 0.5}) {
    const double exact = std::atan(friction);
    double sticks = exact - 3 * degree, slides = exact + 3 * degree;
    for (int k = 0; k < 6; ++k) {
      const double angle = (sticks + slides) / 2;
      Incline incline(friction, angle);
      incline.rest();
      (incline.way() < 0.2 ? sticks : slides) = angle;
    }
    std::printf("incline, friction %.2f: slides from %.2f degrees (%.2f)\n", friction, slides / degree,
                exact / degree);
    EXPECT_NEAR(slides, exact, degree);
  }
}

// Just below, it stays for as long as one looks.
TEST(ValidationContact, DoesNotCreep) {
  Incline incline(0.25, 0.9 * std::atan(0.25));
  incline.rest();
  const double first = incline.way();
  for (int k = 0; k < 50; ++k) incline.rest();
  std::printf(
      "creep on an incline at 0.9 of the friction angle: %.2e d in 50 runs, after %.4f d in the first\n",
      incline.way() - first, first);
  EXPECT_LT(first, 0.02) << "longer than the contact's elastic slip";
  EXPECT_NEAR(incline.way(), first, 1e-4);
}

}  // namespace
}  // namespace loopwright
