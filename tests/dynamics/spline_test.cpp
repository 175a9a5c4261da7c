// Blending functions, mass matrices, elastic energies: against closed forms, differences and src/mechanics.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "dynamics/spline_model.hpp"
#include "dynamics/yarn_energy.hpp"
#include "mechanics/energies/bend.hpp"
#include "mechanics/energies/stretch.hpp"

namespace loopwright {
namespace {

void expect_matrix(const BlendingMatrix& got, const BlendingMatrix& wanted, double over) {
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      EXPECT_NEAR(got[a][b], wanted[a][b] / over, 1e-15 * 1e3 / over + 1e-14) << a << ' ' << b;
}

// Closed per-segment matrices; they follow from the blending functions by integration (int h h, h'h',
// h''h'').
TEST(Blending, CatmullRomMatrices) {
  const Blending c = catmull_rom();
  expect_matrix(product_integrals(c, 0),
                {{{4, -47, -30, 3}, {-47, 680, 307, -30}, {-30, 307, 680, -47}, {3, -30, -47, 4}}}, 1680);
  expect_matrix(product_integrals(c, 1),
                {{{4, -7, 2, 1}, {-7, 136, -131, 2}, {2, -131, 136, -7}, {1, 2, -7, 4}}}, 120);
  expect_matrix(product_integrals(c, 2),
                {{{2, -5, 4, -1}, {-5, 14, -13, 4}, {4, -13, 14, -5}, {-1, 4, -5, 2}}}, 2);
}

TEST(Blending, UniformBSplineMatrices) {
  const Blending c = uniform_b_spline();
  expect_matrix(product_integrals(c, 0),
                {{{20, 129, 60, 1}, {129, 1188, 933, 60}, {60, 933, 1188, 129}, {1, 60, 129, 20}}}, 5040);
  expect_matrix(product_integrals(c, 1),
                {{{6, 7, -12, -1}, {7, 34, -29, -12}, {-12, -29, 34, 7}, {-1, -12, 7, 6}}}, 120);
  expect_matrix(product_integrals(c, 2), {{{2, -3, 0, 1}, {-3, 6, -3, 0}, {0, -3, 6, -3}, {1, 0, -3, 2}}}, 6);
}

TEST(Blending, CatmullRomWithAnyTension) {
  for (const double s : {0.0, 0.3, 0.5, 0.8, 1.0}) {
    const BlendingMatrix m = product_integrals(catmull_rom(s), 0);
    const double m00 = s * s / 105, m11 = 13.0 / 35 + 13 * s / 210 + s * s / 105,
                 m12 = 9.0 / 70 + 11 * s / 105 + s * s / 140, m01 = -11 * s / 210 - s * s / 140,
                 m02 = -13 * s / 420 - s * s / 105, m03 = s * s / 140;
    expect_matrix(
        m, {{{m00, m01, m02, m03}, {m01, m11, m12, m02}, {m02, m12, m11, m01}, {m03, m02, m01, m00}}}, 1);
  }
}

TEST(Blending, SumsAndWhatDerivativesTakeAway) {
  // a blending that is neither of the two: half way between them
  BlendingMatrix mixed{};
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t k = 0; k < 4; ++k)
      mixed[a][k] = 0.5 * (catmull_rom().coefficient[a][k] + uniform_b_spline().coefficient[a][k]);
  const std::array<Blending, 3> all{catmull_rom(0.7), uniform_b_spline(), blending_of(mixed)};
  for (std::size_t which = 0; which < 3; ++which) {
    const Blending& c = all[which];
    const BlendingMatrix m = product_integrals(c, 0), k1 = product_integrals(c, 1),
                         k2 = product_integrals(c, 2);
    double total = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      double one1 = 0, one2 = 0, linear2 = 0;
      for (std::size_t b = 0; b < 4; ++b) {
        total += m[a][b];
        one1 += k1[a][b];
        one2 += k2[a][b];
        linear2 += static_cast<double>(b) * k2[a][b];
      }
      EXPECT_NEAR(one1, 0, 1e-14);
      EXPECT_NEAR(one2, 0, 1e-14);
      // at tension 0.7 evenly spaced points do not make an even curve
      EXPECT_NEAR(linear2, 0, which == 0 ? 10 : 1e-14);
    }
    EXPECT_NEAR(total, 1, 1e-14);
  }
}

