// Cholesky factorisation of a bordered block matrix plus a multiple of its metric (see cholesky.hpp), all
// entries kept: for cells of a few loops. Every loop of such a cell touches most others or their images, so
// that a sparse factor fills up anyway, and finding its pattern anew whenever a contact comes or goes takes
// longer than the factor. The border is the last three rows. LAPACK where CHOLMOD was found (which needs it
// too), otherwise Eigen.
#pragma once
#include <vector>

#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

class DenseCholesky {
 public:
  DenseCholesky();
  // False if the matrix is not positive definite; then `against`, if the factor got far enough to tell, is a
  // direction x with x'(A + shift D)x not positive (up to rounding), else empty.
  bool factor(const BlockMatrix& matrix, double shift, Unknowns& against);
  // x = M^-1 b for the matrix of the last successful factor().
  void solve(const Unknowns& b, Unknowns& x);

 private:
  void direction_against(std::size_t pivot, Unknowns& against) const;

  int order_ = 0;
  std::vector<double> entry_;  // [order][order]; column after column, of which the lower triangle counts
  std::vector<double> right_;  // [order] right-hand side, then solution
};

}  // namespace loopwright
