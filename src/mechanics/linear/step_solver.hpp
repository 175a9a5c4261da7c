// Solves (H + shift D) step = -gradient for Newton's method, by what suits the size of the fabric:
//   few control points    a Cholesky factor at every step, dense for cells of some loops;
//   middling              conjugate gradients with the factor of an earlier step as preconditioner while it
//   is good; many, not periodic    conjugate gradients with a Schwarz preconditioner, factored anew when it
//   has grown stale.
// If H + shift D is not positive definite the shift is raised until it is.
#pragma once
#include "mechanics/linear/conjugate_gradient.hpp"
#include "mechanics/linear/dense_cholesky.hpp"
#include "mechanics/linear/schwarz.hpp"
#include "mechanics/yarn_model.hpp"

namespace loopwright {

class StepSolver {
 public:
  explicit StepSolver(const YarnModel& model);

  struct Report {
    bool solved = false;
    int raised = 0;  // how often the shift had to be raised
  };
  // `accuracy`: relative residual of iterative solves, in the preconditioner's norm.
  // `raise_at`, if there is one, makes the hessian's metric weigh more at the control points it is given, so
  // that not all of a large piece has to be shifted for some. `raised`: where the
  // metric weighs more than in the last call, for the same matrix but for that.
  using RaiseAt = std::function<void(const std::vector<std::int32_t>& nodes, double shift)>;
  Report solve(const BlockMatrix& hessian, const YarnState& state, const Unknowns& gradient, double accuracy,
               double& shift, Unknowns& step, const RaiseAt& raise_at = {},
               const std::vector<std::int32_t>& raised = {});

  int factorisations = 0, iterations = 0;  // over all calls; a direct solve counts as one iteration

 private:
  bool solve_direct(const BlockMatrix& hessian, const Unknowns& gradient, double& shift, int& raised,
                    Unknowns& step);
  bool solve_patched(const BlockMatrix& hessian, const YarnState& state, const Unknowns& gradient,
                     double accuracy, double& shift, int& raised, Unknowns& step, const RaiseAt& raise_at,
                     const std::vector<std::int32_t>& raised_at);

  const YarnModel& model_;
  Cholesky cholesky_;
  DenseCholesky dense_;
  Schwarz schwarz_;
  // Along which the matrix was not positive when a dense factor last failed; empty: it did not, in the last
  // step.
  Unknowns against_;
  bool current_ = false;  // the factor at hand may serve as preconditioner
  double usual_ = 6;      // iterations that a fresh Schwarz factor took last to lower the residual e-fold
};

}  // namespace loopwright
