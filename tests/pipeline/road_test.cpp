// From a notation to relaxed cloth with the built command, checked from outside: files, JSON, exit status.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "outputs/state.hpp"
#include "pipeline/run_command.hpp"

namespace loopwright {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const char* const plain =
    ";!vermiculation-1\n"
    ";;Name: plain\n;;Gauge: 12\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n"
    ";;Size: 6 wales x 5 courses\n;;Edges: held\n"
    "g\n";

const char* const moss =
    ";!vermiculation-1\n"
    ";;Gauge: 12\n;;Bed-Gap: 2 mm\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n"
    ";;Size: 6 wales x 6 courses\n;;Edges: periodic\n"
    "ge\neg\n";

nlohmann::json json_of(const std::string& text) { return nlohmann::json::parse(text); }

// The relaxed plain cell: every key is there, and the numbers agree with each other and with the file.
TEST(Road, PeriodicCellRelaxesAndIsMeasured) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  const CommandOutcome outcome =
      run_command({"relax", "plain.verm", "--periodic", "-o", "plain.h5", "--json", "-"}, folder);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json j = json_of(outcome.out);
  for (const char* key : {"loops",
                          "yarns",
                          "width_mm",
                          "height_mm",
                          "thickness_mm",
                          "wale_spacing_mm",
                          "course_spacing_mm",
                          "loop_length_mm",
                          "mass_g",
                          "Kc",
                          "Kw",
                          "Ks",
                          "newton_iterations",
                          "linear_iterations",
                          "spot_iterations",
                          "residual",
                          "converged",
                          "interlacings",
                          "interlacings_intact",
                          "pass_throughs",
                          "min_clearance",
                          "areal_density_g_m2",
                          "courses_per_cm",
                          "wales_per_cm",
                          "yarn_m",
                          "cover_factor",
                          "wall_s",
                          "peak_memory_mb"})
    EXPECT_TRUE(j.contains(key)) << key;
  EXPECT_EQ(j["converged"], true);
  EXPECT_LT(j["residual"], 2e-4);
  EXPECT_EQ(j["interlacings"], j["interlacings_intact"]);
  EXPECT_GT(j["interlacings"], 0);
  EXPECT_EQ(j["pass_throughs"], 0);
  // yarn barely stretches: the loop keeps the length that the file states
  EXPECT_NEAR(j["loop_length_mm"], 5.9, 0.02 * 5.9);
  // Munden (1959): dry relaxed 5.0 and 3.8, wet relaxed 5.3 and 4.1, fully relaxed 5.5 and 4.2
  EXPECT_GT(j["Kc"], 4.9);
  EXPECT_LT(j["Kc"], 5.6);
  EXPECT_GT(j["Kw"], 3.7);
  EXPECT_LT(j["Kw"], 4.3);
  // 71 tex, 5.9 mm a loop
  const double loops = j["loops"];
  EXPECT_NEAR(j["mass_g"], loops * 71e-6 * 5.9, 1e-3 * loops * 71e-6 * 5.9);
  EXPECT_NEAR(j["areal_density_g_m2"],
              j["mass_g"].get<double>() * 1e6 / (j["width_mm"].get<double>() * j["height_mm"].get<double>()),
              1e-6);
  EXPECT_THAT(folder.names(), ElementsAre("plain.h5", "plain.verm"));

  // the saved state measures the same
  const CommandOutcome measured = run_command({"measure", "plain.h5", "--json", "-"}, folder);
  ASSERT_EQ(measured.status, 0) << measured.err;
  const nlohmann::json again = json_of(measured.out);
  for (const char* key : {"width_mm", "Kc", "Kw", "mass_g", "residual", "converged", "pass_throughs",
                          "interlacings_intact", "newton_iterations"})
    EXPECT_EQ(again[key], j[key]) << key;
}

TEST(Road, PeriodicCellOfKnitoutIsItsRepeat) {
  // 1x1 rib without a word about its repeat: the same cell as that of the letters "ge".
  std::string rib = ";!knitout-2\n;;Carriers: 1\n;;Gauge: 12\n;;X-Loop-Length: 5.9 mm\nin 1\n";
  constexpr int wales = 16;
  const auto course = [&rib](bool right, const char* op) {
    for (int k = 0; k < wales; ++k) {
      const int w = right ? k : wales - 1 - k;
      rib +=
          std::string(op) + (right ? " + " : " - ") + (w % 2 == 0 ? 'f' : 'b') + std::to_string(w) + " 1\n";
    }
  };
  course(true, "tuck");
  for (int c = 0; c < 12; ++c) course(c % 2 == 1, "knit");
  rib += "out 1\n";
  const TemporaryFolder folder;
  folder.write("rib.k", rib);
  folder.write("rib.verm", ";!vermiculation-1\n;;Gauge: 12\n;;Loop-Length: 5.9 mm\n;;Edges: periodic\nge\n");
  const CommandOutcome knitout =
      run_command({"relax", "rib.k", "--periodic", "-o", "k.h5", "--json", "-"}, folder);
  ASSERT_EQ(knitout.status, 0) << knitout.err;
  const CommandOutcome letters = run_command({"relax", "rib.verm", "-o", "v.h5", "--json", "-"}, folder);
  ASSERT_EQ(letters.status, 0) << letters.err;
  const nlohmann::json k = json_of(knitout.out), v = json_of(letters.out);
  EXPECT_EQ(k["loops"], 2);
  EXPECT_EQ(k["interlacings_intact"], 2);
  EXPECT_EQ(k["pass_throughs"], 0);
  EXPECT_NEAR(k["loop_length_mm"].get<double>(), v["loop_length_mm"].get<double>(), 1e-3);
  // Friction lets a rib come to rest over a range of widths; the way to it is the same, its rounding not.
  EXPECT_NEAR(k["width_mm"].get<double>(), v["width_mm"].get<double>(), 0.02 * v["width_mm"].get<double>());
  EXPECT_NEAR(k["height_mm"].get<double>(), v["height_mm"].get<double>(),
              0.02 * v["height_mm"].get<double>());
}

