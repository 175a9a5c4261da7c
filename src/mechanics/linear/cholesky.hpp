// Sparse Cholesky factorisation of a bordered block matrix plus a multiple of its metric D, behind a narrow
// interface:
//   [ A + shift D   C            ]
//   [ C'            G + shift Dm ]
// Its dyads are reckoned in afterwards (Woodbury's formula), so it has to be positive definite without them.
// CHOLMOD (supernodal) where the build found it, otherwise Eigen's simplicial factorisation.
#pragma once
#include <memory>

#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

// Inverse of a symmetric 3 x 3 matrix; false if it is not positive definite.
bool invert3(const Block& s, Block& inverse);

class Cholesky {
 public:
  Cholesky();
  ~Cholesky();
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  // False if the matrix is not positive definite. The elimination order is found anew when the pattern
  // changes.
  bool factor(const BlockMatrix& matrix, double shift);
  // x = M^-1 b for the matrix of the last successful factor().
  void solve(const Unknowns& b, Unknowns& x);
  // Keeps of the factor only what solve() needs, in single precision: half of what it holds and of what a
  // solution must read, and nothing of what only factoring needs. Good for a preconditioner; solve() is then
  // right to about six digits. The next factor() works anew. Without CHOLMOD nothing changes.
  void compact();
  // Gives up the factor, and its memory. With CHOLMOD alone: otherwise nothing changes.
  void clear();
  // Entries of the factor, for reports.
  double factor_entries() const;

 private:
  struct Factor;
  void solve_without_dyads(const Unknowns& b, Unknowns& x);
  bool factor_dyads(const BlockMatrix& matrix);
  std::unique_ptr<Factor> factor_;
};

}  // namespace loopwright
