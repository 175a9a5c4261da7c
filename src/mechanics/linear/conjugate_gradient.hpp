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
};

// Stops when the residual, in the preconditioner's norm, has fallen by `tolerance`, or after `most`
// iterations.
ConjugateGradientResult conjugate_gradient(const BlockMatrix& matrix, double shift,
                                           const Preconditioner& preconditioner, const Unknowns& b,
                                           double tolerance, int most, Unknowns& x);

}  // namespace loopwright
