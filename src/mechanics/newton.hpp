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
  int most_iterations = 100;
  std::function<bool(int iteration, double residual)> on_iteration;  // false: stop
};

struct NewtonResult {
  EnergyParts energy;
  double residual = 0, measure_residual = 0;
  int iterations = 0, linear_iterations = 0, factorisations = 0, crossings = 0;
  int spots = 0, spot_iterations = 0;  // places settled by themselves, their steps (hot_spots.hpp)
  bool converged = false, stopped = false;
  double shift = 0;           // the last shift, to start the next call from
  Measures measure_forces{};  // dE/d(width, height, skew), B/d^2, free or not
};

// `history`, if there is one, is where friction starts from and is left as it is at the end.
NewtonResult newton(const YarnModel& model, YarnState& state, const NewtonOptions& options,
                    double first_shift, ContactHistory* history = nullptr);

}  // namespace loopwright
