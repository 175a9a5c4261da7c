// Changes of many needles at once.
#include <gmock/gmock.h>

#include "../diagram_edits.hpp"
#include "notation/write_vermiculation.hpp"

namespace loopwright {
namespace {

const std::string header = ";!vermiculation-1\n;;Yarn-A: wool 2/28 Nm   ; usual\n";

Vermiculation notation_of(const std::string& courses) {
  Diagnostics diagnostics;
  Vermiculation notation = parse_vermiculation(header + courses, diagnostics);
  EXPECT_TRUE(diagnostics.ok());
  return notation;
}

std::string courses_of(const Vermiculation& notation) {
  const std::string text = write_vermiculation(notation);
  EXPECT_THAT(text, testing::StartsWith(header)) << "what was not changed stays as it was written";
  return text.substr(header.size());
}

TEST(DiagramEdits, CopyAndPasteGoRoundTheRepeat) {
  Vermiculation notation = notation_of("gegv  ; a\ngggg ; b\n");
  const CopiedNeedles copy = copied(notation, {0, 0, 2, 3});
  ASSERT_EQ(copy.wales, 2);
  ASSERT_EQ(paste(notation, copy, 1, 3), "");
  const std::string courses = courses_of(notation);
  EXPECT_THAT(courses, testing::StartsWith("gegv  ; a\n"));
  const Vermiculation wanted = notation_of("gegv\nvggg\n");
  EXPECT_TRUE(same_course(notation.lines[1], wanted.lines[1])) << courses;
}

TEST(DiagramEdits, PasteTakesBothBedsAlong) {
  Vermiculation notation = notation_of("g. / .e\n.. / ..\n");
  ASSERT_EQ(paste(notation, copied(notation, {0, 0, 0, 1}), 1, 0), "");
  EXPECT_TRUE(same_course(notation.lines[1], notation.lines[0]));
}

TEST(DiagramEdits, LinesAreRepeatedAndRemoved) {
  Vermiculation notation = notation_of("g\ne ; second\n");
  ASSERT_EQ(repeat_lines(notation, 0, 1, 2), "");
  EXPECT_EQ(notation.lines.size(), 6U);
  ASSERT_EQ(remove_lines(notation, 1, 5), "");
  EXPECT_EQ(courses_of(notation), "g\n");
  EXPECT_NE(remove_lines(notation, 0, 0), "");
  EXPECT_NE(repeat_lines(notation, 3, 4, 1), "");
}

TEST(DiagramEdits, WalesAreInsertedAndRemovedWithTheirRackings) {
  Vermiculation notation = notation_of("gev\ng\ng. / .e\n");
  ASSERT_EQ(repeat_width(notation), 6);
  ASSERT_EQ(insert_wale(notation, 1), "");
  const Vermiculation wanted = notation_of("geevgev\ng\ng..g.g. / .eee.e.\n");
  EXPECT_TRUE(same_course(notation.lines[0], wanted.lines[0])) << courses_of(notation);
  EXPECT_TRUE(same_course(notation.lines[1], wanted.lines[1])) << "one letter repeats at every width";
  EXPECT_EQ(repeat_width(notation), 7);
  ASSERT_EQ(remove_wale(notation, 1), "");
  EXPECT_EQ(repeat_width(notation), 6);
  EXPECT_NE(insert_wale(notation, 6), "");
  Vermiculation narrow = notation_of("g\n");
  EXPECT_NE(remove_wale(narrow, 0), "");
}

TEST(DiagramEdits, AChangeThatCannotBeLeavesEverythingAsItWas) {
  Vermiculation notation = notation_of("gg\n.t.. & R1 .T..\n");
  const std::string before = write_vermiculation(notation);
  const CopiedNeedles stitches = copied(notation, {0, 0, 0, 1});
  EXPECT_NE(paste(notation, stitches, 1, 0), "") << "stitches among transfers";
  EXPECT_EQ(write_vermiculation(notation), before);
}

}  // namespace
}  // namespace loopwright
