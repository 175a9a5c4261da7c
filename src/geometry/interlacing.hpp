// The interlacing invariant (DESIGN section 4) on curves, and the smallest distance of yarns.
#pragma once
#include <vector>

#include "geometry/fabric.hpp"

namespace loopwright {

struct InterlacingCheck {
  int expected = 0, intact = 0;
  std::vector<int> broken;  // indices into Fabric::interlacings
};

// For every pair of parent and child: the signed number of passes of each half of the child's loop through a
// surface spanned by the parent's head must be +1 and -1 for a front stitch, -1 and +1 for a rear stitch, in
// the sense that the parent's own yarn direction gives to its head (so it holds in any attitude in space).
// Yarn slides: the top of a head is found anew, by climbing from the fitted apex along the wale direction,
// for slides up to 0.4 of a loop.
InterlacingCheck check_interlacings(const Fabric& fabric);

struct Clearance {
  double distance = 0;  // in d, between centrelines
  int yarn_a = -1, yarn_b = -1;
  double t_a = 0, t_b = 0;  // yarn parameters
};

// Smallest distance between centrelines of different pieces of yarn, in d; pieces of one yarn count where
// they are more than 1.25 pi/2 d of rest length apart. Periodic fabrics: all images. Infinite distance if
// there are no two pieces.
Clearance min_clearance(const Fabric& fabric);

}  // namespace loopwright
