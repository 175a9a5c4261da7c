// Stretch of one spline segment of rest length h, by its mean strain:
//   U = 1/2 EA h (L/h - 1)^2 + 1/2 e EA/h (int |p'|^2 du - L^2),   L = int |p'| du   (u in [0, 1], 4-point
//   Gauss)
// EA: stretch stiffness (unit B/d^2 in the model); e: evenness.
// The local form 1/2 EA int (|p'|/h - 1)^2 h du, which is e = 1, punishes uneven speed of the parameter
// inside a segment, which four control points cannot avoid in a bend: at 12 segments a loop it stored 4 % of
// a relaxed plain cell's energy and made the bend energy 3 % too high (membrane locking). One mean strain a
// segment, e = 0, leaves only the true change of length, but lets contacts push the yarn's material out from
// under them within a segment at no cost: friction is used up by that and cloth near its friction limit finds
// no rest. A small e ends that and is not felt otherwise.
#pragma once
#include "mechanics/energies/segment_term.hpp"

namespace loopwright {

// For one segment or several.
template <class Real>
struct StretchOf {
  Real stiffness, rest_length;  // EA, h
  double evenness;

  // Length of the segment, speeds at the Gauss points and their variance (the mean of the squares less the
  // square of the mean, as a sum of squares: the difference would be lost in rounding).
  struct Along {
    Real arc{}, variance{};
    std::array<Real, 4> speed;
  };
  LOOPWRIGHT_INLINE void measure(const GaussPoints<Real>& points, Along& along) const {
    for (std::size_t g = 0; g < 4; ++g) {
      square_root(points.A[g], along.speed[g]);
      along.arc += gauss_weight[g] * along.speed[g];
    }
    for (std::size_t g = 0; g < 4; ++g) {
      const Real uneven = along.speed[g] - along.arc;
      along.variance += gauss_weight[g] * (uneven * uneven);
    }
  }
  LOOPWRIGHT_INLINE void add_energy(const Along& along, Real& energy) const {
    const Real strain = along.arc / rest_length - 1.0;
    energy += 0.5 * stiffness * (strain * strain * rest_length + evenness / rest_length * along.variance);
  }
  LOOPWRIGHT_INLINE void add_energy(const GaussPoints<Real>& points, Real& energy) const {
    Along along;
    measure(points, along);
    add_energy(along, energy);
  }

  // Energy and what the mean strain gives to the Hessian go to `term`, derivatives at the points to `law`.
  LOOPWRIGHT_INLINE void add(const GaussPoints<Real>& points, std::array<PointLaw<Real>, 4>& law,
                             SegmentTerm<Real>& term) const {
    Along along;
    measure(points, along);
    add_energy(along, term.energy);
    const Real even = evenness * stiffness / rest_length;
    // along the mean, beside what acts on the square of the speed
    const Real tension = stiffness * (along.arc / rest_length - 1.0) - even * along.arc,
               hardness = stiffness / rest_length - even;
    Middle<Real> arc_slope{};  // dL/d(v, a, j)
    for (std::size_t g = 0; g < 4; ++g) {
      const double t = gauss_place[g];
      const Real a_speed = gauss_weight[g] / along.speed[g], pull = tension * a_speed;
      law[g].A += 0.5 * (pull + gauss_weight[g] * even);
      law[g].AA -= 0.25 * pull / points.A[g];
      for (std::size_t c = 0; c < 3; ++c) {
        const Real tangent = a_speed * points.slope[g][c];
        arc_slope[0][c] += tangent;
        arc_slope[1][c] += t * tangent;
        arc_slope[2][c] += (0.5 * t * t) * tangent;
      }
    }
    term.add_dyad(hardness, arc_slope);
  }
};

// For one segment.
struct Stretch {
  static constexpr const char* name = "stretch";
  static constexpr std::size_t dofs = 12;
  double stiffness = 1;    // EA
  double rest_length = 1;  // h
  double evenness = 0.005;

  StretchOf<double> of() const { return {stiffness, rest_length, evenness}; }
  double energy(const SegmentDofs& x) const { return element_energy(of(), x); }
  LocalTerm<12> evaluate(const SegmentDofs& x) const { return element_term(of(), x); }
};

}  // namespace loopwright
