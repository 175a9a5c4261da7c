#include "topology/build_yarn_graph.hpp"

#include <algorithm>

#include "machine/racking.hpp"
#include "topology/floats.hpp"

namespace loopwright {
namespace {

// Racking at which an instruction acts; -1: at the end.
Racking racking_at(const KnittingRecord& record, int instruction) {
  const auto after =
      instruction < 0
          ? record.rackings.end()
          : std::upper_bound(record.rackings.begin(), record.rackings.end(), instruction,
                             [](int i, const RackingChange& change) { return i < change.instruction; });
  return Racking(after == record.rackings.begin() ? 0 : (after - 1)->racking);
}

Loop loop_of(const Program& program, const KnittingRecord& record, std::size_t k) {
  const LoopRecord& from = record.loops[k];
  Loop loop;
  loop.yarn = from.yarn;
  loop.kind = from.kind;
  loop.side = is_front(from.formed().needle.bed) ? StitchSide::front : StitchSide::rear;
  loop.direction = from.direction;
  loop.slot = from.formed().slot;
  loop.head_slot = racking_at(record, from.fate_instruction).slot(from.last().needle);
  loop.bed = from.formed().needle.bed;
  loop.head_bed = from.last().needle.bed;
  loop.pass = from.pass;
  loop.head_rank = record.stack_rank[k];
  loop.head_count = record.stack_height[k];
  loop.instruction = from.instruction;
  loop.head_instruction = from.fate_instruction;
  loop.at = program.instructions[static_cast<std::size_t>(from.instruction)].at;
  loop.parents = from.parents;
  loop.fate = from.fate;
  return loop;
}

// One warning for every run of drops that no yarn-carrying instruction interrupts.
void warn_of_unheld(const Program& program, const KnittingRecord& record, const YarnGraph& graph,
                    Diagnostics& diagnostics) {
  std::vector<LoopId> dropped = graph.unheld;
  std::stable_sort(dropped.begin(), dropped.end(), [&](LoopId a, LoopId b) {
    return graph.loop(a).head_instruction < graph.loop(b).head_instruction;
  });
  const auto carries_yarn_between = [&](int first, int last) {
    return std::any_of(program.instructions.begin() + first, program.instructions.begin() + last,
                       [](const Instruction& i) { return i.op >= Op::knit && !i.carriers.empty(); });
  };
  for (std::size_t begin = 0, end = 0; begin < dropped.size(); begin = end) {
    for (end = begin + 1; end < dropped.size(); ++end)
      if (carries_yarn_between(graph.loop(dropped[end - 1]).head_instruction,
                               graph.loop(dropped[end]).head_instruction))
        break;
    const std::size_t count = end - begin;
    const auto needle = [&](std::size_t k) {
      return to_string(record.loops[dropped[k].position()].last().needle);
    };
    const SourceLocation at =
        program.instructions[static_cast<std::size_t>(graph.loop(dropped[begin]).head_instruction)].at;
    diagnostics.warning(
        at, count == 1 ? "the loop dropped from " + needle(begin) +
                             " has nothing drawn through it and will run: knit it off or bind it off first"
                       : std::to_string(count) + " loops dropped from here on (" + needle(begin) + " to " +
                             needle(end - 1) +
                             ") have nothing drawn through them and will run: bind them off first");
  }
}

}  // namespace

YarnGraph build_yarn_graph(const Program& program, const KnittingRecord& record, Diagnostics& diagnostics) {
  YarnGraph graph;

  // Yarns as lists of loops.
  graph.loops.reserve(record.loops.size());
  for (std::size_t k = 0; k < record.loops.size(); ++k) graph.loops.push_back(loop_of(program, record, k));
  for (const YarnRecord& yarn : record.yarns) {
    GraphYarn& to = graph.yarns.emplace_back();
    to.carrier = yarn.carrier;
    const auto formed = std::count_if(yarn.steps.begin(), yarn.steps.end(),
                                      [](const YarnStep& step) { return step.loop.valid(); });
    to.loops.reserve(static_cast<std::size_t>(formed));
    to.floats.reserve(static_cast<std::size_t>(formed));
    for (const YarnStep& step : yarn.steps) {
      if (!step.loop.valid()) continue;
      graph.loops[step.loop.position()].order = static_cast<int>(to.loops.size());
      to.loops.push_back(step.loop);
    }
  }

  std::size_t drawn = 0;
  for (const Loop& loop : graph.loops) drawn += loop.parents.size();
  graph.interlacings.reserve(drawn);
  // Who is drawn through whom. A loop formed on the front bed is drawn from back to front.
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    for (LoopId parent : graph.loops[k].parents) {
      graph.interlacings.push_back({parent, LoopId(k), graph.loops[k].side == StitchSide::front ? 1 : -1});
      graph.loops[parent.position()].children.push_back(LoopId(k));
    }
  }

  trace_floats(program, record, graph);
  for (const LoopCrossing& crossing : record.crossings)
    graph.leg_crossings.push_back({crossing.front, crossing.back});

  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    const Loop& loop = graph.loops[k];
    if (loop.fate == LoopFate::held) graph.left_on_needles.push_back(LoopId(k));
    if (loop.fate == LoopFate::dropped && loop.children.empty()) graph.unheld.push_back(LoopId(k));
  }
  warn_of_unheld(program, record, graph, diagnostics);
  return graph;
}

}  // namespace loopwright
