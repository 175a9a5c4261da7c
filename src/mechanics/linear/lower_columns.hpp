// The lower triangle of A + shift D in compressed columns, its control points in a given order: what a sparse
// factorisation wants to read.
#pragma once
#include <vector>

#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

class LowerColumns {
 public:
  std::vector<int> start, row;  // rows in order in a column
  std::vector<double> value;

  // order: [place] control point; empty: as they are numbered.
  void set_pattern(const BlockMatrix& matrix, const std::vector<int>& order);
  // Of a matrix with the pattern last set.
  void set_values(const BlockMatrix& matrix, double shift);
  int columns() const { return static_cast<int>(start.size()) - 1; }

 private:
  struct Entry {
    int place, source;  // of its row among the control points, in order; of its block in the matrix
  };
  std::vector<std::size_t> block_start_;  // [place of a column's control point]
  std::vector<Entry> entry_;
};

}  // namespace loopwright
