// Two-level Schwarz preconditioner: the fabric is cut into overlapping patches of nearly equal size, each
// patch's own block of the matrix is factored, and a coarse space of patch-wise translations joins them with
// the fabric's measures. Factors cost the same per loop however large the fabric is, where a factor of the
// whole matrix grows faster than its loops.
//
//   M^-1 = sum_p R_p' (R_p (A + shift D) R_p')^-1 R_p  +  P (P' (A + shift D) P)^-1 P'
//
// R_p picks the control points of a patch and of one ring of neighbours; columns of P are hat functions on a
// grid of patches (rows sum to 1) for each direction, and the measures themselves. Source: Smith, Bjorstad,
// Gropp, Domain Decomposition (1996), the additive two-level method.
#pragma once
#include <memory>
#include <vector>

#include "mechanics/linear/cholesky.hpp"

namespace loopwright {

class Schwarz {
 public:
  // Control points by their places in the plane; `patch` is the wanted number of control points in a patch.
  void set_patches(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held,
                   const BlockMatrix& matrix, int patch);
  bool ready() const { return !patches_.empty(); }
  // False if a patch or the coarse matrix is not positive definite: then A + shift D is not either.
  bool factor(const BlockMatrix& matrix, double shift);
  void solve(const Unknowns& b, Unknowns& x);

 private:
  struct Patch {
    std::vector<std::int32_t> nodes;  // sorted
    BlockMatrix matrix;
    Cholesky factor;
    Unknowns right, result;
  };
  void coarse_matrix(const BlockMatrix& matrix, double shift);

  std::vector<std::unique_ptr<Patch>> patches_;
  // Hat functions: control point i takes part in coarse points coarse_point_[4 i + k] with coarse_weight_[4 i
  // + k].
  std::vector<std::int32_t> coarse_point_;
  std::vector<double> coarse_weight_;
  int coarse_unknowns_ = 0;
  std::vector<double> coarse_factor_;  // dense lower Cholesky factor, row-major
};

}  // namespace loopwright
