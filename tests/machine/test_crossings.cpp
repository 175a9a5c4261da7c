// Loops that racking carries past each other: which crossing remains, and who is in front.
#include <gmock/gmock.h>

#include "machine/machine_of.hpp"

namespace loopwright {
namespace {

using testing::IsEmpty;
using testing::UnorderedElementsAre;

using Pair = std::pair<int, int>;  // front, back

std::vector<Pair> crossed(const KnittingRecord& record) {
  std::vector<Pair> pairs;
  for (const LoopCrossing& crossing : record.crossings)
    pairs.emplace_back(crossing.front.value, crossing.back.value);
  return pairs;
}

// Four loops 0 .. 3 on f1 .. f4, parked on the back bed, and a course after the cable.
MachineRun cable(const std::string& transfers) {
  return machine_of(
      "in A\nknit + f1 A\nknit + f2 A\nknit + f3 A\nknit + f4 A\n"
      "xfer f1 b1\nxfer f2 b2\nxfer f3 b3\nxfer f4 b4\n" +
      transfers + "rack 0\nknit - f4 A\nknit - f3 A\nknit - f2 A\nknit - f1 A\nout A\n");
}

// The pair that comes to the front bed first ends up in front: loops pass behind what the front bed holds.
TEST(Crossings, the_group_brought_to_the_front_first_lies_in_front) {
  const MachineRun left_over_right =
      cable("rack 2\nxfer b1 f3\nxfer b2 f4\nrack -2\nxfer b3 f1\nxfer b4 f2\n");
  ASSERT_TRUE(left_over_right.diagnostics.ok()) << left_over_right.diagnostics;
  EXPECT_THAT(crossed(left_over_right.record),
              UnorderedElementsAre(Pair(0, 2), Pair(0, 3), Pair(1, 2), Pair(1, 3)));
  for (const LoopCrossing& crossing : left_over_right.record.crossings) EXPECT_EQ(crossing.front_moved, 1);
  // The course after the cable draws its loops through the crossed ones.
  EXPECT_EQ(numbers(left_over_right.record.loops[4].parents), std::vector<int>{1});

  const MachineRun right_over_left =
      cable("rack -2\nxfer b3 f1\nxfer b4 f2\nrack 2\nxfer b1 f3\nxfer b2 f4\n");
  ASSERT_TRUE(right_over_left.diagnostics.ok()) << right_over_left.diagnostics;
  EXPECT_THAT(crossed(right_over_left.record),
              UnorderedElementsAre(Pair(2, 0), Pair(2, 1), Pair(3, 0), Pair(3, 1)));
  for (const LoopCrossing& crossing : right_over_left.record.crossings) EXPECT_EQ(crossing.front_moved, -1);
}

TEST(Crossings, racking_there_and_back_leaves_none) {
  const MachineRun run = machine_of(
      "in A\nknit + f1 A\nknit + f2 A\nknit + f3 A\nknit - b3 A\nknit - b2 A\nknit - b1 A\n"
      "rack 3\nrack -3\nrack 0.25\nrack 0\n"
      "knit + f1 A\nknit + f2 A\nknit + f3 A\nrack 2\nknit - b3 A\nrack 0\nknit - b2 A\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(crossed(run.record), IsEmpty());
}

TEST(Crossings, a_loop_moved_onto_the_needle_beside_it_does_not_cross) {
  // Lace: f1 onto f2, then the stack is knitted.
  const MachineRun run = machine_of(
      "in A\nknit + f1 A\nknit + f2 A\nknit + f3 A\nxfer f1 b1\nrack 1\nxfer b1 f2\nrack 0\n"
      "knit - f3 A\nknit - f2 A\nknit - f1 A\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(crossed(run.record), IsEmpty());
  EXPECT_EQ(numbers(run.record.loops[4].parents), (std::vector<int>{1, 0}));  // the moved loop lies behind
}

TEST(Crossings, a_loop_moved_past_its_neighbour_crosses_it) {
  // 0 goes behind 1, from f1 to an empty f3 (1 is on the front bed while 0 passes on the back bed).
  const MachineRun run =
      machine_of("in A\nknit + f1 A\nknit + f2 A\nxfer f1 b1\nrack 2\nxfer b1 f3\nrack 0\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(crossed(run.record), UnorderedElementsAre(Pair(1, 0)));
  EXPECT_EQ(run.record.crossings[0].front_moved, -1);
  EXPECT_EQ(run.record.crossings[0].instruction, 5);
}

TEST(Crossings, held_loops_that_stay_racked_apart_cross_at_the_end) {
  const MachineRun run = machine_of("in A\nknit + f2 A\nknit - b1 A\nrack 3\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(crossed(run.record), UnorderedElementsAre(Pair(0, 1)));
}

// 0 passes behind 1 to the right; then 1, on the back bed now, passes behind 0 to the right: a full twist.
// Had 0 gone back behind 1, nothing would be left.
TEST(Crossings, two_loops_wound_round_each_other_keep_both_crossings) {
  const std::string there = "in A\nknit + f1 A\nknit + f2 A\nxfer f1 b1\nrack 2\nxfer b1 f3\nrack 0\n";
  const MachineRun wound = machine_of(there + "xfer f2 b2\nrack 2\nxfer b2 f4\nrack 0\nout A\n");
  ASSERT_TRUE(wound.diagnostics.ok()) << wound.diagnostics;
  EXPECT_THAT(crossed(wound.record), testing::ElementsAre(Pair(1, 0), Pair(0, 1)));

  const MachineRun unwound = machine_of(there + "xfer f3 b3\nrack -2\nxfer b3 f1\nrack 0\nout A\n");
  ASSERT_TRUE(unwound.diagnostics.ok()) << unwound.diagnostics;
  EXPECT_THAT(crossed(unwound.record), IsEmpty());
}

}  // namespace
}  // namespace loopwright
