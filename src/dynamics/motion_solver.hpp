// Inside YarnMotion: matrices and factors that are kept from step to step.
#pragma once
#include <memory>
#include <vector>

#include "dynamics/saddle_solver.hpp"
#include "dynamics/yarn_motion.hpp"
#include "mechanics/assembly.hpp"
#include "mechanics/linear/cholesky.hpp"

namespace loopwright {

// Weight of -eps in [H J'; J -eps]: small against J H^-1 J', large against rounding.
inline constexpr double saddle_softness = 1e-10;
// The same for sliding bindings of an explicit step, against about 1 over a control point's mass: where the
// two touches of a foot come near each other they contradict each other, and this bounds what they do about
// it.
inline constexpr double sliding_softness = 1e-2;

struct YarnMotion::Solver {
  SaddleSolver saddle;
  bool explicit_factored = false;           // [M J'; J -eps] with constant J
  std::vector<BandedCholesky> mass_factor;  // without constraints
  // Contact.
  std::unique_ptr<Assembly> assembly;
  Cholesky cholesky;
  BlockMatrix hessian;
  Unknowns gradient, direction;
  double shift = 0, contact_energy = 0;
  Measures contact_measures{};
};

}  // namespace loopwright
