// Tubes: which courses of a yarn go round, and which wall of the tube every loop is in.
#pragma once
#include <cstdint>
#include <vector>

#include "topology/binding_points.hpp"
#include "topology/yarn_graph.hpp"

namespace loopwright {

// Loops first .. last of a yarn, neighbours in a course, all in one direction.
struct Run {
  std::size_t yarn = 0, first = 0, last = 0;
  std::size_t size() const { return last - first + 1; }
};
std::vector<Run> runs_of(const YarnGraph& graph, const BindingPoints& points);

// Two runs of a yarn, there and back, that a tube's round is made of. The second is not above the first in
// any wale, the next row knits on one of them only, and all that is held of one lies on one side of the
// other's yarn: each on a bed of its own, or, where both beds carry stitches of both walls (rib in the
// round), as the floats between every other needle pass it.
struct Round {
  Run one, other;
  bool one_in_front = true;  // `one` is the wall toward the front bed
};
std::vector<Round> rounds_of(const YarnGraph& graph, const BindingPoints& points);

// By loop: 1 in a wall that lay toward the front bed, -1 toward the rear bed, 0 in no tube. Loops of no round
// belong to the wall whose wales they continue.
std::vector<std::int8_t> tube_walls(const YarnGraph& graph, const std::vector<Round>& rounds);

// By binding point, from the loops that meet there.
std::vector<std::int8_t> walls_of_points(const BindingPoints& points, const std::vector<std::int8_t>& walls);

}  // namespace loopwright
