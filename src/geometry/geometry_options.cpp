#include "geometry/geometry_options.hpp"

#include <algorithm>
#include <numbers>

namespace loopwright {

double liveliness_of(const YarnData& yarn, double diameter_mm) {
  return 2 * std::numbers::pi * yarn.liveliness_per_m.value_or(0) * 1e-3 * diameter_mm;
}

GeometryOptions make_geometry_options(const Program& program) {
  const FabricSettings& settings = program.settings;
  const auto yarn_diameter_mm = [](const YarnData& yarn) {
    return yarn.diameter_mm ? *yarn.diameter_mm : yarn.core_diameter_mm.value_or(0);
  };
  double thickest_mm = 0;
  for (const YarnData& yarn : program.yarns) thickest_mm = std::max(thickest_mm, yarn_diameter_mm(yarn));

  double loop_mm = 7.1;
  if (settings.loop_length_mm) {
    loop_mm = *settings.loop_length_mm;
  } else if (settings.gauge_npi) {
    loop_mm = 4.2 * 25.4 / *settings.gauge_npi;
  } else if (thickest_mm > 0) {
    loop_mm = 17 * thickest_mm;
  }

  GeometryOptions options;
  const double d = thickest_mm > 0 ? thickest_mm : loop_mm / 17;
  options.diameter_mm = d;
  options.loop_length = loop_mm / d;
  options.tuck_length = settings.tuck_length_mm ? *settings.tuck_length_mm / d : 0.75 * options.loop_length;
  options.bed_change = settings.bed_change_mm.value_or(0) / d;
  options.float_slack = settings.float_slack.value_or(0);
  options.wale_pitch = options.loop_length / 4.05;
  options.course_pitch = options.loop_length / 5.3;
  options.needle_pitch = settings.gauge_npi ? 25.4 / *settings.gauge_npi / d : options.wale_pitch;

  const std::size_t carriers = std::max(program.carriers.size(), program.yarns.size());
  options.yarn_diameters.assign(carriers, 1);
  options.yarn_colours.assign(carriers, "");
  options.yarn_tex.assign(carriers, 0);
  options.yarn_liveliness.assign(carriers, 0);
  for (std::size_t c = 0; c < program.yarns.size(); ++c) {
    const double mm = yarn_diameter_mm(program.yarns[c]);
    if (mm > 0) options.yarn_diameters[c] = mm / d;
    options.yarn_colours[c] = program.yarns[c].colour;
    options.yarn_tex[c] = program.yarns[c].linear_density_tex.value_or(0);
    options.yarn_liveliness[c] = liveliness_of(program.yarns[c], d);
  }
  return options;
}

}  // namespace loopwright
