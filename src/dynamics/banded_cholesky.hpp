// Banded symmetric positive definite matrices of half-bandwidth 3, the mass matrices of cubic splines.
// Own code and not LAPACK's pbtrf/pbtrs: for four diagonals those fall back to calls of length 3, which cost
// more than the work, and they want the three coordinates as separate columns.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "base/vec3.hpp"

namespace loopwright {

// Lower triangle by rows: row[i][k] is the entry (i, i - 3 + k); entries left of the matrix are 0.
struct BandMatrix {
  std::vector<std::array<double, 4>> row;

  explicit BandMatrix(std::size_t n = 0) : row(n) {}
  std::size_t size() const { return row.size(); }
  double& at(std::size_t i, std::size_t j) { return i >= j ? row[i][3 - (i - j)] : row[j][3 - (j - i)]; }
  double operator()(std::size_t i, std::size_t j) const {
    const std::size_t apart = i >= j ? i - j : j - i;
    return apart > 3 ? 0 : i >= j ? row[i][3 - apart] : row[j][3 - apart];
  }
};

// y = A x for the points x.
void multiply(const BandMatrix& a, std::span<const Vec3> x, std::span<Vec3> y);

// A = L L', made once; every solve is 16 multiplications a point and coordinate.
class BandedCholesky {
 public:
  BandedCholesky() = default;
  // Throws std::invalid_argument if A is not positive definite (to rounding).
  explicit BandedCholesky(const BandMatrix& a);

  // b becomes A^-1 b, for the three coordinates at once. b must have the size of A.
  void solve(std::span<Vec3> b) const;

 private:
  BandMatrix factor_;  // L, its diagonal inverted
};

}  // namespace loopwright
