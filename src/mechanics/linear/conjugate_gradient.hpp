// Preconditioned conjugate gradients for (A + shift D) x = b; the preconditioner is a factor of an earlier matrix.
#pragma once
#include "mechanics/linear/block_matrix.hpp"
#include "mechanics/linear/cholesky.hpp"

namespace loopwright {

struct ConjugateGradientResult {
  bool converged = false;
  bool indefinite = false;  // a direction of negative curvature was met: A + shift D is not positive definite
  int iterations = 0;
};

// Stops when the residual, in the preconditioner's norm, has fallen by `tolerance`, or after `most` iterations.
ConjugateGradientResult conjugate_gradient(const BlockMatrix& matrix, double shift, Cholesky& preconditioner, const Unknowns& b,
                                           double tolerance, int most, Unknowns& x);

}  // namespace loopwright
