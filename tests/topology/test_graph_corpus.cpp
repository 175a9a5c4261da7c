// Real programmes: every graph is consistent, and its interlacings are those that a second simulator counts.
#include <gmock/gmock.h>

#include "machine/corpus.hpp"
#include "machine/reference_simulator.hpp"
#include "notation/read_program.hpp"
#include "topology/graph_of.hpp"
#include "topology/loop_statistics.hpp"

namespace loopwright {
namespace {

struct CorpusGraph {
  Program program;
  KnittingRecord record;
  YarnGraph graph;
};

CorpusGraph corpus_graph(const std::string& file) {
  CorpusGraph run;
  Diagnostics diagnostics(file);
  run.program = read_program(corpus_folder() / file, diagnostics);
  run.record = run_machine(run.program, diagnostics);
  run.graph = build_yarn_graph(run.program, run.record, diagnostics);
  return run;
}

TEST(GraphCorpus, every_graph_is_consistent) {
  SKIP_WITHOUT_CORPUS();
  for (const CorpusEntry& entry : corpus_knitout())
    EXPECT_THAT(validate_yarn_graph(corpus_graph(entry.file).graph), testing::IsEmpty()) << entry.file;
}

TEST(GraphCorpus, interlacings_are_those_that_another_simulator_counts) {
  SKIP_WITHOUT_CORPUS();
  for (const char* file :
       {"files/singlejersey.knitout", "files/lace.knitout", "files/plating.k", "files/tube.k",
        "files/two_color_brioche.k", "files/icord-bind-off.k", "files/stockenette_tube.k"}) {
    const ReferenceState expected = reference_run(corpus_text(file));
    std::size_t drawn = 0;
    for (const std::vector<int>& parents : expected.parents) drawn += parents.size();
    EXPECT_EQ(corpus_graph(file).graph.interlacings.size(), drawn) << file;
  }
}

// singlejersey.knitout: 80 needles, cast on in two passes of every other needle, then 123 courses, all on the
// front bed, and dropped at the end: so much is read from its text. Every loop but the 80 of the last course
// is knitted off.
TEST(GraphCorpus, single_jersey_in_numbers) {
  SKIP_WITHOUT_CORPUS();
  const CorpusGraph run = corpus_graph("files/singlejersey.knitout");
  const LoopStatistics s = loop_statistics(run.graph);
  EXPECT_EQ(s.loops, 9920);
  EXPECT_EQ(s.interlacings, 9920 - 80);
  EXPECT_EQ(s.front, s.loops);
  EXPECT_EQ(s.unheld, 80);
  EXPECT_EQ(s.left_on_needles, 0);
  EXPECT_EQ(s.highest_stack, 1);
  EXPECT_EQ(s.leg_crossings, 0);
  for (const Interlacing& i : run.graph.interlacings) EXPECT_EQ(i.sign, 1);
}

// Garter turns the bed every course, so the signs of the interlacings in a wale take turns; rib keeps them.
TEST(GraphCorpus, garter_and_rib_differ_in_their_signs) {
  SKIP_WITHOUT_CORPUS();
  const auto turns = [](const YarnGraph& graph) {
    int same = 0, other = 0;
    for (const Interlacing& i : graph.interlacings) {
      const Loop& parent = graph.loop(i.parent);
      if (parent.parents.empty()) continue;
      (parent.side == graph.loop(i.child).side ? same : other)++;
    }
    return std::pair(same, other);
  };
  const auto [garter_same, garter_other] = turns(corpus_graph("files/garter.knitout").graph);
  EXPECT_GT(garter_other, 20 * garter_same);
  const auto [rib_same, rib_other] = turns(corpus_graph("files/rib-2x2.knitout").graph);
  EXPECT_GT(rib_same, 20 * rib_other);
}

// Lace moves loops onto their neighbours: stacks of two and more, each with its child, and no legs crossed.
TEST(GraphCorpus, lace_has_decreases_and_no_crossings) {
  SKIP_WITHOUT_CORPUS();
  const LoopStatistics s = loop_statistics(corpus_graph("files/lace.knitout").graph);
  EXPECT_GE(s.highest_stack, 2);
  EXPECT_GT(s.cast_on, 60);  // the eyelets besides the first course
  EXPECT_EQ(s.leg_crossings, 0);
}

// In the cables of KnitDB groups of k loops change places with the k beside them, both moved by k needles:
// every pair crosses once. A crossing needs its heads' order to differ from the order of their feet.
TEST(GraphCorpus, crossed_legs_stand_the_other_way_round_above) {
  SKIP_WITHOUT_CORPUS();
  int crossings = 0;
  for (const char* file :
       {"knitdb/60_1_074Cable_2.knitout", "knitdb/18_2_075Chain.knitout",
        "knitdb/13_3_049TravelingTwists.knitout", "files/cable_swatch_2_cable.k", "files/cable.k"}) {
    const YarnGraph graph = corpus_graph(file).graph;
    for (const LegCrossing& crossing : graph.leg_crossings) {
      const Loop &front_loop = graph.loop(crossing.front), &back_loop = graph.loop(crossing.back);
      EXPECT_LT((front_loop.slot - back_loop.slot) * (front_loop.head_slot - back_loop.head_slot), 0) << file;
      ++crossings;
    }
    // And no pair of a pass that changed places was missed: compare all neighbours of a pass up to six
    // needles away.
    std::map<int, std::vector<LoopId>> passes;
    for (std::size_t k = 0; k < graph.loops.size(); ++k) passes[graph.loops[k].pass].push_back(LoopId(k));
    std::size_t changed = 0;
    for (const auto& [pass, loops] : passes)
      for (std::size_t a = 0; a < loops.size(); ++a)
        for (std::size_t b = a + 1; b < loops.size(); ++b) {
          const Loop &first = graph.loop(loops[a]), &second = graph.loop(loops[b]);
          changed += (first.slot - second.slot) * (first.head_slot - second.head_slot) < 0;
        }
    EXPECT_EQ(graph.leg_crossings.size(), changed) << file;
  }
  EXPECT_GT(crossings, 500);
}

}  // namespace
}  // namespace loopwright
