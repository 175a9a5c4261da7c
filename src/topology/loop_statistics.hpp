// What a graph holds, in numbers: for the summary that `check` prints and for tests.
#pragma once
#include "topology/yarn_graph.hpp"

namespace loopwright {

struct LoopStatistics {
  int loops = 0, yarns = 0, passes = 0, interlacings = 0;
  int knit = 0, cast_on = 0, tuck = 0, split = 0;  // loops by kind
  int front = 0, rear = 0;                         // loops by the bed on which they were formed
  int highest_stack = 0;      // most heads on one needle when they were cast off, dropped or left
  int floats_past_loops = 0;  // floats that pass at least one held loop
  int most_loops_passed = 0;  // by one float
  int leg_crossings = 0, unheld = 0, left_on_needles = 0;
};

LoopStatistics loop_statistics(const YarnGraph& graph);

}  // namespace loopwright
