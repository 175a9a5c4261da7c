// Small programmes with the whole expected state worked out by hand.
#include <gmock/gmock.h>

#include <chrono>

#include "machine/machine_of.hpp"
#include "machine/racking.hpp"

namespace loopwright {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

// Places that a loop was on, in order.
std::vector<Needle> path(const LoopRecord& loop) {
  std::vector<Needle> needles;
  for (const Placement& placement : loop.placements) needles.push_back(placement.needle);
  return needles;
}

// Needles beside which the carrier stood before each step of a yarn.
std::vector<Needle> came_from(const YarnRecord& yarn) {
  std::vector<Needle> needles;
  for (const YarnStep& step : yarn.steps) needles.push_back(step.from);
  return needles;
}

TEST(RunMachine, knits_a_loop_through_the_one_on_the_needle) {
  const MachineRun run = machine_of("in A\nknit + f1 A\nknit + f2 A\nknit - f2 A\nknit - f1 A\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_EQ(run.diagnostics.warnings(), 0) << run.diagnostics;
  const std::vector<LoopRecord>& loops = run.record.loops;
  ASSERT_EQ(loops.size(), 4u);
  EXPECT_EQ(loops[0].kind, LoopKind::cast_on);
  EXPECT_THAT(loops[0].parents, IsEmpty());
  EXPECT_EQ(loops[2].kind, LoopKind::knit);
  EXPECT_EQ(loops[2].direction, Direction::left);
  EXPECT_THAT(numbers(loops[2].parents), ElementsAre(1));
  EXPECT_THAT(numbers(loops[3].parents), ElementsAre(0));
  EXPECT_EQ(loops[1].fate, LoopFate::cast_off);
  EXPECT_EQ(loops[1].fate_instruction, 3);
  EXPECT_EQ(loops[3].fate, LoopFate::held);
  EXPECT_EQ(loops[3].fate_instruction, -1);
  EXPECT_THAT(held_on(run.record, front(1)), ElementsAre(3));
  EXPECT_THAT(held_on(run.record, front(2)), ElementsAre(2));
  ASSERT_EQ(run.record.yarns.size(), 1u);
  EXPECT_EQ(run.record.yarns[0].in_instruction, 0);
  EXPECT_EQ(run.record.yarns[0].out_instruction, 5);
}

TEST(RunMachine, a_carrier_in_again_lays_a_new_yarn) {
  const MachineRun run = machine_of("in A\nknit + f1 A\nout A\nin A\nknit + f1 A\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  ASSERT_EQ(run.record.yarns.size(), 2u);
  EXPECT_EQ(run.record.yarns[0].out_instruction, 2);
  EXPECT_EQ(run.record.yarns[1].in_instruction, 3);
  EXPECT_EQ(run.record.yarns[1].carrier, CarrierId(0));
  EXPECT_EQ(run.record.loops[1].yarn, YarnId(1));
}

TEST(RunMachine, a_pass_ends_where_direction_carrier_or_advance_changes) {
  const MachineRun run = machine_of(
      "in A\nin B\n"
      "knit + f1 A\nknit + f2 A\nmiss + f3 A\nknit + b5 A\n"  // one pass, a miss and the other bed in it
      "knit + f4 A\n"                                         // goes back: a second one
      "knit - f4 A\n"                                         // turns: a third
      "knit - f3 B\n"                                         // other carrier: a fourth
      "knit - f2 A B\n"                                       // both: a fifth
      "rack 0.25\nknit + f4 A\nknit + b4 A\nknit + f5 A\n"    // all needles at a quarter pitch: a sixth
      "out A\nout B\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  std::vector<int> passes;
  for (const LoopRecord& loop : run.record.loops) passes.push_back(loop.pass);
  EXPECT_THAT(passes, ElementsAre(0, 0, 0, 1, 2, 3, 4, 4, 5, 5, 5));
  EXPECT_EQ(run.record.passes, 6);
}

// At racking R the back needle B faces the front needle B + R: at 2, b1 faces f3; at -2, b4 faces f2.
TEST(RunMachine, racking_of_both_signs_moves_loops_to_the_facing_needle) {
  const MachineRun run = machine_of(
      "in A\nknit + f3 A\nknit + b4 A\nrack 2\nxfer f3 b1\nrack -2\nxfer b4 f2\nknit + f5 A\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(path(run.record.loops[0]), ElementsAre(front(3), back(1)));
  EXPECT_THAT(path(run.record.loops[1]), ElementsAre(back(4), front(2)));
  EXPECT_DOUBLE_EQ(run.record.loops[0].placements[1].slot, 3);
  EXPECT_DOUBLE_EQ(run.record.loops[1].placements[1].slot, 2);
  EXPECT_THAT(held_on(run.record, back(1)), ElementsAre(0));
  EXPECT_THAT(held_on(run.record, front(2)), ElementsAre(1));
  ASSERT_EQ(run.record.rackings.size(), 2u);
  EXPECT_EQ(run.record.rackings[1].instruction, 5);
  EXPECT_EQ(run.record.rackings[1].racking, -2);
}

TEST(RunMachine, restated_rackings_are_no_change) {
  const MachineRun run = machine_of("rack 0\nrack 1\nrack 1.0\nrack +1\nrack -0\nrack 0\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_EQ(run.record.rackings.size(), 2u);
}

// A quarter or half pitch puts back needle b between front needles b + floor(R) and b + floor(R) + 1.
TEST(Racking, fractions_lie_between_needles_for_both_signs) {
  EXPECT_FALSE(Racking(0.25).face(front(3), back(3)));
  EXPECT_EQ(Racking(0.25).order(back(3)), Racking(0.5).order(back(3)));
  EXPECT_GT(Racking(0.25).order(back(3)), Racking(0.25).order(front(3)));
  EXPECT_LT(Racking(0.25).order(back(3)), Racking(0.25).order(front(4)));
  // -0.75: floor is -1, so b1 stands between f0 and f1.
  EXPECT_GT(Racking(-0.75).order(back(1)), Racking(-0.75).order(front(0)));
  EXPECT_LT(Racking(-0.75).order(back(1)), Racking(-0.75).order(front(1)));
  EXPECT_TRUE(Racking(-2).face(front(2), back(4)));
  EXPECT_TRUE(Racking(2).face(back(1), front(3)));
  EXPECT_FALSE(Racking(2).face(back(3), front(1)));
  EXPECT_DOUBLE_EQ(Racking(-0.75).slot(back(1)), 0.25);
  EXPECT_EQ(to_string(Racking(-0.75)), "-0.75");
}

TEST(RunMachine, a_transferred_stack_arrives_turned_round_behind_what_is_there) {
  // f1 holds loops 0 and 2 (a tuck), b1 holds loop 1.
  const MachineRun run = machine_of("in A\nknit + f1 A\nknit + b1 A\ntuck - f1 A\nxfer f1 b1\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(held_on(run.record, back(1)), ElementsAre(1, 2, 0));
  EXPECT_EQ(run.record.loops[2].kind, LoopKind::tuck);
  EXPECT_THAT(run.record.loops[2].parents, IsEmpty());
  // On the back bed the last in the stack is in front: 0, the first of the front needle, is still in front of
  // 2, and both are in front of what was on the back bed.
  EXPECT_EQ(run.record.stack_rank, (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(run.record.stack_height, (std::vector<int>{3, 3, 3}));
}

TEST(RunMachine, there_and_back_keeps_the_order_of_a_stack) {
  const MachineRun run =
      machine_of("in A\ntuck + f1 A\ntuck - f1 A\ntuck + f1 A\nxfer f1 b1\nxfer b1 f1\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(held_on(run.record, front(1)), ElementsAre(0, 1, 2));
  EXPECT_EQ(run.record.stack_rank, (std::vector<int>{0, 1, 2}));
}

TEST(RunMachine, knit_draws_through_the_whole_stack) {
  const MachineRun run = machine_of("in A\nknit + f1 A\ntuck - f1 A\ntuck + f1 A\nknit - f1 A\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(numbers(run.record.loops[3].parents), ElementsAre(0, 1, 2));
  for (int k : {0, 1, 2}) {
    EXPECT_EQ(run.record.loops[static_cast<std::size_t>(k)].fate, LoopFate::cast_off);
    EXPECT_EQ(run.record.stack_rank[static_cast<std::size_t>(k)], k);
    EXPECT_EQ(run.record.stack_height[static_cast<std::size_t>(k)], 3);
  }
}

TEST(RunMachine, split_keeps_the_old_loops_on_the_opposite_needle) {
  const MachineRun run =
      machine_of("in A\nknit + f2 A\nsplit - f2 b2 A\nknit + b2 A\nsplit + f3 b3 A\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  const std::vector<LoopRecord>& loops = run.record.loops;
  EXPECT_EQ(loops[1].kind, LoopKind::split);
  EXPECT_THAT(numbers(loops[1].parents), ElementsAre(0));
  EXPECT_THAT(path(loops[0]), ElementsAre(front(2), back(2)));
  // The parent gets a second child on the back bed, and is cast off only there.
  EXPECT_THAT(numbers(loops[2].parents), ElementsAre(0));
  EXPECT_EQ(loops[0].fate, LoopFate::cast_off);
  EXPECT_EQ(loops[0].fate_instruction, 3);
  EXPECT_THAT(held_on(run.record, front(2)), ElementsAre(1));
  EXPECT_THAT(held_on(run.record, back(2)), ElementsAre(2));
  EXPECT_EQ(loops[3].kind, LoopKind::cast_on);  // from an empty needle
  EXPECT_THAT(held_on(run.record, front(3)), ElementsAre(3));
  EXPECT_THAT(held_on(run.record, back(3)), IsEmpty());
}

TEST(RunMachine, plating_forms_one_loop_a_yarn_through_all_old_ones) {
  const MachineRun run = machine_of("in B A\nknit + f1 B A\nknit - f1 A B\nout A\nout B\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  const std::vector<LoopRecord>& loops = run.record.loops;
  ASSERT_EQ(loops.size(), 4u);
  EXPECT_EQ(run.record.yarns[loops[0].yarn.position()].carrier, CarrierId(1));  // B was named first
  EXPECT_EQ(run.record.yarns[loops[2].yarn.position()].carrier, CarrierId(0));
  EXPECT_THAT(numbers(loops[2].parents), ElementsAre(0, 1));
  EXPECT_THAT(numbers(loops[3].parents), ElementsAre(0, 1));
  EXPECT_THAT(held_on(run.record, front(1)), ElementsAre(2, 3));
  EXPECT_EQ(run.record.passes, 2);
}

TEST(RunMachine, drop_in_both_spellings_and_empty_acts) {
  const MachineRun run = machine_of(
      "in A\nknit + f1 A\nknit + f2 A\nknit + f3 A\ndrop f1\nknit + f2\ntuck - f3\namiss f3\n"
      "drop f1\nxfer f1 b1\nsplit + f3 b3\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  const std::vector<LoopRecord>& loops = run.record.loops;
  EXPECT_EQ(loops[0].fate, LoopFate::dropped);
  EXPECT_EQ(loops[0].fate_instruction, 4);
  EXPECT_EQ(loops[1].fate, LoopFate::dropped);
  EXPECT_EQ(loops[1].fate_instruction, 5);
  EXPECT_EQ(loops[2].fate, LoopFate::held);
  EXPECT_THAT(path(loops[2]), ElementsAre(front(3), back(3)));  // split without yarn is a transfer
}

// knitout's motion rule: a carrier beside a needle goes with the loops that leave it, one of the carrier set
// of a split stays, and a drop moves nothing.
TEST(RunMachine, carriers_follow_transfers_but_not_drops) {
  const MachineRun run = machine_of(
      "in A\nknit + f1 A\nknit + f2 A\nxfer f2 b2\nrack 1\nxfer b2 f3\nrack 0\nmiss - f1 A\n"
      "drop f1\nknit + f4 A\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(came_from(run.record.yarns[0]), ElementsAre(front(1), front(1), front(3), front(1)));
}

TEST(RunMachine, a_split_leaves_its_own_carrier_and_takes_others_along) {
  const MachineRun run = machine_of(
      "in A\nin B\nknit + f1 A\nknit + f1 B\nsplit - f1 b1 A\nknit + f2 A\nknit + f2 B\nout A\nout B\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(came_from(run.record.yarns[0]), ElementsAre(front(1), front(1), front(1)));
  EXPECT_THAT(came_from(run.record.yarns[1]), ElementsAre(front(1), back(1)));
}

TEST(RunMachine, sliders_take_loops_from_needles_and_give_them_back) {
  const MachineRun run = machine_of("in A\nknit + f1 A\nxfer f1 bs1\nrack 1\nxfer bs1 f2\nout A\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_THAT(path(run.record.loops[0]), ElementsAre(front(1), Needle{Bed::back_slider, 1}, front(2)));
}

// Needle indices may lie anywhere; memory and time are those of the needles that are named.
TEST(RunMachine, far_needles_cost_nothing) {
  Program program;
  program.carriers = {"A"};
  program.yarns.resize(1);
  const auto add = [&](Op op, int index) {
    Instruction instruction;
    instruction.op = op;
    instruction.direction = Direction::right;
    instruction.needle = front(index);
    instruction.carriers = {CarrierId(0)};
    program.instructions.push_back(instruction);
  };
  add(Op::in, 0);
  for (int index : {-2'000'000'000, -3, 2'000'000'000, -2'000'000'000}) add(Op::knit, index);
  add(Op::out, 0);
  Diagnostics diagnostics;
  const KnittingRecord record = run_machine(program, diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics;
  ASSERT_EQ(record.loops.size(), 4u);
  EXPECT_THAT(numbers(record.loops[3].parents), ElementsAre(0));
  EXPECT_THAT(held_on(record, front(2'000'000'000)), ElementsAre(2));
}

// Ten times the instructions may not take much more than ten times as long, with loops on both beds, the beds
// racked and moved back in every course, and racks stated over and over. (About 10 ms for the small one.)
TEST(RunMachine, work_is_linear_in_the_programme) {
  const auto seconds = [](int courses) {
    std::string text = ";!knitout-2\n;;Carriers: A\nin A\n";
    for (int course = 0; course < courses; ++course) {
      text += "rack 0.25\n";
      for (int needle = 0; needle < 40; ++needle)
        text +=
            "knit + f" + std::to_string(needle) + " A\nrack 0.25\nknit + b" + std::to_string(needle) + " A\n";
      text += "rack 0\n";
      for (int needle = 39; needle >= 0; --needle)
        text += "rack 0\nknit - f" + std::to_string(needle) + " A\n";
    }
    text += "out A\n";
    Diagnostics diagnostics;
    const Program program = read_knitout(text, diagnostics);
    double best = 1e9;
    for (int repeat = 0; repeat < 3; ++repeat) {
      const auto start = std::chrono::steady_clock::now();
      const KnittingRecord record = run_machine(program, diagnostics);
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      EXPECT_EQ(record.loops.size(), static_cast<std::size_t>(120 * courses));
      EXPECT_THAT(record.crossings, IsEmpty());
    }
    return best;
  };
  const double small = seconds(50), large = seconds(500);
  EXPECT_LT(large, 40 * small + 0.05);
}

}  // namespace
}  // namespace loopwright
