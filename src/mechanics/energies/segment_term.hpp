// Energies of one spline segment that are sums over Gauss points of a law in the products of p' and p'':
// A = p'.p', C = p'.p'', D = p''.p''. What they share is here: from control points to A, C, D and from the
// law's derivatives back to gradient and Hessian.
//
// Inside, a segment is the Taylor series of its tangent at its middle, exact for a cubic:
//   p'(u) = v + t a + t^2/2 j,   p''(u) = a + t j,   t = u - 1/2
// Nine coordinates instead of twelve (where the segment lies does not count), most of whose weights are 0 or
// 1.
//
// Real: double for one segment, Lanes for several at once.
#pragma once
#include <array>
#include <cstddef>

#include "base/wide.hpp"
#include "mechanics/energies/energy.hpp"
#include "mechanics/energies/lanes.hpp"

namespace loopwright {

// v, a, j; x, y, z of each.
template <class Real>
using Middle = std::array<std::array<Real, 3>, 3>;

// Of anything that the control points carry: their places, or their fractional coordinates.
template <class Real, std::size_t count>
LOOPWRIGHT_INLINE void middle_of(const std::array<std::array<Real, count>, 4>& q,
                                 std::array<std::array<Real, count>, 3>& m) {
  for (std::size_t c = 0; c < count; ++c) {
    const Real inner = q[2][c] - q[1][c], outer = q[3][c] - q[0][c];
    m[0][c] = 0.625 * inner + 0.125 * outer;
    m[1][c] = 0.5 * ((q[0][c] - q[1][c]) + (q[3][c] - q[2][c]));
    m[2][c] = outer - 3.0 * inner;
  }
}

// From derivatives by v, a and j to those by the four control points.
template <class Real>
LOOPWRIGHT_INLINE void spread(const Real& v, const Real& a, const Real& j, Real& q0, Real& q1, Real& q2,
                              Real& q3) {
  const Real outer = 0.125 * v + j, inner = 0.625 * v - 3.0 * j, half = 0.5 * a;
  q0 = half - outer;
  q1 = -half - inner;
  q2 = inner - half;
  q3 = half + outer;
}

inline constexpr std::array<double, 4> gauss_place{gauss_node[0] - 0.5, gauss_node[1] - 0.5,
                                                   gauss_node[2] - 0.5, gauss_node[3] - 0.5};  // t

// p', p'' and their products at the Gauss points.
template <class Real>
struct GaussPoints {
  std::array<std::array<Real, 3>, 4> slope, curve;
  std::array<Real, 4> A, C, D;

  LOOPWRIGHT_INLINE explicit GaussPoints(const Middle<Real>& m) {
    for (std::size_t g = 0; g < 4; ++g) {
      const double t = gauss_place[g];
      auto &p = slope[g], &b = curve[g];
      for (std::size_t c = 0; c < 3; ++c) {
        p[c] = m[0][c] + t * (m[1][c] + (0.5 * t) * m[2][c]);
        b[c] = m[1][c] + t * m[2][c];
      }
      A[g] = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
      C[g] = p[0] * b[0] + p[1] * b[1] + p[2] * b[2];
      D[g] = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    }
  }
};

// Derivatives of the law at a Gauss point, weights included; CD and DD are zero for all but set yarn.
template <class Real>
struct PointLaw {
  Real A, C, D, AA, AC, AD, CC, CD, DD;
  LOOPWRIGHT_INLINE PointLaw() {
    for (Real* const x : {&A, &C, &D, &AA, &AC, &AD, &CC, &CD, &DD}) clear(*x);
  }
};

// Value, gradient and Hessian by v, a and j.
template <class Real>
struct SegmentTerm {
  Real energy;
  Middle<Real> gradient;
  // Hessian by coordinate: of one with itself (xx, yy, zz) the six by v v, v a, v j, a a, a j, j j; of one
  // with another (xy, xz, yz) the nine by v v, v a, v j, a v, a a, a j, j v, j a, j j.
  std::array<std::array<Real, 6>, 3> own;
  std::array<std::array<Real, 9>, 3> mixed;

  LOOPWRIGHT_INLINE SegmentTerm() {
    clear(energy);
    clear(gradient);
    clear(own);
    clear(mixed);
  }

