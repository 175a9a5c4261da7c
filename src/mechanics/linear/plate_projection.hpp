// Part of coarse_space.hpp: P' (A + shift D) P for the splines of a plate.
#pragma once
#include "mechanics/linear/coarse_space.hpp"

namespace loopwright {

// Pattern and blocks of `coarse`; `points`: splines that carry something.
void project_plate(const PlateGrid& plate, int points, const BlockMatrix& matrix, double shift,
                   BlockMatrix& coarse);

}  // namespace loopwright
