#include "notation/needle_diagram.hpp"

#include <gmock/gmock.h>

#include "notation/write_vermiculation.hpp"
#include "notation_test.hpp"
#include "random_notation.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

Vermiculation parsed(const std::string& text) {
  Diagnostics diagnostics("diagram.verm");
  Vermiculation notation = parse_vermiculation(text, diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << said(diagnostics) << text;
  return notation;
}
Vermiculation body(const std::string& lines) { return parsed(";!vermiculation-1\n" + lines); }

// A pass in words: front row, rear row and what stands beside; e.g. "g.g / .e. >" with "?" for unused.
std::string in_words(const DiagramPass& pass) {
  const auto row = [](const std::vector<DiagramNeedle>& needles, const char* letters) {
    std::string text;
    for (const DiagramNeedle& needle : needles) text += letters[static_cast<int>(needle.operation)];
    return text;
  };
  std::string text = row(pass.front, "?-.gvtsd") + " / " + row(pass.rear, "?-.enTsd");
  if (pass.implied) text += " implied";
  if (pass.carries_yarn) text += pass.direction == Direction::right ? " >" : " <";
  return text;
}
std::vector<std::string> in_words(const NeedleDiagram& diagram) {
  std::vector<std::string> passes;
  for (const DiagramPass& pass : diagram.passes) passes.push_back(in_words(pass));
  return passes;
}

TEST(NeedleDiagram, RibTakesFrontAndRearNeedlesByTurns) {
  // figure 4 of the paper: 1 and 1 rib
  const NeedleDiagram diagram = needle_diagram(body("ge\n"));
  EXPECT_THAT(in_words(diagram), testing::ElementsAre("g?g?g? / ?e?e?e >"));
  EXPECT_EQ(diagram.gating, 0);
  EXPECT_TRUE(diagram.rear_bed);
  EXPECT_FALSE(needle_diagram(body("g\n")).rear_bed);
}

TEST(NeedleDiagram, DerbyRibHasCrossesForInactiveNeedles) {
  // figure 5
  const NeedleDiagram diagram = needle_diagram(body("gggggg-- / -----eee\n"));
  EXPECT_THAT(in_words(diagram), testing::ElementsAre("gggggg-- / -----eee >"));
  EXPECT_EQ(diagram.gating, 0.5);
  EXPECT_EQ(diagram.passes[0].rear[5].slot, 5.5);
}

TEST(NeedleDiagram, FullCardiganTakesTwoLinesOfGraph) {
  // figure 6
  EXPECT_THAT(in_words(needle_diagram(body("g/n\nv/e\n"))),
              testing::ElementsAre("gggggg / nnnnnn >", "vvvvvv / eeeeee <"));
}

TEST(NeedleDiagram, TransfersThatAreLeftUnsaidAreShown) {
  EXPECT_THAT(in_words(needle_diagram(body("g\ne\n"))),
              testing::ElementsAre("?????? / TTTTTT implied", "gggggg / ?????? >", "tttttt / ?????? implied",
                                   "?????? / eeeeee <"));
  // a piece that the notation writes whole starts on empty needles
  EXPECT_THAT(in_words(needle_diagram(body(";;Edges: free\ng\n"))),
              testing::ElementsAre("gggggg / ?????? >"));
}

TEST(NeedleDiagram, RackingMovesTheRearNeedles) {
  const NeedleDiagram lace = needle_diagram(body("gggggg\n.t....\nR1 .T....\n"));
  ASSERT_EQ(lace.passes.size(), 3u);
  EXPECT_EQ(lace.passes[1].rear[1].slot, 1);
  EXPECT_EQ(lace.passes[2].rear[1].slot, 2);
  EXPECT_EQ(lace.passes[2].racking, 1);
  // inside a course, in either direction
  const NeedleDiagram racked = needle_diagram(body("R1 gg R2 gg / ee\nR1 gg R2 gg / ee\n"));
  ASSERT_EQ(racked.passes.size(), 2u);
  EXPECT_EQ(racked.passes[0].rear[1].slot, 1 + 1.5);
  EXPECT_EQ(racked.passes[0].rear[2].slot, 2 + 2.5);
  EXPECT_EQ(racked.passes[1].rear[7].slot, 7 + 1.5);
  EXPECT_EQ(racked.passes[1].rear[1].slot, 1 + 2.5);
}

TEST(NeedleDiagram, SizeIsWhatIsAskedFor) {
  DiagramOptions options;
  options.wales = 5;
  options.courses = 3;
  const NeedleDiagram diagram = needle_diagram(body("ge\neg\n"), options);
  EXPECT_EQ(diagram.wales, 5);
  EXPECT_EQ(diagram.courses, 3);
  EXPECT_EQ(in_words(diagram.passes.back()), "g?g?g / ?e?e? >");
  options.courses = 10'000;
  options.wales = 10'000;
  EXPECT_THROW(needle_diagram(body("g\n"), options), std::invalid_argument);
}

TEST(NeedleDiagram, OfAProgrammeAgreesWithThatOfItsNotation) {
  // what the compiler makes of a notation, drawn from its instructions alone
  for (const std::string& lines :
       {std::string("g/e\nv/n\ng\n"), std::string("ge\neg\n"), std::string("g. / .e\n.g / e.\n"),
        std::string("R1 g/n\nR0 v/e\n"), std::string("gggggg\n.t....\nR1 .T....\ngggggg\n")}) {
    const Vermiculation notation = body(";;Edges: free\n;;Size: 6 x 4\n" + lines);
    Diagnostics diagnostics("p.verm");
    const Program program = compile_vermiculation(notation, {}, diagnostics);
    DiagramOptions options;
    options.wales = 6;
    options.courses = 4;
    const NeedleDiagram of_program = needle_diagram(program), of_notation = needle_diagram(notation, options);
    std::vector<std::string> expected;
    for (std::string words : in_words(of_notation)) {
      // whose transfers are implied, which needles are at rest: a programme does not say
      for (char& c : words) c = c == '-' || c == '.' ? '?' : c;
      expected.push_back(words.substr(0, words.find(" implied")));
    }
    std::vector<std::string> drawn;
    for (std::string words : in_words(of_program)) {
      for (char& c : words) c = c == '.' ? '?' : c;
      drawn.push_back(words);
    }
    // the first courses may differ: the diagram of a notation that repeats shows no cast-on
    ASSERT_GE(drawn.size(), 4u);
    const auto tail = [](const std::vector<std::string>& all) {
      return std::vector<std::string>(all.end() - 3, all.end());
    };
    EXPECT_EQ(tail(drawn), tail(expected)) << lines;
  }
}

TEST(NeedleDiagram, OfKnitout) {
  Diagnostics diagnostics("d.k");
  const Program program = read_knitout(
      ";!knitout-2\n;;Carriers: 1 2\nin 1\nknit + f1 1\ntuck + f2 1\nmiss + f3 1\nknit - f2 1\nknit - f1 1\n"
      "rack 1\nxfer f2 b1\ndrop f1\nrack 0.25\nknit + f1 1\nsplit + f2 b2 1\nout 1\n",
      diagnostics);
  ASSERT_TRUE(diagnostics.ok()) << said(diagnostics);
  std::size_t all = 0;
  EXPECT_THAT(in_words(needle_diagram(program, {}, &all)),
              testing::ElementsAre("gv. / ??? >", "gg? / ??? <", "dt? / ???", "gs? / ??? >"));
  EXPECT_EQ(all, 4u);
  DiagramOptions options;
  options.first_pass = 2;
  options.most_passes = 1;
  EXPECT_THAT(in_words(needle_diagram(program, options)), testing::ElementsAre("dt / ??"));
}

// --- changes

TEST(DiagramChanges, OneNeedleOfARepeat) {
  Vermiculation notation = body("g/e      ; rib\n. / n*4\n");
  EXPECT_EQ(change_operation(notation, {0, 0, Bed::back, 2}, NeedleOperation::tuck), "");
  EXPECT_EQ(write_vermiculation(notation), ";!vermiculation-1\ngggg / eene ; rib\n. / n*4\n");
  EXPECT_EQ(remove_operation(notation, {0, 0, Bed::front, 0}), "");
  EXPECT_EQ(add_operation(notation, {1, 0, Bed::front, 3}, NeedleOperation::stitch), "");
  EXPECT_EQ(write_vermiculation(notation), ";!vermiculation-1\n.ggg / eene ; rib\n...g / nnnn\n");
  EXPECT_THAT(add_operation(notation, {1, 0, Bed::front, 3}, NeedleOperation::tuck),
              HasSubstr("works already"));
  EXPECT_THAT(remove_operation(notation, {1, 0, Bed::front, 2}), HasSubstr("does nothing"));
  EXPECT_THAT(change_operation(notation, {1, 0, Bed::front, 4}, NeedleOperation::tuck),
              HasSubstr("needles 0 to 3"));
  EXPECT_THAT(change_operation(notation, {2, 0, Bed::front, 0}, NeedleOperation::tuck),
              HasSubstr("there is no line 3"));
}

TEST(DiagramChanges, OnOneNeedleForEachWaleTheOtherBedTakesOver) {
  Vermiculation notation = body("gg\n");
  EXPECT_EQ(change_operation(notation, {0, 0, Bed::back, 1}, NeedleOperation::stitch), "");
  EXPECT_EQ(write_vermiculation(notation), ";!vermiculation-1\nge\n");
  EXPECT_EQ(change_operation(notation, {0, 0, Bed::front, 1}, NeedleOperation::missed), "");
  EXPECT_EQ(write_vermiculation(notation), ";!vermiculation-1\nge\n");
  EXPECT_EQ(write_on_both_beds(notation, 0, 0), "");
  EXPECT_EQ(change_operation(notation, {0, 0, Bed::front, 1}, NeedleOperation::tuck), "");
  EXPECT_EQ(write_vermiculation(notation), ";!vermiculation-1\ngv / .e\n");
}

TEST(DiagramChanges, SplitsAndDropsAreLetters) {
  Vermiculation notation = body("gg\n..\n");
  EXPECT_EQ(change_operation(notation, {0, 0, Bed::back, 1}, NeedleOperation::split), "");
  EXPECT_EQ(change_operation(notation, {0, 0, Bed::front, 0}, NeedleOperation::split), "");
  EXPECT_EQ(change_operation(notation, {1, 0, Bed::front, 0}, NeedleOperation::drop), "");
  EXPECT_EQ(change_operation(notation, {1, 0, Bed::back, 1}, NeedleOperation::drop), "");
  EXPECT_EQ(write_vermiculation(notation), ";!vermiculation-1\nsS\ndD\n");
  const NeedleDiagram diagram = needle_diagram(notation);
  // in the repeat: after a split both needles hold loops, and those on the wrong bed come over first
  EXPECT_EQ(diagram.passes.back().front[0].operation, NeedleOperation::drop);
  EXPECT_EQ(diagram.passes.back().rear[1].operation, NeedleOperation::drop);
}

TEST(DiagramChanges, WhatTheNotationCannotSayIsRefused) {
  Vermiculation notation = body("gg\nt.\n");
  const std::string before = write_vermiculation(notation);
  EXPECT_THAT(change_operation(notation, {0, 0, Bed::front, 1}, NeedleOperation::transfer),
              HasSubstr("transfers or drops and stitches in one pass"));
  EXPECT_THAT(change_operation(notation, {1, 0, Bed::front, 1}, NeedleOperation::stitch),
              HasSubstr("transfers or drops and stitches in one pass"));
  EXPECT_THAT(change_operation(notation, {0, 0, Bed::front, 1}, NeedleOperation::drop),
              HasSubstr("transfers or drops and stitches in one pass"));
  EXPECT_THAT(change_operation(notation, {0, 0, Bed::front, 1}, NeedleOperation::unused),
              HasSubstr("no letter"));
  EXPECT_THAT(change_operation(notation, {0, 0, Bed::front_slider, 1}, NeedleOperation::tuck),
              HasSubstr("sliders"));
  EXPECT_THAT(change_racking(notation, 0, 0, 0.3), HasSubstr("in quarters"));
  EXPECT_THAT(change_feeder(notation, 0, 0, {1}, Direction::none), HasSubstr("no yarn 1"));
  EXPECT_THAT(change_feeder(notation, 0, 0, {0}, Direction::none), HasSubstr("add a header ';;Yarn-A:'"));
  EXPECT_THAT(change_feeder(notation, 1, 0, {}, Direction::left), HasSubstr("carries no yarn"));
  EXPECT_THAT(insert_line(notation, 0, {}), HasSubstr("zero wales"));
  EXPECT_EQ(write_vermiculation(notation), before);
}

TEST(DiagramChanges, RackingAndFeeders) {
  Vermiculation notation = body(";;Yarn-A:\n;;Yarn-B:\ng/e ; rib\n");
  EXPECT_EQ(change_racking(notation, 0, 0, -1), "");
  EXPECT_EQ(change_feeder(notation, 0, 0, {1, 0}, Direction::left), "");
  EXPECT_EQ(write_vermiculation(notation), ";!vermiculation-1\n;;Yarn-A:\n;;Yarn-B:\nB+A< R-1 g / e ; rib\n");
  EXPECT_EQ(change_racking(notation, 0, 0, {}), "");
  EXPECT_EQ(change_feeder(notation, 0, 0, {}, Direction::none), "");
  EXPECT_EQ(write_vermiculation(notation),
            ";!vermiculation-1\n;;Yarn-A:\n;;Yarn-B:\ng/e ; rib\n");  // as it stood
}

TEST(DiagramChanges, LinesArePutInAndTakenOut) {
  const std::string text = "; ground\n[  ; six times\ng ; plain\n; then\ne\n]*6\ngv\n";
  Vermiculation notation = body(text);
  const CourseLine course = body("vg\n").lines.front();
  EXPECT_EQ(insert_line(notation, 0, course), "");
  EXPECT_EQ(remove_line(notation, 13), "");
  EXPECT_EQ(insert_line(notation, 100, course), "");
  EXPECT_EQ(write_vermiculation(notation),
            ";!vermiculation-1\n; ground\nvg\n[  ; six times\ng ; plain\n; then\ne\n]*6\nvg\n");
  EXPECT_EQ(remove_line(notation, 6), "");
  EXPECT_EQ(
      write_vermiculation(notation),
      ";!vermiculation-1\n; ground\nvg\n[\ng ; plain\n; then\ne\n]*2\ng ; plain\n[\ng ; plain\ne\n]*3\nvg\n");
  EXPECT_THAT(remove_line(notation, 100), HasSubstr("no line 101"));
}

// Whatever is changed, the text reads back as the same notation and so as the same diagram.
TEST(DiagramChanges, RandomChangesAreReadBack) {
  int done = 0, refused = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomNotation random(seed);
    Vermiculation notation = parsed(random.text());
    for (int changes = 0; changes < 8 && !notation.lines.empty(); ++changes) {
      const std::size_t line = random.below(notation.lines.size());
      const std::size_t pass = random.below(notation.lines[line].passes.size());
      const Bed bed = random.below(2) == 0 ? Bed::front : Bed::back;
      const NeedlePlace place{line, pass, bed, static_cast<int>(random.below(12))};
      const auto operation = static_cast<NeedleOperation>(random.below(8));
      std::string refusal;
      switch (random.below(8)) {
        case 0:
          refusal = insert_line(notation, random.below(notation.lines.size() + 1), notation.lines[line]);
          break;
        case 1:
          refusal = remove_line(notation, line);
          break;
        case 2:
          refusal = write_on_both_beds(notation, line, pass);
          break;
        case 3:
          refusal = change_racking(notation, line, pass, static_cast<double>(random.below(9)) / 4 - 1);
          break;
        case 4:
          refusal = remove_operation(notation, place);
          break;
        case 5:
          refusal = add_operation(notation, place, operation);
          break;
        default:
          refusal = change_operation(notation, place, operation);
          // what was asked for is what the letter says now
          if (refusal.empty() && operation > NeedleOperation::missed) {
            const Pass& changed = notation.lines[line].passes[pass];
            const auto& row = changed.both_beds && bed == Bed::back ? changed.rear : changed.cells;
            const char letter = row[static_cast<std::size_t>(place.needle) % row.size()].letter;
            EXPECT_EQ(letter, (bed == Bed::front ? "gvtsd" : "enTSD")[static_cast<int>(operation) - 3]);
          }
      }
      (refusal.empty() ? done : refused) += 1;
    }
    const std::string text = write_vermiculation(notation);
    const Vermiculation again = parsed(text);
    ASSERT_TRUE(same_notation(again, notation)) << "seed " << seed << "\n"
                                                << random.text() << "---\n"
                                                << text;
    ASSERT_EQ(write_vermiculation(again), text);
    try {
      const NeedleDiagram a = needle_diagram(notation), b = needle_diagram(again);
      ASSERT_EQ(in_words(a), in_words(b)) << text;
    } catch (const std::invalid_argument&) {
    }
  }
  EXPECT_GT(done, 1000);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace loopwright
