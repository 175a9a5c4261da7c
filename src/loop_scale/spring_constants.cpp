#include "loop_scale/spring_constants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopwright {

ConnectionTable measured_connections() {
  // studies/spring_constants/results.txt; coupling: the geometric mean of the two transverse ratios there
  ConnectionTable table;
  table.weft_even = {{0.2456, 0, 0}, 1003.3, 0.3257};
  table.warp_even = {{0, 0.1890, 0}, 2940.2, 0.3257};
  table.weft_odd = {{0.1368, 0, 0.2019}, 1277.2, 0.6143};
  table.warp_odd = {{0, 0.1258, 0.1650}, 72.4, 0.0948};
  return table;
}

LoopYarn loop_yarn(const Program& program, const GeometryOptions& options) {
  LoopYarn yarn;
  yarn.diameter_mm = options.diameter_mm;
  yarn.loop_length = options.loop_length;
  const YarnData* thickest = nullptr;
  for (const YarnData& data : program.yarns)
    if (!thickest || data.diameter_mm.value_or(0) > thickest->diameter_mm.value_or(0)) thickest = &data;
  const auto stated = [&](const std::optional<double> YarnData::*value) -> std::optional<double> {
    const std::optional<double> found = thickest ? thickest->*value : std::nullopt;
    return found && *found > 0 ? found : std::nullopt;
  };
  const std::optional<double> bend = stated(&YarnData::bend_stiffness_mN_mm2);
  const std::optional<double> tex = stated(&YarnData::linear_density_tex);
  yarn.estimated = !bend || !tex;
  yarn.bend_stiffness = bend.value_or(10) * 1e-9;
  // 1 tex is 1e-3 g/m; a circle of d mm across at 0.5 g/cm^3
  const double circle_mm2 = std::numbers::pi / 4 * options.diameter_mm * options.diameter_mm;
  yarn.linear_density_tex = tex.value_or(0.5 * circle_mm2 * 1000);
  return yarn;
}

double stiffness_unit(const LoopYarn& yarn) {
  return yarn.bend_stiffness / std::pow(yarn.loop_length * yarn.diameter_mm * 1e-3, 3);
}

double loop_mass(const LoopYarn& yarn) {
  return yarn.linear_density_tex * 1e-6 * yarn.loop_length * yarn.diameter_mm * 1e-3;
}

GridStiffness stiffness_of_fabric(double course_stiffness, double wale_stiffness, double wale_spacing,
                                  double course_spacing) {
  return {course_stiffness * course_spacing / wale_spacing, wale_stiffness * wale_spacing / course_spacing};
}

}  // namespace loopwright
