// Cutting a part out of a piece: the middle of a large one, or what a fabric file asked for.
#pragma once
#include <cstdint>
#include <vector>

#include "geometry/type_points.hpp"

namespace loopwright {

// Which loops are wanted, by LoopId.
using LoopSelection = std::vector<std::uint8_t>;

// `wales` x `courses` loops round the middle of the piece; 0: all. A tube is taken whole round (its wales are
// all kept).
LoopSelection middle_window(const YarnGraph& graph, const Layout& layout, int wales, int courses);

// Loops formed on the needles and by the instructions of Program::window; everything if the program sets
// none.
LoopSelection program_window(const YarnGraph& graph, const ProgramWindow& window);

// The selected loops as curves. Yarn is cut in the middle of the sinker or float where it leaves the window;
// floats between loops that are both outside are dropped. Held: cut ends, heads whose children are all
// outside or that lie on a needle, and feet of loops whose parents are all outside.
YarnCurves cut_window(const YarnGraph& graph, const GeometryOptions& options, const PlacedPiece& piece,
                      const LoopSelection& selection);

}  // namespace loopwright
