// Real programmes: what an established converter accepts runs without an error, and the outcome is that of a
// second, independently written simulator.
#include <gmock/gmock.h>

#include <map>

#include "machine/corpus.hpp"
#include "machine/machine_of.hpp"
#include "machine/reference_simulator.hpp"

namespace loopwright {
namespace {

struct CorpusRun {
  Program program;
  Diagnostics reading, running;
  KnittingRecord record;
};

CorpusRun run_corpus_file(const std::string& file) {
  CorpusRun run;
  run.program = read_knitout(corpus_text(file), run.reading);
  run.record = run_machine(run.program, run.running);
  return run;
}

bool is_semantically_wrong(const CorpusEntry& entry) { return entry.tag == "INVALID: semantics"; }

// Programmes that the converter refuses for their first line or its machine's carriers, before it comes to
// what is wrong in their bodies, which it refuses elsewhere: `cross-test.k` brings four carriers in with one
// hook and uses them one by one, `tiles-test.k` also takes out what was never used, `resources__jacquard.k`
// leaves a carrier in.
bool is_refused_for_less(const CorpusEntry& entry) {
  return entry.file == "files/tiles-test.k" || entry.file == "files/cross-test.k" ||
         entry.file == "files/resources__jacquard.k";
}

TEST(MachineCorpus, programmes_that_must_fail_do) {
  SKIP_WITHOUT_CORPUS();
  int found = 0;
  for (const CorpusEntry& entry : corpus_knitout()) {
    if (!is_semantically_wrong(entry)) continue;
    ++found;
    EXPECT_FALSE(run_corpus_file(entry.file).running.ok()) << entry.file;
  }
  EXPECT_EQ(found, 2);
  const CorpusRun second_inhook = run_corpus_file("files/bad_ko.k");
  EXPECT_TRUE(says(second_inhook.running, Severity::error, 8, "releasehook 1")) << second_inhook.running;
  EXPECT_TRUE(says(second_inhook.running, Severity::error, 26, "has not been used")) << second_inhook.running;
  const CorpusRun not_in = run_corpus_file("files/bp_on_error.k");
  EXPECT_TRUE(says(not_in.running, Severity::error, 7, "carrier 1 is not in")) << not_in.running;
}

// The converter rejects some for their headers or for its machine's carriers; to this machine they are good,
// and machine_rules.hpp says of them what the converter says.
TEST(MachineCorpus, all_other_programmes_run_without_error) {
  SKIP_WITHOUT_CORPUS();
  int accepted = 0;
  for (const CorpusEntry& entry : corpus_knitout()) {
    if (is_semantically_wrong(entry)) continue;
    const CorpusRun run = run_corpus_file(entry.file);
    if (is_refused_for_less(entry)) {
      EXPECT_FALSE(run.running.ok()) << entry.file;
      continue;
    }
    EXPECT_TRUE(run.running.ok()) << entry.file << "\n" << run.running;
    if (entry.converter == "ok") ++accepted;
  }
  EXPECT_GT(accepted, 40);
}

TEST(MachineCorpus, the_outcome_is_that_of_an_independent_simulator) {
  SKIP_WITHOUT_CORPUS();
  for (const CorpusEntry& entry : corpus_knitout()) {
    if (is_semantically_wrong(entry)) continue;
    SCOPED_TRACE(entry.file);
    const CorpusRun run = run_corpus_file(entry.file);
    const ReferenceState expected = reference_run(corpus_text(entry.file));
    ASSERT_EQ(expected.misaligned, 0);

    // Loops: as many, from the same lines, drawn through the same ones, ended on the same needles.
    ASSERT_EQ(run.record.loops.size(), expected.parents.size());
    int wrong = 0;
    for (std::size_t k = 0; k < expected.parents.size(); ++k) {
      const LoopRecord& loop = run.record.loops[k];
      const int line = run.program.instructions[static_cast<std::size_t>(loop.instruction)].at.line;
      wrong += line != expected.line[k] || numbers(loop.parents) != expected.parents[k] ||
               to_string(loop.last().needle) != expected.ended_on[k];
    }
    EXPECT_EQ(wrong, 0);

    // Needles at the end, with the order of their stacks.
    std::map<std::string, std::vector<int>> held;
    for (const NeedleStack& stack : run.record.held) held[to_string(stack.needle)] = numbers(stack.loops);
    std::map<std::string, std::vector<int>> expected_held = expected.held;
    std::erase_if(expected_held, [](const auto& stack) { return stack.second.empty(); });
    EXPECT_EQ(held, expected_held);

    // Where every carrier stood before every loop and miss: the motion rule of transfers.
    std::map<std::pair<int, std::string>, std::string> from;
    for (const ReferenceStep& step : expected.steps)
      from[{step.line, step.carrier}] = step.from + ">" + step.needle;
    std::size_t steps = 0;
    for (const YarnRecord& yarn : run.record.yarns) {
      for (const YarnStep& step : yarn.steps) {
        const int line = run.program.instructions[static_cast<std::size_t>(step.instruction)].at.line;
        const std::string moved = to_string(step.from) + ">" + to_string(step.needle);
        wrong += moved != from[{line, run.program.carriers[yarn.carrier.position()]}];
        ++steps;
      }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(steps, expected.steps.size());
  }
}

// KnitDB: each swatch is 84 needles wide and 90 courses high, 7,476 loops after the cast-on with its gaps,
// and one yarn that is knitted to the end, so that every loop but those of the last course has one drawn
// through it.
TEST(MachineCorpus, knitdb_swatches_have_their_loops) {
  SKIP_WITHOUT_CORPUS();
  int swatches = 0;
  for (const CorpusEntry& entry : corpus_knitout()) {
    if (entry.file.rfind("knitdb/", 0) != 0) continue;
    ++swatches;
    const CorpusRun run = run_corpus_file(entry.file);
    EXPECT_EQ(run.record.loops.size(), 7476u) << entry.file;
    EXPECT_EQ(run.record.yarns.size(), 1u) << entry.file;
  }
  EXPECT_GE(swatches, 40);
}

// By hand from tests__cable.k, its first cable: b3 goes to f1 at racking -2 first, then b1 and b2 to f2 and
// f3 at 1. The one brought to the front first lies in front of both.
TEST(MachineCorpus, the_cable_of_one_over_two_is_the_right_way_round) {
  SKIP_WITHOUT_CORPUS();
  const CorpusRun run = run_corpus_file("files/cable.k");
  ASSERT_GE(run.record.crossings.size(), 2u);
  const auto formed_on = [&](LoopId id) { return run.record.loops[id.position()].formed().needle; };
  std::vector<std::string> first;
  for (std::size_t k = 0; k < 2; ++k) {
    first.push_back(to_string(formed_on(run.record.crossings[k].front)) + " over " +
                    to_string(formed_on(run.record.crossings[k].back)));
  }
  EXPECT_THAT(first, testing::UnorderedElementsAre("f3 over f1", "f3 over f2"));
}

}  // namespace
}  // namespace loopwright
