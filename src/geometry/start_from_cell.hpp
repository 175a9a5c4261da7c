// A piece that starts from its relaxed periodic cell instead of from the template: every loop takes the shape
// and the place that its image has in the cell, so that the piece's inside is at rest before the first step.
// The loops of its border are held whole: they are the frame, at the cell's pitch.
#pragma once
#include <optional>
#include <vector>

#include "geometry/fabric.hpp"
#include "geometry/periodic_cell.hpp"

namespace loopwright {

// Of which segment of the cell a segment of the piece is a copy, and at which lattice shift.
struct SegmentImage {
  int yarn = 0, segment = 0;  // in the cell
  std::array<int, 2> shift{0, 0};
};

struct StartFromCell {
  Fabric fabric;
  // [yarn of the piece][segment]. Empty if the yarns were sampled anew instead of copied: where a yarn of the
  // piece is not a stretch of one of the cell's endless yarns (it turns at a selvedge).
  std::vector<std::vector<SegmentImage>> images;
};

// `piece` and `cell` are cut from the same graph, `cell` by `range`, and then relaxed; the piece's loops hold
// all its yarn. Nothing if some loop of the piece has no image in the cell, or if an interlacing of the
// result is not as it should be.
std::optional<StartFromCell> start_from_cell(const Fabric& piece, const Fabric& cell, const YarnGraph& graph,
                                             const CellRange& range);

}  // namespace loopwright
