// A supernodal Cholesky factor copied to single precision, for preconditioners. CHOLMOD before version 5.2
// (Debian 12 has 4) factors in double precision only and keeps what it needs to factor again; solving from
// such a copy reads half as much memory. Only where the build found CHOLMOD.
#pragma once
#include <cholmod.h>

#include <cstddef>
#include <vector>

namespace loopwright {

class SupernodalSingle {
 public:
  SupernodalSingle() = default;
  // From a supernodal L L' factor of a matrix of 3 x 3 blocks that was given in this order: [place] block.
  SupernodalSingle(const cholmod_factor& factor, const std::vector<int>& order);
  // x = (L L')^-1 b as the blocks are numbered.
  void solve(const double* b, double* x) const;
  std::size_t entries() const { return value_.size(); }

 private:
  // Supernode k: columns first_[k] .. first_[k + 1], rows row_[row_start_[k]] .. row_[row_start_[k + 1]]
  // (its own columns first); values by columns from value_start_[k], each from its diagonal on, of which the
  // inverse is kept.
  std::vector<int> order_, first_, row_start_, row_;
  std::vector<std::size_t> value_start_;
  std::vector<float> value_;
  std::size_t most_rows_ = 0;  // of a supernode
};

}  // namespace loopwright