TEST(Blending, RefusesWeightsThatDoNotAddUp) {
  BlendingMatrix c = uniform_b_spline().coefficient;
  c[2][1] += 1e-3;
  EXPECT_THROW(blending_of(c), std::invalid_argument);
  c[2][1] = std::nan("");
  EXPECT_THROW(blending_of(c), std::invalid_argument);
  EXPECT_THROW(product_integrals(uniform_b_spline(), 3), std::invalid_argument);
}

SplineYarn yarn_of(const Blending& blending, const std::vector<Vec3>& points, double set, StretchLaw law) {
  SplineYarn yarn;
  yarn.blending = blending;
  yarn.points = static_cast<int>(points.size());
  yarn.stretch_stiffness = 40;
  yarn.spring_hardening = 3;
  yarn.bend_stiffness = 1.7;
  set_rest_shape(yarn, points, set, law);
  return yarn;
}

std::vector<Vec3> wavy(int n, double phase) {
  std::vector<Vec3> p;
  for (int i = 0; i < n; ++i) p.push_back({1.1 * i, std::sin(i + phase), 0.6 * std::cos(0.7 * i - phase)});
  return p;
}

TEST(Mass, PerLengthAddsUpToTheYarns) {
  const std::vector<Vec3> points = wavy(23, 0.3);
  for (const Blending& blending : {catmull_rom(0.5), uniform_b_spline()}) {
    SplineYarn yarn = yarn_of(blending, points, 0, StretchLaw::mean);
    set_mass_per_length(yarn, 2.5, points);
    const BandMatrix m = mass_matrix(yarn);
    double mass = 0, length = 0;
    for (std::size_t i = 0; i < m.size(); ++i)
      for (std::size_t j = 0; j < m.size(); ++j) mass += m(i, j);
    // length by many short chords
    SplineModel model;
    model.yarns = {yarn};
    Vec3 last = curve_point(model, points, 0, 0).place;
    for (int k = 1; k <= 20000; ++k) {
      const Vec3 next = curve_point(model, points, 0, 20.0 * k / 20000).place;
      length += distance(last, next);
      last = next;
    }
    EXPECT_NEAR(mass, 2.5 * length, 1e-4 * mass);  // 4-point Gauss of a speed that is no polynomial
  }
}

TEST(Mass, BandedFactorSolves) {
  const std::vector<Vec3> points = wavy(40, 1.3);
  SplineYarn yarn = yarn_of(uniform_b_spline(), points, 0, StretchLaw::mean);
  set_mass_per_length(yarn, 1, points);
  const BandMatrix m = mass_matrix(yarn);
  std::vector<Vec3> b(points.size());
  multiply(m, points, b);
  // against the full sum
  for (std::size_t i = 0; i < b.size(); ++i) {
    Vec3 sum;
    for (std::size_t j = 0; j < b.size(); ++j) sum += m(i, j) * points[j];
    EXPECT_LT(distance(sum, b[i]), 1e-13);
  }
  BandedCholesky(m).solve(b);
  for (std::size_t i = 0; i < b.size(); ++i) EXPECT_LT(distance(b[i], points[i]), 1e-10);
  BandMatrix massless(6);
  EXPECT_THROW(BandedCholesky{massless}, std::invalid_argument);
}

// Gradient and Hessian of every law and blending against central differences.
TEST(YarnEnergy, Derivatives) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  for (const StretchLaw law : {StretchLaw::springs, StretchLaw::green, StretchLaw::mean})
    for (const double set : {0.0, 0.8})
      for (const Blending& blending : {uniform_b_spline(), catmull_rom(0.4)}) {
        const std::vector<Vec3> rest = wavy(7, 0.2);
        SplineModel model;
        model.law = law;
        model.yarns = {yarn_of(blending, rest, set, law)};
        model.points = 7;
        std::vector<Vec3> q = rest;
        for (Vec3& p : q) p += Vec3{noise(random), noise(random), noise(random)};
        std::vector<Vec3> g(7);
        BandHessian band(7);
        elastic_energy(model, q, g, &band);
        constexpr double h = 1e-5;
        for (std::size_t i = 0; i < 7; ++i)
          for (int c = 0; c < 3; ++c) {
            std::vector<Vec3> more = q, less = q, g_more(7), g_less(7);
            more[i][c] += h;
            less[i][c] -= h;
            const double up = elastic_energy(model, more, g_more).total(),
                         down = elastic_energy(model, less, g_less).total();
            EXPECT_NEAR(g[i][c], (up - down) / (2 * h), 2e-6 * (1 + std::abs(g[i][c])));
            for (std::size_t j = i; j < 7; ++j)
              for (int e = 0; e < 3; ++e) {
                const double slope = (g_more[j][e] - g_less[j][e]) / (2 * h);
                const double entry =
                    j - i > 3 ? 0 : band[j][3 - (j - i)][static_cast<std::size_t>(3 * e + c)];
                EXPECT_NEAR(entry, slope, 1e-4 * (1 + std::abs(slope)))
                    << static_cast<int>(law) << ' ' << set << ' ' << i << ' ' << j;
              }
          }
      }
}

