#include "machine/review.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "machine/needle_table.hpp"
#include "machine/racking.hpp"
#include "machine/run_machine.hpp"

namespace loopwright {
namespace {

// "once" or "in 12 places, first here".
std::string places(int count) {
  return count == 1 ? "here" : "in " + std::to_string(count) + " places, first here";
}

std::string plural(int count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

class Reviewer {
 public:
  Reviewer(const Program& program, const KnittingRecord& record, Diagnostics& diagnostics)
      : program_(program),
        record_(record),
        diagnostics_(diagnostics),
        is_fabric_(!program.repeat_starts.empty()) {}

  void run() {
    empty_needles();
    stacks();
    floats();
    waits();
    rackings();
    pauses();
    hook();
    caught_yarns();
    twisted_tucks();
    if (is_fabric_) return;
    adjacent_cast_on();
    left_hanging();
  }

 private:
  SourceLocation at(int instruction) const {
    return program_.instructions[static_cast<std::size_t>(instruction)].at;
  }
  std::string line(int instruction) const { return "line " + std::to_string(at(instruction).line); }
  std::string carrier_of(YarnId yarn) const {
    return program_.carriers[record_.yarns[yarn.position()].carrier.position()];
  }
  const LoopRecord& loop(LoopId id) const { return record_.loops[id.position()]; }

  void empty_needles();
  void stacks();
  void floats();
  void waits();
  void rackings();
  void pauses();
  void hook();
  void caught_yarns();
  void twisted_tucks();
  void adjacent_cast_on();
  void left_hanging();

  const Program& program_;
  const KnittingRecord& record_;
  Diagnostics& diagnostics_;
  bool is_fabric_;
};

void Reviewer::empty_needles() {
  const auto cast_on = [](const LoopRecord& each) { return each.kind == LoopKind::cast_on; };
  const auto first = std::find_if(record_.loops.begin(), record_.loops.end(), cast_on);
  if (first != record_.loops.end() && !is_fabric_) {
    const auto count = std::count_if(first, record_.loops.end(), cast_on);
    diagnostics_.warning(at(first->instruction), "a stitch is knitted on an empty needle " +
                                                     places(static_cast<int>(count)) + " (" +
                                                     to_string(first->formed().needle) +
                                                     "): that is a tuck, good for a cast-on alone");
  }
  if (const Acts& drops = record_.drops_of_empty; drops.count > 0)
    diagnostics_.warning(at(drops.first), "a needle that holds nothing is dropped " + places(drops.count) +
                                              " (" + to_string(drops.needle) + ")");
  if (const Acts& moves = record_.transfers_of_empty; moves.count > 0)
    diagnostics_.warning(at(moves.first), "a needle that holds nothing is transferred " +
                                              places(moves.count) + " (" + to_string(moves.needle) + ")");
}

void Reviewer::stacks() {
  const Acts& tall = record_.tall_stacks;
  if (tall.count == 0) return;
  diagnostics_.warning(at(tall.first), "more than " + std::to_string(most_loops_on_needle) +
                                           " loops come onto a needle " + places(tall.count) + " (" +
                                           to_string(tall.needle) + "; the highest stack has " +
                                           std::to_string(tall.highest) + "): knit them off earlier");
}

// The yarn from each loop to the next, where they are when the second one is formed.
void Reviewer::floats() {
  struct Long {
    int count = 0, longest = 0, instruction = -1;
    Needle from, to;
  };
  // an inch of yarn catches fingers and needles
  const int inch = static_cast<int>(std::lround(program_.settings.gauge_npi.value_or(10)));
  for (std::size_t y = 0; y < record_.yarns.size(); ++y) {
    Long warned, advised;
    const LoopRecord* before = nullptr;
    for (const YarnStep& step : record_.yarns[y].steps) {
      if (!step.loop.valid()) continue;
      if (before != nullptr) {
        const auto later =
            std::find_if(before->placements.begin() + 1, before->placements.end(),
                         [&](const Placement& p) { return p.instruction >= step.instruction; });
        const Needle from = (later - 1)->needle;
        const double racking = loop(step.loop).racking;
        const int length = static_cast<int>(std::abs(step.slot - Racking(racking).slot(from)));
        Long& found = length > longest_float ? warned : advised;
        if (length > std::min(inch, longest_float)) {
          ++found.count;
          if (length > found.longest) found = {found.count, length, step.instruction, from, step.needle};
        }
      }
      before = &loop(step.loop);
    }
    const auto say = [&](const Long& found, Severity severity, const std::string& limit) {
      if (found.count == 0) return;
      diagnostics_.add(
          {severity, at(found.instruction),
           "the yarn of carrier " + carrier_of(YarnId(y)) + " floats over " + std::to_string(found.longest) +
               " needles, from " + to_string(found.from) + " to " + to_string(found.to) +
               (found.count > 1
                    ? ", the longest of " + std::to_string(found.count) + " floats over more than " + limit
                    : "") +
               ": tuck it on the way if it must not hang loose"});
    };
    say(warned, Severity::warning, std::to_string(longest_float) + " needles");
    if (!is_fabric_) say(advised, Severity::advice, "an inch (" + plural(inch, "needle") + ")");
  }
}

void Reviewer::waits() {
  for (const YarnRecord& yarn : record_.yarns) {
    if (yarn.in_instruction < 0 || yarn.steps.empty()) continue;
    const int wait = yarn.steps.front().instruction - yarn.in_instruction;
    if (wait > longest_wait)
      diagnostics_.warning(at(yarn.in_instruction), "carrier " + program_.carriers[yarn.carrier.position()] +
                                                        " is brought in here and first used " +
                                                        std::to_string(wait) + " operations later, in " +
                                                        line(yarn.steps.front().instruction) +
                                                        ": it comes in only then");
  }
}

void Reviewer::rackings() {
  const auto last = [&](std::size_t k) {
    return k + 1 < record_.rackings.size() ? record_.rackings[k + 1].instruction
                                           : static_cast<int>(program_.instructions.size());
  };
  int unused = 0, far = 0, first_unused = -1, first_far = -1;
  double farthest = 0;
  for (std::size_t k = 0; k < record_.rackings.size(); ++k) {
    const RackingChange& change = record_.rackings[k];
    if (std::abs(change.racking) > largest_racking && far++ == 0) first_far = change.instruction;
    if (std::abs(change.racking) > std::abs(farthest)) farthest = change.racking;
    const auto begin = program_.instructions.begin();
    const bool used = std::any_of(begin + change.instruction, begin + last(k), names_needle);
    // the beds are brought home at the end
    const bool home = k + 1 == record_.rackings.size() && change.racking == 0;
    if (!used && !home && unused++ == 0) first_unused = change.instruction;
  }
  if (far > 0)
    diagnostics_.warning(at(first_far), "the beds are racked by more than " +
                                            std::to_string(static_cast<int>(largest_racking)) + " needles " +
                                            places(far) + " (up to " + to_string(Racking(farthest)) +
                                            "): not every machine can");
  if (unused > 0) diagnostics_.warning(at(first_unused), "a racking is set and never used " + places(unused));
}

void Reviewer::pauses() {
  int twice = 0, first = -1;
  bool paused = false;
  for (std::size_t k = 0; k < program_.instructions.size(); ++k) {
    const Instruction& instruction = program_.instructions[k];
    if (instruction.op == Op::pause && paused && twice++ == 0) first = static_cast<int>(k);
    if (instruction.op == Op::pause) paused = true;
    if (names_needle(instruction)) paused = false;
  }
  if (twice > 0)
    diagnostics_.warning(at(first),
                         "the machine is paused a second time with nothing knitted between " + places(twice));
}

void Reviewer::hook() {
  if (const Acts& right = record_.hook_to_right; right.count > 0)
    diagnostics_.advise(at(right.first), "a carrier comes in with the hook and goes to the right " +
                                             places(right.count) + " (" + to_string(right.needle) +
                                             "): the hook comes from the right, so start to the left");
  if (const Acts& blocked = record_.hook_blocked; blocked.count > 0)
    diagnostics_.warning(at(blocked.first),
                         "the yarn inserting hook is parked before the needle that is "
                         "used " +
                             places(blocked.count) + " (" + to_string(blocked.needle) + "): it hides the " +
                             std::to_string(needles_behind_hook) +
                             " needles to its right until it is released");
}

void Reviewer::caught_yarns() {
  const Acts& caught = record_.caught_yarns;
  if (caught.count == 0) return;
  diagnostics_.advise(at(caught.first), "a loop is made across the yarn of carrier " +
                                            program_.carriers[caught.carrier.position()] +
                                            ", which has gone past " + to_string(caught.needle) +
                                            " without a loop, " + places(caught.count) +
                                            ": the yarns tangle unless it is meant to be laid in");
}

void Reviewer::twisted_tucks() {
  // on an empty needle a twisted loop is a good cast-on
  const auto twisted = [](const LoopRecord& each) { return each.twisted && !each.on_empty_needle; };
  const auto first = std::find_if(record_.loops.begin(), record_.loops.end(), twisted);
  if (first == record_.loops.end()) return;
  const auto count = std::count_if(first, record_.loops.end(), twisted);
  diagnostics_.advise(at(first->instruction), "a tuck is made against the way that its yarn travels " +
                                                  places(static_cast<int>(count)) + " (" +
                                                  to_string(first->formed().needle) +
                                                  "): its loop is twisted");
}

// Loops that are knitted on empty needles side by side in one pass: the second draws its yarn from the first.
void Reviewer::adjacent_cast_on() {
  int count = 0;
  const LoopRecord* first = nullptr;
  for (const YarnRecord& yarn : record_.yarns) {
    for (std::size_t s = 1; s < yarn.steps.size(); ++s) {
      const LoopId a = yarn.steps[s - 1].loop, b = yarn.steps[s].loop;
      if (!a.valid() || !b.valid()) continue;
      const Needle &left = loop(a).formed().needle, &right = loop(b).formed().needle;
      if (left.bed != right.bed || std::abs(left.index - right.index) != 1 || loop(a).pass != loop(b).pass ||
          !loop(a).on_empty_needle || !loop(b).on_empty_needle)
        continue;
      if (count++ == 0) first = &loop(b);
    }
  }
  if (count > 0)
    diagnostics_.advise(at(first->instruction),
                        "neighbouring empty needles are cast on in one pass " + places(count) + " (" +
                            to_string(first->formed().needle) +
                            "): such loops slip; take every other needle and the rest on the way back");
}

void Reviewer::left_hanging() {
  int loops = 0, first = -1;
  for (const NeedleStack& stack : record_.held) loops += static_cast<int>(stack.loops.size());
  if (loops == 0) return;
  for (const NeedleStack& stack : record_.held)
    for (LoopId id : stack.loops) first = std::max(first, loop(id).instruction);
  diagnostics_.advise(at(first), plural(loops, "loop") + " still hang on " +
                                     plural(static_cast<int>(record_.held.size()), "needle") + " (" +
                                     to_string(record_.held.front().needle) + " to " +
                                     to_string(record_.held.back().needle) +
                                     ") at the end: bind them off, or drop them");
}

}  // namespace

void review(const Program& program, const KnittingRecord& record, Diagnostics& diagnostics) {
  Reviewer(program, record, diagnostics).run();
}

}  // namespace loopwright
