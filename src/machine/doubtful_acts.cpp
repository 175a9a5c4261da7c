// Acts that are possible but seldom meant: counted while the machine runs, told by review().
#include <algorithm>
#include <cmath>

#include "machine/machine.hpp"
#include "machine/run_machine.hpp"

namespace loopwright {

// The yarn comes from beside the needle where the carrier stands; it is laid the wrong way round if the
// carrier must first go past the needle to come back over it.
bool Machine::is_twisted(const Instruction& instruction, CarrierId id) {
  const Carrier& carrier = carriers_[id];
  if (!carrier.at) return false;
  const long long from = 2 * racking_.order(*carrier.at) + static_cast<int>(carrier.side);
  const long long to = 2 * racking_.order(instruction.needle);
  return direction_of(instruction) == Direction::right ? from > to : from < to;
}

void Machine::count(Acts& acts, Needle needle) const {
  if (acts.count++ > 0) return;
  acts.first = now_;
  acts.needle = needle;
}

void Machine::count_tall_stack(Needle needle, std::size_t before) {
  const std::size_t loops = stack(needle).size();
  if (loops <= most_loops_on_needle) return;
  if (before <= most_loops_on_needle) count(record_.tall_stacks, needle);
  record_.tall_stacks.highest = std::max(record_.tall_stacks.highest, static_cast<int>(loops));
}

// A carrier that went past needles without a loop leaves its yarn across them: a loop made there catches it.
void Machine::count_caught_yarns(const Instruction& instruction, const std::vector<CarrierId>& set) {
  for (CarrierId id : carriers_.active()) {
    const Carrier& carrier = carriers_[id];
    if (!carrier.missed || std::find(set.begin(), set.end(), id) != set.end()) continue;
    const LoopId last = last_loop_[carrier.yarn.position()];
    if (!last.valid()) continue;
    const long long here = 2 * racking_.order(instruction.needle);
    const long long begin = 2 * racking_.order(loop(last).last().needle);
    const long long end = 2 * racking_.order(*carrier.at) + static_cast<int>(carrier.side);
    if (std::abs(end - begin) <= 4 * most_needles_passed) continue;
    if (std::min(begin, end) >= here || here >= std::max(begin, end)) continue;
    if (record_.caught_yarns.count == 0) record_.caught_yarns.carrier = id;
    count(record_.caught_yarns, instruction.needle);
  }
}

// The hook is parked to the right of the first needle of what it holds, and hides the needles there.
void Machine::watch_hook(const Instruction& instruction, const std::vector<CarrierId>& set) {
  const std::vector<CarrierId>& holds = carriers_.hook();
  if (holds.empty()) {
    hook_slot_.reset();
    return;
  }
  const double slot = racking_.slot(instruction.needle);
  const bool holds_this = std::find(set.begin(), set.end(), holds.front()) != set.end();
  if (!hook_slot_) {
    if (!holds_this) return;  // it comes with its first use
    hook_slot_ = slot;
    if (direction_of(instruction) == Direction::right) count(record_.hook_to_right, instruction.needle);
  } else if (slot > *hook_slot_ && slot <= *hook_slot_ + needles_behind_hook) {
    count(record_.hook_blocked, instruction.needle);
  }
}

}  // namespace loopwright
