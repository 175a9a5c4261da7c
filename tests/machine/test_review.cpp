// What a knitter would say of programmes that run: each warning and each advice on a programme that deserves
// it, and none on its neighbour that does not.
#include <gmock/gmock.h>

#include "machine/corpus.hpp"
#include "machine/machine_of.hpp"
#include "machine/review.hpp"

namespace loopwright {
namespace {

Diagnostics reviewed(const std::string& lines) {
  MachineRun run = machine_of(lines);
  EXPECT_TRUE(run.diagnostics.ok()) << run.diagnostics << lines;
  review(run.program, run.record, run.diagnostics);
  return run.diagnostics;
}

struct Doubt {
  const char* name;
  const char* doubtful;  // a body: its first line is line 3
  Severity severity;
  int line;
  const char* words;
  const char* better;  // a body of which this is not said
};

std::ostream& operator<<(std::ostream& out, const Doubt& doubt) { return out << doubt.doubtful; }

class Review : public testing::TestWithParam<Doubt> {};

TEST_P(Review, says_it_once_where_it_is_true) {
  const Doubt& doubt = GetParam();
  const Diagnostics said = reviewed(doubt.doubtful);
  EXPECT_TRUE(says(said, doubt.severity, doubt.line, doubt.words)) << said;
  const Diagnostics of_better = reviewed(doubt.better);
  for (const Diagnostic& d : of_better.list())
    EXPECT_EQ(d.message.find(doubt.words), std::string::npos) << of_better;
}

// A tucked cast-on of four needles, and its end.
#define CAST_ON "in A\ntuck - f4 A\ntuck - f2 A\ntuck + f1 A\ntuck + f3 A\n"
#define END "out A\ndrop f1\ndrop f2\ndrop f3\ndrop f4\n"

const Doubt doubts[] = {
    {"knit_on_empty", "in A\nknit + f1 A\nknit + f3 A\nout A\n", Severity::warning, 4,
     "a stitch is knitted on an empty needle in 2 places, first here (f1)", CAST_ON "knit - f3 A\n" END},
    {"drop_of_empty", "in A\ntuck + f1 A\nout A\ndrop f1\ndrop f2\n", Severity::warning, 7,
     "a needle that holds nothing is dropped here (f2)", CAST_ON END},
    {"transfer_of_empty", "in A\ntuck + f1 A\nxfer f2 b2\nxfer b3 f3\nout A\n", Severity::warning, 5,
     "a needle that holds nothing is transferred in 2 places, first here (f2)",
     "in A\ntuck + f1 A\nxfer f1 b1\nout A\n"},
    {"five_loops_on_a_needle",
     "in A\ntuck + f1 A\ntuck - f1 A\ntuck + f1 A\ntuck - f1 A\ntuck + f1 A\ntuck - f1 A\nout A\n",
     Severity::warning, 8, "more than 4 loops come onto a needle here (f1; the highest stack has 6)",
     "in A\ntuck + f1 A\ntuck - f1 A\ntuck + f1 A\ntuck - f1 A\nout A\n"},
    {"float_over_21_needles", "in A\ntuck + f1 A\nmiss + f30 A\ntuck + f22 A\nout A\n", Severity::warning, 6,
     "floats over 21 needles, from f1 to f22", "in A\ntuck + f1 A\ntuck + f21 A\nout A\n"},
    {"float_of_a_loop_that_racking_took_away", "in A\ntuck + b15 A\nrack 15\ntuck + f1 A\nout A\n",
     Severity::warning, 6, "floats over 29 needles, from b15 to f1",
     "in A\ntuck + b15 A\nrack 0\ntuck + f1 A\nout A\n"},
    {"float_of_a_loop_that_was_transferred",
     "in A\ntuck + b15 A\nrack -10\nxfer b15 f5\nrack 0\ntuck + f30 A\nout A\n", Severity::warning, 8,
     "floats over 25 needles, from f5 to f30", "in A\ntuck + b15 A\ntuck + f30 A\nout A\n"},
    {"float_over_an_inch", "in A\ntuck + f1 A\ntuck + f12 A\nout A\n", Severity::advice, 5,
     "floats over 11 needles", "in A\ntuck + f1 A\ntuck + f11 A\nout A\n"},
    {"racked_far", "in A\nrack 5\ntuck + f1 A\nrack 0\nout A\n", Severity::warning, 4,
     "racked by more than 4 needles here (up to 5)", "in A\nrack 4\ntuck + f1 A\nrack 0\nout A\n"},
    {"racking_never_used", "in A\nrack 1\nrack 2\ntuck + f1 A\nrack 0\nout A\n", Severity::warning, 4,
     "a racking is set and never used here", "in A\nrack 2\nrack 2\ntuck + f1 A\nrack 0\nout A\n"},
    {"paused_twice", "in A\npause\npause\ntuck + f1 A\nout A\n", Severity::warning, 5, "paused a second time",
     "in A\npause\ntuck + f1 A\npause\nout A\n"},
    {"hook_goes_right", "inhook A\ntuck + f1 A\nreleasehook A\nout A\n", Severity::advice, 4,
     "start to the left", "inhook A\ntuck - f1 A\nreleasehook A\nout A\n"},
    {"needle_behind_the_hook", "inhook A\ntuck - f5 A\ntuck - f3 A\ntuck + f6 A\nreleasehook A\nout A\n",
     Severity::warning, 6, "is used here (f6)",
     "inhook A\ntuck - f5 A\ntuck - f3 A\ntuck + f4 A\nreleasehook A\ntuck + f6 A\nout A\n"},
    {"yarn_caught", "in A\nin B\ntuck + f1 A\nmiss + f9 A\ntuck + f5 B\nout A\nout B\n", Severity::advice, 7,
     "which has gone past f5 without a loop",
     "in A\nin B\ntuck + f1 A\nmiss + f9 A\ntuck + f10 B\ntuck - f8 A\ntuck - f5 B\nout A\nout B\n"},
    {"twisted_tuck", CAST_ON "knit - f4 A\nknit - f3 A\ntuck + f2 A\n" END, Severity::advice, 10,
     "against the way that its yarn travels here (f2)",
     CAST_ON "knit - f4 A\nknit - f3 A\ntuck - f2 A\ntuck + f2 A\n" END},
    {"neighbours_cast_on", "in A\nknit + f1 A\nknit + f2 A\nknit + f3 A\nout A\n", Severity::advice, 5,
     "neighbouring empty needles are cast on in one pass in 2 places, first here (f2)", CAST_ON END},
    {"neighbours_tucked_on", "in A\ntuck + f1 A\ntuck + f2 A\nout A\n", Severity::advice, 5,
     "neighbouring empty needles", "in A\ntuck + f1 A\ntuck + b2 A\ntuck + f3 A\nout A\n"},
    {"loops_left_hanging", CAST_ON "out A\n", Severity::advice, 7,
     "4 loops still hang on 4 needles (f1 to f4) at the end", CAST_ON END},
};

INSTANTIATE_TEST_SUITE_P(Doubts, Review, testing::ValuesIn(doubts),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(ReviewOfWaits, a_carrier_that_comes_in_long_after_it_was_told) {
  std::string between;
  for (int k = 0; k < 1001; ++k) between += k % 2 == 0 ? "tuck + f1 B\nknit - f1 B\n" : "knit + f1 B\n";
  const Diagnostics said = reviewed("in A\nin B\n" + between + "tuck + f9 A\nout A\nout B\n");
  EXPECT_TRUE(says(said, Severity::warning, 3, "first used")) << said;
}

TEST(ReviewOfGauge, an_inch_has_as_many_needles_as_the_gauge_says) {
  Diagnostics said;
  const Program program =
      read_knitout(";!knitout-2\n;;Carriers: A\n;;Gauge: 5\nin A\ntuck + f1 A\ntuck + f7 A\nout A\n", said);
  review(program, run_machine(program, said), said);
  EXPECT_TRUE(says(said, Severity::advice, 6, "floats over 6 needles")) << said;
}

TEST(ReviewOfRails, carriers_of_one_rail_cannot_pass_each_other) {
  const auto said_of = [](const std::string& carriers, const std::string& lines) {
    Diagnostics said;
    const Program program = read_knitout(";!knitout-2\n;;Carriers: " + carriers + "\n" + lines, said);
    review(program, run_machine(program, said), said);
    return said;
  };
  const std::string passing = "in L\nin R\ntuck + f1 L\ntuck + f5 R\ntuck + f7 L\nout L R\n";
  EXPECT_TRUE(says(said_of("1 L;R 2", passing), Severity::warning, 7, "carrier L goes past carrier R"));
  EXPECT_FALSE(says(said_of("1 L R 2", passing), Severity::warning, 7, "goes past"));
  EXPECT_FALSE(says(said_of("1,L R;2", passing), Severity::warning, 7, "goes past"));
  const std::string apart = "in L\nin R\ntuck + f1 L\ntuck + f5 R\nout R\ntuck + f7 L\nout L\n";
  EXPECT_FALSE(says(said_of("1 L;R 2", apart), Severity::warning, 8, "goes past"));
}

// Real programmes drop hundreds of empty needles: that is one line. What is said stands at lines they have.
TEST(ReviewOfTheCorpus, says_each_kind_once) {
  SKIP_WITHOUT_CORPUS();
  int spoken_of = 0, advised = 0;
  for (const CorpusEntry& entry : corpus_knitout()) {
    Diagnostics reading, said;
    const std::string text = corpus_text(entry.file);
    const Program program = read_knitout(text, reading);
    const KnittingRecord record = run_machine(program, reading);
    review(program, record, said);
    const auto lines = std::count(text.begin(), text.end(), '\n') + 1;
    for (const Diagnostic& d : said.list()) {
      EXPECT_GT(d.at.line, 0) << d.message;
      EXPECT_LE(d.at.line, lines) << d.message;
    }
    EXPECT_LE(said.list().size(), 14 + 3 * record.yarns.size()) << entry.file << said;
    EXPECT_TRUE(said.ok());
    spoken_of += said.list().empty() ? 0 : 1;
    advised += said.advice();
  }
  EXPECT_GT(spoken_of, 60);
  EXPECT_GT(advised, 60);
}

}  // namespace
}  // namespace loopwright
