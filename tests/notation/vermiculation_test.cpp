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
            "in 3; knit + f0 3; miss + f1 3; in 5; miss + f1 5; knit - f1 5 3; miss - f0 5 3; out 3; out 5");
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
  EXPECT_THAT(errors_of("gt\n"), HasSubstr("2:2: error: transfers or drops and stitches in one pass"));
}

TEST(Vermiculation, SplitsAndDropsGoWhereTheBedsStand) {
  const std::string free = ";!vermiculation-1\n;;Edges: free\n";
  Diagnostics diagnostics("s.verm");
  EXPECT_EQ(listing(read_vermiculation(free + "ggg\nR1 .s. / ...\nR-1 S.. / ...\n", diagnostics)), "");
  EXPECT_THAT(said(diagnostics), HasSubstr("'S' belongs to the other bed"));
  Diagnostics good("s.verm");
  // rear needle B faces front needle B + 1; what would leave the piece is a stitch
  EXPECT_EQ(listing(read_vermiculation(free + "ggg\nR1 ss. / ...\nD-d\n", good)),
            "in A; knit + f0 A; knit + f1 A; knit + f2 A; rack 1; miss - b2 A; miss - f2 A; split - f1 b0 A; "
            "knit - f0 A; "
            "drop b0; "
            "drop f2; rack 0; out A");
  EXPECT_EQ(listing(read_vermiculation(free + "ee\nS.\n", good)),
            "in A; knit + b0 A; knit + b1 A; miss - b1 A; split - b0 f0 A; out A");
  // with one needle for each wale all of its loops are knitted on the bed that the letter names
  EXPECT_EQ(listing(read_vermiculation(free + "g\ns\ns\n", good)),
            "in A; knit + f0 A; split - f0 b0 A; xfer b0 f0; split + f0 b0 A; out A");
  EXPECT_EQ(said(good), "");
}

TEST(Vermiculation, ANotationThatIsKnittedOnceIsDoneToItsEnd) {
  Diagnostics diagnostics("s.verm");
  const std::string lines = "gg\n.t\ndD\n";
  EXPECT_EQ(listing(read_vermiculation(";!vermiculation-1\n;;Edges: free\n" + lines, diagnostics)),
            "in A; knit + f0 A; knit + f1 A; xfer f1 b1; drop f0; drop b1; out A");
  EXPECT_EQ(
      listing(read_vermiculation(";!vermiculation-1\n;;Edges: free\n;;Size: 2 x 1\n" + lines, diagnostics)),
      "in A; knit + f0 A; knit + f1 A; out A");
}

