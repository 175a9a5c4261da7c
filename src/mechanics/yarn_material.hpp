// Yarn data as the trade states it, in the model's units.
#pragma once
#include "mechanics/yarn_model.hpp"
#include "notation/program.hpp"

namespace loopwright {

// Stiffness of a yarn of outer diameter d (`diameter_mm`, the unit of length) with bend stiffness B:
//   stretch  EA d^2 / B;   twist  C / B, for yarn that is lively a third of B if it is not stated
//   contact  k = kc d^5 / B (N/mm^3 is B/d^5 by its dimension), core over d, exponent
// What is not stated keeps YarnMaterial's defaults. Throws std::invalid_argument for what is not positive.
YarnMaterial yarn_material(const YarnData& yarn, double diameter_mm);

// The data of the thickest yarn, which sets the unit of length; the first one where no diameter is stated.
const YarnData& reference_yarn(const Program& program);

}  // namespace loopwright
