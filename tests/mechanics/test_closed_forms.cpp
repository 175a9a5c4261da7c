// Energies and shapes that are known without this program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "mechanics/fabrics.hpp"
#include "mechanics/newton.hpp"

namespace loopwright {
namespace {

using std::numbers::pi;

ModelOptions plain_options(double sample_spacing = ModelOptions{}.sample_spacing) {
  ModelOptions options = frictionless().model;
  options.sample_spacing = sample_spacing;
  return options;
}

EnergyParts energy_of(const Fabric& fabric, const ModelOptions& options) {
  const YarnModel model = build_yarn_model(fabric, options);
  const YarnState state = build_yarn_state(fabric);
  Assembly assembly(model);
  assembly.update_pairs(state, 1.6);
  return assembly.energy(state);
}

// Control points of a closed uniform cubic B-spline on a circle: they lie outside it by (2 + cos(2 pi / n))
// / 3.
FabricYarn ring(double radius, int count) {
  const double outside = radius * 3 / (2 + std::cos(2 * pi / count));
  FabricYarn yarn = free_yarn(count, 2 * pi * radius / count, [&](int i) {
    return Vec3{outside * std::cos(2 * pi * i / count), outside * std::sin(2 * pi * i / count), 0};
  });
  yarn.periodic = true;
  return yarn;
}

TEST(ClosedForms, RingBendEnergy) {
  for (const double radius : {1.5, 3.0, 8.0}) {
    double last_error = 1;
    for (const int count : {8, 16, 32, 64}) {
      Fabric fabric = fabric_of({ring(radius, count)});
      fabric.periodic = true;
      fabric.width = fabric.height = 100;
      const double error = std::abs(energy_of(fabric, plain_options(0.5)).bend - pi / radius) * radius / pi;
      // A cubic spline's curvature is right to second order.
      EXPECT_LT(error, 2.2 * std::pow(count / 4.0, -2));
      EXPECT_LT(error, 0.3 * last_error);
      last_error = error;
    }
    EXPECT_LT(last_error, 2e-3);
  }
}

TEST(ClosedForms, StraightYarnStretched) {
  for (const double strain : {-0.02, 0.01, 0.3}) {
    const Fabric fabric = fabric_of({free_yarn(13, 1.4, [&](int i) {
      return Vec3{0.36, 0.48, 0.8} * (1.4 * i * (1 + strain));
    })});
    const EnergyParts e = energy_of(fabric, plain_options());
    EXPECT_NEAR(e.stretch, 0.5 * 3000 * strain * strain * 10 * 1.4, 1e-9);
    EXPECT_NEAR(e.bend, 0, 1e-20);
    EXPECT_EQ(e.contact, 0);
  }
}

// Stiffnesses of a yarn of another thickness go with its section.
TEST(ClosedForms, ThinnerYarnIsSofter) {
  FabricYarn yarn = free_yarn(13, 1.4, [](int i) { return Vec3{1.5 * i, 0.02 * i * i, 0}; });
  const EnergyParts whole = energy_of(fabric_of({yarn}), plain_options());
  yarn.diameter = 0.5;
  const EnergyParts half = energy_of(fabric_of({yarn}), plain_options());
  EXPECT_NEAR(half.stretch, whole.stretch / 4, 1e-12 * whole.stretch);
  EXPECT_NEAR(half.bend, whole.bend / 4, 1e-12 * whole.bend);
}

TEST(ContactLawForms, SlopeAndCurvatureAreThoseOfTheEnergy) {
  for (const double p : {1.5, 2.4, 4.0}) {
    const ContactLaw law{1.1, 0.4, 250, p};
    for (double D = 0.5; D < 1.09; D += 0.03) {
      constexpr double h = 1e-5;
      EXPECT_NEAR(law(D).slope, (law(D + h).energy - law(D - h).energy) / (2 * h), 1e-6 * law(0.5).curvature);
      EXPECT_NEAR(law(D).curvature, (law(D + h).slope - law(D - h).slope) / (2 * h),
                  1e-6 * law(0.5).curvature);
      EXPECT_GT(law(D).energy, 0);
      EXPECT_LT(law(D).slope, 0) << "yarns push apart";
    }
  }
}

TEST(ContactLawForms, BeginsAsAParabolaAndEndsAtTheCore) {
  const ContactLaw law{1, 0.5, 400, 2.4};
  for (const double overlap : {1e-3, 1e-4, 1e-5}) {
    const ContactLaw::Value v = law(1 - overlap);
    EXPECT_NEAR(v.energy / (0.5 * 400 * overlap * overlap), 1, 3 * overlap + 1e-5);
    EXPECT_NEAR(v.slope / (-400 * overlap), 1, 6 * overlap);
    EXPECT_NEAR(v.curvature / 400, 1, 8 * overlap);
  }
  EXPECT_GT(law(0.5 + 1e-6).energy, 1e8) << "y^(1 - p) grows without bound";
  EXPECT_EQ(law(0.5).energy, std::numeric_limits<double>::infinity());
  EXPECT_EQ(law(0.3).energy, std::numeric_limits<double>::infinity());
  // By hand: y = 1/2, p = 2, W = 1/2: k W^2 / 2 [2 - 1 - 1/2] = k / 16.
  EXPECT_NEAR((ContactLaw{1, 0.5, 400, 2.0}(0.75).energy), 25, 1e-12);
}

TEST(ContactLawForms, ThickerYarnsMeetEarlier) {
  const ContactLaw law{1, 0.5, 400, 2.4};
  // The same share of the shell: a density per both lengths, k W^2, grows with the square.
  EXPECT_NEAR(law.scaled(0.7)(0.7 * 0.8).energy, 0.49 * law(0.8).energy, 1e-12);
  EXPECT_NEAR(law.scaled(0.7)(0.7 * 0.8).slope, 0.7 * law(0.8).slope, 1e-12);
}

// Two straight yarns crossing at an angle at distance z: phi depends on their points' distance alone, so in
// the plane of (s, t) the double integral is 2 pi / sin(angle) int phi(sqrt(z^2 + r^2)) r dr = 2 pi /
// sin(angle) int_z^Do phi(D) D dD.
double crossing_energy(const ContactLaw& law, double z, double angle) {
  constexpr int parts = 20000;
  double sum = 0;
  const double h = (law.outer - z) / parts;
  for (int i = 0; i < parts; ++i) {
    const double D = z + (i + 0.5) * h;
    sum += law(D).energy * D * h;
  }
  return 2 * pi / std::sin(angle) * sum;
}

Fabric crossing_yarns(double z, double angle) {
  // Off centre by odd amounts, so that no symmetry of the samples helps.
  return fabric_of({free_yarn(9, 1.4,
                              [](int i) {
                                return Vec3{1.4 * (i - 4) + 0.317, 0, 0};
                              }),
                    free_yarn(9, 1.4, [&](int i) {
                      const double s = 1.4 * (i - 4) - 0.231;
                      return Vec3{s * std::cos(angle), s * std::sin(angle), z};
                    })});
}

TEST(ClosedForms, CrossedYarnsByQuadrature) {
  const ContactLaw law = frictionless().model.material.contact;
  for (const double angle : {pi / 2, 1.0, 0.5})
    for (const double z : {0.65, 0.8, 0.95}) {
      const double exact = crossing_energy(law, z, angle);
      SCOPED_TRACE(testing::Message() << "angle " << angle << " distance " << z << " energy " << exact);
      // The disc of contact has radius sqrt(1 - z^2): 0.31 d at the least, so 0.18 d sees it with few
      // samples.
      EXPECT_NEAR(energy_of(crossing_yarns(z, angle), plain_options(0.18)).contact, exact, 0.06 * exact);
      EXPECT_NEAR(energy_of(crossing_yarns(z, angle), plain_options(0.12)).contact, exact, 0.012 * exact);
      EXPECT_NEAR(energy_of(crossing_yarns(z, angle), plain_options(0.06)).contact, exact, 0.003 * exact);
    }
}

// Side by side: phi depends on the offset along the yarn, and every sample meets its neighbours in full.
TEST(ClosedForms, ParallelYarnsPerLength) {
  const ContactLaw law = frictionless().model.material.contact;
  const double z = 0.8, reach = std::sqrt(1 - z * z);
  double density = 0;
  constexpr int parts = 20000;
  for (int i = 0; i < parts; ++i)
    density += law(std::hypot(z, (2 * (i + 0.5) / parts - 1) * reach)).energy * 2 * reach / parts;
  const auto pair_of = [&](int count) {
    return fabric_of({free_yarn(count, 1.4,
                                [](int i) {
                                  return Vec3{1.4 * i, 0, 0};
                                }),
                      free_yarn(count, 1.4, [&](int i) {
                        return Vec3{1.4 * i + 0.33, 0, z};
                      })});
  };
  // Difference of two lengths: the ends drop out.
  const double per_length = (energy_of(pair_of(23), plain_options(0.1)).contact -
                             energy_of(pair_of(13), plain_options(0.1)).contact) /
                            14;
  EXPECT_NEAR(per_length, density, 0.005 * density);
}

TEST(ClosedForms, PlatesPressStraightYarn) {
  const Fabric fabric = fabric_of({free_yarn(8, 1.4, [](int i) { return Vec3{1.4 * i, 0, 0.3}; })});
  ModelOptions options = plain_options();
  options.plates = {50, -1, 0.1};
  EXPECT_NEAR(energy_of(fabric, options).plates, 0.5 * 50 * 0.04 * 5 * 1.4, 1e-12);
  options.plates = {50, 0.35, 1};
  EXPECT_NEAR(energy_of(fabric, options).plates, 0.5 * 50 * 0.0025 * 5 * 1.4, 1e-12);
  options.plates = {50, -1, 1};
  EXPECT_EQ(energy_of(fabric, options).plates, 0);
}

// The clamped elastica of length L with its ends L - shortening apart, ends parallel: B theta'' = -P
// sin(theta) along arc s with theta = 0 at both ends and no force across. A quarter of it, theta(0) = 0 to
// theta'(L/4) = 0, repeats four times; its energy is 4 times that of the quarter. Solved by shooting:
// classical Runge-Kutta, bisection for theta'(0) and P.
struct Elastica {
  double bend_energy = 0, height = 0;
};

Elastica clamped_elastica(double length, double span) {
  constexpr int steps = 400;
  const double h = length / 4 / steps;
  struct End {
    double angle, slope, x, y, energy;
  };
  const auto shoot = [&](double P, double slope) {
    using State = std::array<double, 5>;  // theta, theta', x, y, energy
    State s{0, slope, 0, 0, 0};
    const auto rate = [&](const State& v) {
      return State{v[1], -P * std::sin(v[0]), std::cos(v[0]), std::sin(v[0]), 0.5 * v[1] * v[1]};
    };
    const auto plus = [](State a, double f, const State& b) {
      for (std::size_t k = 0; k < 5; ++k) a[k] += f * b[k];
      return a;
    };
    for (int i = 0; i < steps; ++i) {
      const State a = rate(s), b = rate(plus(s, h / 2, a)), c = rate(plus(s, h / 2, b)),
                  d = rate(plus(s, h, c));
      for (std::size_t k = 0; k < 5; ++k) s[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
    return End{s[0], s[1], s[2], s[3], s[4]};
  };
  const auto quarter = [&](double slope) {  // P such that the quarter ends without curvature
    double low = 0, high = 400 / (length * length);
    for (int i = 0; i < 80; ++i) (shoot((low + high) / 2, slope).slope > 0 ? low : high) = (low + high) / 2;
    return shoot((low + high) / 2, slope);
  };
  double low = 1e-6, high = 40 / length;
  for (int i = 0; i < 80; ++i) (4 * quarter((low + high) / 2).x > span ? low : high) = (low + high) / 2;
  const End end = quarter((low + high) / 2);
  return {4 * end.energy, 2 * end.y};
}

// One wave of a periodic yarn is the clamped elastica, without ends that a spline would have to hold.
TEST(ClosedForms, BuckledYarnIsTheElastica) {
  constexpr int segments = 30;
  constexpr double h = 1.4, length = segments * h;
  for (const double shortening : {0.1, 0.25, 0.4}) {
    const double span = length * (1 - shortening);
    FabricYarn yarn = free_yarn(segments, h, [&](int i) {
      return Vec3{span * i / segments, 0.1 * length * std::cos(2 * pi * i / segments), 0};
    });
    yarn.periodic = true;
    yarn.shift = {1, 0};
    Fabric fabric = fabric_of({yarn});
    fabric.periodic = true;
    fabric.width = span;
    fabric.height = 60;
    RelaxOptions options = frictionless();
    options.model.free = {false, false, false};
    const RelaxResult result = relax(fabric, options);
    ASSERT_TRUE(result.converged) << result.message;
    EXPECT_EQ(result.fabric.width, span);
    const Elastica elastica = clamped_elastica(length, span);
    double low = 1e9, high = -1e9;
    for (const Vec3& p : polyline(result.fabric, result.fabric.yarns[0], 20)) {
      low = std::min(low, p.y);
      high = std::max(high, p.y);
      EXPECT_NEAR(p.z, 0, 1e-6);
    }
    EXPECT_NEAR(result.energy.bend, elastica.bend_energy, 0.005 * elastica.bend_energy);
    EXPECT_NEAR(high - low, elastica.height, 0.002 * elastica.height);
  }
}

}  // namespace
}  // namespace loopwright
