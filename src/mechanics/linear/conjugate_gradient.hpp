// Preconditioned conjugate gradients for (A + shift D) x = b; the preconditioner is any symmetric
// positive definite operator, such as a factor of an earlier matrix or a Schwarz method.
#pragma once
#include <functional>

#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

using Preconditioner = std::function<void(const Unknowns& b, Unknowns& x)>;  // x = M^-1 b

struct ConjugateGradientResult {
  bool converged = false;
  bool indefinite = false;  // a direction of negative curvature was met: A + shift D is not positive definite
  int iterations = 0;
  std::vector<std::int32_t>
      bent;              // then the control points that give it nine tenths of its negative curvature
  double reduction = 1;  // what is left of the residual that it started from
};

struct ConjugateGradientLimits {
  int most = 200;      // iterations
  int patience = -1;   // gives up when, at the pace of late, more than so many iterations are left; -1: never
  bool go_on = false;  // x holds where to start from; otherwise it starts from zero
};

// Stops when the residual, in the preconditioner's norm, is `tolerance` of that of b, or at its limits.
ConjugateGradientResult conjugate_gradient(const BlockMatrix& matrix, double shift,
                                           const Preconditioner& preconditioner, const Unknowns& b,
                                           double tolerance, const ConjugateGradientLimits& limits,
                                           Unknowns& x);

}  // namespace loopwright