TEST(Road, WindowHasTheWalesAndCoursesAskedFor) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  for (const auto& [window, wales, courses] : {std::tuple("4x3", 4, 3), std::tuple("2x4", 2, 4)}) {
    const CommandOutcome outcome =
        run_command({"build", "plain.verm", "-o", "w.h5", "--json", "-", "--window", window}, folder);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json j = json_of(outcome.out);
    EXPECT_EQ(j["wales"], wales) << window;
    EXPECT_EQ(j["courses"], courses) << window;
    EXPECT_EQ(j["loops"], wales * courses) << window;
  }
}

TEST(Road, FileSizeIsKeptWithHeldEdges) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  const CommandOutcome outcome =
      run_command({"relax", "plain.verm", "-o", "p.h5", "--json", "p.json"}, folder);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json j = json_of(file_content(folder.file("p.json")));
  EXPECT_EQ(j["loops"], 30);
  EXPECT_EQ(j["converged"], true);
  EXPECT_THAT(outcome.out, AllOf(StartsWith("plain.verm: 30 loops, "), HasSubstr("interlacings intact")));
}

TEST(Road, ResultsDoNotDependOnThreads) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  for (const char* threads : {"1", "3"})
    ASSERT_EQ(
        run_command({"relax", "plain.verm", "-o", std::string(threads) + ".h5", "--threads", threads}, folder)
            .status,
        0);
  EXPECT_EQ(file_content(folder.file("1.h5")), file_content(folder.file("3.h5")));
}

// Stopped after a few steps, while the yarn grows in or later, saved, gone on with: the same equilibrium as
// in one go.
TEST(Road, SavedStateIsGoneOnWith) {
  const TemporaryFolder folder;
  folder.write("moss.verm", moss);
  ASSERT_EQ(run_command({"relax", "moss.verm", "-o", "whole.h5"}, folder).status, 0);
  const State whole = read_state(folder.file("whole.h5"));
  for (const char* steps : {"1", "5", "30"}) {
    const CommandOutcome cut = run_command(
        {"relax", "moss.verm", "-o", "part.h5", "--most-iterations", steps, "--json", "-"}, folder);
    ASSERT_EQ(cut.status, 0) << cut.err;
    EXPECT_EQ(json_of(cut.out)["converged"], false);
    EXPECT_THAT(cut.err, HasSubstr("warning: not at rest"));
    const CommandOutcome rest = run_command({"relax", "part.h5", "-o", "part.h5", "--json", "-"}, folder);
    ASSERT_EQ(rest.status, 0) << rest.err;
    const nlohmann::json j = json_of(rest.out);
    EXPECT_EQ(j["converged"], true) << steps;
    EXPECT_GT(j["newton_iterations"], std::stoi(steps));
    const State part = read_state(folder.file("part.h5"));
    EXPECT_NEAR(part.fabric.width, whole.fabric.width, 0.01 * whole.fabric.width) << steps;
    EXPECT_NEAR(part.fabric.height, whole.fabric.height, 0.01 * whole.fabric.height) << steps;
  }
}

// What friction holds, it holds in the saved state as well: at rest before the first step. Without its
// history the same cloth moves.
TEST(Road, RestHeldByFrictionIsRestWhenGoneOnWith) {
  const TemporaryFolder folder;
  folder.write("moss.verm", moss);
  ASSERT_EQ(
      run_command({"relax", "moss.verm", "--periodic", "--friction", "0.3", "-o", "a.h5"}, folder).status, 0);
  ASSERT_EQ(run_command({"relax", "a.h5", "-o", "b.h5"}, folder).status, 0);
  State first = read_state(folder.file("a.h5"));
  ASSERT_FALSE(first.history.empty());
  const State second = read_state(folder.file("b.h5"));
  EXPECT_EQ(second.numbers.at("newton_iterations"), first.numbers.at("newton_iterations"));
  EXPECT_NEAR(second.fabric.height, first.fabric.height, 1e-9 * first.fabric.height);
  first.history.clear();
  write_state(folder.file("forgot.h5"), first);
  ASSERT_EQ(run_command({"relax", "forgot.h5", "-o", "c.h5"}, folder).status, 0);
  EXPECT_GT(read_state(folder.file("c.h5")).numbers.at("newton_iterations"),
            first.numbers.at("newton_iterations"));
}

