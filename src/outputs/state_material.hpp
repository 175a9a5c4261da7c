// How the yarn of a saved state bends, stretches and touches.
#pragma once
#include <optional>

#include "mechanics/yarn_model.hpp"
#include "outputs/state.hpp"

namespace loopwright {

// The numbers of the state's run as the material that it was relaxed with. `missing`, if given, gets the name
// of the first one that is not there.
std::optional<YarnMaterial> state_material(const State& state, std::string* missing = nullptr);

// Writes them; what state_material() reads back.
void set_state_material(State& state, const YarnMaterial& material);

}  // namespace loopwright
