// Text -> Program -> text, and knitout -> text -> the same operations.
#include <gmock/gmock.h>

#include <map>

#include "notation/write_vermiculation.hpp"
#include "notation_test.hpp"
#include "random_notation.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

Program knitted(const std::string& text) {
  Diagnostics diagnostics("k.verm");
  Program program = read_vermiculation(text, diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << said(diagnostics) << text;
  return program;
}

// The same programme as if nothing were known of the file that it came from.
Program without_notation(Program program) {
  program.notation.reset();
  return program;
}

// Without blanks and comments, which are not in the instructions.
std::string letters(const std::string& text) {
  Diagnostics diagnostics("l.verm");
  Vermiculation notation = parse_vermiculation(text, diagnostics);
  std::string all;
  for (const CourseLine& line : notation.lines) all += write_course(line, notation.yarns) + "\n";
  return all;
}

// Needle operations and the racking they are made at, needles counted from `first`; own words, so that the
// writer's own check is checked.
std::vector<std::string> operations(const Program& program, int first) {
  std::vector<std::string> all;
  std::map<std::pair<bool, int>, int> held;
  double racking = 0;
  for (const Instruction& each : program.instructions) {
    if (each.op == Op::rack) racking = each.value;
    if (each.op < Op::knit || each.op == Op::miss || each.op == Op::amiss) continue;
    int& here = held[{is_front(each.needle.bed), each.needle.index}];
    const bool yarn = !each.carriers.empty(), gives = each.op == Op::xfer || each.op == Op::split;
    if (!yarn && here == 0) continue;
    std::ostringstream words;
    // spelt as transfers and drops: split and knit without yarn
    words << (yarn    ? name_of(each.op)
              : gives ? "xfer"
                      : "drop")
          << ' ' << (yarn ? static_cast<int>(each.direction) : 0) << ' '
          << to_string(Needle{each.needle.bed, each.needle.index - first}) << " at ";
    words << (yarn || gives ? racking : 0);  // to a drop the racking is nothing
    for (const CarrierId id : each.carriers) words << ' ' << program.carriers[id.position()];
    if (gives) held[{is_front(each.target.bed), each.target.index}] += here;
    here = yarn ? (each.op == Op::tuck ? here + 1 : 1) : 0;
    all.push_back(words.str());
  }
  // transfers at one racking may come in any order: they share no needle in these programmes
  for (auto begin = all.begin(); begin != all.end();) {
    const auto racking_of = [](const std::string& words) { return words.substr(words.find(" at ")); };
    auto end = begin;
    const auto moves = [](const std::string& w) { return w.starts_with("xfer") || w.starts_with("drop"); };
    while (end != all.end() && moves(*end) && moves(*begin) && racking_of(*end) == racking_of(*begin)) ++end;
    std::sort(begin, end);
    begin = end == begin ? begin + 1 : end;
  }
  return all;
}

int first_needle(const Program& program) {
  int first = 1'000'000;
  for (const Instruction& each : program.instructions)
    if (each.op == Op::knit || each.op == Op::tuck || each.op == Op::xfer || each.op == Op::miss) {
      first = std::min(first, each.needle.index);
      if (each.op == Op::xfer) first = std::min(first, each.target.index);
    }
  return first;
}

std::string written(const Program& program) {
  Diagnostics lost("written.verm");
  const std::string text = write_vermiculation(program, lost);
  EXPECT_EQ(said(lost), "") << text;
  return text;
}

TEST(ProgramAsVermiculation, EveryFabricFileComesBackToTheLastByte) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_dir() / "examples")) {
    if (entry.path().extension() != ".verm") continue;
    const std::string text = text_of(entry.path());
    EXPECT_EQ(written(knitted(text)), text) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 31);
}

