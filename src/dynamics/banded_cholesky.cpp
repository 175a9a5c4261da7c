#include "dynamics/banded_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace loopwright {

void multiply(const BandMatrix& a, std::span<const Vec3> x, std::span<Vec3> y) {
  for (std::size_t i = 0; i < a.size(); ++i) y[i] = a.row[i][3] * x[i];
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t apart = 1; apart <= std::min<std::size_t>(i, 3); ++apart) {
      const double v = a.row[i][3 - apart];
      y[i] += v * x[i - apart];
      y[i - apart] += v * x[i];
    }
}

BandedCholesky::BandedCholesky(const BandMatrix& a) : factor_(a.size()) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t first = i - std::min<std::size_t>(i, 3);
    for (std::size_t j = first; j <= i; ++j) {
      double sum = a.row[i][3 - (i - j)];
      for (std::size_t k = std::max(first, j - std::min<std::size_t>(j, 3)); k < j; ++k)
        sum -= factor_.row[i][3 - (i - k)] * factor_.row[j][3 - (j - k)];
      if (j < i) {
        factor_.row[i][3 - (i - j)] = sum * factor_.row[j][3];
      } else {
        if (!(sum > 1e-14 * a.row[i][3]))
          throw std::invalid_argument("a banded matrix is not positive definite at row " + std::to_string(i) +
                                      ": is there a stretch of yarn without mass?");
        factor_.row[i][3] = 1 / std::sqrt(sum);
      }
    }
  }
}

void BandedCholesky::solve(std::span<Vec3> b) const {
  const std::size_t n = factor_.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t apart = 1; apart <= std::min<std::size_t>(i, 3); ++apart)
      b[i] -= factor_.row[i][3 - apart] * b[i - apart];
    b[i] *= factor_.row[i][3];
  }
  for (std::size_t i = n; i-- > 0;) {
    b[i] *= factor_.row[i][3];
    for (std::size_t apart = 1; apart <= std::min<std::size_t>(i, 3); ++apart)
      b[i - apart] -= factor_.row[i][3 - apart] * b[i];
  }
}

}  // namespace loopwright
