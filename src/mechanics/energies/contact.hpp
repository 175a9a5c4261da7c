// Contact of two spline segments a and b, sampled at midpoints of equal parts:
//   U = sum_ij w_a w_b phi(|p_a(u_i) - p_b(u_j)|),   w = rest length of a sample's part
// With phi per length of both yarns (laws/contact_law.hpp) this is the midpoint rule for the double integral.
// Geometry (distances) knows no stiffness, the law knows no geometry, and nothing is allocated.
//
// Cost per pair of segments with n samples each: n distances from the box round b's samples (12 flops); n
// squared distances (8 flops) for each sample of a that is near it; and for each pair of samples in contact
// about 90 flops for force and Hessian. Hessians of one side are summed per sample and folded into control
// points once per segment by the assembler; the blocks between the sides are summed per pair of segments.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

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
  const auto four = [](const double* p, Lanes& v) LOOPWRIGHT_INLINE_LAMBDA { std::memcpy(&v, p, sizeof v); };
  Lanes least_even = Lanes{} + beyond2, least_odd = least_even;
  const auto four_of = [&](std::size_t j, Lanes& least) LOOPWRIGHT_INLINE_LAMBDA {
    Lanes ox, oy, oz;
    four(others.x + j, ox);
    four(others.y + j, oy);
    four(others.z + j, oz);
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

// Forces and same-side Hessians per sample, and the Hessian between the sides per pair of control points.
struct ContactPairOutput {
  double energy = 0;
  bool active = false;
  std::array<bool, most_contact_samples> touched_a, touched_b;  // samples in contact; the rest are all zero
  std::array<std::array<double, 3>, most_contact_samples> gradient_a, gradient_b;
  std::array<Symmetric3, most_contact_samples> hessian_a, hessian_b;
  std::array<std::array<Symmetric3, 4>, 4> between;  // d2U / dq_a dq_b (symmetric 3 x 3)
};

using SampleWeights = std::array<std::array<double, 4>, most_contact_samples>;

// Midpoint samples u = (i + 1/2) / count.
inline SampleWeights sample_weights(int count) {
  SampleWeights w{};
  for (int i = 0; i < count; ++i) w[static_cast<std::size_t>(i)] = spline_weights((i + 0.5) / count).value;
  return w;
}

// Energy alone; infinite if any pair of samples is inside the core.
LOOPWRIGHT_INLINE double contact_energy(const ContactPairInput& in, const ContactLaw& law) {
  const double outer2 = law.outer * law.outer;
  double energy = 0;
  for (int i = 0; i < in.count; ++i) {
    const double px = in.a.x[i] - in.image[0], py = in.a.y[i] - in.image[1], pz = in.a.z[i] - in.image[2];
    if (in.box_b && squared_distance(px, py, pz, *in.box_b) >= outer2) continue;
    std::array<double, most_contact_samples> d2;
    const auto n = static_cast<std::size_t>(in.count);
    if (squared_distances(px, py, pz, in.b, n, outer2, d2.data()) >= outer2) continue;
    for (int j = 0; j < in.count; ++j) {
      const double v = d2[static_cast<std::size_t>(j)];
      if (v >= outer2) continue;
      if (in.excluded > 0 && std::abs(in.arc_offset + (j - i) * in.spacing) < in.excluded) continue;
      energy += law(std::sqrt(v)).energy;
    }
  }
  return in.weight * energy;
}

// Energy, gradient and, if `with_hessian`, Hessian. `out.active` is false (and nothing else is set) without
// contact.
LOOPWRIGHT_INLINE void contact_terms(const ContactPairInput& in, const ContactLaw& law,
                                     const SampleWeights& weights, bool with_hessian,
                                     ContactPairOutput& out) {
  const double outer2 = law.outer * law.outer;
  const auto n = static_cast<std::size_t>(in.count);
  out.energy = 0;
  out.active = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double px = in.a.x[i] - in.image[0], py = in.a.y[i] - in.image[1], pz = in.a.z[i] - in.image[2];
    if (in.box_b && squared_distance(px, py, pz, *in.box_b) >= outer2) continue;
    std::array<double, most_contact_samples> d2;
    if (squared_distances(px, py, pz, in.b, n, outer2, d2.data()) >= outer2) continue;
    std::array<Symmetric3, 4> row{};  // sum over j of h_b(j) K_ij
    bool row_active = false;
    for (std::size_t j = 0; j < n; ++j) {
      if (d2[j] >= outer2) continue;
      if (in.excluded > 0 && std::abs(in.arc_offset + (static_cast<double>(j) - static_cast<double>(i)) *
                                                          in.spacing) < in.excluded)
        continue;
      if (!out.active) {
        out.active = true;
        for (std::size_t k = 0; k < n; ++k) {
          out.gradient_a[k] = out.gradient_b[k] = {};
          out.hessian_a[k] = out.hessian_b[k] = {};
          out.touched_a[k] = out.touched_b[k] = false;
        }
        out.between = {};
      }
      row_active = out.touched_a[i] = out.touched_b[j] = true;
      const double D = std::sqrt(d2[j]), inv = 1 / D;
      const ContactLaw::Value v = law(D);
      out.energy += in.weight * v.energy;
      const double nx = (px - in.b.x[j]) * inv, ny = (py - in.b.y[j]) * inv, nz = (pz - in.b.z[j]) * inv;
      const double f = in.weight * v.slope;
      out.gradient_a[i][0] += f * nx;
      out.gradient_a[i][1] += f * ny;
      out.gradient_a[i][2] += f * nz;
      out.gradient_b[j][0] -= f * nx;
      out.gradient_b[j][1] -= f * ny;
      out.gradient_b[j][2] -= f * nz;
      if (!with_hessian) continue;
      const double across = f * inv, along = in.weight * v.curvature - across;
      const Symmetric3 K{along * nx * nx + across, along * nx * ny, along * nx * nz,
                         along * ny * ny + across, along * ny * nz, along * nz * nz + across};
      for (std::size_t c = 0; c < 6; ++c) {
        out.hessian_a[i][c] += K[c];
        out.hessian_b[j][c] += K[c];
      }
      for (std::size_t b = 0; b < 4; ++b)
        for (std::size_t c = 0; c < 6; ++c) row[b][c] += weights[j][b] * K[c];
    }
    if (with_hessian && row_active)
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
          for (std::size_t c = 0; c < 6; ++c) out.between[a][b][c] -= weights[i][a] * row[b][c];
  }
}

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
    ContactPairOutput out;
    contact_terms(in, law, w, true, out);
    LocalTerm<24> term;
    if (!out.active) return term;
    term.energy = out.energy;
    constexpr std::array<std::array<std::size_t, 3>, 3> at{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < static_cast<std::size_t>(samples); ++i) {
          term.gradient[3 * k + c] += w[i][k] * out.gradient_a[i][c];
          term.gradient[12 + 3 * k + c] += w[i][k] * out.gradient_b[i][c];
          for (std::size_t l = 0; l < 4; ++l)
            for (std::size_t e = 0; e < 3; ++e) {
              term.hessian[3 * k + c][3 * l + e] += w[i][k] * w[i][l] * out.hessian_a[i][at[c][e]];
              term.hessian[12 + 3 * k + c][12 + 3 * l + e] += w[i][k] * w[i][l] * out.hessian_b[i][at[c][e]];
            }
        }
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = 0; l < 4; ++l)
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t e = 0; e < 3; ++e) {
            term.hessian[3 * k + c][12 + 3 * l + e] += out.between[k][l][at[c][e]];
            term.hessian[12 + 3 * l + e][3 * k + c] += out.between[k][l][at[c][e]];
          }
    return term;
  }
};

}  // namespace loopwright
