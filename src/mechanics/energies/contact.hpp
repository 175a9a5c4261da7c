// Contact of two spline segments a and b, sampled at midpoints of equal parts:
//   U = sum_ij w_a w_b phi(|p_a(u_i) - p_b(u_j)|),   w = rest length of a sample's part
// With phi per length of both yarns (laws/contact_law.hpp) this is the midpoint rule for the double integral.
// Geometry (distances) knows no stiffness, the law knows no geometry, and nothing is allocated.
//
// Cost per pair of segments with n samples each: n distances from the box round b's samples (12 flops); n
// squared distances (8 flops) for each sample of a that is near it; and for each pair of samples in contact
// about 90 flops for the law, and as many for force and Hessian, several pairs at once (energies/lanes.hpp).
// Hessians of one side are summed by sample and taken to control points once.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/wide.hpp"
#include "mechanics/energies/energy.hpp"
#include "mechanics/energies/lanes.hpp"
#include "mechanics/laws/contact_law.hpp"

namespace loopwright {

inline constexpr int most_contact_samples = 36;  // per segment

// A symmetric 3 x 3 matrix: xx, xy, xz, yy, yz, zz.
using Symmetric3 = std::array<double, 6>;

// Samples of a segment: places and the spline weights of each sample, shared by all segments with `count`
// samples.
struct SampleView {
  const double* x;
  const double* y;
  const double* z;
};

// Round the samples of a segment, parallel to the axes.
struct SampleBox {
  std::array<double, 3> low, high;
};

// Of a place from a box; 0 inside.
LOOPWRIGHT_INLINE double squared_distance(double x, double y, double z, const SampleBox& box) {
  const double dx = std::max(std::max(box.low[0] - x, x - box.high[0]), 0.0),
               dy = std::max(std::max(box.low[1] - y, y - box.high[1]), 0.0),
               dz = std::max(std::max(box.low[2] - z, z - box.high[2]), 0.0);
  return dx * dx + dy * dy + dz * dz;
}

// Of a box, moved by -image, from another; 0 where they overlap.
LOOPWRIGHT_INLINE double squared_distance(const SampleBox& a, const std::array<double, 3>& image,
                                          const SampleBox& b) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double apart =
        std::max(std::max(b.low[c] - (a.high[c] - image[c]), (a.low[c] - image[c]) - b.high[c]), 0.0);
    sum += apart * apart;
  }
  return sum;
}

// Of a place from n others, into d2; returns the least of them and `beyond2`. Four at a time, in two running
// minima, so that none waits for the one before it.
LOOPWRIGHT_INLINE double squared_distances(double x, double y, double z, const SampleView& others,
                                           std::size_t n, double beyond2, double* d2) {
  Lanes least_even = Lanes{} + beyond2, least_odd = least_even;
  const auto four_of = [&](std::size_t j, Lanes& least) LOOPWRIGHT_INLINE_LAMBDA {
    Lanes ox, oy, oz;
    load(others.x + j, ox);
    load(others.y + j, oy);
    load(others.z + j, oz);
    const Lanes dx = x - ox, dy = y - oy, dz = z - oz, v = dx * dx + dy * dy + dz * dz;
    std::memcpy(d2 + j, &v, sizeof v);
    least = v < least ? v : least;
  };
  std::size_t j = 0;
  for (; j + 8 <= n; j += 8) {
    four_of(j, least_even);
    four_of(j + 4, least_odd);
  }
  if (j + 4 <= n) {
    four_of(j, least_even);
    j += 4;
  }
  for (; j < n; ++j) {
    const double dx = x - others.x[j], dy = y - others.y[j], dz = z - others.z[j];
    d2[j] = dx * dx + dy * dy + dz * dz;
    least_even[0] = d2[j] < least_even[0] ? d2[j] : least_even[0];
  }
  least_even = least_odd < least_even ? least_odd : least_even;
  return std::min(std::min(least_even[0], least_even[1]), std::min(least_even[2], least_even[3]));
}

