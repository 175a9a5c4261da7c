// One repeat of a structure as a periodic cell: cut from the middle of a piece and closed onto itself.
#pragma once
#include <vector>

#include "geometry/type_points.hpp"

namespace loopwright {

// Loops formed in slots [first_slot, first_slot + wales) by the instructions of one repeat in a piece of
// several: repeat k takes instructions [repeat_starts[k], repeat_starts[k + 1]).
struct CellRange {
  int first_slot = 0, wales = 1;
  std::vector<int> repeat_starts;  // ascending; the last entry ends the last repeat
  int repeat = 0;                  // the one to cut out; there must be one before and after it
};

// The middle repeat of a fabric file with a repeat of its own. Throws std::invalid_argument if it has none.
CellRange cell_range(const Program& program);

// Every loop is chained to its successor in the yarn; a successor outside the cell is the cell's loop with
// the same place in the repeat, at a lattice shift. Which way the courses go does not matter: a cell of one
// plain course has one yarn of shift (1, 0) or (-1, 0). Throws std::invalid_argument, with the source line,
// where a loop has no counterpart in the cell (the cell reaches a selvedge, or the repeats are not alike).
YarnCurves cut_periodic_cell(const YarnGraph& graph, const GeometryOptions& options, const PlacedPiece& piece,
                             const CellRange& range);

// For every loop of the piece: the cell's loop that it is an image of and the lattice shift to it from where
// that loop lies on the cell's curve; an invalid id where it has none (selvedges, cast-on).
struct CellImage {
  LoopId loop;
  std::array<int, 2> shift{0, 0};
};
std::vector<CellImage> cell_images(const YarnGraph& graph, const CellRange& range);

}  // namespace loopwright
