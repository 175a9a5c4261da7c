// What is evaluated for several segments, contacts or boxes at once, against the same one by one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "mechanics/fabrics.hpp"
#include "mechanics/segment_lanes.hpp"

namespace loopwright {
namespace {

using Generator = std::mt19937_64;

double uniform(Generator& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

TEST(Lanes, LogarithmAndExponentialAreThoseOfTheLibrary) {
  Generator random(5);
  Lanes result;
  logarithm(Lanes{} + 1.0, result);
  EXPECT_EQ(result[0], 0);
  for (int repeat = 0; repeat < 20000; ++repeat) {
    const double decades = repeat % 2 == 0 ? 0.3 : 600;
    const Lanes x{std::exp(uniform(random, -decades, decades)), 1 - 1e-9 * uniform(random, 0, 1),
                  uniform(random, 0.5, 2), uniform(random, 0, 1)};
    logarithm(x, result);
    for (std::size_t l = 0; l < lanes; ++l)
      ASSERT_NEAR(result[l], std::log(x[l]), 1e-15 * std::abs(std::log(x[l])) + 1e-30) << x[l];
    const Lanes power{uniform(random, -700, 700), uniform(random, -1, 1), uniform(random, -1e-9, 1e-9), 0};
    exponential(power, result);
    for (std::size_t l = 0; l < lanes; ++l) ASSERT_NEAR(result[l] / std::exp(power[l]), 1, 1e-15) << power[l];
    EXPECT_EQ(result[3], 1);
  }
}

// Control points of a bent segment of about length 1.4.
SegmentDofs segment(Generator& random) {
  SegmentDofs x;
  for (std::size_t k = 0; k < 4; ++k) {
    x[3 * k] = 1.3 * static_cast<double>(k) + uniform(random, -0.2, 0.2);
    x[3 * k + 1] = (k == 1 ? 0.5 : 0) + uniform(random, -0.2, 0.2);
    x[3 * k + 2] = uniform(random, -0.2, 0.2);
  }
  return x;
}

// A 3 x 3 block times M = [[xi, 0, eta], [0, eta, 0], [0, 0, 0]], added.
void add_times_measures(const std::array<std::array<double, 3>, 3>& h, double xi, double eta,
                        std::array<double, 9>& to) {
  for (std::size_t r = 0; r < 3; ++r) {
    to[3 * r] += h[r][0] * xi;
    to[3 * r + 1] += h[r][1] * eta;
    to[3 * r + 2] += h[r][0] * eta;
  }
}

void check_segments(bool set, Generator& random) {
  SegmentLanes in;
  std::array<SegmentDofs, lanes> x;
  std::array<std::array<double, 4>, lanes> natural{};
  in.set = set;
  in.stretch.evenness = Stretch{}.evenness;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    x[lane] = segment(random);
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t c = 0; c < 3; ++c) in.points[k][c][lane] = x[lane][3 * k + c];
      for (std::size_t c = 0; c < 2; ++c) in.fractions[k][c][lane] = uniform(random, -2, 2);
    }
    in.stretch.stiffness[lane] = uniform(random, 500, 3000);
    in.stretch.rest_length[lane] = uniform(random, 1.2, 1.4);
    in.bend.stiffness[lane] = uniform(random, 0.5, 2);
    in.bend.rest_length[lane] = uniform(random, 1.2, 1.4);
    // straight at some points, set at others
    for (std::size_t g = 0; g < 4; ++g) natural[lane][g] = set && g != lane ? uniform(random, 0, 1) : 0;
    for (std::size_t g = 0; g < 4; ++g) in.natural_curvature[g][lane] = natural[lane][g];
  }
  SegmentLanesTerm out;
  evaluate(in, out);
  Lanes stretch_energy, bend_energy;
  energies(in, stretch_energy, bend_energy);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const Stretch stretch{in.stretch.stiffness[lane], in.stretch.rest_length[lane]};
    const Bend bend{in.bend.stiffness[lane], in.bend.rest_length[lane], set ? &natural[lane] : nullptr};
    const LocalTerm<12> s = stretch.evaluate(x[lane]), b = bend.evaluate(x[lane]);
    EXPECT_NEAR(out.stretch[lane], s.energy, 1e-12 * s.energy);
    EXPECT_NEAR(out.bend[lane], b.energy, 1e-12 * b.energy);
    EXPECT_EQ(stretch_energy[lane], out.stretch[lane]);
    EXPECT_EQ(bend_energy[lane], out.bend[lane]);
    const double scale = in.stretch.stiffness[lane];
    std::array<std::array<double, 9>, 4> border{};
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = 0; l < 4; ++l) {
        std::array<std::array<double, 3>, 3> h;
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t e = 0; e < 3; ++e) {
            h[c][e] = s.hessian[3 * k + c][3 * l + e] + b.hessian[3 * k + c][3 * l + e];
            if (k <= l) {
              EXPECT_NEAR(out.blocks[lane][block_of_points[k][l]][3 * c + e], h[c][e], 1e-12 * scale);
            }
          }
        add_times_measures(h, in.fractions[l][0][lane], in.fractions[l][1][lane], border[k]);
      }
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(out.gradient[k][c][lane], s.gradient[3 * k + c] + b.gradient[3 * k + c], 1e-12 * scale);
      for (std::size_t c = 0; c < 9; ++c)
        EXPECT_NEAR(out.border[lane][k][c], border[k][c], 1e-11 * scale)
            << "entry " << c << " of point " << k;
    }
  }
}