struct ContactPairInput {
  SampleView a, b;
  std::array<double, 3> image{};     // added to b's places (lattice image)
  const SampleBox* box_b = nullptr;  // round b's samples, if known: samples of a far from it are passed over
  int count = 0;                     // samples per segment
  double weight = 0;                 // w_a w_b
  // Pairs of samples of one yarn closer than `excluded` along the yarn do not touch: sample i of a lies at
  // i * spacing, sample j of b at arc_offset + j * spacing. excluded = 0: all pairs count.
  double arc_offset = 0, spacing = 0, excluded = 0;
};

using SampleWeights = std::array<std::array<double, 4>, most_contact_samples>;

// Midpoint samples u = (i + 1/2) / count.
inline SampleWeights sample_weights(int count) {
  SampleWeights w{};
  for (int i = 0; i < count; ++i) w[static_cast<std::size_t>(i)] = spline_weights((i + 0.5) / count).value;
  return w;
}

// One side's forces and Hessians, summed at its samples and then at its control points.
struct ContactSide {
  // [sample] x, y, z of the gradient and the energy; xx, xy, xz, yy; yz, zz of the Hessian. Side b's gradient
  // is minus this one.
  std::array<std::array<Lanes, 3>, most_contact_samples> sample;
  std::array<bool, most_contact_samples> touched;
  // Lanes are control points. Sums of the samples' force sizes by their weights, and plain; the gradient.
  Lanes place;
  double size = 0;
  std::array<Lanes, 3> gradient;
  // [control point][xx, xy, xz, yy, yz, zz], lanes: the other control point
  std::array<std::array<Lanes, 6>, 4> hessian;
};

struct ContactTerm {
  double energy = 0;
  bool active = false;  // without contact nothing else is set
  ContactSide a, b;
  std::array<double, 3> push;                   // force on a, whole
  std::array<std::array<Lanes, 6>, 4> between;  // [a's control point][as above], lanes: b's
};

// Energy alone; infinite if any pair of samples is inside the core.
double contact_energy(const ContactPairInput& in, const ContactLaw& law);
void evaluate(const ContactPairInput& in, const ContactLaw& law, const SampleWeights& weights,
              ContactTerm& term);

// The Hessian of a contact times M = [[xi, 0, eta], [0, eta, 0], [0, 0, 0]] of all its control points, by
// control point, row by row.
struct ContactBorder {
  std::array<std::array<double, 9>, 4> a, b;
};
void border(const ContactTerm& term, const std::array<std::array<double, 2>, 4>& fractions_a,
            const std::array<std::array<double, 2>, 4>& fractions_b, ContactBorder& out);

// Contact of two segments as an element of 24 coordinates, for the derivative check and as plain reference.
struct Contact {
  static constexpr const char* name = "contact";
  static constexpr std::size_t dofs = 24;
  ContactLaw law;
  int samples = 8;
  double weight = 1;

  LocalTerm<24> evaluate(const std::array<double, 24>& q) const {
    const SampleWeights w = sample_weights(samples);
    std::array<std::array<double, most_contact_samples>, 6> p{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(samples); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t c = 0; c < 3; ++c) {
          p[c][i] += w[i][k] * q[3 * k + c];
          p[3 + c][i] += w[i][k] * q[12 + 3 * k + c];
        }
    ContactPairInput in{{p[0].data(), p[1].data(), p[2].data()}, {p[3].data(), p[4].data(), p[5].data()}};
    in.count = samples;
    in.weight = weight;
    ContactTerm out;
    loopwright::evaluate(in, law, w, out);
    LocalTerm<24> term;
    if (!out.active) return term;
    term.energy = out.energy;
    constexpr std::array<std::array<std::size_t, 3>, 3> at{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        term.gradient[3 * k + c] = out.a.gradient[c][k];
        term.gradient[12 + 3 * k + c] = out.b.gradient[c][k];
        for (std::size_t l = 0; l < 4; ++l)
          for (std::size_t e = 0; e < 3; ++e) {
            term.hessian[3 * k + c][3 * l + e] = out.a.hessian[k][at[c][e]][l];
            term.hessian[12 + 3 * k + c][12 + 3 * l + e] = out.b.hessian[k][at[c][e]][l];
            term.hessian[3 * k + c][12 + 3 * l + e] = out.between[k][at[c][e]][l];
            term.hessian[12 + 3 * l + e][3 * k + c] = out.between[k][at[c][e]][l];
          }
      }
    return term;
  }
};

}  // namespace loopwright
