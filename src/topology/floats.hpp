// Floats: the yarn between two loops that follow each other, and the held loops that it passes on its way.
#pragma once
#include "topology/yarn_graph.hpp"

namespace loopwright {

// Fills `floats` of every yarn of `graph`, whose loops are there. A float passes the loops that are on
// needles, of either bed, strictly between its ends at the moment when the yarn goes there; a miss takes the
// yarn past its needle. A loop that the yarn passes and passes again on its way back does not count, nor what
// faces the needles of the two loops that the float joins.
void trace_floats(const Program& program, const KnittingRecord& record, YarnGraph& graph);

}  // namespace loopwright
