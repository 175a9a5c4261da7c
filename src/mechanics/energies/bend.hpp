// Bending of one spline segment of rest length h, straight when unloaded:
//   U = 1/2 B int kappa^2 ds0 = 1/2 B h int kappa^2 du,   kappa^2 = |p' x p''|^2 / |p'|^6
// B: bend stiffness (1 in the model's units, energies in B/d). 4-point Gauss.
// With A = p'.p', C = p'.p'', D = p''.p'': kappa^2 = f = D A^-2 - C^2 A^-3; derivatives follow by the chain
// rule.
// Set yarn has a curvature kappa_0 when unloaded: U = 1/2 B int (r - r_0)^2 ds0 with r^2 = kappa^2 + e^2,
// r_0^2 = kappa_0^2 + e^2, e = kappa_0 / 16, which is (kappa - kappa_0)^2 but for yarn that is nearly
// straight where it was bent, whose cusp it rounds. The plane of the bend may turn: yarn without resistance
// to twist.
#pragma once
#include "mechanics/energies/segment_term.hpp"

namespace loopwright {

// For one segment or several.
template <class Real>
struct BendOf {
  Real stiffness, rest_length;         // B, h
  const std::array<Real, 4>* natural;  // kappa_0 at the Gauss points, 1/d; none: straight

  // (r - r_0)^2 as a function of f = kappa^2, and its first two derivatives; f itself where kappa_0 is 0.
  struct Law {
    Real value, slope, curvature;
  };
  LOOPWRIGHT_INLINE void law(const Real& f, std::size_t g, Law& l) const {
    const Real k0 = (*natural)[g], e2 = k0 * k0 * (1.0 / 256), zero{};
    Real r0, r;
    square_root(k0 * k0 + e2, r0);
    square_root(k0 == 0.0 ? zero + 1.0 : f + e2, r);
    l.value = k0 == 0.0 ? f : (r - r0) * (r - r0);
    l.slope = 1.0 - r0 / r;
    l.curvature = 0.5 * r0 / (r * r * r);
  }

  LOOPWRIGHT_INLINE void add_energy(const GaussPoints<Real>& points, Real& energy) const {
    for (std::size_t g = 0; g < 4; ++g) {
      const Real i1 = 1.0 / points.A[g], i2 = i1 * i1, C = points.C[g], f = i2 * (points.D[g] - C * C * i1),
                 weight = 0.5 * gauss_weight[g] * stiffness * rest_length;
      if (natural) {
        Law set;
        law(f, g, set);
        energy += weight * set.value;
      } else {
        energy += weight * f;
      }
    }
  }

  // The energy goes to `term`, derivatives at the points to `f`.
  LOOPWRIGHT_INLINE void add(const GaussPoints<Real>& points, std::array<PointLaw<Real>, 4>& f,
                             SegmentTerm<Real>& term) const {
    for (std::size_t g = 0; g < 4; ++g) {
      const Real C = points.C[g], D = points.D[g];
      const Real i1 = 1.0 / points.A[g], i2 = i1 * i1, i3 = i2 * i1, i4 = i2 * i2;
      const Real weight = 0.5 * gauss_weight[g] * stiffness * rest_length, c2 = C * C * i1,
                 kappa2 = i2 * (D - c2);
      Real w = weight;
      PointLaw<Real>& p = f[g];
      if (natural) {
        Law set;
        law(kappa2, g, set);
        term.energy += weight * set.value;
        w = weight * set.slope;
        // The law's own curvature acts on the slopes of kappa^2.
        const Real by = weight * set.curvature, by_A = i3 * (3.0 * c2 - 2.0 * D), by_C = -2.0 * C * i3;
        p.AA += by * by_A * by_A;
        p.AC += by * by_A * by_C;
        p.AD += by * by_A * i2;
        p.CC += by * by_C * by_C;
        p.CD += by * by_C * i2;
        p.DD += by * i2 * i2;
      } else {
        term.energy += weight * kappa2;
      }
      const Real w3 = -2.0 * w * i3, w4 = 6.0 * w * i4;
      p.A += w * i3 * (3.0 * c2 - 2.0 * D);
      p.C += w3 * C;
      p.D += w * i2;
      p.AA += w4 * (D - 2.0 * c2);
      p.AC += w4 * C;
      p.AD += w3;
      p.CC += w3;
    }
  }
};

// For one segment.
struct Bend {
  static constexpr const char* name = "bend";
  static constexpr std::size_t dofs = 12;
  double stiffness = 1;                            // B
  double rest_length = 1;                          // h
  const std::array<double, 4>* natural = nullptr;  // kappa_0 at the Gauss points, 1/d; none: straight

  BendOf<double> of() const { return {stiffness, rest_length, natural}; }
  double energy(const SegmentDofs& x) const { return element_energy(of(), x); }
  LocalTerm<12> evaluate(const SegmentDofs& x) const { return element_term(of(), x); }
};

}  // namespace loopwright
