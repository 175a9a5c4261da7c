#include "outputs/state_material.hpp"

#include <array>
#include <utility>

namespace loopwright {

std::optional<YarnMaterial> state_material(const State& state, std::string* missing) {
  YarnMaterial material;
  const std::array<std::pair<const char*, double*>, 7> wanted{
      {{"stretch_stiffness", &material.stretch_stiffness},
       {"bend_stiffness", &material.bend_stiffness},
       {"contact_outer", &material.contact.outer},
       {"contact_core", &material.contact.core},
       {"contact_stiffness", &material.contact.stiffness},
       {"contact_exponent", &material.contact.exponent},
       {"friction", &material.friction}}};
  for (const auto& [key, value] : wanted) {
    const auto found = state.numbers.find(key);
    if (found == state.numbers.end()) {
      if (missing != nullptr) *missing = key;
      return std::nullopt;
    }
    *value = found->second;
  }
  if (const auto bend = state.numbers.find("reference_bend_N_m2"); bend != state.numbers.end())
    material.reference_bend_N_m2 = bend->second;
  if (const auto twist = state.numbers.find("twist_stiffness"); twist != state.numbers.end())
    material.twist_stiffness = twist->second;
  return material;
}

void set_state_material(State& state, const YarnMaterial& material) {
  state.numbers["stretch_stiffness"] = material.stretch_stiffness;
  state.numbers["bend_stiffness"] = material.bend_stiffness;
  state.numbers["contact_outer"] = material.contact.outer;
  state.numbers["contact_core"] = material.contact.core;
  state.numbers["contact_stiffness"] = material.contact.stiffness;
  state.numbers["contact_exponent"] = material.contact.exponent;
  state.numbers["friction"] = material.friction;
  if (material.twist_stiffness > 0) state.numbers["twist_stiffness"] = material.twist_stiffness;
  if (material.reference_bend_N_m2 > 0) state.numbers["reference_bend_N_m2"] = material.reference_bend_N_m2;
}

}  // namespace loopwright