TEST(Lanes, SegmentsAreTheElements) {
  Generator random(11);
  for (const bool set : {false, true})
    for (int repeat = 0; repeat < 20 && !testing::Test::HasFailure(); ++repeat) check_segments(set, random);
}

// Any number of samples, not only multiples of the lanes: the plain double sum of the law.
TEST(Lanes, ContactIsTheSumOverPairsOfSamples) {
  Generator random(3);
  const ContactLaw law{1, 0.45, 200, 2.2};
  for (const int samples : {2, 5, 8, 11, 36}) {
    const auto n = static_cast<std::size_t>(samples);
    std::array<std::array<double, most_contact_samples>, 6> p{};
    const double angle = uniform(random, 0.2, 1.4);
    for (std::size_t i = 0; i < n; ++i) {
      const double along = 1.4 * ((static_cast<double>(i) + 0.5) / samples - 0.5);
      p[0][i] = along;
      p[3][i] = along * std::cos(angle);
      p[4][i] = along * std::sin(angle) + 5;  // taken back by the image
      p[5][i] = 0.7 + 0.1 * along;
    }
    ContactPairInput in{{p[0].data(), p[1].data(), p[2].data()}, {p[3].data(), p[4].data(), p[5].data()}};
    in.image = {0, -5, 0};
    in.count = samples;
    in.weight = 0.03;
    for (const double excluded : {0.0, 1.0}) {
      in.arc_offset = 0.9;
      in.spacing = 1.4 / samples;
      in.excluded = excluded;
      double energy = 0;
      Vec3 push;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
          const double arc = in.arc_offset + (static_cast<double>(j) - static_cast<double>(i)) * in.spacing;
          const Vec3 apart{p[0][i] - p[3][j], p[1][i] - (p[4][j] - 5), p[2][i] - p[5][j]};
          const double D = norm(apart);
          if (D >= law.outer || std::abs(arc) < excluded) continue;
          energy += in.weight * law(D).energy;
          push += in.weight * law(D).slope / D * apart;
        }
      SCOPED_TRACE(samples);
      ASSERT_GT(energy, 0);
      ContactTerm term;
      evaluate(in, law, sample_weights(samples), term);
      ASSERT_TRUE(term.active);
      EXPECT_NEAR(contact_energy(in, law), energy, 1e-12 * energy);
      EXPECT_NEAR(term.energy, energy, 1e-12 * energy);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(term.push[static_cast<std::size_t>(c)], push[c], 1e-12 * norm(push));
    }
  }
}

// Near pairs and their distances against all pairs of all samples of nearby images.
TEST(Lanes, NearPairsAreThoseOfAllSamples) {
  const Fabric cell = relax(knitted("ge\neg", "periodic", ""), frictionless()).fabric;
  for (const double spacing : {0.12, 0.25}) {  // 12 and 6 samples a segment
    ModelOptions options = frictionless().model;
    options.sample_spacing = spacing;
    const YarnModel model = build_yarn_model(cell, options);
    const YarnState state = build_yarn_state(cell);
    constexpr double range = 1.5;
    SamplePlaces p;
    const std::vector<SegmentPair> pairs = pairs_within(model, state, range, p);
    ASSERT_GT(pairs.size(), 20u);
    const auto n = static_cast<std::size_t>(model.samples);
    const auto nearest2 = [&](const SegmentPair& pair) {
      double least = range * range;
      const Vec3 image = state.lattice(pair.m, pair.n);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
          const double arc = pair.arc_offset + (static_cast<double>(j) - static_cast<double>(i)) *
                                                   model.yarns[0].rest_length / model.samples;
          if (pair.same_yarn && std::abs(arc) < model.excluded) continue;
          const std::size_t a = static_cast<std::size_t>(pair.a) * n + i,
                            b = static_cast<std::size_t>(pair.b) * n + j;
          least = std::min(least,
                           squared_norm(Vec3{p.x[a], p.y[a], p.z[a]} - Vec3{p.x[b], p.y[b], p.z[b]} - image));
        }
      return least;
    };
    std::size_t found = 0;
    for (const SegmentPair& pair : pairs) EXPECT_NEAR(pair.distance2, nearest2(pair), 1e-12);
    // Pairs of different yarns: all of them, images included.
    for (int a = 0; a < model.segments; ++a)
      for (int b = 0; b < model.segments; ++b)
        for (int m = -3; m <= 3; ++m)
          for (int k = -3; k <= 3; ++k) {
            SegmentPair pair{a, b, static_cast<std::int8_t>(m), static_cast<std::int8_t>(k)};
            const auto yarn = [&](int e) { return model.yarn_of_segment[static_cast<std::size_t>(e)]; };
            if (yarn(a) != yarn(b) && nearest2(pair) < range * range) ++found;
          }
    std::size_t listed = 0;
    for (const SegmentPair& pair : pairs)
      listed += model.yarn_of_segment[static_cast<std::size_t>(pair.a)] !=
                        model.yarn_of_segment[static_cast<std::size_t>(pair.b)]
                    ? 2
                    : 0;
    EXPECT_EQ(found, listed) << "each pair is found from either side";
  }
}

}  // namespace
}  // namespace loopwright
