// Stretch of one spline segment of rest length h, by its mean strain:
//   U = 1/2 EA h (L/h - 1)^2,   L = int |p'| du   (u in [0, 1], 4-point Gauss)
// EA: stretch stiffness (unit B/d^2 in the model).
// The local form 1/2 EA int (|p'|/h - 1)^2 h du punishes uneven speed of the parameter inside a segment,
// which four control points cannot avoid in a bend: at 12 segments a loop it stored 4 % of a relaxed plain
// cell's energy and made the bend energy 3 % too high (membrane locking). One mean strain a segment leaves
// only the true change of length.
#pragma once
#include <cmath>

#include "mechanics/energies/energy.hpp"

namespace loopwright {

struct Stretch {
  static constexpr const char* name = "stretch";
  static constexpr std::size_t dofs = 12;
  double stiffness = 1;    // EA
  double rest_length = 1;  // h

  double energy(const SegmentDofs& x) const {
    double arc = 0;
    for (std::size_t g = 0; g < 4; ++g) {
      std::array<double, 3> a{};
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) a[c] += gauss_spline[g].slope[i] * x[3 * i + c];
      arc += gauss_weight[g] * std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    }
    const double strain = arc / rest_length - 1;
    return 0.5 * (stiffness * strain) * strain * rest_length;
  }

  LocalTerm<12> evaluate(const SegmentDofs& x) const {
    LocalTerm<12> term;
    double arc = 0;
    std::array<double, 12> G{};  // dL/dx
    std::array<std::array<double, 3>, 4> tangent{};
    std::array<double, 4> speed{};
    for (std::size_t g = 0; g < 4; ++g) {
      const auto& h1 = gauss_spline[g].slope;
      std::array<double, 3> a{};
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) a[c] += h1[i] * x[3 * i + c];
      speed[g] = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
      arc += gauss_weight[g] * speed[g];
      for (std::size_t c = 0; c < 3; ++c) tangent[g][c] = a[c] / speed[g];
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) G[3 * i + c] += gauss_weight[g] * h1[i] * tangent[g][c];
    }
    const double strain = arc / rest_length - 1, tension = stiffness * strain;
    term.energy = 0.5 * tension * strain * rest_length;
    for (std::size_t i = 0; i < 12; ++i) term.gradient[i] = tension * G[i];
    for (std::size_t i = 0; i < 12; ++i)
      for (std::size_t j = 0; j < 12; ++j) term.hessian[i][j] = stiffness / rest_length * G[i] * G[j];
    for (std::size_t g = 0; g < 4; ++g) {
      const auto& h1 = gauss_spline[g].slope;
      const auto& t = tangent[g];
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
          const double f = tension * gauss_weight[g] / speed[g] * h1[i] * h1[j];
          for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t e = 0; e < 3; ++e) term.hessian[3 * i + c][3 * j + e] -= f * t[c] * t[e];
            term.hessian[3 * i + c][3 * j + c] += f;
          }
        }
    }
    return term;
  }
};

}  // namespace loopwright