TEST(Vermiculation, ErrorsOfTheGrammar) {
  EXPECT_THAT(errors_of("g\xc3\xa9g\n"), HasSubstr("2:2: error: unknown letter '\\xc3\\xa9'"));
  EXPECT_THAT(errors_of("e/g\n"), HasSubstr("2:1: error: 'e' belongs to the other bed; left of '/'"));
  EXPECT_THAT(errors_of("g/v\n"), HasSubstr("2:3: error: 'v' belongs to the other bed; right of '/'"));
  EXPECT_THAT(errors_of("S/e\n"), HasSubstr("2:1: error: 'S' belongs to the other bed; left of '/'"));
  EXPECT_THAT(errors_of("./d\n"), HasSubstr("2:3: error: 'd' belongs to the other bed; right of '/'"));
  EXPECT_THAT(errors_of("gD\n"), HasSubstr("2:2: error: transfers or drops and stitches in one pass"));
  EXPECT_THAT(errors_of("g\ng/e\ns/.\n"),
              HasSubstr("4:1: error: a split needs needles that face each other"));
  EXPECT_THAT(errors_of("g\nR-0.5 s/.\ng/e\n"), "");
  EXPECT_THAT(errors_of("g\nD\n"), HasSubstr("3:1: warning: there is never a loop to move here"));
  EXPECT_THAT(errors_of("g\nd\n"), "");
  EXPECT_THAT(errors_of("knit + f1 A\n"),
              HasSubstr("2:1: error: 'knit' is knitout; a fabric file has a letter"));
  EXPECT_THAT(errors_of("g>\n"),
              "wrong.verm:2:2: error: '>' stands before the letters of a pass, not after them\n");
  EXPECT_THAT(errors_of("gV\n"),
              HasSubstr("2:2: error: unknown letter 'V'; letters of stitches and tucks are small: 'v'"));
  EXPECT_THAT(errors_of("g2\n"),
              HasSubstr("2:2: error: unknown letter '2'; repeat a letter or a group by '*n'"));
  EXPECT_THAT(errors_of("g_\n"), HasSubstr("2:2: error: unknown letter '_'; a missed needle is '.'"));
  EXPECT_THAT(errors_of("g # x\n"), "wrong.verm:2:3: error: unknown letter '#'; a comment starts with ';'\n");
  EXPECT_THAT(errors_of("[ge]*2\n"), HasSubstr("2:2: error: '[' stands on a line of its own"));
  EXPECT_THAT(errors_of(";;Size 3 x 3\ng\n"), HasSubstr("2:7: warning: there is no ':' after 'Size'"));
  EXPECT_THAT(errors_of(";;gage: 12\ng\n"),
              HasSubstr("2:3: warning: unknown header 'gage' has no effect; write 'Gauge'"));
  EXPECT_THAT(errors_of(";;mine: 12\ng\n"), HasSubstr("own headers start with 'X-'"));
  EXPECT_THAT(errors_of("g/\n"), HasSubstr("2:1: error: a pass on both beds names needles on both sides"));
  EXPECT_THAT(errors_of("g/e/g\n"), HasSubstr("2:4: error: a pass has two rows"));
  EXPECT_THAT(errors_of("g &\n"), HasSubstr("2:4: error: a pass of zero wales"));
  EXPECT_THAT(errors_of("(ge\n"), HasSubstr("2:1: error: this '(' is never closed"));
  EXPECT_THAT(errors_of("ge)\n"), HasSubstr("2:3: error: unknown letter ')'"));
  EXPECT_THAT(errors_of("g*0\n"), HasSubstr("2:3: error: repeated zero times"));
  EXPECT_THAT(errors_of("g*\n"), HasSubstr("2:3: error: expected how many times"));
  EXPECT_THAT(errors_of("g*99999999999\n"), HasSubstr("2:3: error: at most 10000 repeats"));
  EXPECT_THAT(errors_of("(g*1000)*1000\n"), HasSubstr("2:9: error: this makes more than 10000 wales"));
  EXPECT_THAT(errors_of("g R g\n"), HasSubstr("2:4: error: expected a number of needles after 'R'"));
  EXPECT_THAT(errors_of("r9 g\n"), HasSubstr("2:2: error: racking is counted in needles, from -8 to 8"));
  EXPECT_THAT(errors_of("R0.3 g\n"), HasSubstr("2:2: error: racking is counted in needles"));
  EXPECT_THAT(errors_of("g / e R1 e\n"), HasSubstr("2:7: error: racking among the rear needles"));
  EXPECT_THAT(errors_of("g\nR0.5 t\n"), HasSubstr("3:6: error: transfers need needles that face each other"));
  EXPECT_THAT(errors_of("B: g\n"), HasSubstr("2:1: error: no yarn is called 'B'"));
  EXPECT_THAT(errors_of("A+A: g\n"), HasSubstr("2:3: error: yarn 'A' is named twice"));
  EXPECT_THAT(errors_of("A+: g\n"), HasSubstr("2:3: error: expected the name of a yarn"));
  EXPECT_THAT(errors_of("A: t\n"), HasSubstr("2:1: error: a pass of transfers or drops carries no yarn"));
  EXPECT_THAT(errors_of("[\ng\n"), HasSubstr("2:1: error: this '[' is never closed"));
  EXPECT_THAT(errors_of("g\n]*2\n"), HasSubstr("3:1: error: this ']' has no '['"));
  EXPECT_THAT(errors_of("[\ng\n] 2\n"), HasSubstr("4:3: error: expected how many times"));
  EXPECT_THAT(errors_of(";;Gating: opposite\ng/e\n"),
              HasSubstr("3:3: error: needle b-3 faces f-3 and both take yarn"));
  EXPECT_THAT(errors_of("; nothing\n"), HasSubstr("error: there is no course"));
  EXPECT_THAT(errors_of("t\n"), HasSubstr("error: there is no course"));
  EXPECT_THAT(errors_of("g*9973\ng*9967\n"), HasSubstr("3:1: error: the widths of the passes up to here"));
  Diagnostics diagnostics("x.verm");
  read_vermiculation("ge\n", diagnostics);
  EXPECT_THAT(said(diagnostics),
              HasSubstr("x.verm:1:1: error: the first line is not ';!vermiculation-1' but 'ge'"));
}

