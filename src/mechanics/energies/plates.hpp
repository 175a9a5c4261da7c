// Two flat plates between which a piece lies, so that it does not curl: centrelines beyond a plate are pushed
// back,
//   U = 1/2 k h int max(z - high, low - z, 0)^2 du   over a segment of rest length h (midpoint samples, u in
//   [0, 1])
// k: stiffness of the plates per length of yarn (unit B/d^4 in the model). Plain fabric curls because its
// bending moments do not cancel; between plates it lies flat, as a swatch does that is measured.
#pragma once
#include "mechanics/energies/contact.hpp"
#include "mechanics/energies/energy.hpp"

namespace loopwright {

struct Plates {
  static constexpr const char* name = "plates";
  static constexpr std::size_t dofs = 12;
  double stiffness = 50, low = -1, high = 1, rest_length = 1;
  int samples = 8;

  // Does any sample in this box lie beyond a plate?
  bool touch(const SampleBox& box) const { return box.low[2] < low || box.high[2] > high; }

  LocalTerm<12> evaluate(const SegmentDofs& x, const SampleWeights& weights) const {
    LocalTerm<12> term;
    const double k = stiffness * rest_length / samples;
    for (std::size_t s = 0; s < static_cast<std::size_t>(samples); ++s) {
      const auto& w = weights[s];
      const double z = w[0] * x[2] + w[1] * x[5] + w[2] * x[8] + w[3] * x[11];
      const double beyond = z > high ? z - high : z < low ? z - low : 0;
      if (beyond == 0) continue;
      term.energy += 0.5 * k * beyond * beyond;
      for (std::size_t i = 0; i < 4; ++i) {
        term.gradient[3 * i + 2] += k * beyond * w[i];
        for (std::size_t j = 0; j < 4; ++j) term.hessian[3 * i + 2][3 * j + 2] += k * w[i] * w[j];
      }
    }
    return term;
  }
  LocalTerm<12> evaluate(const SegmentDofs& x) const { return evaluate(x, sample_weights(samples)); }
};

}  // namespace loopwright
