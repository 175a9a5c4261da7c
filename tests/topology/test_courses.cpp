// Courses of small programmes, counted by hand.
#include <gmock/gmock.h>

#include "topology/courses.hpp"
#include "topology/graph_of.hpp"

namespace loopwright {
namespace {

using testing::ElementsAre;

TEST(Courses, plain_knitting_counts_its_rows) {
  const GraphRun run =
      graph_of("in A\nknit + f1 A\nknit + f2 A\nknit - f2 A\nknit - f1 A\nknit + f1 A\nknit + f2 A\nout A\n");
  EXPECT_THAT(course_numbers(run.graph), ElementsAre(0, 0, 1, 1, 2, 2));
}

TEST(Courses, two_passes_on_alternate_needles_are_one_course) {
  // as interlock is knitted: a pass on f1 and b2, one on f2 and b1
  const GraphRun run = graph_of(
      "in A\nknit + f1 A\nknit + b2 A\nknit - f2 A\nknit - b1 A\n"
      "knit + f1 A\nknit + b2 A\nknit - f2 A\nknit - b1 A\nout A\n");
  EXPECT_THAT(course_numbers(run.graph), ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
}

TEST(Courses, a_pass_of_tucks_counts_with_the_pass_before_it) {
  const GraphRun run = graph_of(
      "in A\nknit + f1 A\nknit + f2 A\nknit - f2 A\nknit - f1 A\ntuck + f1 A\ntuck + f2 A\n"
      "knit - f2 A\nknit - f1 A\nout A\n");
  // loops drawn through the tucks follow the course of what they are drawn through
  EXPECT_THAT(course_numbers(run.graph), ElementsAre(0, 0, 1, 1, 1, 1, 2, 2));
}

TEST(Courses, short_rows_are_courses_of_their_own) {
  const GraphRun run =
      graph_of("in A\nknit + f1 A\nknit + f2 A\nknit - f2 A\nknit + f2 A\nknit - f2 A\nknit - f1 A\nout A\n");
  EXPECT_THAT(course_numbers(run.graph), ElementsAre(0, 0, 1, 2, 3, 3));
}

}  // namespace
}  // namespace loopwright
