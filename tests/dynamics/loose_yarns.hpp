// Yarns by themselves, for tests of what ties them.
#pragma once
#include <vector>

#include "dynamics/spline_model.hpp"
#include "dynamics/yarn_motion.hpp"

namespace loopwright {

// Control points on a straight line.
inline std::vector<Vec3> line(const Vec3& from, const Vec3& step, int points) {
  std::vector<Vec3> place;
  for (int i = 0; i < points; ++i) place.push_back(from + i * step);
  return place;
}

// Adds a yarn, unstretched as it lies, of mass 1 per length; which one it is.
inline int add_yarn(SplineModel& model, MotionState& state, const std::vector<Vec3>& points,
                    double stretch_stiffness, double bend_stiffness, bool held) {
  SplineYarn yarn;
  yarn.first = model.points;
  yarn.points = static_cast<int>(points.size());
  yarn.stretch_stiffness = stretch_stiffness;
  yarn.bend_stiffness = bend_stiffness;
  set_rest_shape(yarn, points, 0, StretchLaw::mean);
  set_mass_per_length(yarn, 1, points);
  model.yarns.push_back(yarn);
  model.points += yarn.points;
  model.held.resize(static_cast<std::size_t>(model.points), held ? 1 : 0);
  state.place.insert(state.place.end(), points.begin(), points.end());
  state.velocity.resize(state.place.size());
  return static_cast<int>(model.yarns.size()) - 1;
}

}  // namespace loopwright
