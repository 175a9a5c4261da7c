// Friction's history of a piece that starts from its relaxed cell: what holds the cell at rest holds the
// piece too.
#pragma once
#include "geometry/start_from_cell.hpp"
#include "mechanics/assembly.hpp"

namespace loopwright {

// The contacts of the cell at every place of the piece where both their segments are there. `start` must say
// which segments they are (images not empty), else nothing is carried over.
ContactHistory tiled_history(const Fabric& cell, const ContactHistory& history, const StartFromCell& start);

}  // namespace loopwright
