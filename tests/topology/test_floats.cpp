// What the yarn passes between two loops.
#include <gmock/gmock.h>

#include "topology/graph_of.hpp"

namespace loopwright {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Loops that float `k` of a yarn passes, in its order.
std::vector<int> passed(const GraphRun& run, std::size_t k, std::size_t yarn = 0) {
  std::vector<int> loops;
  for (const PassedLoop& p : run.graph.yarns[yarn].floats[k].passed) loops.push_back(p.loop.value);
  return loops;
}

const std::string cast_on =
    "in A\nknit + f1 A\nknit + f2 A\nknit + f3 A\nknit + f4 A\nknit + f5 A\n";  // loops 0 .. 4

TEST(Floats, neighbours_pass_nothing) {
  const GraphRun run = graph_of(cast_on + "knit - f5 A\nknit - f4 A\nout A\n");
  for (std::size_t k = 0; k < 6; ++k) EXPECT_THAT(passed(run, k), IsEmpty()) << k;
}

TEST(Floats, pass_the_held_loops_between_in_yarn_order) {
  const GraphRun run = graph_of(cast_on + "knit - f5 A\nknit - f1 A\nknit + f4 A\nout A\n");
  EXPECT_THAT(passed(run, 5), ElementsAre(3, 2, 1));
  EXPECT_THAT(passed(run, 6), ElementsAre(1, 2));
  EXPECT_DOUBLE_EQ(run.graph.yarns[0].floats[5].passed[0].slot, 4);
  EXPECT_EQ(run.graph.yarns[0].floats[5].passed[0].bed, Bed::front);
}

TEST(Floats, pass_only_what_is_held_when_the_yarn_goes_there) {
  // f3 is dropped before the yarn passes, f2 is knitted by B before: its new loop is passed.
  const GraphRun run =
      graph_of(cast_on + "knit - f5 A\nin B\nknit - f2 B\ndrop f3\nknit - f1 A\nout A\nout B\n");
  EXPECT_THAT(passed(run, 5), ElementsAre(3, 6));
}

TEST(Floats, pass_loops_of_both_beds_by_their_slots) {
  // Back loops of B on b2 and b3; racking 1 puts them over slots 3 and 4.
  const GraphRun run = graph_of(
      "in A\nin B\nknit + f1 A\nknit + b2 B\nknit + b3 B\nknit + b4 B\nknit + f2 B\nrack 1\n"
      "knit + f5 A\nout A\nout B\n");
  EXPECT_THAT(passed(run, 0),
              ElementsAre(4, 1, 2));  // f2 at 2, b2 at 3, b3 at 4; b4 stands at 5, the float's end
  EXPECT_EQ(run.graph.yarns[0].floats[0].passed[1].bed, Bed::back);
  EXPECT_DOUBLE_EQ(run.graph.yarns[0].floats[0].passed[1].slot, 3);
}

TEST(Floats, all_needle_racking_puts_back_loops_between_front_ones) {
  // f1, b1 (at 1.25) and f2 in turn: nothing between; from f1 to f2 past b1: b1's loop.
  const GraphRun run =
      graph_of("in A\nrack 0.25\nknit + f1 A\nknit + b1 A\nknit + f2 A\nknit - f2 A\nknit - f1 A\nout A\n");
  EXPECT_THAT(passed(run, 0), IsEmpty());
  EXPECT_THAT(passed(run, 1), IsEmpty());
  EXPECT_THAT(passed(run, 3), ElementsAre(1));
  // At -0.75, b2 stands between f1 and f2.
  const GraphRun left =
      graph_of("in A\nrack -0.75\nknit + f1 A\nknit + b2 A\nknit + f2 A\nknit - f2 A\nknit - f1 A\nout A\n");
  EXPECT_THAT(passed(left, 3), ElementsAre(1));
}

TEST(Floats, a_miss_takes_the_yarn_past_its_needle) {
  const GraphRun run = graph_of(cast_on + "knit - f5 A\nmiss - f4 A\nmiss - f3 A\nknit - f2 A\nout A\n");
  EXPECT_THAT(passed(run, 5), ElementsAre(3, 2));
  EXPECT_THAT(run.graph.yarns[0].floats[5].missed, ElementsAre(front(4), front(3)));
}

TEST(Floats, going_past_and_back_again_passes_nothing) {
  // Out over f4 and f5 and back: the yarn slips off again.
  const GraphRun run = graph_of(cast_on +
                                "in B\nknit + f3 B\nmiss + f4 B\nmiss + f5 B\nmiss - f5 B\nmiss - f4 B\n"
                                "knit - f2 B\nout A\nout B\n");
  EXPECT_THAT(passed(run, 0, 1), IsEmpty());
  EXPECT_EQ(run.graph.yarns[1].floats[0].missed.size(), 4u);
}

TEST(Floats, what_faces_the_ends_of_a_float_is_not_passed) {
  const GraphRun run =
      graph_of("in A\nin B\nknit + b1 B\nknit + b2 B\nknit + b3 B\nknit + f1 A\nknit + f3 A\nout A\nout B\n");
  ASSERT_EQ(run.graph.yarns[1].carrier, CarrierId(0));
  EXPECT_THAT(passed(run, 0, 1), ElementsAre(1));
}

TEST(Floats, begin_where_a_transfer_took_the_carrier) {
  // The loop on f5 goes to f3 with its carrier; from there to f1 only f2 is passed.
  const GraphRun run = graph_of(cast_on + "xfer f5 b5\nrack -2\nxfer b5 f3\nrack 0\nknit - f1 A\nout A\n");
  EXPECT_THAT(passed(run, 4), ElementsAre(1));
}

TEST(Floats, misses_before_the_first_loop_of_a_yarn_belong_to_no_float) {
  const GraphRun run =
      graph_of(cast_on + "in B\nmiss - f5 B\nmiss - f4 B\nknit - f3 B\nknit - f1 B\nout A\nout B\n");
  ASSERT_EQ(run.graph.yarns[1].floats.size(), 1u);
  EXPECT_THAT(run.graph.yarns[1].floats[0].missed, IsEmpty());
  EXPECT_THAT(passed(run, 0, 1), ElementsAre(1));
}

}  // namespace
}  // namespace loopwright
