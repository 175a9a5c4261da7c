// Schwarz preconditioner: the fabric is cut into overlapping patches of nearly equal size, each patch's own
// block of the matrix is factored, and coarse spaces join them. Factors cost the same per loop however large
// the fabric is, where a factor of the whole matrix grows faster than its loops.
//
//   M^-1 = sum_p R_p' (R_p H R_p')^-1 R_p + sum_c P_c (P_c' H P_c)^-1 P_c' + W (W' K W)^-1 W',
//   H = A + shift D,   K = H bordered by the measures,   W = [-H^-1 C; 1]
//
// R_p picks the control points of a patch and their next neighbours along the yarn. There are two coarse
// spaces: the binding points (binding_space.hpp), which see loops move against each other, and the splines of
// a plate with a cell for every patch (plate_space), which follow long waves. W is how the fabric answers a
// change of its measures, nearly: a few conjugate-gradient iterations of its own. With it the measures leave
// the rest alone; carried along affinely instead, every loop would resist them as if its yarn could not bend,
// and iterations would grow with the piece.
// Source: Smith, Bjorstad, Gropp, Domain Decomposition (1996), additive methods of several levels;
// Nicolaides, Deflation of conjugate gradients, SIAM J. Numer. Anal. 24 (1987), for W.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "mechanics/linear/cholesky.hpp"
#include "mechanics/linear/coarse_space.hpp"

namespace loopwright {

class Schwarz {
 public:
  // Control points by their places in the plane. `coarse`, beside the plate, has a row for each of them or no
  // points; it is not copied and must stay.
  void set_patches(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held,
                   const BlockMatrix& matrix, const CoarseSpace& coarse);
  bool ready() const { return !patches_.empty(); }
  // False if a patch or the coarse matrix is not positive definite: then A + shift D is not either.
  bool factor(const BlockMatrix& matrix, double shift);
  // Control points of the patches that were not, where it was they. With a metric that weighs more there,
  // factor_again() factors only these.
  std::vector<std::int32_t> indefinite() const;
  bool factor_again(const BlockMatrix& matrix, double shift);
  // Factors the patches of these control points anew, where the metric weighs more than it did.
  bool factor_round(const std::vector<std::int32_t>& nodes, const BlockMatrix& matrix, double shift);
  void solve(const Unknowns& b, Unknowns& x);

  int iterations = 0;  // that answers to the measures took, over all calls of factor()

 private:
  struct Patch {
    std::vector<std::int32_t> nodes;  // sorted
    std::size_t first_result = 0;
    Cholesky factor;
    bool definite = true;
  };

  // A coarse space with the factor of the matrix that it sees.
  struct Level {
    const CoarseSpace* space = nullptr;
    Cholesky factor;
    Unknowns right, result;
  };

  bool factor_patches(const BlockMatrix& matrix, double shift, bool all);
  void number_results();
  bool answer_measures(const BlockMatrix& matrix, double shift);
  void solve_points(const Unknowns& b, Unknowns& x);  // without the measures

  std::size_t control_points_ = 0;
  std::vector<std::unique_ptr<Patch>> patches_;
  std::vector<std::array<float, 3>> results_;           // of all patches' control points
  std::vector<std::int32_t> result_start_, result_at_;  // [control point] its places among the results
  bool coarse_ready_ = false;                           // the levels have their factors
  CoarseSpace plate_;
  std::vector<std::unique_ptr<Level>> levels_;
  std::vector<Unknowns> answers_;  // W, for width, height, skew
  Block measures_inverse_{};       // (W' K W)^-1
};

}  // namespace loopwright
