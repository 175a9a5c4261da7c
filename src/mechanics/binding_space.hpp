// The first paper's correlation of yarn with binding points, as the coarse space of the yarn-scale solver:
// one coarse point for every place where a loop is drawn through others.
#pragma once
#include "geometry/fabric.hpp"
#include "mechanics/linear/coarse_space.hpp"

namespace loopwright {

// Rows: the control points of all yarns in turn. A loop's sinkers follow its own binding point and that of
// its neighbour in the yarn, its feet its own, its head the one of the loop drawn through it (a head with
// nothing drawn through has one to itself), its legs both: linear in the yarn between a quarter and three
// quarters of each half loop (loop_scale/correlation.hpp has the same map on type value points). Rows sum to
// 1, but for held points, which are empty. No points if the fabric has no loops.
CoarseSpace binding_space(const Fabric& fabric);

}  // namespace loopwright
