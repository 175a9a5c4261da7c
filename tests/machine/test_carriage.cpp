// The traverses that a programme takes, and the carriers that are kicked out of the way.
#include <gmock/gmock.h>

#include <map>
#include <random>

#include "machine/machine_of.hpp"
#include "machine/racking.hpp"

namespace loopwright {
namespace {

// "5: A f3-" for a kick before the instruction in line 5 that puts A to the left of f3.
std::vector<std::string> kicks_of(const std::string& lines) {
  const MachineRun run = machine_of(lines);
  EXPECT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  std::vector<std::string> kicks;
  for (const KickBack& kick : run.record.kick_backs)
    kicks.push_back(
        std::to_string(run.program.instructions[static_cast<std::size_t>(kick.instruction)].at.line) + ": " +
        run.program.carriers[kick.carrier.position()] + " " + to_string(kick.needle) +
        (kick.side == Direction::left ? "-" : "+"));
  return kicks;
}

int passes_of(const std::string& lines) { return machine_of(lines).record.carriage_passes; }

TEST(KickBacks, none_where_a_carrier_goes_to_and_fro) {
  EXPECT_TRUE(kicks_of("in A\nknit + f1 A\nknit + f2 A\nknit - f2 A\nknit - f1 A\nout A\n").empty());
}

TEST(KickBacks, a_carrier_parked_beyond_a_needle_that_works) {
  // A stops right of f5, nobody knows how far; B works to the right of it, and then to the left of it.
  EXPECT_THAT(kicks_of("in A\nin B\nknit + f5 A\nknit + f9 B\nout A\nout B\n"),
              testing::ElementsAre("6: A f5-"));
  EXPECT_TRUE(kicks_of("in A\nin B\nknit + f5 A\nknit + f3 B\nout A\nout B\n").empty());
}

TEST(KickBacks, of_a_needle_that_gives_or_drops_its_loops) {
  EXPECT_THAT(kicks_of("in A\nknit + f9 A\nknit - f5 A\nknit + f7 A\nxfer f9 b9\nout A\n"),
              testing::ElementsAre("7: A f7-"));
  EXPECT_THAT(kicks_of("in A\nknit + f9 A\nknit - f5 A\nknit + f7 A\ndrop f9\nout A\n"),
              testing::ElementsAre("7: A f7-"));
}

TEST(KickBacks, a_pass_whose_carrier_is_on_the_side_to_which_it_goes) {
  EXPECT_THAT(kicks_of("in A\nknit + f1 A\nknit - f9 A\nknit - f5 A\nknit - f4 A\nout A\n"),
              testing::ElementsAre("5: A f9+"));  // from right of f1 nobody knows how far, so past f9 first
  EXPECT_THAT(kicks_of("in A\nknit + f5 A\nknit + f1 A\nout A\n"), testing::ElementsAre("5: A f1-"));
}

TEST(KickBacks, a_miss_goes_where_it_is_told_and_kicks_nobody) {
  EXPECT_TRUE(kicks_of("in A\nin B\nknit + f5 A\nmiss + f9 B\nout A\nout B\n").empty());
  // and it is the way to keep a carrier clear by hand
  EXPECT_TRUE(kicks_of("in A\nin B\nknit + f5 A\nmiss - f5 A\nknit + f9 B\nout A\nout B\n").empty());
}

TEST(KickBacks, a_carrier_that_followed_its_loop_is_parked_where_it_was) {
  // Its loop goes to f2; the carrier still stands right of f5, so f4 is between.
  EXPECT_THAT(
      kicks_of(
          "in A\nin B\nknit + f5 A\nxfer f5 b5\nrack -3\nxfer b5 f2\nrack 0\nknit + f4 B\nout A\nout B\n"),
      testing::ElementsAre("10: A f2-"));
}

TEST(CarriagePasses, runs_of_one_kind) {
  const std::string knits = "in A\nknit + f1 A\nknit + f2 A\nknit + f3 A\n";
  EXPECT_EQ(passes_of(knits + "out A\n"), 1);
  EXPECT_EQ(passes_of(knits + "knit - f3 A\nout A\n"), 2);
  EXPECT_EQ(passes_of(knits + "xfer f1 b1\nxfer f3 b3\nxfer f2 b2\nout A\n"), 2);  // any order
  EXPECT_EQ(passes_of(knits + "knit - f3 A\nknit - f1 A\nxfer f2 b2\nxfer f3 b3\nout A\n"), 3);
  EXPECT_EQ(passes_of(knits + "knit - f3 A\nxfer b1 f1\nrack 1\nxfer b1 f2\nrack 0\nout A\n"),
            5);                                                               // a racking each, and a kick
  EXPECT_EQ(passes_of("in A\nknit + f1 A\npause\nknit + f2 A\nout A\n"), 3);  // and a kick: A is right of f1
  EXPECT_EQ(passes_of("in A\nknit + f1 A\nstitch 1 2\nknit - f1 A\nstitch 1 3\nknit + f1 A\nout A\n"), 3);
  EXPECT_EQ(passes_of("inhook A\nknit - f3 A\nreleasehook A\nknit + f3 A\nout A\n"), 2);
}

TEST(CarriagePasses, facing_needles_share_one_only_in_the_all_needle_position) {
  EXPECT_EQ(passes_of("in A\nrack 0.25\nknit + f1 A\nknit + b1 A\nknit + f2 A\nrack 0\nout A\n"), 1);
  EXPECT_EQ(passes_of("in A\nrack 0.25\nknit - b1 A\nknit - f1 A\nrack 0\nout A\n"), 1);
  EXPECT_EQ(passes_of("in A\nrack -0.75\nknit + f0 A\nknit + b1 A\nknit + f1 A\nrack 0\nout A\n"), 1);
  EXPECT_GT(passes_of("in A\nknit + f1 A\nknit + b1 A\nknit + f2 A\nout A\n"), 1);
}

// Replays random programmes with the kick-backs that the machine recorded, and asks before every instruction
// whether all carriers are clear of it. What is parked is only known to be beyond a place.
TEST(KickBacks, leave_the_way_clear_in_random_programmes) {
  struct Park {
    double place = 0;
    int side = 0;
  };
  int kicks = 0, asked = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    std::string text = "in A\nin B\nin C\nknit + f0 A\nknit + f1 B\nknit + f2 C\n";
    for (int k = 0; k < 100; ++k) {
      const std::string needle = (below(2) == 0 ? "f" : "b") + std::to_string(below(8));
      const std::string set(1, static_cast<char>('A' + below(3)));
      const char* op[] = {"knit", "tuck", "miss"};
      if (below(4) > 0)
        text += std::string(op[below(3)]) + (below(2) == 0 ? " + " : " - ") + needle + " " + set + "\n";
      else
        text += below(2) == 0 ? "drop " + needle + "\n"
                              : "xfer f" + needle.substr(1) + " b" + needle.substr(1) + "\n";
    }
    const MachineRun run = machine_of(text + "out A B C\n");
    ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
    std::map<int, Park> parked;             // by carrier
    std::map<int, std::pair<int, int>> at;  // index of its needle and side; both beds face each other here
    std::size_t next = 0;
    for (std::size_t i = 0; i < run.program.instructions.size(); ++i) {
      const Instruction& instruction = run.program.instructions[i];
      for (; next < run.record.kick_backs.size() &&
             run.record.kick_backs[next].instruction == static_cast<int>(i);
           ++next, ++kicks) {
        const KickBack& kick = run.record.kick_backs[next];
        parked[kick.carrier.value] = {double(kick.needle.index), static_cast<int>(kick.side)};
      }
      if (instruction.op < Op::knit) continue;
      const int here = instruction.needle.index;
      for (const auto& [carrier, place] : at) {
        const bool own = !instruction.carriers.empty() && instruction.carriers.front().value == carrier;
        const Park& park = parked[carrier];
        if (own || instruction.op == Op::miss) continue;
        const int side = place.first + 0.5 * place.second < here ? -1 : 1;
        EXPECT_EQ(park.side, side) << text;
        EXPECT_LE(side * here, side * park.place) << text;
        ++asked;
      }
      for (const CarrierId id : instruction.carriers) {
        at[id.value] = {here, static_cast<int>(instruction.direction)};
        parked[id.value] = {double(here), static_cast<int>(instruction.direction)};
      }
    }
    EXPECT_EQ(next, run.record.kick_backs.size());
    if (HasFailure()) return;
  }
  EXPECT_GT(kicks, 1000);
  EXPECT_GT(asked, 5000);
}

TEST(CarrierPlaces, are_kept_when_a_carrier_goes_out) {
  const MachineRun run = machine_of(
      "in A\nin B\nknit + f3 A\nknit - f5 B\nxfer f3 b3\nrack 1\nxfer b3 f4\nrack 0\nout A\nout B\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  ASSERT_EQ(run.record.carriers.size(), 4u);
  EXPECT_EQ(run.record.carriers[0].needle, front(4));
  EXPECT_EQ(run.record.carriers[0].side, Direction::right);
  EXPECT_FALSE(run.record.carriers[0].in);
  EXPECT_EQ(run.record.carriers[1].needle, front(5));
  EXPECT_EQ(run.record.carriers[1].side, Direction::left);
  EXPECT_FALSE(run.record.carriers[2].needle);
}

TEST(CarrierPlaces, are_not_moved_by_transfers_after_the_carrier_went_out) {
  const MachineRun run = machine_of("in A\nknit + f3 A\nxfer f3 b3\nout A\nrack 1\nxfer b3 f4\nrack 0\n");
  ASSERT_TRUE(run.diagnostics.ok()) << run.diagnostics;
  EXPECT_EQ(run.record.carriers[0].needle, back(3));
  EXPECT_EQ(run.record.loops[0].last().needle, front(4));
}

TEST(CarrierPlaces, tell_who_is_still_in) {
  const MachineRun run = machine_of("in A\nknit + b3 A\nrack 2\n");
  EXPECT_EQ(run.record.carriers[0].needle, back(3));
  EXPECT_TRUE(run.record.carriers[0].in);
}

TEST(TwistedTucks, are_made_against_the_way_of_the_yarn) {
  const auto twisted = [](const std::string& lines) {
    const MachineRun run = machine_of(lines);
    return run.record.loops.back().twisted;
  };
  EXPECT_FALSE(twisted("in A\ntuck + f1 A\nout A\n"));
  EXPECT_FALSE(twisted("in A\nknit + f1 A\ntuck + f3 A\nout A\n"));
  EXPECT_TRUE(twisted("in A\nknit + f1 A\ntuck - f3 A\nout A\n"));
  EXPECT_FALSE(twisted("in A\nknit + f5 A\ntuck - f5 A\nout A\n"));
  EXPECT_TRUE(twisted("in A\nknit + f5 A\ntuck + f5 A\nout A\n"));
  EXPECT_FALSE(twisted("in A\nknit + f1 A\nknit - f3 A\nout A\n"));  // drawn through a loop it pulls straight
}

}  // namespace
}  // namespace loopwright