TEST(ProgramAsVermiculation, RandomNotationsComeBackToTheLastByte) {
  int files = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::string text = RandomNotation(seed).text();
    // other line ends, no last one, a byte-order mark
    if (seed % 5 == 1)
      for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2) text.insert(at, "\r");
    if (seed % 5 == 2) text.pop_back();
    if (seed % 5 == 3) text.insert(0, "\xef\xbb\xbf");
    Diagnostics diagnostics("r.verm");
    FabricOptions options;
    options.most_instructions = 20'000;
    const Program program = read_vermiculation(text, diagnostics, options);
    if (!diagnostics.ok()) continue;
    ASSERT_EQ(written(program), text) << "seed " << seed;
    ++files;
  }
  EXPECT_GT(files, 300);
}

TEST(ProgramAsVermiculation, AFileThatCannotBeKnittedHasNoProgrammeToWrite) {
  Diagnostics diagnostics("k.verm"), lost("k.verm");
  EXPECT_EQ(write_vermiculation(read_vermiculation(";!vermiculation-1\nq\n", diagnostics), lost), "");
  EXPECT_FALSE(lost.ok());
}

TEST(ProgramAsVermiculation, EveryExampleOfTheLibraryComesBackFromItsInstructions) {
  int same_letters = 0, files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "examples" / "structures")) {
    if (entry.path().extension() != ".verm") continue;
    const std::string text = text_of(entry.path());
    const Program program = without_notation(knitted(text));
    Diagnostics lost(entry.path().filename());
    const std::string written = write_vermiculation(program, lost);
    EXPECT_EQ(said(lost), "");
    const Program again = without_notation(knitted(written));
    EXPECT_EQ(listing(again), listing(program)) << entry.path() << written;
    EXPECT_EQ(again.settings.edges, program.settings.edges);
    EXPECT_EQ(again.settings.size_wales, program.settings.size_wales);
    EXPECT_EQ(again.settings.gauge_npi, program.settings.gauge_npi);
    EXPECT_EQ(again.settings.repeat_wales, program.settings.repeat_wales);
    EXPECT_EQ(again.settings.repeat_courses, program.settings.repeat_courses);
    EXPECT_EQ(again.yarns.front().material, program.yarns.front().material);
    // what is written in this way stays as it is
    EXPECT_EQ(write_vermiculation(again, lost), written);
    if (letters(written) == letters(text))
      ++same_letters;
    else
      std::cout << "[   INFO   ] " << entry.path().filename() << " comes back as\n" << letters(written);
    ++files;
  }
  EXPECT_GE(files, 26);
  // some say what need not be said: a racking of 0, a direction that the carrier takes anyway, transfers that
  // the next course implies
  EXPECT_GE(same_letters, 19);
}

