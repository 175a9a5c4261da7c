// The repeat of a piece that does not say it (knitout): the smallest number of wales and of courses after
// which the loops and what goes through them are the same again.
#pragma once
#include <optional>

#include "geometry/periodic_cell.hpp"
#include "geometry/window.hpp"

namespace loopwright {

struct FoundRepeat {
  CellRange range;  // to cut it out; it lies in the region, away from its edges if there is room
  int courses = 0;  // carriage passes that form loops, in one repeat
  // Share of the region's wales and courses in which it repeats; below 1 the rest is other stitches (the
  // columns left over where the region is no whole number of repeats wide).
  double wales_share = 0, courses_share = 0;
};

// Looks at the selected loops, which should fill a rectangle of needles and passes. Two loops are alike if
// they were formed alike, of the same yarn, on the same bed, lie in the same place of their stack, were drawn
// through loops at the same relative places and cross the legs of others in the same order; which way the
// yarn went does not count. Along the wales at least 85 % of the region's passes must repeat (after at least
// `least_seen` passes of a second repeat), along the courses its widest part. Nothing where there is no such
// repeat.
std::optional<FoundRepeat> find_repeat(const YarnGraph& graph, const LoopSelection& region,
                                       int least_seen = 4);
// The same for a whole piece, whose borders are of other stitches: looked for in its middle nine tenths, two
// thirds and half.
std::optional<FoundRepeat> find_repeat(const YarnGraph& graph);

}  // namespace loopwright
