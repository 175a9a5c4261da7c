// Blending functions of cubic spline segments, behind one interface: four control points, four cubic weights.
//   p(u) = sum_i h_i(u) q_i,   h_i(u) = sum_k coefficient[i][k] u^k,   u in [0, 1]
// Segment j of a yarn uses its control points j .. j + 3, so a yarn of n points has n - 3 segments.
#pragma once
#include <array>

namespace loopwright {

using BlendingMatrix = std::array<std::array<double, 4>, 4>;

struct BlendingWeights {
  std::array<double, 4> value, slope, curve;  // h, h', h''
};

struct Blending {
  BlendingMatrix coefficient{};

  BlendingWeights weights(double u) const;
};

// C2; the curve does not go through its control points.
Blending uniform_b_spline();
// C1; the curve of a segment goes from q_1 to q_2 with slopes tension (q_2 - q_0) and tension (q_3 - q_1);
// 1/2 is the usual Catmull-Rom spline, 0 gives straight pieces (Vince, 3-D Computer Animation, 1992).
Blending catmull_rom(double tension = 0.5);
// Any other: Bezier-like, hermite-like, ... Throws std::invalid_argument if a coefficient is not finite or
// the weights do not add up to 1 at every u: such a curve would not follow its points when they are moved.
Blending blending_of(const BlendingMatrix& coefficient);

// int_0^1 h_a^(k) h_b^(k) du for derivative k = 0, 1, 2; exact. Throws std::invalid_argument for other k.
BlendingMatrix product_integrals(const Blending& blending, int derivative);

}  // namespace loopwright
