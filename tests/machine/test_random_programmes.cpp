// Random right programmes: the machine against the second simulator, and its crossings, which it finds from
// few comparisons, against a count of every pair at every racking.
#include <gmock/gmock.h>

#include <map>
#include <random>

#include "machine/machine_of.hpp"
#include "machine/reference_simulator.hpp"

namespace loopwright {
namespace {

// A programme of carriers A, B, C on the needles 0 to 7 of both beds, with every operation that makes or
// moves loops.
std::string random_programme(unsigned seed, int length) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const std::vector<std::string> rackings = {"-2", "-1", "0", "0", "1", "2", "3", "0.25", "-0.75", "0.5"};
  const std::vector<std::string> sets = {"A", "A", "B", "C", "A B", "C A"};
  std::string text = "in A\nin B\nin C\nknit + f0 A\nknit + f1 B\nknit + f2 C\n";
  double racking = 0;
  for (int k = 0; k < length; ++k) {
    const int index = below(8);
    const bool front_bed = below(2) == 0;
    const std::string needle = (front_bed ? "f" : "b") + std::to_string(index);
    const std::string direction = below(2) == 0 ? " + " : " - ";
    const std::string set = sets[static_cast<std::size_t>(below(6))];
    const bool aligned = racking == std::floor(racking);
    const int shift = static_cast<int>(racking);
    const std::string opposite =
        front_bed ? "b" + std::to_string(index - shift) : "f" + std::to_string(index + shift);
    switch (below(12)) {
      case 0:
      case 1:
        text += "knit" + direction + needle + " " + set + "\n";
        break;
      case 2:
        text += "tuck" + direction + needle + " " + set + "\n";
        break;
      case 3:
        text += "miss" + direction + needle + " " + set + "\n";
        break;
      case 4:
        text += below(4) == 0 ? "drop " + needle + "\n" : "";
        break;
      case 5:
        text += aligned ? "split" + direction + needle + " " + opposite + " " + set + "\n" : "";
        break;
      case 6:
      case 7:
      case 8:
        text += aligned ? "xfer " + needle + " " + opposite + "\n" : "";
        break;
      default: {
        const std::string& value = rackings[static_cast<std::size_t>(below(10))];
        racking = std::stod(value);
        text += "rack " + value + "\n";
      }
    }
  }
  return text + "out A B C\n";
}

// Needle of a loop just before an instruction; nothing if it is on none then.
const Needle* needle_before(const LoopRecord& loop, int instruction) {
  const bool there =
      loop.instruction < instruction && (loop.fate_instruction < 0 || loop.fate_instruction >= instruction);
  const Needle* needle = nullptr;
  if (there)
    for (const Placement& placement : loop.placements)
      if (placement.instruction < instruction) needle = &placement.needle;
  return needle;
}

// Half pitches from the left: 2 i on the front bed, 2 (i + R) on the back bed with every fraction as one
// half.
int half_pitches(const Needle& needle, double racking) {
  if (is_front(needle.bed)) return 2 * needle.index;
  return 2 * needle.index + static_cast<int>(std::floor(racking) + std::ceil(racking));
}

int sign(int x) { return (x > 0) - (x < 0); }

// For every pair of loops how far the one in front went past the other, in half turns, over every single
// racking.
std::map<std::pair<int, int>, int> half_turns_of_all_pairs(const KnittingRecord& record) {
  std::map<std::pair<int, int>, int> turns;
  double before = 0;
  for (const RackingChange& change : record.rackings) {
    for (std::size_t a = 0; a < record.loops.size(); ++a) {
      const Needle* front_needle = needle_before(record.loops[a], change.instruction);
      if (!front_needle || !is_front(front_needle->bed)) continue;
      for (std::size_t b = 0; b < record.loops.size(); ++b) {
        const Needle* back_needle = needle_before(record.loops[b], change.instruction);
        if (!back_needle || is_front(back_needle->bed)) continue;
        const int was = sign(half_pitches(*front_needle, before) - half_pitches(*back_needle, before));
        const int is =
            sign(half_pitches(*front_needle, change.racking) - half_pitches(*back_needle, change.racking));
        turns[{static_cast<int>(std::min(a, b)), static_cast<int>(std::max(a, b))}] += is - was;
      }
    }
    before = change.racking;
  }
  return turns;
}

TEST(RandomProgrammes, agree_with_the_second_simulator) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const std::string text = random_programme(seed, 200);
    const MachineRun run = machine_of(text);
    ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics << text;
    const ReferenceState expected = reference_run(text);
    ASSERT_EQ(expected.misaligned, 0);
    ASSERT_EQ(run.record.loops.size(), expected.parents.size()) << text;
    for (std::size_t k = 0; k < expected.parents.size(); ++k) {
      ASSERT_EQ(numbers(run.record.loops[k].parents), expected.parents[k]) << text;
      ASSERT_EQ(to_string(run.record.loops[k].last().needle), expected.ended_on[k]) << text;
    }
    for (const NeedleStack& stack : run.record.held)
      ASSERT_EQ(numbers(stack.loops), expected.held.at(to_string(stack.needle))) << text;
  }
}

TEST(RandomProgrammes, crossings_are_those_of_all_pairs_at_all_rackings) {
  std::size_t seen = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const std::string text = random_programme(seed, 200);
    const KnittingRecord record = machine_of(text).record;
    std::map<std::pair<int, int>, int> expected;
    for (const auto& [pair, turns] : half_turns_of_all_pairs(record))
      if (std::abs(turns) >= 2) expected[pair] = turns / 2;
    std::map<std::pair<int, int>, int> found;
    for (const LoopCrossing& crossing : record.crossings) {
      const auto pair = std::minmax(crossing.front.value, crossing.back.value);
      found[{pair.first, pair.second}] += crossing.front_moved;
      ++seen;
    }
    ASSERT_EQ(found, expected) << text;
  }
  EXPECT_GT(seen, 100u);
}

}  // namespace
}  // namespace loopwright
