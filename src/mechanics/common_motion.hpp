// What all yarn of a step has in common: an affine map of space, and in a piece that it does not do justice
// to a smooth field over the plane beside it. Neither moves yarn through yarn as long as they do not fold
// space, so that only what is left has to stay below half the distance to yarn that was not looked at. With
// the affine map alone the steps of a piece whose edges move otherwise than its middle would be cut the more
// the larger it is.
#pragma once
#include <cstdint>
#include <vector>

#include "mechanics/yarn_model.hpp"

namespace loopwright {

struct CommonMotion {
  double in_plane = 0, across = 0;  // how much it moves two points apart, for their distance: x, y; z
  double thickness = 0;             // of the fabric along z, d
  double loose = 0;                 // the largest motion of yarn that is left, d
  std::vector<double> left;         // [control point] what is left of its own motion, d

  // The largest relative motion of two points of yarn at least `range` apart, for their distance: over a
  // distance D >= range that is at most in_plane D + across min(D, thickness) and twice the loose motion,
  // which is hardest at D = range.
  double far_ratio(double range) const;
};

// `enough`: loose motion (d) for which a finer look is not needed.
CommonMotion common_motion(const YarnModel& model, const YarnState& state, const YarnState& target,
                           double range, double enough);

}  // namespace loopwright
