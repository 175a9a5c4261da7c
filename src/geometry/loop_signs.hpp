// What a loop's neighbours say about the z order at its crossings: signs, layers and lateral places.
#pragma once
#include <vector>

#include "geometry/layout.hpp"
#include "topology/yarn_graph.hpp"

namespace loopwright {

inline int stitch_sign(StitchSide side) { return static_cast<int>(side); }

// z of a yarn at a crossing of foot and leg or leg and head, in r (DESIGN section 5).
inline constexpr double crossing_reach = 1;

// All z in yarn radii.
struct LoopSigns {
  int s = 1;     // of the loop itself
  double c = 1;  // of its children; 0: children of both signs (split loops)
  // z of the foot (A) and the lower leg (B): clear of the layers of all heads that they cross.
  double foot = -crossing_reach, lower_leg = crossing_reach;
  double foot_layer = 0;   // z of the loop among plated loops that go through the same parents
  double head_layer = 0;   // z of its head in its stack, front positive
  double foot_spread = 0;  // the feet stand so much farther out, beside a sibling that goes the other way
  double head_spread = 0;  // the head is so much wider, for children that go both ways
  double leg_offset = 0;   // z of the legs where they cross those of other loops (cables)
  double early_rise =
      0.05;  // share of the way from the foot's side to the head's that a leaning leg has made near its foot
};

// For every loop the fullest stack that its head lies in; empty for a head without children.
std::vector<std::vector<LoopId>> stacks_of_heads(const YarnGraph& graph);

std::vector<LoopSigns> loop_signs(const YarnGraph& graph, const Layout& layout, double shape_radius);

}  // namespace loopwright
