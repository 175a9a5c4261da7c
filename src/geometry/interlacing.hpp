// The interlacing invariant (DESIGN section 4) on curves, and the smallest distance of yarns.
#pragma once
#include <vector>

#include "geometry/fabric.hpp"

namespace loopwright {

struct InterlacingCheck {
  int expected = 0, intact = 0;
  int by_head = 0;          // of the intact ones, those that only the parent's head alone shows (below)
  std::vector<int> broken;  // indices into Fabric::interlacings
};

// For every pair of parent and child: a linking number of each half of the child's loop with the parent's
// must be +1 and -1 for a front stitch, -1 and +1 for a rear stitch, in the sense that the parent's own yarn
// direction gives to its head (so it holds in any attitude in space). An open arc has no linking number; both
// are closed along the wale at infinity, the parent's arc (from sinker to sinker) downward from its ends, the
// halves of the child's loop (from the top of the loop before it in its course to its own, and from there to
// the top of the loop after it) upward from theirs. Seen along the wale that is the signed number of
// crossings at which the child's yarn is the lower one. It cannot change without yarn going through yarn or a
// line along the wale from one of these ends, however far loops lean and whatever yarn slides, as long as the
// top of the child's head stays between its feet and the parent's feet stay out of its arc's head (about 0.35
// of a loop). Where that says no, yarn beyond the pair hangs over the ends (the chain of a bind-off, held
// loops with tucks): then the parent's head alone is looked at (head_reading.hpp).
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
