// The yarn between loops: sinkers between neighbours, floats past held loops, turns at selvedges, yarn ends.
#pragma once
#include <vector>

#include "geometry/loop_signs.hpp"
#include "geometry/type_points.hpp"

namespace loopwright {

// Fills piece.sinkers from the loops already placed. `flat`: where they lie before anything is moved, which
// says what a float passes.
void place_sinkers(const YarnGraph& graph, const GeometryOptions& options,
                   const std::vector<LoopSigns>& signs, const Layout& flat, PlacedPiece& piece);

}  // namespace loopwright
