// The softest motions of cloth at rest, and so whether it is stable: the lowest eigenvalues of the stored
// energy's Hessian H over the yarn's mass matrix M (rest length as mass), with sizes and held points fixed,
//   H u = lambda M u,   lambda in B/d^4: omega^2 rho d^4 / B of the free oscillation (rho: mass per length).
// Rigid motion, which costs nothing, is left out. Stable: all lambda above zero; sizes that can change must
// be stable as well (condensed_stiffness, its eigenvalues above zero). Source of the criterion: Sylvester's
// law of inertia for the bordered Hessian.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "experiments/rest_hessian.hpp"

namespace loopwright {

struct Mode {
  double lambda = 0;  // B/d^4
  // Share of the motion along the yarn, int (u . t)^2 / int u^2: near 1 for yarn that slides through its
  // loops. Without friction that is all but free; what is left comes from the control points' spacing.
  double along = 0;
  std::vector<Vec3> shape;  // displacement of every control point, int u^2 ds = 1
};

struct ModeOptions {
  int wanted = 6;
  double tolerance = 1e-7;  // bound on the relative error of lambda plus the shift of the inverse
  int most_vectors = 400;   // of the subspace; more are not tried
};

// The lowest modes, in ascending order. By block Krylov iteration on (H + s M)^-1 M with a Cholesky factor,
// fully orthogonalised; s is as small as makes the sum positive definite. Throws std::runtime_error if
// no s does or the subspace does not suffice; std::invalid_argument if fewer than one mode is wanted or
// there are not so many.
std::vector<Mode> lowest_modes(const Fabric& fabric, const ModelOptions& options,
                               const ModeOptions& modes = {});

// Whether cloth at rest is stable without friction: its lowest modes at fixed sizes and, for a cell whose
// modes are all above zero, the eigenvalues of its condensed stiffness over width, height and skew (B/d^3),
// ascending. A cell that friction holds may be unstable in this sense.
struct Stability {
  std::vector<Mode> modes;
  std::optional<std::array<double, 3>> sizes;
  bool stable = false;
};
Stability stability(const Fabric& fabric, const ModelOptions& options, int modes_wanted);

}  // namespace loopwright
