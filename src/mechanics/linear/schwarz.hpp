// Schwarz preconditioner: the fabric is cut into overlapping patches of nearly equal size, each patch's own
// block of the matrix is factored, and coarse spaces join them with the fabric's measures. Factors cost the
// same per loop however large the fabric is, where a factor of the whole matrix grows faster than its loops.
//
//   M^-1 = sum_p R_p' (R_p (A + shift D) R_p')^-1 R_p  +  sum_c P_c (P_c' (A + shift D) P_c)^-1 P_c'
//
// R_p picks the control points of a patch and their next neighbours along the yarn. There are two coarse
// spaces: the binding points (binding_space.hpp), which see loops move against each other, and hat functions
// over squares of patches, which follow long waves, rotations among them; each is joined by the measures.
// Source: Smith, Bjorstad, Gropp, Domain Decomposition (1996), additive methods of several levels.
#pragma once
#include <memory>
#include <vector>

#include "mechanics/linear/cholesky.hpp"
#include "mechanics/linear/coarse_space.hpp"

namespace loopwright {

class Schwarz {
 public:
  // Control points by their places in the plane. `coarse`, beside the hat functions, has a row for each of
  // them or no points.
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

  // A coarse space with the factor of the matrix that it sees.
  struct Level {
    CoarseSpace space;
    Cholesky factor;
    Unknowns right, result;
  };

  std::vector<std::unique_ptr<Patch>> patches_;
  std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace loopwright
