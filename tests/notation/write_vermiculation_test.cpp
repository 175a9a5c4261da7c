// Text -> parsed form -> text changes nothing, whatever is written; what was changed is read back as it is.
#include "notation/write_vermiculation.hpp"

#include <gmock/gmock.h>

#include "notation_test.hpp"
#include "random_notation.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

Vermiculation parsed(const std::string& text) {
  Diagnostics diagnostics("written.verm");
  Vermiculation notation = parse_vermiculation(text, diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << said(diagnostics) << text;
  return notation;
}

// Without its layout a notation is written in the canonical way.
std::string canonical(Vermiculation notation) {
  notation.written.clear();
  return write_vermiculation(notation);
}

void expect_lossless(const std::string& text) {
  const Vermiculation notation = parsed(text);
  EXPECT_EQ(write_vermiculation(notation), text);
  const std::string plain = canonical(notation);
  const Vermiculation again = parsed(plain);
  EXPECT_TRUE(same_notation(again, notation)) << text << "---\n" << plain;
  EXPECT_EQ(write_vermiculation(again), plain);
  EXPECT_EQ(canonical(again), plain);
}

TEST(WriteVermiculation, EveryExampleComesBackToTheLastByte) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_dir() / "examples")) {
    if (entry.path().extension() != ".verm") continue;
    expect_lossless(text_of(entry.path()));
    ++files;
  }
  EXPECT_GE(files, 16);
}

TEST(WriteVermiculation, RandomNotationsComeBackToTheLastByte) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    expect_lossless(RandomNotation(seed).text());
    if (HasFailure()) FAIL() << "seed " << seed;
  }
}

TEST(WriteVermiculation, ChangedCellsAreReadBackAndOtherLinesStand) {
  for (unsigned seed = 0; seed < 1000; ++seed) {
    RandomNotation random(seed);
    Vermiculation notation = parsed(random.text());
    for (int changes = 0; changes < 3; ++changes) {
      CourseLine& line = notation.lines[random.below(notation.lines.size())];
      Pass& pass = line.passes[random.below(line.passes.size())];
      if (pass.cells.empty() || !pass.knits()) continue;
      Cell& cell = pass.cells[random.below(pass.cells.size())];
      cell.letter = pass.both_beds ? "gvs.-"[random.below(5)] : "gevnsS.-"[random.below(8)];
    }
    const std::string text = write_vermiculation(notation);
    Diagnostics diagnostics("changed.verm");
    const Vermiculation again = parse_vermiculation(text, diagnostics);
    ASSERT_TRUE(diagnostics.ok()) << said(diagnostics) << text;
    ASSERT_TRUE(same_notation(again, notation)) << "seed " << seed << "\n"
                                                << random.text() << "---\n"
                                                << text;
    ASSERT_EQ(write_vermiculation(again), text);
  }
}

constexpr const char* panel =
    ";!vermiculation-1\n"
    "; a panel of mine\n"
    ";;Gauge: 12 npi      ; needles per inch\n"
    ";;Yarn-A: wool 2/28 Nm\n"
    "\n"
    "[            ; ground\n"
    "ee  (gg)*2   ; rib\n"
    "]*6\n"
    "g            ; plain\n";

TEST(WriteVermiculation, ABracketIsOpenedOnlyWhereItsCopiesDiffer) {
  Vermiculation notation = parsed(panel);
  notation.lines[2].passes[0].cells[1].letter = 'v';
  EXPECT_EQ(write_vermiculation(notation),
            ";!vermiculation-1\n; a panel of mine\n;;Gauge: 12 npi      ; needles per inch\n"
            ";;Yarn-A: wool 2/28 Nm\n\n"
            "[            ; ground\nee  (gg)*2   ; rib\n]*2\n"
            "evgggg       ; rib\n"
            "[\nee  (gg)*2   ; rib\n]*3\n"
            "g            ; plain\n");
}

TEST(WriteVermiculation, HeadersThatChangedAreWrittenAnewInTheirPlace) {
  Vermiculation notation = parsed(panel);
  notation.settings.gauge_npi = 7;
  notation.settings.loop_length_mm = 6.2;
  notation.yarns[0].data.friction_coefficient = 0.125;
  notation.yarns.push_back({"B", {}, {}});
  notation.lines[6].passes[0].yarns = {1};
  EXPECT_EQ(write_vermiculation(notation),
            ";!vermiculation-1\n; a panel of mine\n;;Gauge: 7  ; needles per inch\n"
            ";;Yarn-A: wool 2/28 Nm friction=0.125\n;;Yarn-B:\n;;Loop-Length: 6.2 mm\n\n"
            "[            ; ground\nee  (gg)*2   ; rib\n]*6\n"
            "B: g         ; plain\n");
  notation.settings.gauge_npi.reset();
  EXPECT_THAT(write_vermiculation(notation), testing::Not(HasSubstr("Gauge")));
}

TEST(WriteVermiculation, LinesPutInWithoutALayoutAreStillAllWritten) {
  Vermiculation notation = parsed(panel);
  notation.lines.push_back(notation.lines.front());
  EXPECT_TRUE(same_notation(parsed(write_vermiculation(notation)), notation));
}

TEST(WriteVermiculation, LongRowsAreFolded) {
  const auto row = [](const std::string& letters) {
    const Vermiculation notation = parsed(";!vermiculation-1\n" + letters + "\n");
    return write_course(notation.lines.front(), notation.yarns);
  };
  EXPECT_EQ(row("ge ge"), "gege");
  EXPECT_EQ(row("gegegegegege"), "(ge)*6");
  EXPECT_EQ(row("g*20"), "g*20");
  EXPECT_EQ(row("vv g*20 en"), "vv g*20 en");
  EXPECT_EQ(row("r1 g R-0.5 g R0"), "R-1 g R-0.5 g R0");
  EXPECT_EQ(row("R1. / e R2"), "R1 . / e R2");
  EXPECT_EQ(row("R1"), "R1");
}

}  // namespace
}  // namespace loopwright
