// Forces in a fabric at rest against closed forms.
#include "mechanics/yarn_forces.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

FabricYarn straight(int segments, double step, double rest, const Vec3& at) {
  return free_yarn(segments + 3, rest, [=](int i) { return at + Vec3{(i - 1) * step, 0, 0}; });
}

std::size_t middle(const YarnForces& forces, std::size_t segment) {
  const auto samples = static_cast<std::size_t>(forces.samples);
  return segment * samples + samples / 2;
}

TEST(YarnForces, tension_is_stiffness_times_strain) {
  ModelOptions options;
  options.material.stretch_stiffness = 3000;
  const YarnForces forces = yarn_forces(fabric_of({straight(12, 1.01, 1, {})}), options);
  ASSERT_EQ(forces.tension.size(), 12U);
  for (const double tension : forces.tension) EXPECT_NEAR(tension, 30, 1e-9);
  for (const double contact : forces.contact) EXPECT_EQ(contact, 0);
}

TEST(YarnForces, thicker_yarn_is_stiffer_by_its_section) {
  FabricYarn thin = straight(8, 1.01, 1, {});
  thin.diameter = 0.5;
  const YarnForces forces = yarn_forces(fabric_of({thin}), {});
  EXPECT_NEAR(forces.tension[3], 0.01 * 3000 * 0.25, 1e-9);
}

// Two parallel yarns at distance h press with q = int -phi'(D) h / D ds, D = sqrt(h^2 + s^2), per length.
TEST(YarnForces, parallel_yarns_press_with_the_integral_of_the_law) {
  ModelOptions options;
  options.sample_spacing = 0.05;
  const ContactLaw law = options.material.contact;
  for (const double h : {0.8, 0.9, 0.97}) {
    const double reach = std::sqrt(law.outer * law.outer - h * h);
    double q = 0;
    constexpr int steps = 20000;
    for (int k = 0; k < steps; ++k) {
      const double s = reach * (k + 0.5) / steps, D = std::sqrt(h * h + s * s),
                   y = (D - law.core) / (law.outer - law.core);
      // the law's slope as its header gives phi, differentiated by hand
      const double slope =
          -law.stiffness * (law.outer - law.core) / law.exponent * (std::pow(y, -law.exponent) - 1);
      q += 2 * reach / steps * -slope * h / D;
    }
    const Fabric fabric = fabric_of({straight(24, 1, 1, {}), straight(24, 1, 1, {0, 0, h})});
    const YarnForces forces = yarn_forces(fabric, options);
    // away from the ends
    EXPECT_NEAR(forces.contact[middle(forces, 12)], q, 0.01 * q) << h;
    EXPECT_NEAR(forces.contact[middle(forces, 24 + 12)], q, 0.01 * q) << h;
  }
}

TEST(YarnForces, forces_from_both_sides_cancel_and_a_core_is_infinite) {
  const Fabric pinched =
      fabric_of({straight(24, 1, 1, {}), straight(24, 1, 1, {0, 0, 0.9}), straight(24, 1, 1, {0, 0, -0.9})});
  const YarnForces forces = yarn_forces(pinched, {});
  EXPECT_NEAR(forces.contact[middle(forces, 12)], 0, 1e-9);
  EXPECT_GT(forces.contact[middle(forces, 24 + 12)], 1);
  const YarnForces inside =
      yarn_forces(fabric_of({straight(8, 1, 1, {}), straight(8, 1, 1, {0, 0, 0.3})}), {});
  EXPECT_TRUE(std::isinf(inside.contact[middle(inside, 4)]));
}

}  // namespace
}  // namespace loopwright
