// Two-level Schwarz preconditioner: the fabric is cut into overlapping patches of nearly equal size, each
// patch's own block of the matrix is factored, and a coarse space joins them with the fabric's measures.
// Factors cost the same per loop however large the fabric is, where a factor of the whole matrix grows faster
// than its loops.
//
//   M^-1 = sum_p R_p' (R_p (A + shift D) R_p')^-1 R_p  +  P (P' (A + shift D) P)^-1 P'
//
// R_p picks the control points of a patch and their next neighbours along the yarn; columns of P are the
// coarse points for each direction, and the measures themselves. Source: Smith, Bjorstad, Gropp, Domain
// Decomposition (1996), the additive two-level method.
#pragma once
#include <memory>
#include <vector>

#include "mechanics/linear/cholesky.hpp"
#include "mechanics/linear/coarse_space.hpp"

namespace loopwright {

class Schwarz {
 public:
  // Control points by their places in the plane. `coarse` has a row for each of them; if it has no points,
  // hat functions on the grid of patches take its place.
  void set_patches(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held,
                   const BlockMatrix& matrix, const CoarseSpace& coarse);
  bool ready() const { return !patches_.empty(); }
  // False if a patch or the coarse matrix is not positive definite: then A + shift D is not either.
  bool factor(const BlockMatrix& matrix, double shift);
  void solve(const Unknowns& b, Unknowns& x);

 private:
  struct Patch {
    std::vector<std::int32_t> nodes;  // sorted
    Cholesky factor;
    Unknowns right, result;
  };

  std::vector<std::unique_ptr<Patch>> patches_;
  CoarseSpace coarse_;
  Cholesky coarse_factor_;
  Unknowns coarse_right_, coarse_result_;
};

}  // namespace loopwright
