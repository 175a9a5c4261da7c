// What is told of impossible acts, with the line; and that the rest still runs.
#include <gmock/gmock.h>

#include <limits>

#include "machine/machine_of.hpp"

namespace loopwright {
namespace {

struct Fault {
  const char* name;
  const char* lines;  // body; its first line is line 3
  int line;           // where the error must stand
  const char* words;  // what it must say, the remedy included
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.lines; }

class MachineError : public testing::TestWithParam<Fault> {};

TEST_P(MachineError, is_told_once_with_line_and_remedy) {
  const Fault& fault = GetParam();
  const MachineRun run = machine_of(fault.lines);
  EXPECT_TRUE(says(run.diagnostics, Severity::error, fault.line, fault.words)) << run.diagnostics;
  EXPECT_EQ(run.diagnostics.errors(), 1) << run.diagnostics;
  for (const Diagnostic& d : run.diagnostics.list()) EXPECT_GT(d.at.column, 0) << d.message;
}

const Fault faults[] = {
    {"carrier_not_in", "knit + f1 A\nknit + f2 A\nout A\n", 3, "write 'in A' or 'inhook A'"},
    {"in_twice", "in A\nknit + f1 A\nin A\nknit + f2 A\nout A\n", 5, "already in, since line 3"},
    {"out_unused", "in A\nout A\n", 4, "brought in at line 3 but has not been used"},
    {"out_of_nothing", "out A\n", 3, "carrier A is not in"},
    {"out_twice", "in A\nknit + f1 A\nout A\nout A\n", 6, "carrier A is not in"},
    {"second_inhook", "inhook A\nknit + f1 A\ninhook B\nknit + f2 B\nreleasehook A\nout A\nout B\n", 5,
     "write 'releasehook A' before this 'inhook'"},
    {"release_of_nothing", "in A\nknit + f1 A\nreleasehook A\nout A\n", 5, "holds nothing"},
    {"release_of_another", "inhook A\nknit + f1 A\nin B\nknit + f2 B\nreleasehook B\nout A\nout B\n", 7,
     "holds A since line 3, not B"},
    {"release_before_use", "inhook A\nreleasehook A\nknit + f1 A\nout A\n", 4, "before it has been used"},
    {"outhook_while_busy", "in A\nknit + f1 A\ninhook B\nknit + f2 B\nouthook A\nreleasehook B\nout B\n", 7,
     "write 'releasehook B' before this"},
    {"out_of_part_of_the_hook", "inhook A B\nknit + f1 A B\nout A\nout B\n", 5,
     "write 'releasehook A B' before this"},
    {"outhook_before_releasehook", "inhook A\nknit + f1 A\nouthook A\n", 5,
     "write 'releasehook A' before this"},
    {"miss_without_carrier", "in A\nknit + f1 A\nmiss + f2\nknit + f3 A\nout A\n", 5,
     "a miss without a carrier"},
    {"transfer_misaligned", "in A\nknit + f3 A\nxfer f3 b1\nout A\n", 5,
     "write 'rack 2' before the transfer"},
    {"transfer_misaligned_from_back", "in A\nknit + b4 A\nxfer b4 f2\nout A\n", 5,
     "write 'rack -2' before the transfer"},
    {"transfer_on_one_bed", "in A\nknit + f3 A\nxfer f3 f4\nout A\n", 5, "same bed"},
    {"transfer_needle_to_own_slider", "in A\nknit + f3 A\nxfer f3 fs3\nout A\n", 5, "same bed"},
    {"transfer_between_sliders", "in A\nknit + f3 A\nxfer f3 bs3\nxfer bs3 fs3\nout A\n", 6, "both sliders"},
    {"transfer_at_a_fraction", "in A\nknit + f3 A\nrack 0.25\nxfer f3 b3\nout A\n", 6,
     "all-needle racking 0.25"},
    {"split_misaligned", "in A\nknit + f3 A\nrack 1\nsplit - f3 b3 A\nout A\n", 6, "write 'rack 0' before"},
    {"first_use_of_part_of_a_set", "in A B\nknit + f1 A\nknit + f1 A B\nout A B\n", 4,
     "but line 3 brings in A B"},
    {"first_use_of_more_than_the_set", "in A\nin B\nknit + f1 A B\nout A B\n", 5, "but line 3 brings in A"},
    {"left_in", "in A\nin B\nknit + f1 A\nknit + f2 B\nout B\n", 3, "carrier A is still in at the end"},
    {"left_in_unused", "in A\nin B\nknit + f1 A\nout A\n", 4, "carrier B is brought in and never used"},
    {"left_in_the_hook", "inhook A\nknit + f1 A\n", 3, "end with 'releasehook' and 'out A'"},
    {"loop_on_slider", "in A\nknit + f3 A\nknit + fs4 A\nout A\n", 5,
     "no loop can be made on the slider fs4"},
    {"split_from_slider", "in A\nknit + f3 A\nsplit + bs4 f4 A\nout A\n", 5,
     "no loop can be made on the slider bs4"},
};

INSTANTIATE_TEST_SUITE_P(Faults, MachineError, testing::ValuesIn(faults),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(MachineErrors, the_rest_of_a_faulty_programme_still_runs) {
  // The carrier was never brought in; the transfer misses. Both are told, the loops are made.
  const MachineRun run =
      machine_of("knit + f1 A\nknit + f2 A\nxfer f1 b3\nknit - f2 A\nknit - f1 A\nout A\n");
  EXPECT_EQ(run.diagnostics.errors(), 2) << run.diagnostics;
  ASSERT_EQ(run.record.loops.size(), 4u);
  EXPECT_THAT(numbers(run.record.loops[3].parents), testing::ElementsAre(0));
  ASSERT_EQ(run.record.yarns.size(), 1u);
  EXPECT_EQ(run.record.yarns[0].in_instruction, -1);
  EXPECT_EQ(run.record.yarns[0].out_instruction, 5);
}

TEST(MachineErrors, unknown_and_doubled_carriers_of_a_programme_made_by_hand) {
  Program program;
  program.carriers = {"A"};
  program.yarns.resize(1);
  Instruction knit;
  knit.op = Op::knit;
  knit.direction = Direction::right;
  knit.needle = front(1);
  knit.carriers = {CarrierId(0), CarrierId(0), CarrierId(7), CarrierId()};
  Instruction bring_in;
  bring_in.op = Op::in;
  bring_in.carriers = {CarrierId(0)};
  Instruction take_out = bring_in;
  take_out.op = Op::out;
  program.instructions = {bring_in, knit, take_out};
  Diagnostics diagnostics;
  const KnittingRecord record = run_machine(program, diagnostics);
  EXPECT_EQ(diagnostics.errors(), 3) << diagnostics;
  EXPECT_EQ(record.loops.size(), 1u);
}

TEST(MachineErrors, rackings_that_are_no_number_of_needles) {
  Program program;
  for (double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e9}) {
    Instruction rack;
    rack.op = Op::rack;
    rack.value = value;
    program.instructions.push_back(rack);
  }
  Diagnostics diagnostics;
  const KnittingRecord record = run_machine(program, diagnostics);
  EXPECT_EQ(diagnostics.errors(), 3) << diagnostics;
  EXPECT_TRUE(record.rackings.empty());
}

}  // namespace
}  // namespace loopwright
