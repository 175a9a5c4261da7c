// Affine changes of a cell's or framed piece's measures.
#pragma once
#include "geometry/fabric.hpp"

namespace loopwright {

// The fabric with other measures (d); its points go along affinely.
Fabric deformed(const Fabric& fabric, double width, double height, double skew);

}  // namespace loopwright
