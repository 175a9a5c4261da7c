// Small programmes with the expected graph worked out by hand.
#include <gmock/gmock.h>

#include "topology/graph_of.hpp"
#include "topology/loop_statistics.hpp"

namespace loopwright {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// "parent>child sign", in the order of the graph.
std::vector<std::string> interlaced(const YarnGraph& graph) {
  std::vector<std::string> all;
  for (const Interlacing& i : graph.interlacings)
    all.push_back(std::to_string(i.parent.value) + ">" + std::to_string(i.child.value) +
                  (i.sign > 0 ? " +" : " -"));
  return all;
}

TEST(YarnGraph, front_stitches_are_drawn_to_the_front_and_rear_ones_to_the_back) {
  // Cast on two on each bed, one course of knit on the front and one on the back; then the front loop is
  // moved and knitted by the back bed: its sign is that of the bed which draws the new loop.
  const GraphRun run = graph_of(
      "in A\nknit + f1 A\nknit + b2 A\nknit - b2 A\nknit - f1 A\nxfer f1 b1\nknit + b1 A\nknit + b2 A\nout "
      "A\n");
  EXPECT_THAT(interlaced(run.graph), ElementsAre("1>2 -", "0>3 +", "3>4 -", "2>5 -"));
  EXPECT_EQ(run.graph.loops[3].side, StitchSide::front);
  EXPECT_EQ(run.graph.loops[3].head_bed, Bed::back);
  EXPECT_EQ(run.graph.loops[4].side, StitchSide::rear);
  EXPECT_THAT(numbers(run.graph.loops[3].children), ElementsAre(4));
  EXPECT_THAT(numbers(run.graph.yarns[0].loops), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(run.graph.yarns[0].floats.size(), 5u);
  EXPECT_EQ(run.graph.loops[4].order, 4);
  EXPECT_EQ(run.graph.loops[4].at.line, 9);
}

TEST(YarnGraph, heads_stand_where_their_children_pull_them) {
  // f1's loop is moved to f2 over racking 1 and knitted there with f2's own.
  const GraphRun run = graph_of(
      "in A\nknit + f1 A\nknit + f2 A\nxfer f1 b1\nrack 1\nxfer b1 f2\nrack 0\nknit - f2 A\nknit - f1 A\nout "
      "A\n");
  const std::vector<Loop>& loops = run.graph.loops;
  EXPECT_DOUBLE_EQ(loops[0].slot, 1);
  EXPECT_DOUBLE_EQ(loops[0].head_slot, 2);
  EXPECT_DOUBLE_EQ(loops[1].head_slot, 2);
  EXPECT_EQ(loops[0].head_count, 2);
  EXPECT_EQ(loops[0].head_rank, 1);  // it arrived from the back bed, behind the loop that was there
  EXPECT_EQ(loops[1].head_rank, 0);
  EXPECT_THAT(interlaced(run.graph), ElementsAre("1>2 +", "0>2 +"));
  EXPECT_EQ(loops[3].kind, LoopKind::cast_on);  // the eyelet
}

TEST(YarnGraph, racking_moves_heads_on_the_back_bed) {
  const GraphRun run = graph_of("in A\nknit + b3 A\nrack 2\nknit - b3 A\nrack 1\nout A\n");
  EXPECT_DOUBLE_EQ(run.graph.loops[0].slot, 3);
  EXPECT_DOUBLE_EQ(run.graph.loops[0].head_slot, 5);  // when it was knitted
  EXPECT_DOUBLE_EQ(run.graph.loops[1].slot, 5);
  EXPECT_DOUBLE_EQ(run.graph.loops[1].head_slot, 4);  // at the end, still held
}

TEST(YarnGraph, a_split_gives_its_parent_two_children) {
  const GraphRun run = graph_of("in A\nknit + f1 A\nsplit - f1 b1 A\nknit + b1 A\nknit - f1 A\nout A\n");
  EXPECT_THAT(interlaced(run.graph), ElementsAre("0>1 +", "0>2 -", "1>3 +"));
  EXPECT_THAT(numbers(run.graph.loops[0].children), ElementsAre(1, 2));
  EXPECT_EQ(run.graph.loops[0].head_instruction, 3);
}

TEST(YarnGraph, plating_interlaces_every_pair) {
  const GraphRun run = graph_of("in A B\nknit + f1 A B\nknit - f1 A B\nout A B\n");
  EXPECT_THAT(interlaced(run.graph), ElementsAre("0>2 +", "1>2 +", "0>3 +", "1>3 +"));
  EXPECT_EQ(run.graph.yarns.size(), 2u);
}

TEST(YarnGraph, loops_that_will_run_are_told) {
  const GraphRun run = graph_of(
      "in A\nknit + f1 A\nknit + f2 A\nknit + f3 A\nknit - f3 A\ndrop f1\ndrop f2\nknit + f4 A\ndrop f3\nout "
      "A\n");
  EXPECT_THAT(numbers(run.graph.unheld), ElementsAre(0, 1, 3));
  EXPECT_TRUE(says(run.diagnostics(), Severity::warning, 8, "2 loops dropped from here on (f1 to f2)"))
      << run.diagnostics();
  EXPECT_TRUE(says(run.diagnostics(), Severity::warning, 11, "the loop dropped from f3"))
      << run.diagnostics();
  EXPECT_EQ(run.diagnostics().warnings(), 2) << run.diagnostics();
  EXPECT_THAT(numbers(run.graph.left_on_needles), ElementsAre(4));
}

TEST(YarnGraph, a_dropped_loop_with_a_child_is_held) {
  const GraphRun run = graph_of("in A\nknit + f1 A\nsplit - f1 b1 A\ndrop b1\nout A\n");
  EXPECT_THAT(run.graph.unheld, IsEmpty());
  EXPECT_EQ(run.diagnostics().warnings(), 0) << run.diagnostics();
}

TEST(YarnGraph, cables_cross_legs) {
  const GraphRun run = graph_of(
      "in A\nknit + f1 A\nknit + f2 A\nxfer f1 b1\nxfer f2 b2\nrack 1\nxfer b1 f2\nrack -1\nxfer b2 f1\nrack "
      "0\n"
      "knit - f2 A\nknit - f1 A\nout A\n");
  ASSERT_EQ(run.graph.leg_crossings.size(), 1u);
  EXPECT_EQ(run.graph.leg_crossings[0].front, LoopId(0));  // brought to the front first
  EXPECT_EQ(run.graph.leg_crossings[0].back, LoopId(1));
}

TEST(YarnGraph, statistics_count_what_is_there) {
  const GraphRun run = graph_of(
      "in A\nknit + f1 A\nknit + f2 A\nknit + b3 A\ntuck - f2 A\nsplit - f1 b1 A\nknit + f2 A\nout A\n");
  const LoopStatistics s = loop_statistics(run.graph);
  EXPECT_EQ(s.loops, 6);
  EXPECT_EQ(s.cast_on, 3);
  EXPECT_EQ(s.tuck, 1);
  EXPECT_EQ(s.split, 1);
  EXPECT_EQ(s.knit, 1);
  EXPECT_EQ(s.front, 5);
  EXPECT_EQ(s.rear, 1);
  EXPECT_EQ(s.highest_stack, 2);
  EXPECT_EQ(s.passes, 3);
  EXPECT_EQ(s.interlacings, 3);
  EXPECT_EQ(s.left_on_needles, 4);
}

// A sound graph with one thing wrong in it, and words of what must be said.
struct Damage {
  const char* name;
  void (*damage)(YarnGraph&);
  const char* words;
};

class Validation : public testing::TestWithParam<Damage> {};

TEST_P(Validation, finds_the_fault) {
  YarnGraph graph = graph_of(
                        "in A\nin B\nknit + f1 A\nknit + f2 A\ntuck - f2 A\nknit - f1 A\nknit + f1 B\nknit + "
                        "f2 B\nout A B\n")
                        .graph;
  GetParam().damage(graph);
  const std::vector<std::string> faults = validate_yarn_graph(graph);
  EXPECT_THAT(faults, testing::Contains(testing::HasSubstr(GetParam().words)));
}

const Damage damages[] = {
    {"wrong_sign", [](YarnGraph& g) { g.interlacings[0].sign = -g.interlacings[0].sign; }, "wrong sign"},
    {"lost_interlacing", [](YarnGraph& g) { g.interlacings.pop_back(); }, "interlacings"},
    {"foreign_interlacing", [](YarnGraph& g) { g.interlacings[0].parent = LoopId(1); }, "not its parent"},
    {"lost_child", [](YarnGraph& g) { g.loops[0].children.clear(); }, "not its child"},
    {"double_interlacing", [](YarnGraph& g) { g.interlacings.push_back(g.interlacings[0]); },
     "interlaced twice"},
    {"swapped_yarn_order", [](YarnGraph& g) { std::swap(g.yarns[0].loops[0], g.yarns[0].loops[1]); },
     "another place"},
    {"loop_of_no_yarn",
     [](YarnGraph& g) {
       g.yarns[1].loops.pop_back();
       g.yarns[1].floats.pop_back();
     },
     "0 times"},
    {"lost_float", [](YarnGraph& g) { g.yarns[0].floats.pop_back(); }, "floats for"},
    {"float_that_joins_others", [](YarnGraph& g) { g.yarns[0].floats[0].to = LoopId(3); }, "does not join"},
    {"float_past_itself",
     [](YarnGraph& g) {
       g.yarns[0].floats[0].passed.push_back({LoopId(0), 1, Bed::front});
     },
     "cannot pass"},
    {"float_past_the_future",
     [](YarnGraph& g) {
       g.yarns[0].floats[0].passed.push_back({LoopId(5), 1, Bed::front});
     },
     "older than it"},
    {"two_of_one_rank", [](YarnGraph& g) { g.loops[2].head_rank = g.loops[1].head_rank; }, "has head rank"},
    {"wrong_side", [](YarnGraph& g) { g.loops[0].side = StitchSide::rear; }, "another side"},
    {"parents_of_a_tuck", [](YarnGraph& g) { g.loops[3].kind = LoopKind::tuck; }, "do not suit its kind"},
    {"cast_off_by_nothing", [](YarnGraph& g) { g.loops[2].children.clear(); }, "nothing is drawn through it"},
    {"held_but_not_listed", [](YarnGraph& g) { g.left_on_needles.clear(); }, "not among the loops left"},
    {"crossing_of_one",
     [](YarnGraph& g) {
       g.leg_crossings.push_back({LoopId(0), LoopId(0)});
     },
     "needs two loops"},
    {"unknown_loop", [](YarnGraph& g) { g.interlacings[0].child = LoopId(99); }, "not there"},
};

INSTANTIATE_TEST_SUITE_P(Damages, Validation, testing::ValuesIn(damages),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace loopwright
