// loopwright convert as a user meets it: what it writes is read again without an error, and what it cannot do
// it says, leaving nothing behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/run_command.hpp"

namespace loopwright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const char* const plain =
    ";!vermiculation-1\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n;;Size: 8 wales x 6 courses\ng\n";
const char* const plated =
    ";!vermiculation-1\n;;Yarn-A: wool 2/28 Nm\n;;Yarn-B: wool 2/28 Nm\n;;Size: 8 wales x 6 courses\nA+B: "
    "g\n";

TEST(ConvertCommand, WritesWhatItsMachineTakes) {
  for (const char* machine : {"shima", "kniterate"}) {
    const TemporaryFolder folder;
    folder.write("plain.verm", plain);
    const CommandOutcome done =
        run_command({"convert", "plain.verm", "-o", "plain.k", "--machine", machine}, folder);
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(done.err, "");
    EXPECT_THAT(done.out, HasSubstr("plain.k: 48 operations of the pattern, 8 needles cast on"));
    const CommandOutcome check = run_command({"check", "--machine", machine, "plain.k"}, folder);
    EXPECT_EQ(check.status, 0) << check.out;
    EXPECT_THAT(check.out, Not(HasSubstr("advice")));
    EXPECT_THAT(file_content(folder.file("plain.k")), HasSubstr(";;X-Loop-Length: 5.9 mm\n"));
    EXPECT_THAT(file_content(folder.file("plain.k")), HasSubstr(" ;!source: plain.verm:5:1\n"));
  }
}

TEST(ConvertCommand, TheOtherMachineDoesNotTakeIt) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  EXPECT_EQ(run_command({"convert", "plain.verm", "-o", "plain.k"}, folder).status, 0);
  const CommandOutcome check = run_command({"check", "--machine", "kniterate", "plain.k"}, folder);
  EXPECT_EQ(check.status, 1);
  EXPECT_THAT(check.out, HasSubstr("error: Kniterate: the Carriers header must be '1 2 3 4 5 6'"));
  EXPECT_THAT(check.out, HasSubstr("error: Kniterate: the machine has no yarn inserting hook"));
}

TEST(ConvertCommand, BindsOffWhenAsked) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  const CommandOutcome done = run_command({"convert", "plain.verm", "-o", "plain.k", "--bind-off"}, folder);
  EXPECT_EQ(done.status, 0) << done.err;
  const CommandOutcome check = run_command({"check", "plain.k", "--json", "-"}, folder);
  EXPECT_THAT(check.out, HasSubstr("\"unheld_loops\": 1,")) << "the tail's last loop alone";
}

TEST(ConvertCommand, WhatTheMachineCannotKnitIsNotWritten) {
  const TemporaryFolder folder;
  folder.write("plated.verm", plated);
  const CommandOutcome done =
      run_command({"convert", "plated.verm", "-o", "plated.k", "--machine", "kniterate"}, folder);
  EXPECT_EQ(done.status, 1);
  EXPECT_THAT(done.err, HasSubstr("error: Kniterate: a stitch takes at most 1 yarn, not 2"));
  EXPECT_THAT(done.err, HasSubstr("[source: plated.verm:5:6]"));
  EXPECT_THAT(folder.names(), ElementsAre("plated.verm"));
  EXPECT_EQ(run_command({"convert", "plated.verm", "-o", "plated.k"}, folder).status, 0);
}

TEST(ConvertCommand, KnitoutBecomesAFabricFileAndItsLossesAreTold) {
  const TemporaryFolder folder;
  folder.write("a.k",
               ";!knitout-2\n;;Carriers: A\nx-stitch-number 5\nin A\nknit + f1 A\nknit + f2 A\n"
               "knit - f2 A\nknit - f1 A\nout A\n");
  const CommandOutcome done = run_command({"convert", "a.k", "-o", "a.verm"}, folder);
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("a.k:3:1: warning: "));
  EXPECT_THAT(done.out, HasSubstr("1 thing could not be expressed"));
  EXPECT_EQ(run_command({"convert", "a.verm", "-o", "back.k"}, folder).status, 0);
}

TEST(ConvertCommand, KnitoutIsWrittenAnewInOneSpelling) {
  const TemporaryFolder folder;
  folder.write("a.k",
               ";!knitout-2\r\n;;Carriers: A\r\n\tin  A;\r\nrack +0\r\nknit + f1 A ; a remark\r\nout A\r\n");
  const CommandOutcome done = run_command({"convert", "a.k", "-o", "b.k"}, folder);
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(file_content(folder.file("b.k")),
            ";!knitout-2\n;;Carriers: A\nin A\nrack 0\nknit + f1 A\nout A\n");
  EXPECT_EQ(run_command({"convert", "a.k", "-o", "c.k", "--machine", "shima"}, folder).status, 1);
}

TEST(ConvertCommand, APieceThatIsTooWideIsNotWritten) {
  const TemporaryFolder folder;
  folder.write("wide.verm", ";!vermiculation-1\n;;Size: 253 wales x 2 courses\ng\n");
  const CommandOutcome done =
      run_command({"convert", "wide.verm", "-o", "wide.k", "--machine", "kniterate"}, folder);
  EXPECT_EQ(done.status, 1);
  EXPECT_THAT(done.err, HasSubstr("the piece takes 253 needles, the bed has 252"));
  EXPECT_THAT(folder.names(), ElementsAre("wide.verm"));
  EXPECT_EQ(run_command({"convert", "wide.verm", "-o", "wide.k"}, folder).status, 0);
}

TEST(ConvertCommand, RefusesWhatMakesNoSense) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  folder.write("wrong.k", ";!knitout-2\n;;Carriers: A\nin A\nknit + f1 A\n");
  const std::vector<std::vector<std::string>> wrong{
      {"convert", "plain.verm", "-o", "plain.obj"},
      {"convert", "plain.verm", "-o", "again.verm"},
      {"convert", "missing.verm", "-o", "x.k"},
      {"convert", "wrong.k", "-o", "x.verm"},
      {"convert", "plain.verm", "-o", "x.k", "--machine", "stoll"},
      {"convert", "plain.verm", "-o", "no_such_folder/x.k"}};
  for (const std::vector<std::string>& words : wrong) {
    const CommandOutcome done = run_command(words, folder);
    EXPECT_NE(done.status, 0) << words.back();
    EXPECT_NE(done.err, "") << words.back();
    EXPECT_THAT(folder.names(), ElementsAre("plain.verm", "wrong.k"));
  }
}

}  // namespace
}  // namespace loopwright