TEST(Vermiculation, ErrorsOfHeaders) {
  EXPECT_THAT(errors_of(";;Edges: hemmed\ng\n"),
              HasSubstr("2:10: error: edges are held, bound-off, free or periodic"));
  EXPECT_THAT(errors_of(";;Size: 0 x 3\ng\n"), HasSubstr("2:9: error: a size is at least 1, not '0'"));
  EXPECT_THAT(errors_of(";;Size: -4 x 3\ng\n"), HasSubstr("2:9: error: a size is at least 1, not '-4'"));
  EXPECT_THAT(errors_of(";;Size: 4\ng\n"), HasSubstr("2:10: error: expected 'x'"));
  EXPECT_THAT(errors_of(";;Size: 4 wales x 5 wales\ng\n"),
              HasSubstr("2:9: error: a size names wales and courses once"));
  EXPECT_THAT(errors_of(";;Size: 4 x 5 cm\ng\n"), HasSubstr("2:15: error: expected the end of the size"));
  EXPECT_THAT(errors_of(";;Set: 1.5\ng\n"), HasSubstr("2:8: error: Set is a share from 0"));
  EXPECT_THAT(errors_of(";;Loop-Length: inf mm\ng\n"), HasSubstr("2:16: error: expected a number"));
  EXPECT_THAT(errors_of(";;Loop-Length: 1e400 mm\ng\n"), HasSubstr("2:16: error: expected a number"));
  EXPECT_THAT(errors_of(";;Loop-Length: 6 furlong\ng\n"),
              HasSubstr("2:16: error: unknown unit 'furlong'; write mm"));
  EXPECT_THAT(errors_of(";;Gauge: 0\ng\n"), HasSubstr("2:10: error: Gauge must be greater than 0"));
  EXPECT_THAT(errors_of(";;Loop-Length:\ng\n"), HasSubstr("2:15: error: header 'Loop-Length' has no value"));
  EXPECT_THAT(errors_of(";;Yarn-A: wool 2/28 Nm diameter=0 mm\ng\n"),
              HasSubstr("2:33: error: diameter must be greater"));
  EXPECT_THAT(errors_of(";;Yarn-A: wool fluff=3\ng\n"), HasSubstr("2:16: error: unknown yarn key 'fluff'"));
  EXPECT_THAT(errors_of(";;Yarn-A: wool colour=red\ng\n"), HasSubstr("2:23: error: expected a colour"));
  EXPECT_THAT(errors_of(";;Yarn-A: wool\n;;Yarn-B: wool\n;;Carriers: 3\ng\n"),
              HasSubstr("4:13: error: there are 2 yarns"));
  EXPECT_THAT(errors_of(";;Gaugw: 7\ng\n"), HasSubstr("2:3: warning: unknown header 'Gaugw'"));
  EXPECT_THAT(errors_of("g\n;;Gauge: 7\n"), HasSubstr("3:3: warning: header 'Gauge' after the first course"));
  EXPECT_THAT(errors_of(";;Yarn-A: wool\n;;Yarn-B: wool\ng\n"),
              HasSubstr("3:8: warning: yarn B is never knitted"));
}

