#include "notation/needle_acts.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "notation/program_passes.hpp"

namespace loopwright {
namespace {

// 0.

// Transfers that follow one another at one racking and share no needle may come in any order.
void sort_transfers(std::vector<NeedleAct>& acts) {
  for (std::size_t i = 0; i < acts.size();) {
    std::set<Needle> used;
    std::size_t end = i;
    while (end < acts.size() && acts[end].op == Op::xfer && acts[end].racking == acts[i].racking &&
           !used.contains(acts[end].needle) && !used.contains(acts[end].target)) {
      used.insert(acts[end].needle);
      used.insert(acts[end].target);
      ++end;
    }
    std::sort(acts.begin() + static_cast<std::ptrdiff_t>(i), acts.begin() + static_cast<std::ptrdiff_t>(end),
              [](const NeedleAct& a, const NeedleAct& b) { return a.needle < b.needle; });
    i = std::max(end, i + 1);
  }
}

}  // namespace

std::vector<NeedleAct> needle_acts(const Program& program, int first) {
  std::vector<NeedleAct> acts;
  std::map<Needle, std::size_t> held;
  double racking = 0;
  for (const Instruction& each : program.instructions) {
    if (each.op == Op::rack) racking = each.value;
    // a miss moves no loop, and needles that it faces may hide it
    if (each.op < Op::knit || each.op == Op::miss) continue;
    const bool gives = each.op == Op::xfer;
    if (!carries_yarn(each) && held[each.needle] == 0) continue;
    NeedleAct act{each.op, each.direction, each.needle, each.target, racking, {}, each.at};
    act.needle.index -= first;
    if (gives) act.target.index -= first;
    for (const CarrierId id : each.carriers) act.carriers.push_back(program.carriers[id.position()]);
    acts.push_back(std::move(act));
    if (gives) held[each.target] += held[each.needle];
    const std::size_t loops = carries_yarn(each) ? each.carriers.size() : 0;
    held[each.needle] = each.op == Op::tuck ? held[each.needle] + loops : loops;
  }
  sort_transfers(acts);
  return acts;
}

}  // namespace loopwright
