// A piece that starts from its relaxed periodic cell instead of from the template: every loop takes the shape
// and the place that its image has in the cell, so that the piece's inside is at rest before the first step.
// The loops of its border are held whole: they are the frame, at the cell's pitch.
#pragma once
#include <optional>

#include "geometry/fabric.hpp"
#include "geometry/periodic_cell.hpp"

namespace loopwright {

// `piece` and `cell` are cut from the same graph, `cell` by `range`, and then relaxed. Nothing if some loop
// of the piece has no image in the cell, or if an interlacing of the result is not as it should be.
std::optional<Fabric> start_from_cell(const Fabric& piece, const Fabric& cell, const YarnGraph& graph,
                                      const CellRange& range);

}  // namespace loopwright
