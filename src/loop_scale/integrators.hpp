// The integration methods that the first paper weighs against each other (section 4.4), in their textbook
// form, for any step: what compares them must be able to see them fail. NetKernel::advance is the fast
// Verlet.
#pragma once
#include <string_view>
#include <vector>

#include "loop_scale/net_kernel.hpp"

namespace loopwright {

enum class Integrator : std::uint8_t {
  verlet,               // eq. (9), damping solved for
  explicit_euler,       // X += h V, then V += h a of before
  semi_implicit_euler,  // V += h a, then X += h V of after
  implicit_euler        // V += h a(X, V of after), X += h V of after: Newton's method, conjugate gradients
};
std::string_view name_of(Integrator integrator);

// Advances by `steps` steps of length h; no bound on h. What it cost is added to `evaluations` (of the
// springs; a product with the stiffness matrix counts as one). The state may become infinite: the caller
// looks.
void integrate(const MassSpringNet& net, const NetKernel& kernel, Integrator integrator, double h, int steps,
               NetState& state, long long* evaluations = nullptr);

}  // namespace loopwright
