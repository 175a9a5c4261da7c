#include "geometry/loop_signs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace loopwright {
namespace {

constexpr double layer_gap =
    2.2;  // between yarns that lie over each other, in r: a little more than they are thick
// Between the middles of loops whose legs cross; their legs lie like shingles, 0.6 up and down.
constexpr double crossing_gap = 3.8;
constexpr double split_spread = 0.7;

// Loops drawn through the same head to the same side, front one first.
std::vector<LoopId> plated_group(const YarnGraph& graph, LoopId id, const Loop& loop) {
  std::vector<LoopId> group;
  for (const LoopId sibling : graph.loop(loop.parents.front()).children)
    if (graph.loop(sibling).side == loop.side) group.push_back(sibling);
  if (group.empty()) group.push_back(id);
  std::stable_sort(group.begin(), group.end(), [&](LoopId a, LoopId b) {
    return graph.loop(a).instruction == graph.loop(b).instruction &&
           graph.loop(a).head_rank < graph.loop(b).head_rank;
  });
  return group;
}

// A passes behind (s > 0) the upper legs of all parents and B before their heads. A head in the same stack
// that the loop is not drawn through (a split loop's parents joined it later) is left wholly behind or wholly
// in front.
void clear_parents(const YarnGraph& graph, LoopId id, const std::vector<LoopId>& stack,
                   std::vector<LoopSigns>& signs) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Loop& loop = graph.loop(id);
  LoopSigns& sign = signs[id.position()];
  const double s = sign.s;
  // Everything mirrored to s = +1.
  double leg = infinity, head = -infinity, nearest = infinity, farthest = -infinity;
  for (const LoopId parent : loop.parents) {
    const LoopSigns& of = signs[parent.position()];
    const double layer = s * of.head_layer, c = s * of.c * crossing_reach;
    leg = std::min(leg, layer + c);
    head = std::max(head, layer - c);
    nearest = std::min(nearest, layer);
    farthest = std::max(farthest, layer);
  }
  double behind = -infinity, before = infinity;
  for (const LoopId other : stack) {
    if (std::find(loop.parents.begin(), loop.parents.end(), other) != loop.parents.end()) continue;
    const LoopSigns& of = signs[other.position()];
    const double layer = s * of.head_layer, c = s * of.c * crossing_reach;
    if (layer < nearest) behind = std::max(behind, layer + c);
    if (layer > farthest) before = std::min(before, layer - c);
  }
  double foot = leg - 2 * crossing_reach, lower_leg = head + 2 * crossing_reach;
  if (foot < behind + crossing_reach) foot = (leg + behind) / 2;
  if (lower_leg > before - crossing_reach) lower_leg = (head + before) / 2;

  const std::vector<LoopId> group = plated_group(graph, id, loop);
  const double count = static_cast<double>(group.size());
  const double from_front = static_cast<double>(std::find(group.begin(), group.end(), id) - group.begin());
  const double rank = s > 0 ? from_front : count - 1 - from_front;  // 0: nearest to where the loop comes out
  sign.foot_layer = s * ((count - 1) / 2 - rank) * layer_gap;
  sign.foot = s * (foot - rank * layer_gap);
  sign.lower_leg = s * (lower_leg + (count - 1 - rank) * layer_gap);
}

// Cables: move crossing legs apart, forward under face stitches and back under rear stitches, until every
// pair has its gap.
void separate_legs(const YarnGraph& graph, const Layout& layout, double r, std::vector<LoopSigns>& signs) {
  const auto foot_side = [&](std::size_t i) { return layout.lower[i].z / r + 1.5 * signs[i].s; };
  const auto head_side = [&](std::size_t i) {
    return layout.upper[i].z / r + 1.5 * signs[i].c + signs[i].head_layer;
  };
  const auto leans = [&](std::size_t i) { return std::abs(layout.upper[i].x - layout.lower[i].x) > 3 * r; };
  const auto leg = [&](LoopId id) {
    const std::size_t i = id.position();
    const double side = leans(i) ? head_side(i) : (foot_side(i) + head_side(i)) / 2;
    return side + signs[i].leg_offset;
  };
  // A leg in front is early on whichever side is farther forward, one behind on whichever is farther back.
  for (const LegCrossing& crossing : graph.leg_crossings) {
    const std::size_t front = crossing.front.position(), back = crossing.back.position();
    if (head_side(front) > foot_side(front)) signs[front].early_rise = 1;
    if (head_side(back) < foot_side(back)) signs[back].early_rise = 1;
  }
  constexpr int most_sweeps = 60;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    bool moved = false;
    for (const LegCrossing& crossing : graph.leg_crossings) {
      const double missing = leg(crossing.back) + crossing_gap - leg(crossing.front);
      if (missing <= 1e-9) continue;
      LoopSigns& front = signs[crossing.front.position()];
      LoopSigns& back = signs[crossing.back.position()];
      // A leg may move away from the sinkers of its children, which lie behind face stitches, but not into
      // them.
      const bool may_advance = front.c > 0, may_retreat = back.c < 0;
      const double share = may_advance == may_retreat ? 0.5 : may_advance ? 1 : 0;
      front.leg_offset += share * missing;
      back.leg_offset -= (1 - share) * missing;
      moved = true;
    }
    if (!moved) return;
  }
}

}  // namespace

std::vector<std::vector<LoopId>> stacks_of_heads(const YarnGraph& graph) {
  std::vector<std::vector<LoopId>> stack_of(graph.loops.size());
  for (const Loop& loop : graph.loops)
    for (const LoopId parent : loop.parents)
      if (loop.parents.size() > stack_of[parent.position()].size())
        stack_of[parent.position()] = loop.parents;
  return stack_of;
}

std::vector<LoopSigns> loop_signs(const YarnGraph& graph, const Layout& layout, double shape_radius) {
  const std::vector<std::vector<LoopId>> stack_of = stacks_of_heads(graph);
  std::vector<LoopSigns> signs(graph.loops.size());
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const Loop& loop = graph.loops[i];
    LoopSigns& sign = signs[i];
    sign.s = stitch_sign(loop.side);
    sign.c = sign.s;
    sign.foot = -sign.s * crossing_reach;
    sign.lower_leg = sign.s * crossing_reach;
    sign.head_layer = ((std::max(loop.head_count, 1) - 1) / 2.0 - loop.head_rank) * layer_gap;
    if (loop.children.empty()) continue;
    bool front = false, rear = false;
    for (const LoopId child : loop.children)
      (graph.loop(child).side == StitchSide::front ? front : rear) = true;
    sign.c = front && rear ? 0 : front ? 1 : -1;
  }
  // Children that go both ways through a head stand side by side in it, and all heads of the stack are wider
  // for them.
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    if (signs[i].c != 0) continue;
    for (const LoopId member : stack_of[i]) signs[member.position()].head_spread = split_spread;
    const std::vector<LoopId>& children = graph.loops[i].children;
    for (const LoopId child : children)
      if (graph.loop(child).side != graph.loop(children.front()).side)
        signs[child.position()].foot_spread = split_spread;
  }
  for (std::size_t i = 0; i < graph.loops.size(); ++i)
    if (!graph.loops[i].parents.empty())
      clear_parents(graph, LoopId(i), stack_of[graph.loops[i].parents.front().position()], signs);
  separate_legs(graph, layout, shape_radius, signs);
  return signs;
}

}  // namespace loopwright