TEST(Vermiculation, HeadersFillTheSettings) {
  Diagnostics diagnostics("all.verm");
  const Program program = read_vermiculation(
      ";!vermiculation-1\n;;Name: everything ; but this\n;;Gauge: E12\n;;Bed-Gap: 0.4 cm\n;;Loop-Length: 6.2 "
      "mm\n"
      ";;Tuck-Length: 4 mm\n;;Float-Slack: 5 %\n;;Bed-Change: 1.5 mm\n;;Set: 0.25\n;;Size: 4 courses x 6 "
      "wales\n"
      ";;Edges: bound-off\n;;X-Own: anything\ng\n",
      diagnostics);
  EXPECT_EQ(said(diagnostics), "");
  const FabricSettings& settings = program.settings;
  EXPECT_EQ(settings.name, "everything");
  EXPECT_EQ(settings.gauge_npi, 12);
  EXPECT_EQ(settings.bed_gap_mm, 4);
  EXPECT_EQ(settings.loop_length_mm, 6.2);
  EXPECT_EQ(settings.tuck_length_mm, 4);
  EXPECT_DOUBLE_EQ(settings.float_slack.value(), 0.05);
  EXPECT_EQ(settings.bed_change_mm, 1.5);
  EXPECT_EQ(settings.set, 0.25);
  EXPECT_EQ(settings.size_wales, 6);
  EXPECT_EQ(settings.size_courses, 4);
  EXPECT_EQ(settings.edges, Edges::bound_off);
}

TEST(Vermiculation, RackingInsideACourseHappensWhereTheCarriageIs) {
  EXPECT_EQ(listing(free_piece("g. R1 .g\n", "4 x 2")),
            "in A; knit + f0 A; miss + f1 A; rack 1; miss + f2 A; knit + f3 A; "
            "rack 0; knit - f3 A; miss - f2 A; rack 1; miss - f1 A; knit - f0 A; rack 0; out A");
}

TEST(Vermiculation, RackingThatStandsAloneHoldsToTheEndOfTheRepeat) {
  const auto racks = [](const std::string& body) {
    std::string values;
    for (const Instruction& each : free_piece(body, "1 x 4").instructions) {
      if (each.op == Op::rack)
        values += std::to_string(static_cast<int>(each.value)) + " at " + std::to_string(each.at.line) + "; ";
    }
    return values;
  };
  // the head of free_piece takes three lines
  EXPECT_EQ(racks("g\nR2\ng\n"), "2 at 5; 0 at 4; 2 at 5; 0 at 6; ");
  EXPECT_EQ(racks("R2 g\ng\n"), "2 at 4; 0 at 5; 2 at 4; 0 at 5; ");
}

TEST(Vermiculation, TheSlotOrderFollowsTheRacking) {
  // at racking 1.5 rear needle 0 lies between front needles 1 and 2
  EXPECT_EQ(listing(free_piece("R1 g/e\n", "3 x 1")),
            "in A; rack 1.5; knit + f0 A; knit + f1 A; knit + b0 A; knit + f2 A; knit + b1 A; knit + b2 A; "
            "rack 0; out A");
}

TEST(Vermiculation, EachFeederTurnsByItself) {
  EXPECT_EQ(listing(free_piece("A: g\nB: g\nA: g\n", "1 x 4", ";;Yarn-A:\n;;Yarn-B:\n")),
            "in A; knit + f0 A; in B; knit + f0 B; knit - f0 A; knit + f0 A; out A; out B");
}

TEST(Vermiculation, GroupsAndBracketsAreWrittenOut) {
  EXPECT_EQ(listing(free_piece("((g)*2 e)*2\n")), listing(free_piece("ggegge\n")));
  EXPECT_EQ(listing(free_piece("[\ng\n[\ne\n]*2\n]*2\n")), listing(free_piece("g\ne\ne\ng\ne\ne\n")));
}

TEST(Vermiculation, MissedAndInactiveNeedles) {
  EXPECT_EQ(listing(free_piece("g.-g\n")), "in A; knit + f0 A; miss + f1 A; knit + f3 A; out A");
  // a missed wale is passed on the bed that holds its loops
  EXPECT_THAT(listing(free_piece("ge\ng.\n")), HasSubstr("miss - b1 A; knit - f0 A"));
}

