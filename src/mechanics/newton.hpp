// Newton's method with an adaptive shift for one energy: the full Hessian plus a multiple of the identity,
// just large enough to be positive definite and trusted; steps are cut so that no yarn passes through
// another, then by a line search.
#pragma once
#include <functional>

#include "mechanics/assembly.hpp"
#include "mechanics/linear/cholesky.hpp"

namespace loopwright {

struct NewtonOptions {
  double tolerance = 2e-4;
  // A large piece, not periodic, may end where all but a two-hundredth of its control points are below this
  // force: the rest is left to a run that follows. 0: it must not.
  double mostly_quiet = 0;
  int most_iterations = 100;
  std::function<bool(int iteration, double residual)> on_iteration;  // false: stop
};

struct NewtonResult {
  EnergyParts energy;
  double residual = 0, measure_residual = 0;
  int iterations = 0, linear_iterations = 0, factorisations = 0, crossings = 0;
  int spot_iterations = 0;                                 // of places settled by themselves (hot_spots.hpp)
  bool converged = false, stopped = false, quiet = false;  // quiet: mostly, and ended for that
  double shift = 0;                                        // the last shift, to start the next call from
  double first_shift = 0;     // what the first step needed, for a call that starts as far from rest
  Measures measure_forces{};  // dE/d(width, height, skew), B/d^2, free or not
};

// `history`, if there is one, is where friction starts from and is left as it is at the end.
NewtonResult newton(const YarnModel& model, YarnState& state, const NewtonOptions& options,
                    double first_shift, ContactHistory* history = nullptr);

}  // namespace loopwright
