// Interlacings read at a parent's head alone, by windows of yarn: where a linking number cannot be had.
#pragma once
#include "geometry/loop_arcs.hpp"

namespace loopwright {

// The child's yarn is intersected with a fan of triangles spanned by the parent's head from neck to neck,
// from a sinker to the top of the child's head and from there to the next sinker; `sense` must be the signed
// number of passes of the first half, minus that the one of the second. Where the heads were fitted is tried
// first; if yarn has slid (by up to 0.4 of a loop), their tops are found anew by climbing along the wale;
// where a parent's head was moved aside, so that the middle of a sinker lies between its legs, the foot is
// followed into the next loop, on the sides where that is no loop of the pair's.
bool passes_head(const LoopArcs& arcs, const LoopArc& parent, const LoopArc& child, const Vec3& moved,
                 int sense, bool may_go_before, bool may_go_after);

}  // namespace loopwright
