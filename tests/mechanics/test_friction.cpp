// Friction: one contact, and a cloth that stays where it was put.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mechanics/energies/friction.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

Friction contact_of(double load) {
  Friction f;
  f.load = load;
  f.softness = 0.02;
  f.normal = {0, 0, 1};
  f.weight_a = f.weight_b = {0.25, 0.25, 0.25, 0.25};
  return f;
}

TEST(FrictionContact, NeverAboveItsLoadAndThereOnceItSlides) {
  const Friction f = contact_of(3);
  double last = 0;
  for (double slip = 0; slip < 0.1; slip += 0.0005) {
    const double force = norm(f.force({slip * 0.6, slip * 0.8, 0.7}));
    EXPECT_LE(force, 3 * (1 + 1e-12));
    EXPECT_GE(force, last - 1e-12) << "the force must not fall while the slip grows";
    last = force;
    if (slip >= 0.02) {
      EXPECT_NEAR(force, 3, 1e-12);
    }
    if (slip > 0 && slip < 0.0195) {
      EXPECT_LT(force, 3);
    }
  }
  EXPECT_EQ(f.force({0, 0, 5}), Vec3{}) << "motion along the normal is not slip";
  // It pulls back along the slip: the gradient is along it.
  EXPECT_GT(f.force({0.05, 0, 0}).x, 0);
}

TEST(FrictionContact, SpringOfKnownStiffnessWhileItSticks) {
  const Friction f = contact_of(3);
  EXPECT_NEAR(norm(f.force({1e-7, 0, 0})) / 1e-7, 2 * 3 / 0.02, 0.01);
  // At half the softness 2 y - y^2 = 3/4 of the load.
  EXPECT_NEAR(norm(f.force({0.01, 0, 0})), 0.75 * 3, 1e-12);
}

// Steps of a contact dragged along x: its history is carried on, as the assembly does after each accepted
// step.
struct Dragged {
  Friction law;
  double x = 0, work = 0;
  double force_after(double to) {
    law.start = {x, 0, 0};
    const double before = law.force({x, 0, 0}).x;
    law.slip = law.slip_after({to, 0, 0});
    law.start = {to, 0, 0};
    const double after = law.force({to, 0, 0}).x;
    work += 0.5 * (before + after) * (to - x);
    x = to;
    return after;
  }
};

TEST(FrictionContact, HistoryGivesALoopOfWork) {
  Dragged contact{contact_of(2), 0, 0};
  for (int i = 1; i <= 100; ++i) contact.force_after(0.002 * i);
  EXPECT_NEAR(contact.force_after(0.2), 2, 1e-12);
  EXPECT_NEAR(norm(contact.law.slip), 0.02, 1e-12) << "the anchor is dragged along";
  const double there = contact.work;
  // Back by one softness: the spring is slack. By two: it pulls the other way at full load.
  for (int i = 1; i <= 10; ++i) contact.force_after(0.2 - 0.002 * i);
  EXPECT_NEAR(contact.force_after(0.18), 0, 1e-9);
  for (int i = 1; i <= 100; ++i) contact.force_after(0.18 - 0.0018 * i);
  EXPECT_NEAR(contact.force_after(0), -2, 1e-12);
  // Both ways cost about load times way (less the soft starts), so nothing like an elastic energy comes back.
  EXPECT_GT(there, 0.9 * 2 * 0.2);
  EXPECT_GT(contact.work, 1.75 * 2 * 0.2);
}

TEST(FrictionContact, SmallMotionThereAndBackCostsNothing) {
  Dragged contact{contact_of(2), 0, 0};
  for (int i = 1; i <= 200; ++i) contact.force_after(0.015 * i / 200);
  EXPECT_GT(contact.work, 0);
  for (int i = 1; i <= 200; ++i) contact.force_after(0.015 * (200 - i) / 200);
  EXPECT_NEAR(contact.work, 0, 1e-5);
  EXPECT_NEAR(norm(contact.law.slip), 0, 1e-12);
}

TEST(FrictionContact, EnergyIsConvexAndNotNegativeWithoutHistory) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-0.06, 0.06);
  Friction f = contact_of(4);
  f.normal = normalized({0.3, -0.5, 0.8});
  f.slip = f.tangential({0.01, 0.008, 0});
  f.start = {0.4, -0.2, 0.9};
  EXPECT_NEAR(f.energy(f.start), 0, 1e-15);
  for (int repeat = 0; repeat < 2000; ++repeat) {
    const Vec3 a = f.start + Vec3{any(random), any(random), any(random)},
               b = f.start + Vec3{any(random), any(random), any(random)};
    for (const double s : {0.25, 0.5, 0.75})
      EXPECT_LE(f.energy((1 - s) * a + s * b), (1 - s) * f.energy(a) + s * f.energy(b) + 1e-14);
    // Its Hessian along any direction, too.
    const auto k = f.stiffness(a);
    const Vec3 d = b - a;
    EXPECT_GE(d.x * (k[0] * d.x + k[1] * d.y + k[2] * d.z) + d.y * (k[1] * d.x + k[3] * d.y + k[4] * d.z) +
                  d.z * (k[2] * d.x + k[4] * d.y + k[5] * d.z),
              -1e-10);
  }
  f.slip = {};
  for (int repeat = 0; repeat < 200; ++repeat)
    EXPECT_GE(f.energy(f.start + Vec3{any(random), any(random), any(random)}), 0);
}

// A knit with friction has a continuum of rest shapes (Crassous, Poincloux and Steinberger, Phys. Rev. Lett.
// 133, 2024): a cell let go when too wide stays wider than one let go when too long. Without friction both
// come to the same shape.
double aspect_from(double wider, double friction) {
  RelaxOptions options = frictionless();
  Fabric cell = relax(knitted("g", "periodic", ""), options).fabric;
  // Held at another width until it has come to rest there, then let go.
  for (FabricYarn& yarn : cell.yarns)
    for (Vec3& p : yarn.control_points) p.x *= wider;
  cell.width *= wider;
  options.grow_in = false;
  options.model.free.width = false;
  const RelaxResult stretched = relax(cell, options);
  EXPECT_TRUE(stretched.converged) << stretched.message;
  EXPECT_EQ(stretched.fabric.width, cell.width);
  options.model.free.width = true;
  options.model.material.friction = friction;
  const RelaxResult result = relax(stretched.fabric, options);
  EXPECT_TRUE(result.converged) << "friction " << friction << ": " << result.message;
  return result.fabric.width / result.fabric.height;
}

TEST(FrictionCloth, RestShapeDependsOnThePast) {
  const double free_wide = aspect_from(1.1, 0), free_long = aspect_from(1 / 1.1, 0);
  EXPECT_NEAR(free_wide, free_long, 2e-3 * free_wide);
  double last = 0.005;
  for (const double friction : {0.05, 0.15, 0.4}) {
    const double apart = (aspect_from(1.1, friction) - aspect_from(1 / 1.1, friction)) / free_wide;
    std::printf("friction %.2f: aspects differ by %.2f %%\n", friction, 100 * apart);
    EXPECT_GT(apart, last);
    last = apart;
  }
}

}  // namespace
}  // namespace loopwright