  // by g g'
  LOOPWRIGHT_INLINE void add_dyad(const Real& by, const Middle<Real>& g) {
    constexpr std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [c, e] = pairs[k];
      for (std::size_t i = 0, at = 0; i < 3; ++i) {
        const Real own_i = by * g[i][k], mixed_i = by * g[i][c];
        for (std::size_t j = i; j < 3; ++j) own[k][at++] += own_i * g[j][k];
        for (std::size_t j = 0; j < 3; ++j) mixed[k][3 * i + j] += mixed_i * g[j][e];
      }
    }
  }

  // What the law at Gauss point k adds. With_set: CD and DD count.
  template <bool with_set>
  LOOPWRIGHT_INLINE void add_point(const GaussPoints<Real>& points, std::size_t k, const PointLaw<Real>& f) {
    const double t = gauss_place[k], h = 0.5 * t;
    const auto &a = points.slope[k], &b = points.curve[k];
    const Real AA4 = 4.0 * f.AA, AC2 = 2.0 * f.AC, AD4 = 4.0 * f.AD, A2 = 2.0 * f.A, D2 = 2.0 * f.D;
    // Hessian by p' and p'': aa = a x' + b y' + 2 f_A, ab = a z' + b r' + f_C, bb = a r' + b q' + 2 f_D.
    std::array<Real, 3> x, y, z, r, q;
    for (std::size_t c = 0; c < 3; ++c) {
      const Real by_a = A2 * a[c] + f.C * b[c], by_b = f.C * a[c] + D2 * b[c];
      gradient[0][c] += by_a;
      gradient[1][c] += t * by_a + by_b;
      gradient[2][c] += t * (h * by_a + by_b);
      x[c] = AA4 * a[c] + AC2 * b[c];
      y[c] = AC2 * a[c] + f.CC * b[c];
      z[c] = AC2 * a[c] + AD4 * b[c];
      r[c] = f.CC * a[c];
      if constexpr (with_set) {
        r[c] += 2.0 * f.CD * b[c];
        q[c] = 2.0 * f.CD * a[c] + 4.0 * f.DD * b[c];
      }
    }
    const auto bb_of = [&](std::size_t c, std::size_t e, Real& bb) {
      bb = a[c] * r[e];
      if constexpr (with_set) bb += b[c] * q[e];
    };
    constexpr std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
    for (std::size_t n = 0; n < 3; ++n) {
      Real bb;
      bb_of(n, n, bb);
      bb += D2;
      add_own(own[n], t, a[n] * x[n] + b[n] * y[n] + A2, a[n] * z[n] + b[n] * r[n] + f.C, bb);
      const auto [c, e] = pairs[n];
      bb_of(c, e, bb);
      add_mixed(mixed[n], t, a[c] * x[e] + b[c] * y[e], a[c] * z[e] + b[c] * r[e], a[e] * z[c] + b[e] * r[c],
                bb);
    }
  }

 private:
  LOOPWRIGHT_INLINE static void add_own(std::array<Real, 6>& to, double t, const Real& aa, const Real& ab,
                                        const Real& bb) {
    const double h = 0.5 * t;
    const Real by_a = t * aa + ab, by_j = t * (h * aa + ab), on_j = t * (h * ab + bb);
    to[0] += aa;
    to[1] += by_a;
    to[2] += by_j;
    to[3] += t * (by_a + ab) + bb;
    to[4] += t * by_j + on_j;
    to[5] += t * (h * by_j + on_j);
  }
  LOOPWRIGHT_INLINE static void add_mixed(std::array<Real, 9>& to, double t, const Real& aa, const Real& ab,
                                          const Real& ba, const Real& bb) {
    const double h = 0.5 * t;
    const Real by_a = t * aa + ab, by_j = t * (h * aa + ab), on_a = t * ba + bb, on_j = t * (h * ba + bb);
    to[0] += aa;
    to[1] += by_a;
    to[2] += by_j;
    to[3] += t * aa + ba;
    to[4] += t * by_a + on_a;
    to[5] += t * by_j + on_j;
    to[6] += t * (h * aa + ba);
    to[7] += t * (h * by_a + on_a);
    to[8] += t * (h * by_j + on_j);
  }
};

