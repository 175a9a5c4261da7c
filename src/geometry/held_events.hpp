// What happened to a needle while it held a loop: tucks laid on top and floats that passed. The order of
// these events is the order in which tucks and floats lie along the held loop's legs.
#pragma once
#include <vector>

#include "topology/yarn_graph.hpp"

namespace loopwright {

struct HeldEvent {
  int instruction = 0;
  LoopId tuck;              // the tuck loop, or invalid for a float
  int yarn = -1, gap = -1;  // the float: graph.yarns[yarn].floats[gap]
};

struct HeldEvents {
  std::vector<std::vector<HeldEvent>> of_loop;  // by LoopId, in time order

  // Share of the held loop's height at which an event lies: (i + 1) / (n + 1) for the i-th of n; 1/2 if it is
  // unknown.
  double share_of_tuck(LoopId held, LoopId tuck) const;
  double share_of_float(LoopId held, int yarn, int gap) const;
};

HeldEvents held_events(const YarnGraph& graph);

// Whether a loop's head is still on a needle at that time.
bool is_held_at(const Loop& loop, int instruction);

// How many rows the cloth grew at `from`, the last loop of a yarn before `to`, while the yarn waited (its
// carrier stood still): its float is as long as they are, and the two loops do not lie at one level. Not
// counted (0) where that is less than two rows, as in turning or in jacquard.
int rows_waited(const YarnGraph& graph, LoopId from, LoopId to);

// The stack that a loop's head lies in: the parents of its first child, or what its needle holds at the end.
std::vector<std::vector<LoopId>> head_stacks(const YarnGraph& graph);

}  // namespace loopwright
