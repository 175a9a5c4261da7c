// Sparse factorisation of the symmetric matrices of constrained motion,
//   [ H   J'     ]
//   [ J  -eps I  ]
// With H positive definite and a small eps this is quasi-definite: L D L' exists in any order of elimination,
// without pivoting. Used with repeated correction of the constraints, eps leaves no trace in the result. The
// signs of D tell whether H was positive definite on the motions that J allows.
#pragma once
#include <memory>
#include <span>

namespace loopwright {

class SaddleSolver {
 public:
  SaddleSolver();
  ~SaddleSolver();
  SaddleSolver(const SaddleSolver&) = delete;
  SaddleSolver& operator=(const SaddleSolver&) = delete;

  // A new matrix of this size, all zero.
  void start(int rows);
  // Adds to entry (row, column) and its mirror image; either triangle may be named; repeated
  // entries are added up.
  void add(int row, int column, double value);
  // False if the factorisation broke down. The elimination order is kept while the pattern stays the same.
  bool factor();
  int negative_pivots() const;
  // b becomes the solution.
  void solve(std::span<double> b) const;
  // Entries of the factor, for reports.
  double factor_entries() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace loopwright