// Gradient and Hessian by the control points, 3 x 3 blocks row by row: those of control points k <= l, in the
// order 00 01 02 03 11 12 13 22 23 33.
template <class Real>
using SegmentBlocks = std::array<std::array<Real, 9>, 10>;
inline constexpr std::array<std::array<std::size_t, 4>, 4> block_of_points{
    {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}}};

template <class Real>
LOOPWRIGHT_INLINE void spread_gradient(const Middle<Real>& by, std::array<std::array<Real, 3>, 4>& points) {
  for (std::size_t c = 0; c < 3; ++c)
    spread(by[0][c], by[1][c], by[2][c], points[0][c], points[1][c], points[2][c], points[3][c]);
}

template <class Real>
LOOPWRIGHT_INLINE void spread_hessian(const SegmentTerm<Real>& term, SegmentBlocks<Real>& blocks) {
  // One coordinate of all points with another: first the columns, then the rows.
  const auto spread_both = [](const std::array<std::array<Real, 3>, 3>& by,
                              std::array<std::array<Real, 4>, 4>& points) {
    std::array<std::array<Real, 4>, 3> rows;
    for (std::size_t i = 0; i < 3; ++i)
      spread(by[i][0], by[i][1], by[i][2], rows[i][0], rows[i][1], rows[i][2], rows[i][3]);
    for (std::size_t l = 0; l < 4; ++l)
      spread(rows[0][l], rows[1][l], rows[2][l], points[0][l], points[1][l], points[2][l], points[3][l]);
  };
  constexpr std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  std::array<std::array<Real, 4>, 4> h;
  for (std::size_t n = 0; n < 3; ++n) {
    const auto& o = term.own[n];
    spread_both({{{o[0], o[1], o[2]}, {o[1], o[3], o[4]}, {o[2], o[4], o[5]}}}, h);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = k; l < 4; ++l) blocks[block_of_points[k][l]][4 * n] = h[k][l];
    const auto [c, e] = pairs[n];
    const auto& m = term.mixed[n];
    spread_both({{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}}}, h);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = k; l < 4; ++l) {
        blocks[block_of_points[k][l]][3 * c + e] = h[k][l];
        blocks[block_of_points[k][l]][3 * e + c] = h[l][k];
      }
  }
}

// Coordinates of one segment, as the derivative check has them.
inline std::array<std::array<double, 3>, 4> control_points(const SegmentDofs& x) {
  std::array<std::array<double, 3>, 4> q;
  for (std::size_t i = 0; i < 12; ++i) q[i / 3][i % 3] = x[i];
  return q;
}
inline GaussPoints<double> gauss_points(const SegmentDofs& x) {
  Middle<double> m;
  middle_of(control_points(x), m);
  return GaussPoints<double>(m);
}
inline LocalTerm<12> local_term(const SegmentTerm<double>& term) {
  LocalTerm<12> local;
  local.energy = term.energy;
  std::array<std::array<double, 3>, 4> gradient;
  spread_gradient(term.gradient, gradient);
  SegmentBlocks<double> blocks;
  spread_hessian(term, blocks);
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      local.gradient[3 * k + c] = gradient[k][c];
      for (std::size_t l = 0; l < 4; ++l)
        for (std::size_t e = 0; e < 3; ++e)
          local.hessian[3 * k + c][3 * l + e] = blocks[block_of_points[k][l]][k <= l ? 3 * c + e : 3 * e + c];
    }
  return local;
}

// One segment by itself, of the energy that StretchOf or BendOf has.
template <class EnergyOf>
double element_energy(const EnergyOf& of, const SegmentDofs& x) {
  double sum = 0;
  of.add_energy(gauss_points(x), sum);
  return sum;
}
template <class EnergyOf>
LocalTerm<12> element_term(const EnergyOf& of, const SegmentDofs& x) {
  const GaussPoints<double> points = gauss_points(x);
  std::array<PointLaw<double>, 4> law;
  SegmentTerm<double> term;
  of.add(points, law, term);
  for (std::size_t g = 0; g < 4; ++g) term.add_point<true>(points, g, law[g]);
  return local_term(term);
}

}  // namespace loopwright
