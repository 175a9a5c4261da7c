// What an energy gives for one element: value, gradient and full (not projected) Hessian in the element's own
// coordinates. Elements are pure functions and allocate nothing; one assembler and one derivative check serve
// all.
#pragma once
#include <array>
#include <cstddef>

namespace loopwright {

template <std::size_t Dofs>
struct LocalTerm {
  double energy = 0;
  std::array<double, Dofs> gradient{};
  std::array<std::array<double, Dofs>, Dofs> hessian{};
};

// Coordinates of a spline segment: its four control points, x y z of each.
using SegmentDofs = std::array<double, 12>;

// Uniform cubic B-spline weights and their derivatives with respect to the segment's parameter u in [0, 1].
struct SplineWeights {
  std::array<double, 4> value, slope, curve;
};

constexpr SplineWeights spline_weights(double u) {
  const double v = 1 - u, u2 = u * u, u3 = u2 * u;
  return {{v * v * v / 6, (3 * u3 - 6 * u2 + 4) / 6, (-3 * u3 + 3 * u2 + 3 * u + 1) / 6, u3 / 6},
          {-v * v / 2, (3 * u2 - 4 * u) / 2, (-3 * u2 + 2 * u + 1) / 2, u2 / 2},
          {v, 3 * u - 2, 1 - 3 * u, u}};
}

// 4-point Gauss rule on [0, 1]: exact for the degree-7 polynomials of mass matrices, ample for bending.
inline constexpr std::array<double, 4> gauss_node{0.069431844202973712, 0.33000947820757187,
                                                  0.66999052179242813, 0.93056815579702629};
inline constexpr std::array<double, 4> gauss_weight{0.17392742256872693, 0.32607257743127307,
                                                    0.32607257743127307, 0.17392742256872693};
inline constexpr std::array<SplineWeights, 4> gauss_spline{
    spline_weights(gauss_node[0]), spline_weights(gauss_node[1]), spline_weights(gauss_node[2]),
    spline_weights(gauss_node[3])};

}  // namespace loopwright
