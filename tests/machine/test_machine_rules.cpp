// What the converters of two makers ask. The corpus holds the verdict of one of them on real programmes.
#include <gmock/gmock.h>

#include "machine/corpus.hpp"
#include "machine/machine_of.hpp"
#include "machine/machine_rules.hpp"

namespace loopwright {
namespace {

const std::string shima_head = ";!knitout-2\n;;Carriers: 1 2 3 4 5 6 7 8 9 10\n";
const std::string kniterate_head = ";!knitout-2\n;;Carriers: 1 2 3 4 5 6\n";

Diagnostics checked(const std::string& text, MachineKind machine) {
  Diagnostics diagnostics("x.k");
  const Program program = read_knitout(text, diagnostics);
  run_machine(program, diagnostics);
  check_machine_rules(program, machine, diagnostics);
  return diagnostics;
}

// Reader, machine and rules together say of each real programme what the converter said.
TEST(MachineRules, accept_and_reject_the_corpus_as_the_shima_converter_does) {
  SKIP_WITHOUT_CORPUS();
  int accepted = 0, rejected = 0;
  for (const CorpusEntry& entry : corpus_knitout()) {
    const Diagnostics said = checked(corpus_text(entry.file), MachineKind::shima);
    if (entry.converter.empty()) {  // the swatches, which were knitted on such a machine
      EXPECT_TRUE(said.ok()) << entry.file << said;
      continue;
    }
    EXPECT_EQ(said.ok(), entry.converter == "ok") << entry.file << ": " << entry.converter << "\n" << said;
    ++(said.ok() ? accepted : rejected);
  }
  EXPECT_EQ(accepted + rejected, 68);
  EXPECT_GT(accepted, 45);
  EXPECT_GT(rejected, 15);
}

TEST(MachineRules, kniterate_programmes_of_the_corpus_are_good_for_a_kniterate) {
  SKIP_WITHOUT_CORPUS();
  int found = 0;
  for (const CorpusEntry& entry : corpus_knitout()) {
    if (entry.tag.rfind("kniterate", 0) != 0) continue;
    ++found;
    const Diagnostics said = checked(corpus_text(entry.file), MachineKind::kniterate);
    EXPECT_TRUE(said.ok()) << entry.file << said;
  }
  EXPECT_EQ(found, 3);
}

struct Breach {
  const char* name;
  MachineKind machine;
  const char* lines;  // a body: its first line is line 3
  int line;           // 0: the file as a whole
  const char* words;
};

std::ostream& operator<<(std::ostream& out, const Breach& breach) { return out << breach.lines; }

class MachineRule : public testing::TestWithParam<Breach> {};

TEST_P(MachineRule, is_told_once) {
  const Breach& breach = GetParam();
  const bool shima = breach.machine == MachineKind::shima;
  const Diagnostics said = checked((shima ? shima_head : kniterate_head) + breach.lines, breach.machine);
  EXPECT_TRUE(says(said, Severity::error, breach.line, breach.words)) << said;
  EXPECT_EQ(said.errors(), 1) << said;
}

constexpr MachineKind shima = MachineKind::shima, kniterate = MachineKind::kniterate;
const Breach breaches[] = {
    {"half_pitch_on_a_shima", shima, "rack 0.5\n", 3, "one and 0.25, not 0.5"},
    {"nine_needles", shima, "rack -9\n", 3, "8 needles to each side, not -9"},
    {"third_pitch_on_a_kniterate", kniterate, "rack 0.3\n", 3, "one and 0.5, not 0.3"},
    {"hook_on_a_kniterate", kniterate, "in 1\nknit + f1 1\nouthook 1\n", 5, "no yarn inserting hook"},
    {"three_yarns", shima, "in 1 2 3\nknit + f1 1 2 3\nout 1 2 3\n", 4, "at most 2 yarns, not 3"},
    {"plating_on_a_kniterate", kniterate, "in 1 2\nknit + f1 1 2\nout 1 2\n", 4, "at most 1 yarn, not 2"},
    {"order_of_first_use", shima, "in 1 2\nknit + f1 2 1\nout 1 2\n", 4,
     "in the order in which they came in"},
    {"order_of_release", shima, "inhook 1 2\nknit - f1 1 2\nreleasehook 2 1\nout 1 2\n", 5,
     "'releasehook' must name the carriers in the order"},
    {"slider_on_a_kniterate", kniterate, "in 1\nknit + f1 1\nxfer f1 bs1\nout 1\n", 5, "no sliders"},
    {"other_things_before_the_way_back", shima, "in 1\nknit + f1 1\nsplit + f1 bs1 1\nknit + f2 1\nout 1\n",
     6, "must come back before anything else from bs1"},
    {"way_back_of_three", shima, "in 1\nknit + f1 1\nsplit + f1 bs1 1\nrack 3\nxfer bs1 f4\nrack 0\nout 1\n",
     7, "1, 2 or 4 needles away, not 3"},
    {"too_wide_for_a_kniterate", kniterate, "in 1\nmiss + f1 1\nmiss + f253 1\nout 1\n", 0,
     "takes 253 needles, the bed has 252"},
    {"too_wide_for_a_shima", shima, "in 1\nmiss + f-270 1\nmiss + b270 1\nout 1\n", 0,
     "takes 541 needles, the bed has 540"},
    {"stitch_setting_of_a_shima", shima, "x-stitch-number A\n", 3, "a whole number"},
    {"stitch_setting_of_a_kniterate", kniterate, "x-stitch-number 12\n", 3, "a digit or a capital letter"},
    {"stitch_values_beyond_the_table", shima, "stitch 5 10\n", 3, "no entry for 'stitch 5 10'"},
    {"stitch_values_the_wrong_way_round", shima, "stitch 35 25\n", 3, "no entry for 'stitch 35 25'"},
    {"stitch_values_with_a_fraction", shima, "stitch 25 35.5\n", 3, "whole numbers"},
    {"speed_of_a_shima", shima, "x-speed-number fast\n", 3, "a whole number, not 'fast'"},
    {"speed_below_nothing", shima, "x-speed-number -1\n", 3, "a whole number, not '-1'"},
    {"presser", shima, "x-presser-mode maybe\n", 3, "on, off or auto"},
};

INSTANTIATE_TEST_SUITE_P(Breaches, MachineRule, testing::ValuesIn(breaches),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(MachineRules, what_the_machines_can_do) {
  EXPECT_TRUE(checked(shima_head +
                          "inhook 2 1\nknit - f1 2 1\nreleasehook 2 1\nrack 8.25\nrack 0\n"
                          "split + f1 bs1 1\nsplit + f2 bs2 1\nrack 1\nxfer bs1 f2\nxfer bs2 f3\nrack 0\n"
                          "outhook 2 1\nx-stitch-number 30\nx-presser-mode auto\nx-speed-number 15\n"
                          "stitch -10 10\nstitch 10 15\nstitch 20 25\nstitch 25 65\nstitch 20 20\n",
                      shima)
                  .ok());
  EXPECT_TRUE(checked(kniterate_head + "in 1\nrack -0.5\nknit + f1 1\nknit + b1 1\nrack 0.25\nout 1\n"
                                       "x-stitch-number A\n",
                      kniterate)
                  .ok());
}

TEST(MachineRules, places_beyond_a_table_are_told_once) {
  const Diagnostics said = checked(
      shima_head + "x-speed-number 300\nx-speed-number 16\nx-stitch-number 0\nx-stitch-number 121\n", shima);
  EXPECT_TRUE(said.ok()) << said;
  EXPECT_TRUE(says(said, Severity::warning, 3, "x-speed-number is a place in a table from 0 to 15, not 300"))
      << said;
  EXPECT_TRUE(says(said, Severity::warning, 5, "x-stitch-number is a place in a table from 1 to 120, not 0"))
      << said;
  EXPECT_EQ(said.warnings(), 2) << said;
  EXPECT_EQ(checked(kniterate_head + "x-speed-number 300\n", kniterate).warnings(), 0);
}

TEST(MachineRules, a_kniterate_takes_a_pass_for_knits_and_one_for_tucks) {
  const Diagnostics mixed =
      checked(kniterate_head + "in 1\nknit + f1 1\ntuck + f2 1\nknit + f3 1\nout 1\n", kniterate);
  EXPECT_TRUE(says(mixed, Severity::warning, 5, "knits and tucks on one bed 2 times")) << mixed;
  const Diagnostics beds =
      checked(kniterate_head + "in 1\nrack 0.5\nknit + f1 1\ntuck + b1 1\nknit + f2 1\ntuck - f2 1\nout 1\n",
              kniterate);
  EXPECT_EQ(beds.warnings(), 0) << beds;
}

TEST(MachineRules, the_carriers_header_is_that_of_the_machine) {
  EXPECT_TRUE(says(checked(";!knitout-2\n", shima), Severity::error, 0, "the Carriers header is required"));
  EXPECT_TRUE(says(checked(kniterate_head, shima), Severity::error, 0, "must be '1 2 3 4 5 6 7 8 9 10'"));
  EXPECT_TRUE(says(checked(shima_head, kniterate), Severity::error, 0, "must be '1 2 3 4 5 6'"));
  EXPECT_TRUE(
      says(checked(";!knitout-2\n;;Carriers: 1,2 3 4 5 6\n", kniterate), Severity::error, 0, "must be"));
}

}  // namespace
}  // namespace loopwright
