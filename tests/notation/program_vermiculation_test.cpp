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

// Without blanks and comments, which a Program does not keep.
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
    if (each.op != Op::knit && each.op != Op::tuck && each.op != Op::xfer) continue;
    int& here = held[{is_front(each.needle.bed), each.needle.index}];
    std::ostringstream words;
    words << name_of(each.op) << ' ' << static_cast<int>(each.direction) << ' '
          << to_string(Needle{each.needle.bed, each.needle.index - first}) << " at " << racking;
    for (const CarrierId id : each.carriers) words << ' ' << program.carriers[id.position()];
    if (each.op == Op::xfer) {
      if (here == 0) continue;
      held[{is_front(each.target.bed), each.target.index}] += here;
      here = 0;
    } else {
      here = each.op == Op::tuck ? here + 1 : 1;
    }
    all.push_back(words.str());
  }
  // transfers at one racking may come in any order: they share no needle in these programmes
  for (auto begin = all.begin(); begin != all.end();) {
    const auto racking_of = [](const std::string& words) { return words.substr(words.find(" at ")); };
    auto end = begin;
    while (end != all.end() && end->starts_with("xfer") && racking_of(*end) == racking_of(*begin)) ++end;
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

TEST(ProgramAsVermiculation, EveryExampleOfTheLibraryComesBack) {
  int same_letters = 0, files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "examples" / "structures")) {
    if (entry.path().extension() != ".verm") continue;
    const std::string text = text_of(entry.path());
    const Program program = knitted(text);
    Diagnostics lost(entry.path().filename());
    const std::string written = write_vermiculation(program, lost);
    EXPECT_EQ(said(lost), "");
    const Program again = knitted(written);
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
    const Program program = read_vermiculation(text, diagnostics, options);
    if (!diagnostics.ok()) continue;
    const std::string written = write_vermiculation(program, lost);
    if (lost.warnings() + lost.errors() > 0) continue;
    const Program copy = read_vermiculation(written, again);
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
  EXPECT_THAT(told, HasSubstr("k.k:8:1: warning: 'split' becomes a stitch"));
  EXPECT_THAT(told, HasSubstr("k.k:10:1: warning: 'pause'"));
  EXPECT_THAT(told,
              HasSubstr("k.k:11:1: warning: machine settings are not in the notation: 'x-speed-number 3'"));
  EXPECT_THAT(told, testing::Not(HasSubstr("k.k:12")));  // nothing was there to drop
  EXPECT_THAT(told, HasSubstr("k.k:14:1: warning: sliders are not in the notation: fs1 becomes its needle"));
  EXPECT_THAT(told, HasSubstr("k.k:16:1: warning: carrier 1 comes in a second time"));
  EXPECT_THAT(told, HasSubstr("k.k:18:1: warning: what follows the last course is not in the notation"));
  EXPECT_EQ(lost.errors(), 0);
  knitted(text);
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
  EXPECT_GE(without_loss, 10);
}

}  // namespace
}  // namespace loopwright
