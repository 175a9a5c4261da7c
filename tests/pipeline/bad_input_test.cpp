// Whatever a user hands to the command by mistake: it says what is wrong and where, leaves nothing behind and
// returns 1.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "pipeline/run_command.hpp"

namespace loopwright {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const char* const good_knitout =
    ";!knitout-2\n"
    ";;Carriers: 1 2 3\n"
    "in 1\n"
    "tuck - f3 1\ntuck - f1 1\ntuck + f0 1\ntuck + f2 1\n"
    "knit - f3 1\nknit - f2 1\nknit - f1 1\nknit - f0 1\n"
    "knit + f0 1\nknit + f1 1\nknit + f2 1\nknit + f3 1\n"
    "out 1\n";

struct BadInput {
  std::string name;  // of the case
  std::string file;  // its name, the suffix among it
  std::string content;
  std::string finding;  // regular expression for what must be said
};

std::ostream& operator<<(std::ostream& out, const BadInput& input) { return out << input.name; }

std::string noise() {
  std::string bytes;
  unsigned state = 12345;
  for (int i = 0; i < 4000; ++i) {
    state = state * 1664525U + 1013904223U;
    bytes.push_back(static_cast<char>(state >> 24U));
  }
  return bytes;
}

class BadInputTest : public testing::TestWithParam<BadInput> {};

// Every command that reads a notation refuses it alike.
TEST_P(BadInputTest, IsRefusedWithItsPlace) {
  const BadInput& input = GetParam();
  const TemporaryFolder folder;
  folder.write(input.file, input.content);

  const CommandOutcome check = run_command({"check", input.file}, folder);
  EXPECT_EQ(check.status, 1) << check.out << check.err;
  EXPECT_THAT(check.out, ContainsRegex(input.file + ":.*error: .*" + input.finding));

  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"build", input.file, "-o", "out.obj"},
           {"relax", input.file, "-o", "out.h5", "--json", "out.json", "--render", "out.png"},
           {"render", input.file, "-o", "out.png"}}) {
    const CommandOutcome outcome = run_command(words, folder);
    EXPECT_EQ(outcome.status, 1) << words[0] << outcome.out << outcome.err;
    EXPECT_THAT(outcome.err, ContainsRegex(input.file + ":.*error: .*" + input.finding)) << words[0];
    EXPECT_THAT(folder.names(), ElementsAre(input.file)) << words[0];
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadInputTest,
    testing::Values(
        BadInput{"EmptyKnitout", "empty.k", "", ""}, BadInput{"EmptyFabricFile", "empty.verm", "", ""},
        BadInput{"NoiseAsKnitout", "noise.k", noise(), ""},
        BadInput{"NoiseAsFabricFile", "noise.verm", noise(), ""},
        BadInput{"UnknownSuffix", "noise.txt", noise(), ""},
        BadInput{"TruncatedKnitout", "cut.k", std::string(good_knitout).substr(0, 60), ""},
        BadInput{"TruncatedFabricFile", "cut.verm", ";!vermiculation-1\n;;Gauge: 7\n", ""},
        BadInput{"UnknownLetter", "letter.verm", ";!vermiculation-1\n;;Size: 4 wales x 4 courses\ngq\n", "q"},
        BadInput{"TooManyWales", "wide.verm", ";!vermiculation-1\n;;Size: 1000000000 wales x 24 courses\ng\n",
                 ""},
        BadInput{"NegativeLoopLength", "negative.verm",
                 ";!vermiculation-1\n;;Loop-Length: -6.2 mm\n;;Size: 4 wales x 4 courses\ng\n", ""},
        BadInput{"NeedleOutOfRange", "far.k",
                 ";!knitout-2\n;;Carriers: 1\nin 1\nknit + f1000000000 1\nout 1\n", ""},
        BadInput{"CarrierNotIn", "carrier.k", ";!knitout-2\n;;Carriers: 1 2\nin 1\nknit + f1 2\nout 1\n",
                 "2"}),
    [](const testing::TestParamInfo<BadInput>& one) { return one.param.name; });

TEST(BadInput, PlaceIsLineAndColumn) {
  const TemporaryFolder folder;
  folder.write("letter.verm", ";!vermiculation-1\n;;Size: 4 wales x 4 courses\ngq\n");
  const CommandOutcome outcome = run_command({"check", "letter.verm"}, folder);
  EXPECT_THAT(outcome.out, HasSubstr("letter.verm:3:2: error: "));
}

