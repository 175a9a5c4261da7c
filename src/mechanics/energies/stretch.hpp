// Stretch of one spline segment of rest length h:
//   U = 1/2 EA int (|p'|/|p0'| - 1)^2 |p0'| du,   |p0'| = h   (engineering strain; u in [0, 1])
// EA: stretch stiffness (unit B/d^2 in the model). 4-point Gauss. Source: Kaldor et al. 2008 and Ding et al. 2024 use this form.
#pragma once
#include <cmath>

#include "mechanics/energies/energy.hpp"

namespace loopwright {

struct Stretch {
  static constexpr const char* name = "stretch";
  static constexpr std::size_t dofs = 12;
  double stiffness = 1;    // EA
  double rest_length = 1;  // h

  LocalTerm<12> evaluate(const SegmentDofs& x) const {
    LocalTerm<12> term;
    for (std::size_t g = 0; g < 4; ++g) {
      const auto& h1 = gauss_spline[g].slope;
      std::array<double, 3> a{};
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) a[c] += h1[i] * x[3 * i + c];
      const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
      const double strain = length / rest_length - 1, weight = gauss_weight[g] * stiffness;
      term.energy += 0.5 * weight * rest_length * strain * strain;
      // dU/da = w EA e t;  d2U/da2 = w EA [ t t / h + e / |a| (I - t t) ],  t = a / |a|
      const double first = weight * strain, across = first / length, along = weight / rest_length - across;
      std::array<double, 3> t{a[0] / length, a[1] / length, a[2] / length};
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) term.gradient[3 * i + c] += first * h1[i] * t[c];
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
          const double hh = h1[i] * h1[j];
          for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t e = 0; e < 3; ++e) term.hessian[3 * i + c][3 * j + e] += hh * along * t[c] * t[e];
            term.hessian[3 * i + c][3 * j + c] += hh * across;
          }
        }
    }
    return term;
  }
};

}  // namespace loopwright
