// How the size and the stiffness of a cell depend on the data of its yarn: derivatives at its rest without
// friction, from the factored Hessian, without coming to rest again.
//
// At rest E_q(q, theta) = 0 (q: control points and free measures), so dq/dtheta = -H^-1 E_q,theta. A size s
// that is one of the measures needs one solve for all theta (adjoint): ds/dtheta = -(H^-1 e_s) . E_q,theta.
// E_q,theta comes from central differences of the gradient at the same place; stiffness from central
// differences of the condensed Hessian along (dq/dtheta, theta). Both differences are exact to about 1e-7.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "mechanics/relax.hpp"

namespace loopwright {

// What a yarn's data say; one changes while the others keep their SI values. The loop length is that of all
// yarns, floats included, in proportion. Thinner yarns of a fabric follow the thickest in proportion.
enum class YarnQuantity {
  loop_length,
  diameter,
  core_diameter,
  bend_stiffness,
  stretch_stiffness,
  shell_stiffness,
  shell_exponent
};
inline constexpr std::array<YarnQuantity, 7> yarn_quantities{
    YarnQuantity::loop_length,    YarnQuantity::diameter,          YarnQuantity::core_diameter,
    YarnQuantity::bend_stiffness, YarnQuantity::stretch_stiffness, YarnQuantity::shell_stiffness,
    YarnQuantity::shell_exponent};
// As in the headers of fabric files: "loop-length", "bend-stiffness" ...
std::string name_of(YarnQuantity quantity);

// Relative changes: d ln(output) / d ln(quantity), per cent per per cent.
struct Sensitivity {
  YarnQuantity quantity{};
  double width = 0, height = 0;                                    // in mm, not in d
  double course_modulus = 0, wale_modulus = 0, shear_modulus = 0;  // N/m, as in MembraneStiffness
};

// One for each quantity, in the order of yarn_quantities. `rest`: of sharp_rest() or elastic_rest() of a
// periodic cell with `options`. Throws std::invalid_argument if the fabric is not periodic or neither size is
// free, std::runtime_error if the rest is not a minimum.
std::vector<Sensitivity> sensitivities(const RelaxResult& rest, const RelaxOptions& options);

// The fabric and yarn with one quantity at `factor` times its value: what the derivatives are derivatives of.
struct ChangedYarn {
  Fabric fabric;
  RelaxOptions options;
};
ChangedYarn with_quantity(const Fabric& fabric, const RelaxOptions& options, YarnQuantity quantity,
                          double factor);

// Standard deviations of width and height, relative, from those of independent quantities, relative, to first
// order. Pairs of a quantity and its deviation; a quantity that is not named is certain. Throws
// std::invalid_argument for deviations that are negative or not finite.
struct Deviation {
  YarnQuantity quantity{};
  double share = 0;
};
struct SizeDeviation {
  double width = 0, height = 0;
};
SizeDeviation size_deviation(std::span<const Sensitivity> sensitivities,
                             std::span<const Deviation> deviations);

}  // namespace loopwright
