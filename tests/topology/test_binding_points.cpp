// Binding points O and P and the four bonding points of a stitch, as the two papers use the words.
#include <gmock/gmock.h>

#include "topology/binding_points.hpp"
#include "topology/graph_of.hpp"

namespace loopwright {
namespace {

using testing::ElementsAre;

// Plain fabric: P of the loop below is O of the loop above, "P_(i-1)j = O_ij" (first paper, equations 1 and
// 2).
TEST(BindingPoints, in_plain_fabric_every_inner_point_is_one_p_and_one_o) {
  const GraphRun run =
      graph_of("in A\nknit + f1 A\nknit + f2 A\nknit - f2 A\nknit - f1 A\nknit + f1 A\nknit + f2 A\nout A\n");
  const BindingPoints points = binding_points(run.graph);
  // Two needles, three courses: four rows of points in each wale.
  EXPECT_EQ(points.points.size(), 8u);
  for (const Interlacing& i : run.graph.interlacings)
    EXPECT_EQ(points.upper[i.parent.position()], points.lower[i.child.position()]);
  for (std::size_t k = 0; k < run.graph.loops.size(); ++k) EXPECT_NE(points.lower[k], points.upper[k]);
  const BindingPoint& middle = points.points[static_cast<std::size_t>(points.lower[2])];
  EXPECT_THAT(numbers(middle.upper_of), ElementsAre(1));
  EXPECT_THAT(numbers(middle.lower_of), ElementsAre(2));
  EXPECT_DOUBLE_EQ(middle.slot, 2);
}

TEST(BindingPoints, stacks_bring_several_p_plating_several_o_to_a_point) {
  const GraphRun run = graph_of("in A\nin B\nknit + f1 A\ntuck - f1 B\nknit + f1 A B\nout A B\n");
  const BindingPoints points = binding_points(run.graph);
  const BindingPoint& site = points.points[static_cast<std::size_t>(points.lower[2])];
  EXPECT_THAT(numbers(site.upper_of), ElementsAre(0, 1));
  EXPECT_THAT(numbers(site.lower_of), ElementsAre(2, 3));
  EXPECT_EQ(points.points.size(), 5u);  // the site, O of the cast-on and of the tuck, P of the two held loops
}

TEST(BindingPoints, a_split_parent_carries_both_children) {
  const GraphRun run = graph_of("in A\nknit + f1 A\nsplit - f1 b1 A\nknit + b1 A\nout A\n");
  const BindingPoints points = binding_points(run.graph);
  EXPECT_EQ(points.upper[0], points.lower[1]);
  EXPECT_EQ(points.upper[0], points.lower[2]);
}

TEST(BindingPoints, a_split_loop_knitted_off_with_its_parent_has_its_feet_and_head_in_one_point) {
  const GraphRun run = graph_of("in A\nknit + f1 A\nsplit - f1 b1 A\nxfer b1 f1\nknit + f1 A\nout A\n");
  const BindingPoints points = binding_points(run.graph);
  EXPECT_EQ(points.lower[1], points.upper[1]);
}

TEST(BondingPoints, four_a_stitch_two_at_each_binding_point_with_their_beds) {
  const GraphRun run = graph_of("in A\nknit + f1 A\nknit - f1 A\nxfer f1 b1\nknit + b1 A\nout A\n");
  const BindingPoints points = binding_points(run.graph);
  const std::array<BondingPoint, 4>& stitch = points.bonding[1];
  EXPECT_EQ(stitch[0].place, BondingPlace::bottom_left);
  EXPECT_EQ(stitch[1].place, BondingPlace::top_left);
  EXPECT_EQ(stitch[2].place, BondingPlace::top_right);
  EXPECT_EQ(stitch[3].place, BondingPlace::bottom_right);
  for (int bottom : {0, 3}) {
    EXPECT_EQ(stitch[static_cast<std::size_t>(bottom)].binding_point, points.lower[1]);
    EXPECT_EQ(stitch[static_cast<std::size_t>(bottom)].bed, Bed::front);  // formed there
  }
  for (int top : {1, 2}) {
    EXPECT_EQ(stitch[static_cast<std::size_t>(top)].binding_point, points.upper[1]);
    EXPECT_EQ(stitch[static_cast<std::size_t>(top)].bed, Bed::back);  // knitted off there
  }
  // Loop 1 was formed to the left: its yarn comes from the right.
  const std::array<BondingPoint, 4> order = in_yarn_order(points, run.graph, LoopId(1));
  EXPECT_EQ(order[0].place, BondingPlace::bottom_right);
  EXPECT_EQ(order[3].place, BondingPlace::bottom_left);
  EXPECT_EQ(in_yarn_order(points, run.graph, LoopId(2))[0].place, BondingPlace::bottom_left);
}

}  // namespace
}  // namespace loopwright
