#include "geometry/loop_signs.hpp"

#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

constexpr double layer_gap =
    2.2;  // between yarns that lie over each other, in r: a little more than they are thick
constexpr double crossing_gap = 2.6;  // between legs that cross
constexpr double split_reach = 2;     // feet that go both ways through one head: leg between them
constexpr double split_spread = 1.7;

// Loops drawn through the same head, front one first.
std::vector<LoopId> plated_group(const YarnGraph& graph, LoopId id, const Loop& loop) {
  std::vector<LoopId> group;
  if (loop.parents.empty()) return {id};
  for (const LoopId sibling : graph.loop(loop.parents.front()).children)
    if (graph.loop(sibling).side == loop.side && graph.loop(sibling).instruction == loop.instruction)
      group.push_back(sibling);
  std::stable_sort(group.begin(), group.end(),
                   [&](LoopId a, LoopId b) { return graph.loop(a).head_rank < graph.loop(b).head_rank; });
  return group;
}

// Cables: move crossing legs apart, face stitches forward and rear stitches back, until every pair has its
// gap.
void separate_legs(const YarnGraph& graph, const Layout& layout, double r, std::vector<LoopSigns>& signs) {
  const auto leg = [&](LoopId id) {
    const std::size_t i = id.position();
    return (layout.lower[i].z + layout.upper[i].z) / (2 * r) + 0.75 * (signs[i].s + signs[i].c) +
           signs[i].leg_offset;
  };
  constexpr int most_sweeps = 60;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    bool moved = false;
    for (const LegCrossing& crossing : graph.leg_crossings) {
      const double missing = leg(crossing.back) + crossing_gap - leg(crossing.front);
      if (missing <= 1e-9) continue;
      LoopSigns& front = signs[crossing.front.position()];
      LoopSigns& back = signs[crossing.back.position()];
      const double share = front.s == back.s ? (front.s > 0 ? 1 : 0) : 0.5;
      front.leg_offset += share * missing;
      back.leg_offset -= (1 - share) * missing;
      moved = true;
    }
    if (!moved) return;
  }
}

}  // namespace

std::vector<LoopSigns> loop_signs(const YarnGraph& graph, const Layout& layout, double shape_radius) {
  std::vector<LoopSigns> signs(graph.loops.size());
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const Loop& loop = graph.loops[i];
    LoopSigns& sign = signs[i];
    sign.s = stitch_sign(loop.side);
    sign.c = sign.s;
    if (!loop.children.empty()) {
      bool front = false, rear = false;
      for (const LoopId child : loop.children)
        (graph.loop(child).side == StitchSide::front ? front : rear) = true;
      sign.c = front && rear ? 0 : front ? 1 : -1;
      if (front && rear) sign.head_spread = split_spread;
    }
    const double stack_half = (std::max(loop.head_count, 1) - 1) / 2.0 * layer_gap;
    sign.head_layer = stack_half - loop.head_rank * layer_gap;

    if (loop.parents.empty()) continue;
    const std::vector<LoopId> group = plated_group(graph, LoopId(i), loop);
    const auto rank = std::find(group.begin(), group.end(), LoopId(i)) - group.begin();
    const double group_half = (static_cast<double>(group.size()) - 1) / 2 * layer_gap;
    sign.foot_layer = group_half - static_cast<double>(rank) * layer_gap;
    const double parents_half = (static_cast<double>(loop.parents.size()) - 1) / 2 * layer_gap;
    sign.foot_reach = 1 + parents_half + group_half;
    for (const LoopId sibling : graph.loop(loop.parents.front()).children) {
      if (graph.loop(sibling).side == loop.side) continue;
      sign.foot_reach = std::max(sign.foot_reach, parents_half + split_reach);
      if (sibling < LoopId(i)) sign.foot_spread = split_spread;
    }
  }
  separate_legs(graph, layout, shape_radius, signs);
  return signs;
}

}  // namespace loopwright
