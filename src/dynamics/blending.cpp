#include "dynamics/blending.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace loopwright {

BlendingWeights Blending::weights(double u) const {
  BlendingWeights w{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& c = coefficient[i];
    w.value[i] = c[0] + u * (c[1] + u * (c[2] + u * c[3]));
    w.slope[i] = c[1] + u * (2 * c[2] + u * 3 * c[3]);
    w.curve[i] = 2 * c[2] + 6 * u * c[3];
  }
  return w;
}

Blending uniform_b_spline() {
  constexpr double s = 1.0 / 6;
  return {{{{s, -3 * s, 3 * s, -s}, {4 * s, 0, -6 * s, 3 * s}, {s, 3 * s, 3 * s, -3 * s}, {0, 0, 0, s}}}};
}

Blending catmull_rom(double t) {
  return blending_of({{{0, -t, 2 * t, -t}, {1, 0, t - 3, 2 - t}, {0, t, 3 - 2 * t, t - 2}, {0, 0, -t, t}}});
}

Blending blending_of(const BlendingMatrix& coefficient) {
  for (std::size_t k = 0; k < 4; ++k) {
    double sum = 0, size = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!std::isfinite(coefficient[i][k]))
        throw std::invalid_argument("a blending function has a coefficient that is not a number");
      sum += coefficient[i][k];
      size += std::abs(coefficient[i][k]);
    }
    if (!(std::abs(sum - (k == 0 ? 1 : 0)) <= 1e-12 * (1 + size)))
      throw std::invalid_argument("the blending functions do not add up to 1: their coefficients of u^" +
                                  std::to_string(k) + " must add up to " + (k == 0 ? "1" : "0"));
  }
  return {coefficient};
}

BlendingMatrix product_integrals(const Blending& blending, int derivative) {
  if (derivative < 0 || derivative > 2)
    throw std::invalid_argument("product_integrals: derivative must be 0, 1 or 2");
  BlendingMatrix c = blending.coefficient;
  for (int d = 0; d < derivative; ++d)
    for (auto& row : c) {
      for (std::size_t k = 0; k < 3; ++k) row[k] = static_cast<double>(k + 1) * row[k + 1];
      row[3] = 0;
    }
  BlendingMatrix integral{};
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b)
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < 4; ++l)
          integral[a][b] += c[a][k] * c[b][l] / static_cast<double>(k + l + 1);
  return integral;
}

}  // namespace loopwright
