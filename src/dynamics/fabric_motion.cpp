// From a fabric to its yarns in motion, and back.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/yarn_motion.hpp"

namespace loopwright {

MotionUnits motion_units(const Fabric& fabric, double bend_N_m2) {
  if (!(bend_N_m2 > 0))
    throw std::invalid_argument(
        "motion in seconds needs the yarn's bend stiffness: name a material in the fabric file");
  const auto thickest =
      std::max_element(fabric.yarns.begin(), fabric.yarns.end(),
                       [](const FabricYarn& a, const FabricYarn& b) { return a.diameter < b.diameter; });
  if (thickest == fabric.yarns.end() || !(thickest->linear_density_tex > 0))
    throw std::invalid_argument(
        "motion in seconds needs the yarn's linear density: name a material in the fabric file");
  const double d = fabric.diameter_mm * 1e-3, rho = thickest->linear_density_tex * 1e-6;
  return {d, d * d * std::sqrt(rho / bend_N_m2), bend_N_m2 / (d * d)};
}

SplineModel spline_model(const Fabric& fabric, const YarnMaterial& material, double set, bool drawn_lengths) {
  if (fabric.periodic)
    throw std::invalid_argument(
        "yarn in motion needs a piece with edges: a periodic cell has a lattice that cannot move in time");
  double densest = 0;
  for (const FabricYarn& yarn : fabric.yarns) densest = std::max(densest, yarn.linear_density_tex);
  SplineModel model;
  for (const FabricYarn& yarn : fabric.yarns) {
    SplineYarn spline;
    spline.first = model.points;
    spline.points = static_cast<int>(yarn.control_points.size());
    const double section =
        yarn.diameter * yarn.diameter;  // stiffness and mass in proportion, as src/mechanics
    spline.stretch_stiffness = material.stretch_stiffness * section;
    spline.bend_stiffness = material.bend_stiffness * section;
    spline.diameter = yarn.diameter;
    spline.evenness = 0.005;  // bends are tight in cloth that is pulled, and it is never long in free flight
    set_rest_shape(spline, yarn.control_points, set, StretchLaw::mean);
    if (!drawn_lengths)
      spline.rest_length.assign(static_cast<std::size_t>(spline.segments()), yarn.segment_rest_length);
    const double density =
        densest > 0 && yarn.linear_density_tex > 0 ? yarn.linear_density_tex / densest : section;
    set_mass_per_parameter(spline, density * yarn.segment_rest_length);
    model.points += spline.points;
    model.held.insert(model.held.end(), yarn.held.begin(), yarn.held.end());
    model.yarns.push_back(std::move(spline));
  }
  model.held.resize(static_cast<std::size_t>(model.points), 0);
  return model;
}

MotionState motion_state(const Fabric& fabric) {
  MotionState state;
  for (const FabricYarn& yarn : fabric.yarns)
    state.place.insert(state.place.end(), yarn.control_points.begin(), yarn.control_points.end());
  state.velocity.assign(state.place.size(), Vec3{});
  return state;
}

Fabric with_places(const Fabric& fabric, std::span<const Vec3> place) {
  Fabric moved = fabric;
  std::size_t next = 0;
  for (FabricYarn& yarn : moved.yarns)
    for (Vec3& q : yarn.control_points) q = place[next++];
  return moved;
}

}  // namespace loopwright
