#include "geometry/held_events.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace loopwright {
namespace {

template <class Match>
double share(const std::vector<HeldEvent>& events, Match match) {
  const auto found = std::find_if(events.begin(), events.end(), match);
  if (found == events.end()) return 0.5;
  return (static_cast<double>(found - events.begin()) + 1) / (static_cast<double>(events.size()) + 1);
}

}  // namespace

double HeldEvents::share_of_tuck(LoopId held, LoopId tuck) const {
  return share(of_loop[held.position()], [&](const HeldEvent& e) { return e.tuck == tuck; });
}

double HeldEvents::share_of_float(LoopId held, int yarn, int gap) const {
  return share(of_loop[held.position()],
               [&](const HeldEvent& e) { return !e.tuck.valid() && e.yarn == yarn && e.gap == gap; });
}

std::vector<std::vector<LoopId>> head_stacks(const YarnGraph& graph) {
  std::vector<std::vector<LoopId>> stacks;
  for (const Loop& loop : graph.loops)
    if (!loop.parents.empty() && (stacks.empty() || stacks.back() != loop.parents))
      stacks.push_back(loop.parents);
  std::map<std::pair<Bed, int>, std::vector<LoopId>> on_needles;
  for (const LoopId id : graph.left_on_needles) {
    const Loop& loop = graph.loop(id);
    on_needles[{loop.head_bed, static_cast<int>(std::lround(4 * loop.head_slot))}].push_back(id);
  }
  for (auto& [needle, loops] : on_needles) stacks.push_back(std::move(loops));
  return stacks;
}

HeldEvents held_events(const YarnGraph& graph) {
  HeldEvents events;
  events.of_loop.resize(graph.loops.size());
  for (const std::vector<LoopId>& stack : head_stacks(graph))
    for (const LoopId tuck : stack) {
      if (graph.loop(tuck).kind != LoopKind::tuck) continue;
      for (const LoopId held : stack) {
        if (graph.loop(held).instruction >= graph.loop(tuck).instruction) continue;
        // A loop that was moved onto the needle later was not held there when the tuck was laid.
        if (std::abs(graph.loop(held).head_slot - graph.loop(tuck).slot) > 0.3) continue;
        HeldEvent event;
        event.instruction = graph.loop(tuck).instruction;
        event.tuck = tuck;
        events.of_loop[held.position()].push_back(event);
      }
    }
  for (std::size_t y = 0; y < graph.yarns.size(); ++y)
    for (std::size_t k = 0; k < graph.yarns[y].floats.size(); ++k) {
      const Float& yarn_float = graph.yarns[y].floats[k];
      if (!yarn_float.to.valid()) continue;
      for (const PassedLoop& passed : yarn_float.passed) {
        HeldEvent event;
        event.instruction = graph.loop(yarn_float.to).instruction;
        event.yarn = static_cast<int>(y);
        event.gap = static_cast<int>(k);
        events.of_loop[passed.loop.position()].push_back(event);
      }
    }
  for (std::vector<HeldEvent>& list : events.of_loop) {
    std::stable_sort(list.begin(), list.end(),
                     [](const HeldEvent& a, const HeldEvent& b) { return a.instruction < b.instruction; });
    const auto same = [](const HeldEvent& a, const HeldEvent& b) {
      return a.tuck == b.tuck && a.yarn == b.yarn && a.gap == b.gap;
    };
    list.erase(std::unique(list.begin(), list.end(), same), list.end());
  }
  return events;
}

bool is_held_at(const Loop& loop, int instruction) {
  return loop.head_instruction < 0 || loop.head_instruction > instruction;
}

int rows_waited(const YarnGraph& graph, LoopId from, LoopId to) {
  int rows = 0;
  for (LoopId at = from; !graph.loop(at).children.empty(); ++rows) {
    at = graph.loop(at).children.front();
    if (graph.loop(at).instruction >= graph.loop(to).instruction) break;
  }
  return rows < 2 ? 0 : rows;
}

}  // namespace loopwright
