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
#include <cmath>

#include "mechanics/energies/energy.hpp"

namespace loopwright {

struct Stretch {
  static constexpr const char* name = "stretch";
  static constexpr std::size_t dofs = 12;
  double stiffness = 1;    // EA
  double rest_length = 1;  // h
  double evenness = 0.005;

  double energy(const SegmentDofs& x) const {
    double arc = 0, square = 0;
    for (std::size_t g = 0; g < 4; ++g) {
      std::array<double, 3> a{};
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) a[c] += gauss_spline[g].slope[i] * x[3 * i + c];
      const double speed2 = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
      arc += gauss_weight[g] * std::sqrt(speed2);
      square += gauss_weight[g] * speed2;
    }
    return energy_of(arc, square);
  }
  double energy_of(double arc, double square) const {
    const double strain = arc / rest_length - 1;
    return 0.5 * stiffness * (strain * strain * rest_length + evenness / rest_length * (square - arc * arc));
  }

  LocalTerm<12> evaluate(const SegmentDofs& x) const {
    LocalTerm<12> term;
    double arc = 0, square = 0;
    std::array<double, 12> G{};  // dL/dx
    std::array<std::array<double, 3>, 4> tangent{};
    std::array<double, 4> speed{};
    for (std::size_t g = 0; g < 4; ++g) {
      const auto& h1 = gauss_spline[g].slope;
      std::array<double, 3> a{};
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) a[c] += h1[i] * x[3 * i + c];
      const double speed2 = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
      speed[g] = std::sqrt(speed2);
      arc += gauss_weight[g] * speed[g];
      square += gauss_weight[g] * speed2;
      for (std::size_t c = 0; c < 3; ++c) tangent[g][c] = a[c] / speed[g];
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) G[3 * i + c] += gauss_weight[g] * h1[i] * tangent[g][c];
    }
    term.energy = energy_of(arc, square);
    const double even = evenness * stiffness / rest_length;
    // along the mean, beside what acts on the square of the speed
    const double tension = stiffness * (arc / rest_length - 1) - even * arc,
                 hardness = stiffness / rest_length - even;
    for (std::size_t i = 0; i < 12; ++i) {
      term.gradient[i] = tension * G[i];
      for (std::size_t j = i; j < 12; ++j) term.hessian[i][j] = hardness * G[i] * G[j];
    }
    for (std::size_t g = 0; g < 4; ++g) {
      const auto& h1 = gauss_spline[g].slope;
      const auto& t = tangent[g];
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t c = 0; c < 3; ++c)
          term.gradient[3 * i + c] += even * gauss_weight[g] * h1[i] * speed[g] * t[c];
        // Blocks on and above the diagonal; below it they are mirrored at the end.
        for (std::size_t j = i; j < 4; ++j) {
          const double f = tension * gauss_weight[g] / speed[g] * h1[i] * h1[j],
                       own = f + even * gauss_weight[g] * h1[i] * h1[j];
          for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t e = 0; e < 3; ++e) term.hessian[3 * i + c][3 * j + e] -= f * t[c] * t[e];
            term.hessian[3 * i + c][3 * j + c] += own;
          }
        }
      }
    }
    for (std::size_t i = 0; i < 12; ++i)
      for (std::size_t j = 0; j < i; ++j) term.hessian[i][j] = term.hessian[j][i];
    return term;
  }
};

}  // namespace loopwright
