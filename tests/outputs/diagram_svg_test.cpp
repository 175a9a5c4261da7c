// The drawing is XML whose glyphs are those of the diagram: loops, crosses, arrows, in the places they
// belong.
#include "outputs/write_diagram_svg.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "notation/read_program.hpp"
#include "temporary_folder.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

std::string drawn(const std::string& body, const DiagramOptions& options = {}) {
  Diagnostics diagnostics("drawn.verm");
  const Vermiculation notation = parse_vermiculation(";!vermiculation-1\n" + body, diagnostics);
  EXPECT_TRUE(diagnostics.ok());
  return diagram_svg(needle_diagram(notation, options));
}

std::ptrdiff_t count(const std::string& text, char c) { return std::count(text.begin(), text.end(), c); }

// The `d` of every path, joined by blanks; with `colour` those stroked in it alone.
std::string paths(const std::string& svg, const std::string& colour = "") {
  std::string all;
  for (std::size_t at = svg.find("<path d=\""); at != svg.npos; at = svg.find("<path d=\"", at)) {
    at += 9;
    const std::string rest = svg.substr(at, svg.find("/>", at) - at);
    if (colour.empty() || rest.find("stroke=\"" + colour + "\"") != rest.npos)
      all += rest.substr(0, rest.find('"')) + ' ';
  }
  return all;
}

double number_after(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key);
  EXPECT_NE(at, text.npos) << key;
  return std::stod(text.substr(at + key.size()));
}

// Whether every tag is closed, in order.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != xml.npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == xml.npos) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (tag.find('<') != tag.npos || count(tag, '"') % 2 != 0) return false;
    if (tag.ends_with('/')) continue;
    if (tag.starts_with('/')) {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
  }
  return open.empty();
}

constexpr const char* first_colour = "#1f3a5f";

TEST(DiagramSvg, ARibClosesALoopRoundEachNeedle) {
  const std::string svg = drawn("ge\n");
  EXPECT_TRUE(well_formed(svg));
  const std::string yarn = paths(svg, first_colour);
  EXPECT_EQ(count(yarn, 'M'), 1);      // one running thread ...
  EXPECT_EQ(count(yarn, 'C'), 6 * 4);  // ... round six needles, four curves each
}

TEST(DiagramSvg, DerbyRibHasACrossForEachInactiveNeedle) {
  const std::string svg = drawn("gggggg-- / -----eee\n");
  EXPECT_EQ(count(paths(svg, first_colour), 'C'), 9 * 4);
  // a cross is two strokes: one M and one relative move
  std::string crosses = paths(svg, "#222222");
  EXPECT_EQ(count(crosses, 'm'), 2 + 5);
}

TEST(DiagramSvg, TheFirstCourseIsAtTheBottomAndTheFrontBedBelowTheRear) {
  const std::string svg = drawn("g/n\nv/e\n");
  const auto height_of = [&](const std::string& text) {
    const std::size_t at = svg.rfind("<text", svg.find(">" + text + "</text>"));
    return number_after(svg.substr(at), " y=\"");
  };
  // the number of course 2 stands above that of course 1: y grows downwards; needle 1 is below both
  EXPECT_LT(height_of("2"), number_after(svg.substr(svg.find(">1</text>") - 90), " y=\""));
  EXPECT_THAT(svg, HasSubstr("line 2: course 1"));
  EXPECT_THAT(svg, HasSubstr("line 3: course 2"));
}

TEST(DiagramSvg, ATuckDoesNotCrossItsLegs) {
  // from left to right the curves of a tuck go to its left side first, those of a stitch to its right side
  const auto first_curve_end = [](const std::string& svg) {
    std::istringstream curve(paths(svg, first_colour).substr(paths(svg, first_colour).find('C') + 1));
    double x = 0, last = 0;
    for (int i = 0; i < 5; ++i) curve >> (i == 4 ? last : x);
    return last;
  };
  const auto start = [](const std::string& svg) { return std::stod(paths(svg, first_colour).substr(1)); };
  DiagramOptions one;
  one.wales = 1;
  const std::string stitch = drawn("g\n", one), tuck = drawn("v\n", one);
  const double needle = start(stitch) + 0.75 * 7;
  EXPECT_GT(first_curve_end(stitch), needle);
  EXPECT_LT(first_curve_end(tuck), needle);
}

