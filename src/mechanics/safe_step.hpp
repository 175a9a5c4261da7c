// How far a step may go so that no yarn passes through another.
//
// A straight motion of all points from x to x + s (0 to 1) cannot carry yarn a through yarn b while, for
// every pair of their points, the relative motion stays below their distance. Checked for every pair of
// segments within the list's range, with the yarn as straight sticks round the contact samples (0.12 d apart
// at rest length; sticks tile the yarn as it lies, so thin and stretched yarn is seen too); all other pairs
// are farther apart than the range, so that motion beyond what they have in common (common_motion.hpp) is
// capped by the range.
#pragma once
#include "mechanics/assembly.hpp"

namespace loopwright {

// Two segments that move more for their distance than they may.
struct NearPair {
  std::int32_t a = 0, b = 0;
  double ratio = 0;  // relative motion over distance at scale 1
};

// A control point that moves farther than it may.
struct FarNode {
  std::int32_t node = 0;
  double ratio = 0;  // of its motion to that
};

struct SafeStep {
  double scale = 1;         // the largest allowed multiple of the step, at most 1
  double pair_ratio = 0;    // relative motion over distance of the worst pair at scale 1
  double loose_motion = 0;  // largest motion beyond the common one at scale 1, in d
  int worst_a = -1, worst_b = -1;
  // False where yarns are nearer than sticks can tell from touching (0.016 d): the step is not certified
  // then.
  bool surely_apart = true;
  // What holds the step back, if it was asked for: all pairs that move more than `share`, and the control
  // points that move farther beyond the common motion than pairs were looked for.
  std::vector<NearPair> near;
  std::vector<FarNode> far;
};

// `assembly` has its pairs within `range`, found at this state. `share` (below 1): part of a distance that
// may be used up. `list_causes`: whether to list what holds the step back.
SafeStep safe_step(const YarnModel& model, const Assembly& assembly, const YarnState& state,
                   const YarnState& target, double range, double outer_diameter, double share,
                   bool list_causes = false);

}  // namespace loopwright
