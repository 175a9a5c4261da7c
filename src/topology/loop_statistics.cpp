#include "topology/loop_statistics.hpp"

#include <algorithm>

namespace loopwright {

LoopStatistics loop_statistics(const YarnGraph& graph) {
  LoopStatistics s;
  s.loops = static_cast<int>(graph.loops.size());
  s.yarns = static_cast<int>(graph.yarns.size());
  s.interlacings = static_cast<int>(graph.interlacings.size());
  s.leg_crossings = static_cast<int>(graph.leg_crossings.size());
  s.unheld = static_cast<int>(graph.unheld.size());
  s.left_on_needles = static_cast<int>(graph.left_on_needles.size());
  for (const Loop& loop : graph.loops) {
    s.knit += loop.kind == LoopKind::knit;
    s.cast_on += loop.kind == LoopKind::cast_on;
    s.tuck += loop.kind == LoopKind::tuck;
    s.split += loop.kind == LoopKind::split;
    s.front += loop.side == StitchSide::front;
    s.rear += loop.side == StitchSide::rear;
    s.highest_stack = std::max(s.highest_stack, loop.head_count);
    s.passes = std::max(s.passes, loop.pass + 1);  // a pass without a loop is none of the fabric's
  }
  for (const GraphYarn& yarn : graph.yarns) {
    for (const Float& f : yarn.floats) {
      s.floats_past_loops += !f.passed.empty();
      s.most_loops_passed = std::max(s.most_loops_passed, static_cast<int>(f.passed.size()));
    }
  }
  return s;
}

}  // namespace loopwright