TEST(YarnEnergy, AgreesWithMechanicsOnUniformBSplines) {
  const std::vector<Vec3> q = wavy(4, 0.9);
  SplineModel model;
  model.yarns = {yarn_of(uniform_b_spline(), q, 0, StretchLaw::mean)};
  model.yarns[0].rest_length[0] *= 0.9;
  model.yarns[0].evenness = Stretch{}.evenness;
  model.points = 4;
  std::vector<Vec3> g(4);
  BandHessian band(4);
  const ElasticEnergy energy = elastic_energy(model, q, g, &band);
  SegmentDofs x;
  for (std::size_t k = 0; k < 12; ++k) x[k] = q[k / 3][static_cast<int>(k % 3)];
  const LocalTerm<12> stretch = Stretch{40, model.yarns[0].rest_length[0]}.evaluate(x),
                      bend = Bend{1.7, model.yarns[0].rest_length[0]}.evaluate(x);
  EXPECT_NEAR(energy.stretch, stretch.energy, 1e-13);
  EXPECT_NEAR(energy.bend, bend.energy, 1e-13);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_NEAR(g[k / 3][static_cast<int>(k % 3)], stretch.gradient[k] + bend.gradient[k], 1e-12);
    for (std::size_t l = 0; l <= k; ++l) {
      if (k / 3 == l / 3 && l % 3 > k % 3) continue;
      EXPECT_NEAR(band[k / 3][3 - (k / 3 - l / 3)][3 * (k % 3) + l % 3],
                  stretch.hessian[k][l] + bend.hessian[k][l], 1e-11);
    }
  }
}

TEST(YarnEnergy, KeepsItsNaturalShape) {
  const std::vector<Vec3> q = wavy(12, 0.4);
  for (const StretchLaw law : {StretchLaw::springs, StretchLaw::green, StretchLaw::mean}) {
    SplineModel model;
    model.law = law;
    model.yarns = {yarn_of(catmull_rom(), q, 1, law)};
    model.yarns[0].evenness = 0;  // the rest shape's own speed is uneven
    model.points = 12;
    std::vector<Vec3> g(12);
    const double energy = elastic_energy(model, q, g).total();
    EXPECT_NEAR(energy, 0, 1e-12);
  }
}

// Springs: T = EA (e + hardening e^3) between two points drawn apart.
TEST(YarnEnergy, NonLinearSprings) {
  std::vector<Vec3> q{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  SplineModel model;
  model.law = StretchLaw::springs;
  model.yarns = {yarn_of(catmull_rom(), q, 0, StretchLaw::springs)};
  model.points = 4;
  for (Vec3& p : q) p.x *= 1.2;
  std::vector<Vec3> g(4);
  EXPECT_NEAR(elastic_energy(model, q, g).stretch, 3 * 40 * (0.5 * 0.04 + 0.25 * 3 * 0.0016), 1e-12);
  EXPECT_NEAR(g[3].x, 40 * (0.2 + 3 * 0.008), 1e-12);
}

// Straight, evenly spaced B-spline: the linear bend energy is the exact one to second order in the
// deflection.
TEST(YarnEnergy, LinearBendIsTheLimitOfTheExactOne) {
  for (const double size : {1e-2, 1e-3}) {
    std::vector<Vec3> q, g(20);
    for (int i = 0; i < 20; ++i) q.push_back({0.8 * i, size * std::sin(0.5 * i), 0});
    SplineModel model;
    std::vector<Vec3> straight = q;
    for (Vec3& p : straight) p.y = 0;
    model.yarns = {yarn_of(uniform_b_spline(), straight, 0, StretchLaw::mean)};
    model.points = 20;
    const double exact = elastic_energy(model, q, g).bend;
    std::vector<Vec3> kq(20);
    multiply(linear_bend_matrix(model.yarns[0]), q, kq);
    double linear = 0;
    for (std::size_t i = 0; i < 20; ++i) linear += 0.5 * dot(q[i], kq[i]);
    EXPECT_NEAR(linear / exact, 1, 10 * size * size);
  }
}

}  // namespace
}  // namespace loopwright
