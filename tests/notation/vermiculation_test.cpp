#include <gmock/gmock.h>

#include "notation_test.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

// The body below a magic line and a free edge, so that exactly the piece is knitted.
Program free_piece(const std::string& body, const std::string& size = "", const std::string& more = "") {
  Diagnostics diagnostics("free.verm");
  const std::string text =
      ";!vermiculation-1\n;;Edges: free\n" + (size.empty() ? "" : ";;Size: " + size + "\n") + more + body;
  Program program = read_vermiculation(text, diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << said(diagnostics) << text;
  return program;
}

std::string errors_of(const std::string& body) {
  Diagnostics diagnostics("wrong.verm");
  read_vermiculation(";!vermiculation-1\n" + body, diagnostics);
  return said(diagnostics);
}

TEST(Vermiculation, PlainAlternatesDirections) {
  EXPECT_EQ(listing(free_piece("g\n", "3 wales x 2 courses")),
            "in A; knit + f0 A; knit + f1 A; knit + f2 A; knit - f2 A; knit - f1 A; knit - f0 A; out A");
}

TEST(Vermiculation, RibTakesItsNeedlesInTurnFromBothBeds) {
  EXPECT_EQ(listing(free_piece("ge\n", "4 x 1")),
            "in A; knit + f0 A; knit + b1 A; knit + f2 A; knit + b3 A; out A");
}

TEST(Vermiculation, GarterBringsTheLoopsToTheBedThatKnitsNext) {
  EXPECT_EQ(listing(free_piece("g\ne\n", "2 x 3")),
            "in A; knit + f0 A; knit + f1 A; xfer f0 b0; xfer f1 b1; knit - b1 A; knit - b0 A; "
            "xfer b0 f0; xfer b1 f1; knit + f0 A; knit + f1 A; out A");
}

TEST(Vermiculation, FacingNeedlesWorkAtHalfPitch) {
  EXPECT_EQ(listing(free_piece("g/e\ng/n\n", "2 x 2")),
            "in A; rack 0.5; knit + f0 A; knit + b0 A; knit + f1 A; knit + b1 A; "
            "tuck - b1 A; knit - f1 A; tuck - b0 A; knit - f0 A; rack 0; out A");
}

TEST(Vermiculation, InterlockStaysOpposite) {
  EXPECT_EQ(listing(free_piece("g./.e\n.g/e.\n", "2 x 2")),
            "in A; knit + f0 A; knit + b1 A; knit - f1 A; knit - b0 A; out A");
}

TEST(Vermiculation, RackingIsAbsoluteAndRkIsKnitoutsPlusK) {
  EXPECT_EQ(
      listing(free_piece("gggg\n.t..\nR1 .T..\ngggg\n", "4 x 2")),
      "in A; knit + f0 A; knit + f1 A; knit + f2 A; knit + f3 A; xfer f1 b1; rack 1; xfer b1 f2; rack 0; "
      "knit - f3 A; knit - f2 A; knit - f1 A; knit - f0 A; out A");
  // Rk and r-k are the same
  EXPECT_EQ(listing(free_piece("gggg\n.t..\nr-1 .T..\ngggg\n", "4 x 2")),
            listing(free_piece("gggg\n.t..\nR1 .T..\ngggg\n", "4 x 2")));
}

TEST(Vermiculation, FeedersDirectionsAndPlating) {
  EXPECT_EQ(listing(free_piece("A> g.\nB+A< .g\n", "2 x 2", ";;Yarn-A:\n;;Yarn-B:\n;;Carriers: 3 5\n")),
            "in 3; knit + f0 3; miss + f1 3; in 5; knit - f1 5 3; miss - f0 5 3; out 3; out 5");
}

TEST(Vermiculation, HeldEdgesHaveAMarginOfWholeRepeats) {
  Diagnostics diagnostics("held.verm");
  const Program program = read_vermiculation(
      ";!vermiculation-1\n;;Size: 4 wales x 6 courses\n;;Edges: held\nge\neg\n", diagnostics);
  ASSERT_TRUE(diagnostics.ok()) << said(diagnostics);
  EXPECT_EQ(program.window.first_needle, 0);
  EXPECT_EQ(program.window.needles, 4);
  EXPECT_EQ(program.settings.repeat_wales, 2);
  EXPECT_EQ(program.settings.repeat_courses, 2);
  // 6 courses and 4 above and below: 7 repeats of 2 courses; the window starts and ends with a repeat
  ASSERT_EQ(program.repeat_starts.size(), 8u);
  EXPECT_EQ(program.window.first_instruction, program.repeat_starts[2]);
  EXPECT_EQ(program.window.first_instruction + program.window.instructions, program.repeat_starts[5]);
  int left = 0, right = 0, wanted = 0;
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    const Instruction& each = program.instructions[i];
    if (each.op != Op::knit) continue;
    left = std::min(left, each.needle.index);
    right = std::max(right, each.needle.index);
    const int place = static_cast<int>(i) - program.window.first_instruction;
    if (place >= 0 && place < program.window.instructions && each.needle.index >= 0 && each.needle.index < 4)
      ++wanted;
  }
  EXPECT_EQ(left, -4);
  EXPECT_EQ(right, 7);
  EXPECT_EQ(wanted, 24);
}

TEST(Vermiculation, ErrorsPointAtTheCharacter) {
  EXPECT_THAT(errors_of("gkg\n"),
              HasSubstr("wrong.verm:2:2: error: unknown letter 'k'; a stitch on the front bed is 'g'"));
  EXPECT_THAT(errors_of("g()g\n"), HasSubstr("2:2: error: an empty group has zero wales"));
  EXPECT_THAT(errors_of(";;Size: 1000000000 wales x 3 courses\ng\n"),
              HasSubstr("2:9: error: a size is at most 10000"));
  EXPECT_THAT(errors_of(";;Loop-Length: -6 mm\ng\n"),
              HasSubstr("2:16: error: Loop-Length must be greater than 0"));
  EXPECT_THAT(errors_of(";;Loop-Length: nan mm\ng\n"),
              HasSubstr("2:16: error: expected a number with a unit"));
  EXPECT_THAT(errors_of(";;Loop-Length: 6\ng\n"), HasSubstr("2:16: error: the unit is missing after '6'"));
  EXPECT_THAT(errors_of(";;Yarn-A: unobtainium\ng\n"),
              HasSubstr("2:11: error: unknown material 'unobtainium'; known are "));
  EXPECT_THAT(errors_of("gt\n"), HasSubstr("2:2: error: transfers and stitches in one pass"));
}

}  // namespace
}  // namespace loopwright
