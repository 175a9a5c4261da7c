// loopwright homogenise, sensitivity and --modes, from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pipeline/run_command.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const char* const garter =
    ";!vermiculation-1\n;;Gauge: 12\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n"
    ";;Size: 1 wales x 2 courses\n;;Edges: periodic\ng\ne\n";

TEST(HomogeniseCommand, WritesConstantsGridAndPlot) {
  const TemporaryFolder folder;
  folder.write("garter.verm", garter);
  const CommandOutcome outcome =
      run_command({"homogenise", "garter.verm", "--course", "0.05", "--wale", "-0.05", "0.05", "--shear",
                   "0.05", "--csv", "g.csv", "--json", "g.json", "--plot", "g.svg", "--segments", "12"},
                  folder);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Poisson"));
  const std::string csv = file_content(folder.file("g.csv"));
  EXPECT_THAT(csv, StartsWith("course_strain,wale_strain,shear,course_force_N_m"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 3 * 2);
  for (const char* key : {"\"stiffness_N_m\"", "\"course_poisson\"", "\"wale_pull\"", "\"law\"", "\"error\""})
    EXPECT_THAT(file_content(folder.file("g.json")), HasSubstr(key));
  EXPECT_THAT(file_content(folder.file("g.svg")), HasSubstr("along the wales, law"));
}

TEST(HomogeniseCommand, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  folder.write("nameless.verm",
               ";!vermiculation-1\n;;Gauge: 12\n;;Loop-Length: 5.9 mm\n;;Edges: periodic\ng\n");
  const CommandOutcome nameless = run_command({"homogenise", "nameless.verm"}, folder);
  EXPECT_EQ(nameless.status, 1);
  EXPECT_THAT(nameless.err, HasSubstr("bend stiffness"));
  folder.write("garter.verm", garter);
  EXPECT_EQ(run_command({"homogenise", "garter.verm", "--csv", "-", "--json", "-"}, folder).status, 1);
  const CommandOutcome crushed =
      run_command({"homogenise", "garter.verm", "--course", "-0.95", "--csv", "a.csv"}, folder);
  EXPECT_EQ(crushed.status, 1);
  EXPECT_THAT(crushed.err, HasSubstr("strains must"));
  EXPECT_THAT(folder.names(), testing::UnorderedElementsAre("garter.verm", "nameless.verm"));
}

TEST(SensitivityCommand, PrintsATableAndDeviations) {
  const TemporaryFolder folder;
  folder.write("garter.verm", garter);
  const CommandOutcome outcome = run_command(
      {"sensitivity", "garter.verm", "--segments", "12", "--deviation", "loop-length=2", "--csv", "s.csv"},
      folder);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("standard deviation of width"));
  EXPECT_THAT(file_content(folder.file("s.csv")), HasSubstr("\nshell-exponent,"));
  for (const char* bad : {"loop-length=-2", "colour=2", "loop-length", "diameter=x"}) {
    const CommandOutcome refused = run_command({"sensitivity", "garter.verm", "--deviation", bad}, folder);
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("KEY=PERCENT"));
  }
}

TEST(ModesOption, SaysWhetherClothIsStable) {
  const TemporaryFolder folder;
  folder.write("plain.verm",
               ";!vermiculation-1\n;;Gauge: 12\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n"
               ";;Size: 1 wales x 1 courses\n;;Edges: periodic\ng\n");
  const CommandOutcome relaxed = run_command(
      {"relax", "plain.verm", "--friction", "0", "-o", "p.h5", "--modes", "3", "--json", "-"}, folder);
  ASSERT_EQ(relaxed.status, 0) << relaxed.err;
  EXPECT_THAT(relaxed.out, HasSubstr("\"stable\": true"));
  EXPECT_THAT(relaxed.out, HasSubstr("\"lambda_B_d4\""));
  const CommandOutcome measured = run_command({"measure", "p.h5", "--modes", "2"}, folder);
  EXPECT_EQ(measured.status, 0) << measured.err;
  EXPECT_THAT(measured.out, HasSubstr("stable without friction"));
}

// A rib swatch lies as flat without plates as between them.
TEST(LetGo, SaysHowThePieceBends) {
  const TemporaryFolder folder;
  folder.write(
      "rib.verm",
      ";!vermiculation-1\n;;Gauge: 10\n;;Bed-Gap: 2 mm\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 7.4 mm\n"
      ";;Size: 6 wales x 6 courses\n;;Edges: free\nge\n");
  const CommandOutcome outcome = run_command(
      {"relax", "rib.verm", "--friction", "0.4", "--let-go", "-o", "r.h5", "--json", "-"}, folder);
  EXPECT_THAT(outcome.out, HasSubstr("\"wale_curvature_per_mm\": "));
  EXPECT_THAT(outcome.err, HasSubstr("curvature along courses"));
  const std::string key = "\"course_curvature_per_mm\": ";
  ASSERT_NE(outcome.out.find(key), std::string::npos);
  EXPECT_LT(std::abs(std::stod(outcome.out.substr(outcome.out.find(key) + key.size()))), 0.1);
}

}  // namespace
}  // namespace loopwright