TEST(Vermiculation, TransfersThatNeverDoAnythingAreTold) {
  EXPECT_THAT(errors_of("gg\n.T\n"), HasSubstr("3:2: warning: there is never a loop to move here"));
  EXPECT_EQ(errors_of("gg\n.t\n"), "");
}

TEST(Vermiculation, BoundOffEndsWithOneLoop) {
  const Program program = [] {
    Diagnostics diagnostics("bound_off.verm");
    return read_vermiculation(";!vermiculation-1\n;;Edges: bound-off\n;;Size: 3 x 1\nge\n", diagnostics);
  }();
  EXPECT_EQ(listing(program),
            "in A; knit + f0 A; knit + b1 A; knit + f2 A; xfer b1 f1; "
            "xfer f2 b2; rack -1; xfer b2 f1; rack 0; knit - f1 A; "
            "xfer f1 b1; rack -1; xfer b1 f0; rack 0; knit - f0 A; out A");
}

TEST(Vermiculation, PeriodicWantsWholeRepeatsThatClose) {
  Diagnostics diagnostics("p.verm");
  FabricOptions options;
  options.edges = Edges::periodic;
  const Program program =
      read_vermiculation(";!vermiculation-1\n;;Size: 3 x 3\nge\neg\n", diagnostics, options);
  EXPECT_THAT(
      said(diagnostics),
      HasSubstr("warning: a periodic cell is made of whole repeats; the size becomes 4 wales x 4 courses"));
  EXPECT_EQ(program.window.needles, 4);
  EXPECT_EQ(program.settings.edges, Edges::periodic);
  Diagnostics open("open.verm");
  read_vermiculation(";!vermiculation-1\ng/.\n./n\n", open, options);
  EXPECT_THAT(
      said(open),
      HasSubstr("does not close to a periodic cell: needle b0 holds 2 loops where the repeat starts and 3"));
}

TEST(Vermiculation, WindowOfAPieceThatIsNoMultipleOfItsRepeat) {
  Diagnostics diagnostics("w.verm");
  const Program program = read_vermiculation(";!vermiculation-1\n;;Size: 5 x 3\ng\ne\n", diagnostics);
  ASSERT_TRUE(diagnostics.ok());
  int knits = 0;
  for (int i = 0; i < program.window.instructions; ++i) {
    const Instruction& each =
        program.instructions[static_cast<std::size_t>(program.window.first_instruction + i)];
    if (each.op == Op::knit && each.needle.index >= 0 && each.needle.index < program.window.needles) ++knits;
  }
  EXPECT_EQ(knits, 15);
}

TEST(Vermiculation, TooLargeAPieceIsAnError) {
  Diagnostics diagnostics("large.verm");
  FabricOptions options;
  options.most_instructions = 1000;
  const Program program =
      read_vermiculation(";!vermiculation-1\n;;Size: 100 x 100\ng\n", diagnostics, options);
  EXPECT_THAT(said(diagnostics), HasSubstr("the piece takes more than 1000 instructions"));
  EXPECT_TRUE(program.instructions.empty());
  // letters that do nothing are limited too: 10,000 lines of transfers where nothing is held
  Diagnostics idle("idle.verm");
  read_vermiculation(";!vermiculation-1\n;;Size: 1000 x 1000\ng-*99\n[\n-*99 t\n]*10000\n", idle, options);
  EXPECT_THAT(said(idle), HasSubstr("or as many idle letters"));
}

// knitout wants a set that comes in used whole and alone first.
TEST(Vermiculation, AYarnThatJoinsAnotherGoesToWhereThePassStarts) {
  Diagnostics diagnostics("x.verm");
  const Program program = read_vermiculation(
      ";!vermiculation-1\n;;Yarn-A: wool 2/28 Nm\n;;Yarn-B: wool 2/28 Nm\n;;Edges: free\nA: gg\nA+B: gg\n",
      diagnostics);
  EXPECT_EQ(said(diagnostics), "");
  EXPECT_EQ(listing(program),
            "in A; knit + f0 A; knit + f1 A; in B; miss + f1 B; knit - f1 A B; knit - f0 A B; out A; out B");
}

}  // namespace
}  // namespace loopwright
