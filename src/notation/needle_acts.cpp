#include "notation/needle_acts.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "notation/program_passes.hpp"

namespace loopwright {
namespace {

// Transfers that follow one another at one racking, and drops, may come in any order if they share no needle.
void sort_transfers(std::vector<NeedleAct>& acts) {
  for (std::size_t i = 0; i < acts.size();) {
    std::set<Needle> used;
    std::size_t end = i;
    std::optional<double> racking;
    for (; end < acts.size() && !used.contains(acts[end].needle); ++end) {
      const NeedleAct& act = acts[end];
      if (act.op == Op::xfer) {
        if (used.contains(act.target) || racking.value_or(act.racking) != act.racking) break;
        racking = act.racking;
        used.insert(act.target);
      } else if (act.op != Op::drop) {
        break;
      }
      used.insert(act.needle);
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
    if (each.op < Op::knit || each.op == Op::miss || each.op == Op::amiss) continue;
    const bool gives = each.op == Op::xfer || each.op == Op::split, yarn = carries_yarn(each);
    if (!yarn && (held[each.needle] == 0 || each.op == Op::tuck)) continue;
    // without yarn a knit drops and a split transfers; where the beds stand is nothing to a drop
    const Op op = yarn ? each.op : gives ? Op::xfer : each.op == Op::knit ? Op::drop : each.op;
    NeedleAct act{op,
                  yarn ? each.direction : Direction::none,
                  each.needle,
                  each.target,
                  op == Op::drop ? 0 : racking,
                  {},
                  each.at};
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