TEST(BadInput, MissingFileAndFolder) {
  const TemporaryFolder folder;
  for (const std::string& file : {std::string("missing.k"), std::string(".")}) {
    const CommandOutcome check = run_command({"check", file}, folder);
    EXPECT_EQ(check.status, 1);
    EXPECT_THAT(check.out, AllOf(HasSubstr(file), HasSubstr("error")));
    for (const std::string& command : {std::string("relax"), std::string("render"), std::string("build")}) {
      const std::string out = command == "render" ? "out.png" : "out.h5";
      const CommandOutcome outcome = run_command({command, file, "-o", out}, folder);
      EXPECT_EQ(outcome.status, 1) << command;
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(file), HasSubstr("error"))) << command;
    }
    const CommandOutcome measure = run_command({"measure", file}, folder);
    EXPECT_EQ(measure.status, 1);
    EXPECT_THAT(measure.err, AllOf(HasSubstr(file), HasSubstr("error")));
  }
  EXPECT_THAT(folder.names(), ElementsAre());
}

TEST(BadInput, MeasureWantsAState) {
  const TemporaryFolder folder;
  folder.write("noise.h5", noise());
  folder.write("empty.h5", "");
  folder.write("signature.h5", std::string("\x89HDF\r\n\x1a\n", 8));
  for (const std::string& file : folder.names()) {
    const CommandOutcome outcome = run_command({"measure", file}, folder);
    EXPECT_EQ(outcome.status, 1) << file;
    EXPECT_THAT(outcome.err, HasSubstr(file));
  }
}

TEST(BadInput, OneGoodFileDoesNotExcuseABadOne) {
  const TemporaryFolder folder;
  folder.write("good.k", good_knitout);
  EXPECT_EQ(run_command({"check", "good.k"}, folder).status, 0);
  EXPECT_EQ(run_command({"check", "good.k", "missing.k", "good.k"}, folder).status, 1);
}

TEST(BadInput, CommandLine) {
  const TemporaryFolder folder;
  folder.write("good.k", good_knitout);
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"relaxx"},
      {"check"},
      {"relax", "good.k"},
      {"relax", "good.k", "-o", "out.h5", "--window", "16"},
      {"relax", "good.k", "-o", "out.h5", "--window", "0x4"},
      {"relax", "good.k", "-o", "out.h5", "--window", "-3x4"},
      {"relax", "good.k", "-o", "out.h5", "--window", "4x4", "--periodic"},
      {"relax", "good.k", "-o", "out.h5", "--view", "sideways"},
      {"relax", "good.k", "-o", "out.h5", "--threads", "-1"},
      {"relax", "good.k", "-o", "out.unknown"},
      {"build", "good.k", "-o", "out"},
      {"relax", "good.k", "-o", "no/such/folder/out.h5"},
      {"render", "good.k", "-o", "out.png", "--picture-size", "0x100"},
      {"render", "good.k", "-o", "out.png", "--picture-size", "1000000x1000000"},
      {"render", "good.k", "-o", "out.h5"},
  };
  for (const auto& words : wrong) {
    const CommandOutcome outcome = run_command(words, folder);
    EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words);
    EXPECT_THAT(outcome.err + outcome.out, Not("")) << testing::PrintToString(words);
    EXPECT_THAT(folder.names(), ElementsAre("good.k")) << testing::PrintToString(words);
  }
}

TEST(Command, SaysItsVersionAndHelp) {
  const TemporaryFolder folder;
  const std::string said = run_command({"version"}, folder).out;
  EXPECT_THAT(said, ContainsRegex("^loopwright [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  for (const char* fact : {"\ncommit: ", "\ncompiler: ", "\nbuild type: ", "\nlibraries: Eigen 3.", "HDF5 1.",
                           "\nnumbers: double (64 bits)", "\nthreads: ", "\nlicence of this binary: "})
    EXPECT_THAT(said, HasSubstr(fact));
  EXPECT_EQ(run_command({"--version"}, folder).out, run_command({"version"}, folder).out);
  const CommandOutcome help = run_command({"--help"}, folder);
  EXPECT_EQ(help.status, 0);
  for (const char* word : {"check", "build", "relax", "render", "measure", "version"})
    EXPECT_THAT(help.out, HasSubstr(word));
}

}  // namespace
}  // namespace loopwright
