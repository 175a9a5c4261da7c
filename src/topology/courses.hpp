// Which course each loop belongs to.
#pragma once
#include <vector>

#include "topology/yarn_graph.hpp"

namespace loopwright {

// Per loop, counted from 0. All loops that the carriage formed in one pass are of one course: the course
// after the latest that any of them was drawn through. A pass without such loops (a cast-on, tucks only) is
// of the course of the pass before it, or of course 0. So the two passes of a course of interlock, or of a
// tube, count as one.
std::vector<int> course_numbers(const YarnGraph& graph);

}  // namespace loopwright
