#include "notation/read_knitout.hpp"

#include <gmock/gmock.h>

#include "notation/scan.hpp"
#include "notation_test.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

TEST(ReadKnitout, EveryOperation) {
  Diagnostics diagnostics("all.k");
  const Program program = read_knitout(
      ";!knitout-2\n;;Carriers: 1 2 L3\n;;Gauge: 15\ninhook 1\ntuck - f-3 1\nreleasehook 1\nin 2 L3\n"
      "knit + f3 2 L3 ; plated\nsplit - bs7 f7 1;\nmiss + b10000 2\ndrop f1\namiss fs-0\nxfer f1 b2\n"
      "rack -0.75\nrack +1\nstitch -5 10.5\npause\nx-stitch-number 101\nx-vis-color #ff8800 2\nknit + f1\n"
      "outhook 1\nout 2 L3\n",
      diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << said(diagnostics);
  EXPECT_EQ(diagnostics.warnings(), 0) << said(diagnostics);
  EXPECT_EQ(
      listing(program),
      "inhook 1; tuck - f-3 1; releasehook 1; in 2 L3; knit + f3 2 L3; split - bs7 f7 1; miss + b10000 2; "
      "drop f1; amiss fs0; xfer f1 b2; rack -0.75; rack 1; stitch; pause; extension; extension 2; knit + f1; "
      "outhook 1; out 2 L3");
  EXPECT_EQ(program.settings.gauge_npi, 15);
  EXPECT_EQ(program.instructions[12].value, -5);
  EXPECT_EQ(program.instructions[12].value2, 10.5);
  EXPECT_EQ(program.instructions[14].text, "x-stitch-number 101");
  EXPECT_EQ(program.yarns[1].colour, "#ff8800");
  EXPECT_EQ(program.instructions[1].at, (SourceLocation{5, 1}));
}

TEST(ReadKnitout, SaysWhatIsWrongAndWhere) {
  const auto said_of = [](const std::string& text) {
    Diagnostics diagnostics("x.k");
    read_knitout(text, diagnostics);
    return said(diagnostics);
  };
  const std::string head = ";!knitout-2\n;;Carriers: 1 2\n";
  EXPECT_THAT(said_of(""), HasSubstr("the file is empty"));
  EXPECT_THAT(said_of("in 1\n"), HasSubstr("x.k:1:1: error: the first line is not ';!knitout-2' but 'in 1'"));
  EXPECT_THAT(said_of(";!knitout-2\nin 1\n"), HasSubstr("the Carriers header is missing"));
  EXPECT_THAT(said_of(";!knitout-3\n;;Carriers: 1\n"), HasSubstr("x.k:1:11: warning: version 3 is newer"));
  EXPECT_THAT(said_of(head + "in 1 # left"),
              HasSubstr("x.k:3:6: error: '#' starts no comment in knitout; write ';'"));
  EXPECT_THAT(said_of(head + "Knit + f1 1"),
              HasSubstr("x.k:3:1: error: unknown operation 'Knit'; write 'knit'"));
  EXPECT_THAT(said_of(head + "tcuk + f1 1"), HasSubstr("unknown operation 'tcuk'; write 'tuck'"));
  EXPECT_THAT(said_of(head + "purl + f1 1"), HasSubstr("unknown operation 'purl'; knitout knows"));
  EXPECT_THAT(said_of(head + "knit f1 1"),
              HasSubstr("x.k:3:6: error: expected a direction, + or -, not 'f1'; the "
                        "direction stands before the needle, e.g. '+ f1'"));
  EXPECT_THAT(said_of(head + "drop F1"), HasSubstr("not 'F1'; beds are written small, 'f1'"));
  EXPECT_THAT(said_of(head + "drop f 1"), HasSubstr("not 'f'; its number follows without a blank"));
  EXPECT_THAT(said_of(head + "rack 0,25"), HasSubstr("not '0,25'; write a point for the comma"));
  EXPECT_THAT(said_of(";!knitout-2\n;;carriers: 1\n"),
              HasSubstr("x.k:2:3: warning: unknown header 'carriers' is "
                        "left out; write 'Carriers'"));
  EXPECT_THAT(said_of(";!knitout-2\n;;Carriers:1 2\n"),
              HasSubstr("x.k:2:12: warning: a blank is missing after the colon"));
  EXPECT_THAT(said_of("\xef\xbb\xbf;!knitout-2\n;;Carriers: 1\n"),
              HasSubstr("x.k:1:1: error: the file starts with a byte-order mark"));
  EXPECT_THAT(said_of(";!knitout-2 \n;;Carriers: 1\n"),
              HasSubstr("x.k:1:12: error: a blank in the first line"));
  EXPECT_THAT(said_of(";!knitout- 2\n;;Carriers: 1\n"),
              HasSubstr("x.k:1:11: error: a blank in the first line"));
  EXPECT_THAT(said_of(head + "drop f+5"),
              HasSubstr("x.k:3:7: error: a needle's number has no '+'; write 'f5'"));
  EXPECT_THAT(said_of(head + "purl + f1 1"), HasSubstr("x.k:3:1: error: unknown operation 'purl'"));
  EXPECT_THAT(said_of(head + "  knit x f1 1"),
              HasSubstr("x.k:3:8: error: expected a direction, + or -, not 'x'"));
  EXPECT_THAT(said_of(head + "knit \xe2\x88\x92 f1 1"), HasSubstr("typographic minus"));
  EXPECT_THAT(said_of(head + "knit + f 1"), HasSubstr("x.k:3:8: error: expected a needle"));
  EXPECT_THAT(said_of(head + "knit + f10001 1"), HasSubstr("needles run from -10000 to 10000"));
  EXPECT_THAT(said_of(head + "knit + b-99999999999999999999 1"),
              HasSubstr("needles run from -10000 to 10000"));
  EXPECT_THAT(said_of(head + "knit +"), HasSubstr("x.k:3:7: error: the line ends where a needle"));
  EXPECT_THAT(said_of(head + "knit + f1 3"),
              HasSubstr("x.k:3:11: error: carrier '3' is not in the Carriers header"));
  EXPECT_THAT(said_of(head + "knit + f1 1 1"), HasSubstr("x.k:3:13: error: carrier '1' is named twice"));
  EXPECT_THAT(said_of(head + "xfer f1 b1 1"), HasSubstr("x.k:3:12: error: '1' is too much here"));
  EXPECT_THAT(said_of(head + "rack nan"), HasSubstr("x.k:3:6: error: expected a racking"));
  EXPECT_THAT(said_of(head + "rack 1e9"), HasSubstr("racking is out of range"));
  EXPECT_THAT(said_of(head + "in"), HasSubstr("x.k:3:3: error: the line ends where a carrier was expected"));
  EXPECT_THAT(said_of(head + "x-fancy 1\nx-fancy 2\n"),
              HasSubstr("x.k:3:1: warning: unknown extension 'x-fancy'"));
  EXPECT_THAT(said_of(";!knitout-2\n;;Carriers: 1\n;;Carriers: 2\nin 2\n"),
              HasSubstr("3:3: warning: header 'Carriers'"));
  EXPECT_THAT(said_of(";!knitout-2\r\n;;Carriers: 1\r\nin 1\r\n"),
              HasSubstr("x.k:1:12: warning: the line ends with CR LF"));
  EXPECT_THAT(said_of(head + "purl + f1 1 ;!source: my.js 17"), HasSubstr("[source: my.js 17]"));
}

// Line ends of other systems, alone and doubled, are no part of a name; what was understood survives writing.
TEST(ReadKnitout, LineEndsAreNoPartOfACarrier) {
  for (const std::string text : {"in \r\r\n\r\n\ni\xff\rin\ni\n", "in A\r\r\nin \r\n",
                                 ";;Carriers: A\r\r\nin A\r\r\n", "in \x01\n", "in A\rin B\n"}) {
    Diagnostics diagnostics("x.k"), again("x.k");
    const Program program = read_knitout(";!knitout-2\n" + text, diagnostics);
    for (const std::string& name : program.carriers) EXPECT_THAT(name, testing::AnyOf("A", "B"));
    const Program copy = read_knitout(write_knitout(program), again);
    EXPECT_EQ(listing(copy), listing(program)) << text;
  }
}

TEST(ReadKnitout, ControlCharactersInNamesAreErrors) {
  Diagnostics diagnostics("x.k");
  read_knitout(";!knitout-2\n;;Carriers: A \x02\nin A\rB\n", diagnostics);
  EXPECT_THAT(said(diagnostics),
              HasSubstr("x.k:2:15: error: carrier name '\\x02' holds a control character"));
  EXPECT_THAT(said(diagnostics),
              HasSubstr("x.k:3:4: error: carrier name 'A\\x0dB' holds a control character"));
}

TEST(ReadKnitout, WithoutACarriersHeaderEveryNameIsAllowed) {
  Diagnostics diagnostics("x.k");
  const Program program = read_knitout(";!knitout-2\nin 7\nknit + f1 7\nout 7\n", diagnostics);
  EXPECT_EQ(diagnostics.errors(), 0) << said(diagnostics);
  EXPECT_THAT(said(diagnostics), HasSubstr("x.k: warning: the Carriers header is missing"));
  EXPECT_EQ(program.carriers, std::vector<std::string>{"7"});
}

TEST(ReadKnitout, RailsOfSeveralCarriers) {
  Diagnostics diagnostics("x.k");
  const Program program = read_knitout(";!knitout-2\n;;Carriers: 1 L1,L2;R1,R2 9\nin R1\n", diagnostics);
  EXPECT_EQ(said(diagnostics), "");
  EXPECT_THAT(program.carriers, testing::ElementsAre("1", "L1", "L2", "R1", "R2", "9"));
}

TEST(ReadKnitout, HeadersEndAtTheFirstOtherLine) {
  Diagnostics diagnostics("x.k");
  const Program program = read_knitout(
      ";!knitout-2\n;;Carriers: 1\n;; a remark\n;;Carriers: 2\nin 1 ;no space before this comment\n\tknit  "
      "+\tf1 1;\n",
      diagnostics);
  EXPECT_THAT(program.carriers, testing::ElementsAre("1"));
  EXPECT_THAT(said(diagnostics),
              HasSubstr("x.k:4:1: warning: header 'Carriers' comes after the headers have ended"));
  EXPECT_EQ(listing(program), "in 1; knit + f1 1");
}

TEST(ReadKnitout, AnyWholeNumberIsAVersion) {
  for (const char* version : {"0", "1", "2", "3", "99999999999999999999"}) {
    Diagnostics diagnostics("x.k");
    read_knitout(std::string(";!knitout-") + version + "\n;;Carriers: 1\n", diagnostics);
    EXPECT_TRUE(diagnostics.ok()) << version;
  }
  for (const char* version : {"", "x", "2.0", "-1"}) {
    Diagnostics diagnostics("x.k");
    read_knitout(std::string(";!knitout-") + version + "\n;;Carriers: 1\n", diagnostics);
    EXPECT_FALSE(diagnostics.ok()) << version;
  }
}

TEST(ReadKnitout, OtherEncodingsAreTold) {
  Diagnostics diagnostics("x.k");
  read_knitout(";!knitout-2\n;;Carriers: 1\n; gr\xc3\xbc\xc3\x9f\nin 1 ; caf\xe9\n", diagnostics);
  EXPECT_THAT(said(diagnostics), HasSubstr("x.k:4:11: warning: the text is not UTF-8"));
  EXPECT_EQ(diagnostics.warnings(), 1);
  // RFC 3629: overlong forms and surrogates are no UTF-8, the last code point is
  EXPECT_EQ(first_byte_not_utf8("12345678\xf4\x8f\xbf\xbf"), std::string_view::npos);
  EXPECT_EQ(first_byte_not_utf8("a\xc0\xaf"), 1u);
  EXPECT_EQ(first_byte_not_utf8("ab\xed\xa0\x80"), 2u);
  EXPECT_EQ(first_byte_not_utf8("\xe2\x82"), 0u);
}

// A source mark is opaque: every message about its line repeats it as it stands, whoever says it.
TEST(ReadKnitout, SourceMarksAreRepeatedVerbatim) {
  Diagnostics diagnostics("x.k");
  const Program program =
      read_knitout(";!knitout-2\n;;Carriers: 1\nin 1 ;!source: \xc3\xbc.js: 17 ; \"a\"\nin 1\n", diagnostics);
  ASSERT_EQ(program.source_marks.size(), 1u);
  EXPECT_EQ(program.source_marks[0].second, "\xc3\xbc.js: 17 ; \"a\"");
  diagnostics.error(program.instructions[0].at, "first");
  diagnostics.error(program.instructions[1].at, "second");
  EXPECT_EQ(said(diagnostics),
            "x.k:3:1: error: first [source: \xc3\xbc.js: 17 ; \"a\"]\nx.k:4:1: error: second\n");
}

}  // namespace
}  // namespace loopwright
