// How much of a fabric's area is covered by yarn.
#pragma once
#include "geometry/fabric.hpp"

namespace loopwright {

// Share of the area covered by yarn, seen along z, between 0 and 1. Yarn counts as opaque over its whole
// diameter. Periodic: of the cell. Finite: of the rectangle between the outermost heads of loops; NaN if that
// has no area. Counted on a grid of about 16 points a diameter (fewer where the piece is so large that the
// grid would pass 4 million points): a yarn's rim is found to half a grid step, and errors along a curved rim
// cancel.
double cover_factor(const Fabric& fabric);

}  // namespace loopwright
