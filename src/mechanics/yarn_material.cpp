#include "mechanics/yarn_material.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace loopwright {
namespace {

double positive(double value, const char* name) {
  if (!std::isfinite(value) || value <= 0)
    throw std::invalid_argument(std::string("the yarn's ") + name + " must be a positive number");
  return value;
}

}  // namespace

YarnMaterial yarn_material(const YarnData& yarn, double diameter_mm) {
  const double d = positive(diameter_mm, "diameter");
  YarnMaterial material;
  if (yarn.bend_stiffness_mN_mm2) {
    const double B = positive(*yarn.bend_stiffness_mN_mm2, "bend stiffness") * 1e-3;  // N mm^2
    material.reference_bend_N_m2 = B * 1e-6;
    if (yarn.stretch_stiffness_cN)
      material.stretch_stiffness =
          positive(*yarn.stretch_stiffness_cN, "stretch stiffness") * 1e-2 * d * d / B;
    if (yarn.twist_stiffness_mN_mm2)
      material.twist_stiffness = positive(*yarn.twist_stiffness_mN_mm2, "twist stiffness") * 1e-3 / B;
    if (yarn.shell_stiffness)
      material.contact.stiffness = positive(*yarn.shell_stiffness, "shell stiffness") * std::pow(d, 5) / B;
  }
  if (yarn.shell_exponent) material.contact.exponent = positive(*yarn.shell_exponent, "shell exponent");
  if (yarn.core_diameter_mm && yarn.diameter_mm)
    material.contact.core = positive(*yarn.core_diameter_mm, "core diameter") / *yarn.diameter_mm;
  return material;
}

const YarnData& reference_yarn(const Program& program) {
  static const YarnData unstated;
  if (program.yarns.empty()) return unstated;
  return *std::max_element(program.yarns.begin(), program.yarns.end(),
                           [](const YarnData& a, const YarnData& b) {
                             return a.diameter_mm.value_or(0) < b.diameter_mm.value_or(0);
                           });
}

}  // namespace loopwright
