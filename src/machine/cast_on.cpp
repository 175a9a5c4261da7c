#include "machine/cast_on.hpp"

#include <algorithm>
#include <set>

#include "machine/needle_table.hpp"

namespace loopwright {
namespace {

Direction back_from(Direction direction) {
  return direction == Direction::right ? Direction::left : Direction::right;
}

// Needles next to each other on one bed differ, and so do needles that face each other.
bool is_even(Needle needle) { return (needle.index + (is_front(needle.bed) ? 0 : 1)) % 2 == 0; }

}  // namespace

CastOn cast_on_of(const Program& fabric, const KnittingRecord& record) {
  CastOn cast_on;
  const int repeat_end = fabric.repeat_starts.size() > 1 ? fabric.repeat_starts[1]
                                                         : static_cast<int>(fabric.instructions.size());
  // A needle that gets its first loop by a transfer must be empty until then.
  std::set<Needle> met;
  double racking = 0;
  bool knits = false;
  for (int k = 0; k < repeat_end; ++k) {
    const Instruction& instruction = fabric.instructions[static_cast<std::size_t>(k)];
    if (instruction.op == Op::rack) racking = instruction.value;
    if (names_target(instruction)) met.insert(instruction.target);
    if (!names_needle(instruction) || instruction.op == Op::miss) continue;
    const bool forms = !instruction.carriers.empty();
    if (met.insert(instruction.needle).second && forms) cast_on.needles.push_back(instruction.needle);
    if (forms && !knits) cast_on.racking = Racking(racking);
    knits = knits || forms;
  }
  std::sort(cast_on.needles.begin(), cast_on.needles.end(), [&](const Needle& a, const Needle& b) {
    const long long place_a = cast_on.racking.order(a), place_b = cast_on.racking.order(b);
    return place_a != place_b ? place_a < place_b : a < b;
  });

  std::set<int> front_passes, rear_passes;
  for (const LoopRecord& loop : record.loops)
    if (loop.instruction < repeat_end)
      (is_front(loop.formed().needle.bed) ? front_passes : rear_passes).insert(loop.pass);
  const bool pass_on_both = std::any_of(front_passes.begin(), front_passes.end(),
                                        [&](int pass) { return rear_passes.count(pass) > 0; });
  const auto on_front = [](const Needle& needle) { return is_front(needle.bed); };
  const auto on_rear = [](const Needle& needle) { return !is_front(needle.bed); };
  cast_on.beds_apart = !pass_on_both &&
                       std::any_of(cast_on.needles.begin(), cast_on.needles.end(), on_front) &&
                       std::any_of(cast_on.needles.begin(), cast_on.needles.end(), on_rear);
  return cast_on;
}

std::vector<CastOnPass> cast_on_passes(const CastOn& cast_on, Direction first) {
  std::vector<CastOnPass> passes;
  if (cast_on.needles.empty()) return passes;
  const bool begins_even =
      is_even(first == Direction::right ? cast_on.needles.front() : cast_on.needles.back());
  for (const bool even : {begins_even, !begins_even}) {
    const auto add = [&](Direction direction, const std::optional<bool>& front) {
      CastOnPass pass{{}, direction};
      for (const Needle& needle : cast_on.needles)
        if (is_even(needle) == even && (!front || is_front(needle.bed) == *front))
          pass.needles.push_back(needle);
      if (!pass.needles.empty()) passes.push_back(std::move(pass));
    };
    const Direction direction = even == begins_even ? first : back_from(first);
    if (!cast_on.beds_apart) {
      add(direction, std::nullopt);
    } else {
      // round and round: front to the right, rear to the left
      add(first, first == Direction::right);
      add(back_from(first), first != Direction::right);
    }
  }
  return passes;
}

}  // namespace loopwright