TEST(ProgramAsVermiculation, RandomNotationsMakeTheSameOperations) {
  int compared = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::string text = RandomNotation(seed).text();
    Diagnostics diagnostics("r.verm"), lost("r.verm"), again("again.verm");
    FabricOptions options;
    options.most_instructions = 20'000;
    const Program program = without_notation(read_vermiculation(text, diagnostics, options));
    if (!diagnostics.ok()) continue;
    const std::string written = write_vermiculation(program, lost);
    if (lost.warnings() + lost.errors() > 0) continue;
    const Program copy = without_notation(read_vermiculation(written, again));
    ASSERT_TRUE(again.ok()) << "seed " << seed << '\n' << text << "---\n" << written << said(again);
    // written once in this way it is the same for ever
    ASSERT_EQ(write_vermiculation(copy, again), written) << "seed " << seed << '\n' << text;
    const int shift = copy.window.needles > 0 || program.window.needles > 0 ? 0 : first_needle(program);
    const auto made = operations(copy, copy.settings.repeat_wales > 0 && shift != 0 ? first_needle(copy) : 0);
    const auto wanted = operations(program, shift);
    if (copy.window.needles == program.window.needles) {
      ASSERT_EQ(made, wanted) << "seed " << seed << '\n' << text << "---\n" << written;
      ++compared;
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(ProgramAsVermiculation, KnitoutBecomesLines) {
  Diagnostics diagnostics("k.k"), lost("k.k");
  const Program program = read_knitout(
      ";!knitout-2\n;;Carriers: 3\n;;Gauge: 15\nin 3\nknit + f5 3\nknit + f6 3\nknit - f6 3\nknit - f5 3\n"
      "xfer f5 b5\nxfer f6 b6\nknit + b5 3\nknit + b6 3\nrack 1\nxfer b5 f6\nrack 0\nknit - b6 3\nknit - f6 "
      "3\n"
      "knit + f5 3\nout 3\n",
      diagnostics);
  ASSERT_TRUE(diagnostics.ok());
  EXPECT_EQ(write_vermiculation(program, lost),
            ";!vermiculation-1\n;;Gauge: 15\n;;Carriers: 3\n;;Edges: free\n"
            "g\ng\ne\nR1 T.\n-. / -e\n< -g / -.\ng-\n");
}

TEST(ProgramAsVermiculation, WhatCannotBeSaidIsToldWithItsPlace) {
  Diagnostics diagnostics("k.k"), lost("k.k");
  const Program program = read_knitout(
      ";!knitout-2\n;;Carriers: 1\ninhook 1\nknit + f1 1\nknit + f2 1\nreleasehook 1\nstitch 1 2\n"
      "split - f2 b2 1\nknit - f1 1\npause\nx-speed-number 3\ndrop f9\ndrop b2\nknit + fs1 1\nout 1\nin 1\n"
      "knit - f1 1\nxfer f1 b1\n",
      diagnostics);
  ASSERT_TRUE(diagnostics.ok()) << said(diagnostics);
  const std::string text = write_vermiculation(program, lost);
  const std::string told = said(lost);
  EXPECT_THAT(told, HasSubstr("k.k:3:1: warning: 'inhook'"));
  EXPECT_THAT(told, HasSubstr("k.k:6:1: warning: 'releasehook'"));
  EXPECT_THAT(told, HasSubstr("k.k:7:1: warning: 'stitch'"));
  EXPECT_THAT(told, testing::Not(HasSubstr("k.k:8")));  // a letter of its own
  EXPECT_THAT(told, HasSubstr("k.k:10:1: warning: 'pause'"));
  EXPECT_THAT(told,
              HasSubstr("k.k:11:1: warning: machine settings are not in the notation: 'x-speed-number 3'"));
  EXPECT_THAT(told, testing::Not(HasSubstr("k.k:12")));  // nothing was there to drop
  EXPECT_THAT(told, HasSubstr("k.k:14:1: warning: sliders are not in the notation: fs1 becomes its needle"));
  EXPECT_THAT(told, HasSubstr("k.k:16:1: warning: carrier 1 comes in a second time"));
  EXPECT_EQ(lost.errors(), 0);
  const Program copy = knitted(text);
  const auto last = std::find_if(copy.instructions.rbegin(), copy.instructions.rend(),
                                 [](const Instruction& each) { return each.op >= Op::knit; });
  ASSERT_NE(last, copy.instructions.rend());
  EXPECT_EQ(last->op, Op::xfer);  // what follows the last course is done as well
}

// --- edited programmes keep what was not edited

constexpr const char* sampler =
    ";!vermiculation-1\n"
    "; made for the autumn range\n"
    ";;Name: sampler      ; working title\n"
    ";;Gauge: 12 npi\n"
    ";;Edges: free\n"
    "\n"
    "> (ge)*2        ; rib\n"
    "[               ; ground\n"
    "gg  gg          ; plain\n"
    "]*3\n"
    "; an eyelet\n"
    ".t..\n"
    "R1 .T..         ; onto its neighbour\n"
    "g g g g         ; back\n";

// The nth stitch of the programme, from 0.
Instruction& stitch(Program& program, int n) {
  for (Instruction& each : program.instructions)
    if (each.op == Op::knit && n-- == 0) return each;
  throw std::out_of_range("the programme has fewer stitches");
}

void expect_made(const std::string& text, const Program& program) {
  EXPECT_EQ(operations(knitted(text), 0), operations(program, 0)) << text;
}

TEST(EditedProgramme, OneStitchChangedLeavesTheOtherCoursesAsTheyAreWritten) {
  Program program = knitted(sampler);
  stitch(program, 4 + 5).op = Op::tuck;  // second course of the ground, its second needle from the right
  const std::string text = written(program);
  EXPECT_EQ(text,
            ";!vermiculation-1\n"
            "; made for the autumn range\n"
            ";;Name: sampler      ; working title\n"
            ";;Gauge: 12 npi\n"
            ";;Edges: free\n"
            "\n"
            "> (ge)*2        ; rib\n"
            "gg  gg          ; plain\n"
            "gvgg            ; plain\n"
            "gg  gg          ; plain\n"
            "; an eyelet\n"
            ".t..\n"
            "R1 .T..         ; onto its neighbour\n"
            "g g g g         ; back\n");
  expect_made(text, program);
}

TEST(EditedProgramme, ACourseTakenOutAndOnePutIn) {
  Program program = knitted(sampler);
  auto& all = program.instructions;
  const auto is_rib = [](const Instruction& each) { return each.op == Op::knit && each.at.line == 7; };
  const auto rib = std::find_if(all.begin(), all.end(), is_rib);
  const std::vector<Instruction> course(rib, rib + 4);
  const auto eyelet =
      std::find_if(all.begin(), all.end(), [](const auto& each) { return each.at.line == 12; });
  std::vector<Instruction> more = course;
  for (Instruction& each : more) {
    each.at = {};
    each.needle.bed = Bed::front;
    each.direction = Direction::right;
  }
  more[2].op = Op::tuck;
  all.insert(eyelet, more.begin(), more.end());
  const std::string text = written(program);
  expect_made(text, program);
  EXPECT_THAT(text, HasSubstr("]*3\nggvg\n; an eyelet\n.t..\n")) << text;
  EXPECT_THAT(text, HasSubstr("> (ge)*2        ; rib\n[               ; ground\ngg  gg          ; plain\n"));
}

TEST(EditedProgramme, AChangeInEveryRepeatStaysARepeat) {
  Program program = knitted(
      ";!vermiculation-1\n; pique\n;;Size: 6 wales x 8 courses\n\ngg   ; all\nvg   ; tuck at every other\n");
  for (Instruction& each : program.instructions)
    if (each.op == Op::tuck) each.op = Op::knit;
  const std::string text = written(program);
  EXPECT_EQ(
      text,
      ";!vermiculation-1\n; pique\n;;Size: 6 wales x 8 courses\n\ngg   ; all\ngg   ; tuck at every other\n");
  expect_made(text, program);
}

TEST(EditedProgramme, AChangeInOneRepeatIsWrittenThere) {
  Program program = knitted(
      ";!vermiculation-1\n;;Size: 4 wales x 8 courses  ; small\n;;Edges: free\n; jersey\ng   ; all\n");
  stitch(program, 4 * 3).op = Op::tuck;
  const std::string text = written(program);
  EXPECT_EQ(text,
            ";!vermiculation-1\n;;Edges: free\n; jersey\n[\ng   ; all\n]*3\n"
            "gggv ; all\n[\ng   ; all\n]*4\n");
  expect_made(text, program);
}

TEST(EditedProgramme, ABoundOffPieceIsStillBoundOff) {
  Program program =
      knitted(";!vermiculation-1\n;;Size: 4 wales x 4 courses\n;;Edges: bound-off\ng   ; jersey\n");
  stitch(program, 5).op = Op::tuck;
  const std::string text = written(program);
  EXPECT_THAT(text, HasSubstr(";;Edges: bound-off\n"));
  EXPECT_THAT(text, HasSubstr("; jersey\n"));
  expect_made(text, program);
}

TEST(EditedProgramme, SettingsAndYarnsAreChangedInTheirHeaders) {
  Program program = knitted(sampler);
  program.settings.gauge_npi = 7;
  program.yarns[0].friction_coefficient = 0.25;
  std::string wanted = sampler;
  wanted.replace(wanted.find("12 npi"), 6, "7");
  wanted.insert(wanted.find(";;Edges"), "");
  const std::string text = written(program);
  EXPECT_THAT(text, HasSubstr(";;Gauge: 7\n"));
  EXPECT_THAT(text, HasSubstr("friction=0.25"));
  EXPECT_THAT(text, HasSubstr("; made for the autumn range\n"));
  EXPECT_THAT(text, HasSubstr("R1 .T..         ; onto its neighbour\n"));
}

TEST(EditedProgramme, RandomChangesMakeTheProgrammeAndKeepTheOtherComments) {
  int compared = 0, commented = 0, kept = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomNotation random(seed);
    Diagnostics diagnostics("r.verm"), lost("r.verm");
    FabricOptions options;
    options.most_instructions = 20'000;
    Program program = read_vermiculation(random.text(), diagnostics, options);
    if (!diagnostics.ok()) continue;
    std::vector<std::size_t> stitches;
    for (std::size_t i = 0; i < program.instructions.size(); ++i)
      if (program.instructions[i].op == Op::knit && !program.instructions[i].carriers.empty())
        stitches.push_back(i);
    if (stitches.empty()) continue;
    program.instructions[stitches[random.below(stitches.size())]].op = Op::tuck;
    const std::string text = write_vermiculation(program, lost);
    if (lost.errors() + lost.warnings() > 0) continue;
    const Program copy = knitted(text);
    const bool shifted = copy.window.needles == 0;
    ASSERT_EQ(operations(copy, shifted ? first_needle(copy) : 0),
              operations(program, shifted ? first_needle(program) : 0))
        << "seed " << seed << '\n'
        << random.text() << "---\n"
        << text;
    ++compared;
    // the last line of the file, "ge", is written in every one
    const std::string last = random.text().substr(random.text().rfind('\n', random.text().size() - 2) + 1);
    if (last.find("; ") == std::string::npos) continue;
    ++commented;
    if (text.find(last.substr(last.find("; "))) != std::string::npos) ++kept;
  }
  std::cout << "[   INFO   ] " << compared << " changed, of " << commented << " with comments " << kept
            << " keep them\n";
  EXPECT_GT(compared, 50);
  EXPECT_GT(kept * 10, commented * 8);
}

TEST(ProgramAsVermiculation, NothingToKnitIsAnError) {
  Diagnostics lost("empty.k");
  EXPECT_EQ(write_vermiculation(Program{}, lost), "");
  EXPECT_THAT(said(lost), HasSubstr("error: the programme knits nothing"));
}

TEST(ProgramAsVermiculation, RealProgrammes) {
  if (!std::filesystem::is_directory(corpus() / "files"))
    GTEST_SKIP() << "the corpus of real programmes is absent: " << corpus();
  int read = 0, without_loss = 0;
  for (const auto& entry : std::filesystem::directory_iterator(corpus() / "files")) {
    const std::string suffix = entry.path().extension();
    if ((suffix != ".k" && suffix != ".knitout") || std::filesystem::file_size(entry.path()) > 150'000)
      continue;
    Diagnostics diagnostics(entry.path().filename()), lost(entry.path().filename()), again("again.verm");
    const Program program = read_knitout(text_of(entry.path()), diagnostics);
    if (!diagnostics.ok()) continue;
    const std::string text = write_vermiculation(program, lost);
    if (lost.errors() > 0) continue;
    const Program copy = read_vermiculation(text, again);
    EXPECT_TRUE(again.ok()) << entry.path() << said(again);
    ++read;
    bool only_machine_settings = true;
    for (const Diagnostic& each : lost.list())
      only_machine_settings = only_machine_settings && (each.message.find("hook") != std::string::npos ||
                                                        each.message.find("settings") != std::string::npos ||
                                                        each.message.find("'stitch'") != std::string::npos);
    if (!only_machine_settings) continue;
    EXPECT_EQ(operations(copy, 0), operations(program, first_needle(program))) << entry.path();
    ++without_loss;
  }
  RecordProperty("without_loss", without_loss);
  std::cout << "[   INFO   ] " << without_loss << " of " << read << " without loss of a loop\n";
  EXPECT_GE(read, 40);
  EXPECT_GE(without_loss, 41);
}

}  // namespace
}  // namespace loopwright
