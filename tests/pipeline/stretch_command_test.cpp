// loopwright stretch, from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "outputs/state.hpp"
#include "pipeline/run_command.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const char* const plain =
    ";!vermiculation-1\n;;Gauge: 12\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n"
    ";;Size: 1 wales x 1 courses\n;;Edges: periodic\ng\n";

TEST(StretchCommand, WritesPointsPlotAndState) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  const CommandOutcome outcome =
      run_command({"stretch", "plain.verm", "--direction", "wale", "--to", "0.1", "0", "--step", "0.05",
                   "--csv", "p.csv", "--plot", "p.svg", "-o", "p.h5"},
                  folder);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("5 points"));
  std::istringstream csv(file_content(folder.file("p.csv")));
  std::string line;
  int lines = 0;
  std::getline(csv, line);
  EXPECT_THAT(line, StartsWith("course_strain,wale_strain,shear,course_force_N_m,wale_force_N_m"));
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 5);
  EXPECT_THAT(file_content(folder.file("p.svg")), HasSubstr("along the wales"));
  EXPECT_EQ(read_state(folder.file("p.h5")).fabric.loops.size(), 1U);
  // a saved state knows its yarn and can be stretched again
  const CommandOutcome again = run_command({"stretch", "p.h5", "--to", "0.02", "--csv", "-"}, folder);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, StartsWith("course_strain,"));
}

TEST(StretchCommand, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  EXPECT_THAT(run_command({"stretch", "plain.verm"}, folder).err, HasSubstr("--csv FILE"));
  EXPECT_THAT(run_command({"stretch", "plain.verm", "--to", "-0.95", "--csv", "a.csv"}, folder).err,
              HasSubstr("a strain must lie between"));
  folder.write("nameless.verm",
               ";!vermiculation-1\n;;Gauge: 12\n;;Loop-Length: 5.9 mm\n;;Edges: periodic\ng\n");
  const CommandOutcome nameless = run_command({"stretch", "nameless.verm", "--csv", "a.csv"}, folder);
  EXPECT_EQ(nameless.status, 1);
  EXPECT_THAT(nameless.err, HasSubstr("bend stiffness"));
  EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("plain.verm", "nameless.verm"));
}

}  // namespace
}  // namespace loopwright