// A finite piece that is gone on with lies between the plates of its first run, not between new ones round
// what the first run left.
TEST(Road, APieceThatIsGoneOnWithKeepsItsPlates) {
  const TemporaryFolder folder;
  folder.write("held.verm", plain);
  ASSERT_EQ(run_command({"relax", "held.verm", "-o", "a.h5", "--most-iterations", "3"}, folder).status, 0);
  ASSERT_EQ(run_command({"relax", "a.h5", "-o", "b.h5", "--most-iterations", "3"}, folder).status, 0);
  const State first = read_state(folder.file("a.h5")), second = read_state(folder.file("b.h5"));
  EXPECT_GT(first.numbers.at("plate_stiffness"), 0);
  EXPECT_LT(first.numbers.at("plate_low"), first.numbers.at("plate_high"));
  for (const char* number : {"plate_stiffness", "plate_low", "plate_high"})
    EXPECT_EQ(second.numbers.at(number), first.numbers.at(number)) << number;
}

TEST(Road, InterruptedRunIsSavedAndSaysSo) {
  const TemporaryFolder folder;
  std::string large = plain;
  large.replace(large.find("6 wales x 5"), 11, "60 wales x 60");
  folder.write("large.verm", large);
  const CommandOutcome outcome =
      run_command({"relax", "large.verm", "-o", "large.h5", "--render", "large.png"}, folder, 2.5);
  ASSERT_EQ(outcome.status, 130) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("stopped"), HasSubstr("large.h5")));
  EXPECT_THAT(folder.names(), ElementsAre("large.h5", "large.verm"));
  EXPECT_EQ(read_state(folder.file("large.h5")).fabric.loops.size(), 3600U);
}

TEST(Road, JammedYarnIsSaid) {
  const TemporaryFolder folder;
  const auto relaxed = [&](const std::string& loop_mm) {
    folder.write("tight.verm", ";!vermiculation-1\n;;Yarn-A: diameter=1 mm\n;;Loop-Length: " + loop_mm +
                                   " mm\n;;Edges: periodic\ng\n");
    return run_command({"relax", "tight.verm", "-o", "tight.h5"}, folder);
  };
  const CommandOutcome jammed = relaxed("12"), loose = relaxed("17");
  EXPECT_EQ(jammed.status, 0) << jammed.err;
  EXPECT_THAT(jammed.err, HasSubstr("tight.verm: warning: jammed: at rest the yarn is stretched by 1"));
  EXPECT_THAT(loose.err, Not(HasSubstr("jammed")));
}

TEST(Road, PicturesAreWrittenOfNotationAndState) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  ASSERT_EQ(run_command({"build", "plain.verm", "-o", "p.h5"}, folder).status, 0);
  for (const char* view : {"front", "back", "left", "top", "corner"})
    for (const char* file : {"plain.verm", "p.h5"}) {
      const std::string png = std::string(view) + file + ".png";
      const CommandOutcome outcome =
          run_command({"render", file, "-o", png, "--view", view, "--picture-size", "160x120"}, folder);
      if (outcome.err.find("OpenGL") != std::string::npos) GTEST_SKIP() << "no OpenGL here: " << outcome.err;
      ASSERT_EQ(outcome.status, 0) << outcome.err;
    }
  // the same fabric, so the same picture; another view, another picture
  EXPECT_EQ(file_content(folder.file("frontplain.verm.png")), file_content(folder.file("frontp.h5.png")));
  EXPECT_NE(file_content(folder.file("frontp.h5.png")), file_content(folder.file("backp.h5.png")));
}

TEST(Road, CheckGivesItsFindingsAsJson) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  folder.write("bad.verm", std::string(plain) + "gq\n");
  const CommandOutcome outcome = run_command({"check", "plain.verm", "bad.verm", "--json", "-"}, folder);
  EXPECT_EQ(outcome.status, 1);
  const nlohmann::json files = json_of(outcome.out)["files"];
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0]["errors"], 0);
  EXPECT_GT(files[0]["loops"], 0);
  EXPECT_EQ(files[1]["file"], "bad.verm");
  EXPECT_EQ(files[1]["errors"], 1);
  EXPECT_EQ(files[1]["diagnostics"][0]["line"], 9);
  EXPECT_EQ(files[1]["diagnostics"][0]["severity"], "error");
}

TEST(Road, OutputThatCannotBeWrittenIsAnError) {
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  const CommandOutcome outcome =
      run_command({"relax", "plain.verm", "--periodic", "-o", "p.h5", "--json", "missing/p.json"}, folder);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("missing/p.json"));
  EXPECT_THAT(folder.names(), ElementsAre("plain.verm"));
}

}  // namespace
}  // namespace loopwright
