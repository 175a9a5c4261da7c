// The size of a finite piece that no frame holds, found from where its loops are.
#pragma once
#include "geometry/fabric.hpp"

namespace loopwright {

struct PieceSize {
  double width = 0, height = 0;  // in d
};

// A course here is a run of loops that a yarn forms in one direction. Width: along x from the first to the
// last head of a course plus one wale, the mean over the widest courses (those with at least 90 % of the most
// loops). Height: along y from the lowest to the highest of these courses plus one of their distances. A
// piece with a single loop in a course, or a single course, keeps the fabric's own width or height.
PieceSize piece_size(const Fabric& fabric);

}  // namespace loopwright