TEST(DiagramSvg, TransfersAreArrowsAndThoseUnsaidDashed) {
  const std::string said = drawn("gggggg\n.t....\nR1 .T....\n");
  EXPECT_EQ(count(paths(said), 'z'), 2);
  EXPECT_THAT(said, HasSubstr(">R1</text>"));
  EXPECT_THAT(said, testing::Not(HasSubstr("dasharray")));
  EXPECT_THAT(drawn("g\ne\n"), HasSubstr("dasharray"));
}

TEST(DiagramSvg, ASplitHasTheNeedleThatItGivesTo) {
  Diagnostics diagnostics("s.k");
  const Program program = read_program_text(
      ";!knitout-2\n;;Carriers: 1\nin 1\nknit + f1 1\nsplit - f1 b1 1\nout 1\n", ".k", diagnostics);
  const std::string svg = diagram_svg(needle_diagram(program));
  EXPECT_EQ(count(paths(svg), 'z'), 1);
  const std::string dots =
      paths(svg, "#b5b5b5");  // the rear needle of the split, none of the course before it
  EXPECT_EQ(count(dots, 'M'), 1);
}

TEST(DiagramSvg, SeveralYarnsHaveTheirColoursAndNames) {
  const std::string svg =
      drawn(";;Yarn-A: colour=#f2e6c8\n;;Yarn-B2: colour=#28406a\nA: g.\nB2: .g\nA+B2: g\n");
  EXPECT_EQ(count(paths(svg, "#28406a"), 'C'), (3 + 6) * 4);
  EXPECT_EQ(count(paths(svg, "#f2e6c8"), 'C'), (3 + 6) * 4);
  EXPECT_EQ(count(paths(svg, "#555555"), 'C'), (3 + 6) * 4);  // the rim of the light one
  EXPECT_THAT(svg, HasSubstr(">A+B2</text>"));
}

TEST(DiagramSvg, NamesCannotBreakTheXml) {
  const std::string svg = drawn(";;Name: <b>\"bird's\" & eye</b> \x01\ng\n");
  EXPECT_TRUE(well_formed(svg));
  EXPECT_THAT(svg, HasSubstr("&lt;b&gt;&quot;bird's&quot; &amp; eye&lt;/b&gt;"));
  EXPECT_EQ(svg.find('\x01'), svg.npos);
}

TEST(DiagramSvg, TwentyFourBySquareFitsAnA4PageForEveryExample) {
  int files = 0;
  const auto examples = std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(examples)) {
    if (entry.path().extension() != ".verm") continue;
    Diagnostics diagnostics(entry.path().filename());
    const Vermiculation notation = parse_vermiculation(*read_text(entry.path(), diagnostics), diagnostics);
    DiagramOptions options;
    options.wales = options.courses = 24;
    const std::string svg = diagram_svg(needle_diagram(notation, options));
    EXPECT_TRUE(well_formed(svg)) << entry.path();
    EXPECT_LE(number_after(svg, " width=\""), 186.01) << entry.path();
    EXPECT_LE(number_after(svg, " height=\""), 273.01) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 16);
}

TEST(DiagramSvg, TheLibraryHasItsSourcesAndDrawingsAsTheyAre) {
  const auto folder = std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples" / "structures";
  const std::string page = test::content(folder / ".." / ".." / "docs" / "structures.md");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".verm") continue;
    Diagnostics diagnostics(entry.path().filename());
    const std::string text = *read_text(entry.path(), diagnostics);
    EXPECT_THAT(text, HasSubstr("\n; Source: ")) << entry.path();
    const std::filesystem::path drawing = std::filesystem::path(entry.path()).replace_extension(".svg");
    EXPECT_EQ(test::content(drawing), diagram_svg(needle_diagram(parse_vermiculation(text, diagnostics))))
        << "draw it again: loopwright diagram " << entry.path() << " -o " << drawing;
    EXPECT_THAT(page, HasSubstr("structures/" + entry.path().filename().string()))
        << "tell it in docs/structures.md";
    ++files;
  }
  EXPECT_GE(files, 26);
}

using DiagramSvgFile = test::TemporaryFolder;

TEST_F(DiagramSvgFile, IsWrittenWholeOrNotAtAll) {
  write_diagram_svg(in_folder("empty.svg"), {});
  EXPECT_TRUE(well_formed(test::content(in_folder("empty.svg"))));
  EXPECT_THROW(write_diagram_svg(in_folder("missing/rib.svg"), {}), std::runtime_error);
  EXPECT_THAT(names(), testing::ElementsAre("empty.svg"));
}

}  // namespace
}  // namespace loopwright
