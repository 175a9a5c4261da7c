// Files of cloth, passes of knitout, cloth on its way, and what goes on from the cloth at hand.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "../cloth_file_job.hpp"
#include "../knitted_so_far.hpp"
#include "../scene_budget.hpp"
#include "../stretch_session.hpp"
#include "outputs/write_fabric.hpp"

namespace loopwright {
namespace {

constexpr const char* rib_headers =
    ";!vermiculation-1\n;;Gauge: 12\n;;Bed-Gap: 2 mm\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n"
    ";;Size: 6 wales x 6 courses\n;;Edges: held\n";

ClothRequest request_of(const std::string& text, const char* suffix = ".verm") {
  ClothRequest request;
  request.text = text, request.suffix = suffix, request.name = "test";
  return request;
}

ClothMoment last_of(const ClothRequest& request) {
  ClothMoment last;
  const std::atomic<bool> cancelled = false;
  make_cloth(request, cancelled, [&](ClothMoment moment) { last = std::move(moment); });
  return last;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const ClothMoment& rib() {
  static const ClothMoment moment = last_of(request_of(std::string(rib_headers) + "ge\n"));
  return moment;
}

ClothAtHand hand_of(const ClothMoment& moment) { return {moment.knitting, moment.relaxed, moment.options}; }

class CommandPiece : public testing::Test {
 protected:
  std::filesystem::path file(const char* name) const {
    return std::filesystem::temp_directory_path() / ("loopwright_view_" + std::string(name));
  }
};

// Friction makes rest depend on the way, so sizes agree as well as two ways do.
TEST(ClothAtHand, OtherYarnDataComeToTheSizesOfAFreshStart) {
  const std::string text = std::string(rib_headers) + "ge\n";
  const std::vector<std::pair<std::string, std::string>> edits{
      {"wool 2/28 Nm", "wool 2/28 Nm bend-stiffness=20 mN mm^2"},
      {"wool 2/28 Nm", "wool 2/28 Nm diameter=0.4mm"},
      {"Loop-Length: 5.9 mm", "Loop-Length: 6.2 mm"}};
  for (const auto& [from, to] : edits) {
    ClothRequest request = request_of(replaced(text, from, to));
    const ClothMoment fresh = last_of(request);
    ASSERT_EQ(fresh.stage, ClothStage::at_rest) << to << ": " << fresh.message;
    request.at_hand = hand_of(rib());
    const ClothMoment went_on = last_of(request);
    EXPECT_TRUE(went_on.went_on) << to;
    ASSERT_EQ(went_on.stage, ClothStage::at_rest) << to;
    EXPECT_EQ(went_on.interlacings.intact, went_on.interlacings.expected);
    EXPECT_FALSE(went_on.broken());
    EXPECT_NEAR(went_on.measured->width_mm, fresh.measured->width_mm, 0.03 * fresh.measured->width_mm) << to;
    EXPECT_NEAR(went_on.measured->height_mm, fresh.measured->height_mm, 0.03 * fresh.measured->height_mm)
        << to;
  }
}

TEST(ClothAtHand, TheSameYarnIsAtRestAlready) {
  ClothRequest request = request_of(std::string(";!vermiculation-1\n; a comment\n") +
                                    std::string(rib_headers).substr(18) + "ge\n");
  request.at_hand = hand_of(rib());
  const ClothMoment again = last_of(request);
  EXPECT_TRUE(again.went_on);
  EXPECT_EQ(again.stage, ClothStage::at_rest);
  EXPECT_LT(again.iterations, rib().iterations / 2 + 2);
}

TEST(ClothAtHand, OtherLoopsBeginAnew) {
  for (const char* courses : {"gg\n", "geg\n", "ge\neg\n"}) {
    ClothRequest request = request_of(std::string(rib_headers) + courses);
    request.at_hand = hand_of(rib());
    const ClothMoment moment = last_of(request);
    EXPECT_FALSE(moment.went_on) << courses;
    EXPECT_EQ(moment.stage, ClothStage::at_rest) << courses;
  }
}

TEST(StretchSession, ShearsAsTheTestOfTheCommand) {
  StretchSession session(*rib().relaxed, *rib().options, StretchDirection::shear);
  const StretchPoint by_hand = session.go_to(0.04);
  StretchTest test;
  test.direction = StretchDirection::shear;
  test.turning_points = {0.04};
  const StretchPoint wanted = stretch(*rib().relaxed, *rib().options, test).points.back();
  EXPECT_NEAR(by_hand.shear, wanted.shear, 1e-9);
  EXPECT_NEAR(by_hand.shear_force, wanted.shear_force, 0.02 * std::abs(wanted.shear_force));
  EXPECT_EQ(by_hand.interlacings_intact, by_hand.interlacings);
}

TEST_F(CommandPiece, AStateGoesOnToTheSameCloth) {
  State state = saved_state(*rib().relaxed, *rib().options, 1);
  state.texts[state_notation] = "ge\n";
  ClothRequest request;
  request.cloth_file = file("state.h5");
  write_fabric(request.cloth_file, state);
  const ClothMoment moment = last_of(request);
  std::filesystem::remove(request.cloth_file);
  ASSERT_EQ(moment.stage, ClothStage::at_rest) << moment.message;
  EXPECT_EQ(*moment.text, "ge\n");
  EXPECT_EQ(moment.interlacings.intact, 2);
  EXPECT_NEAR(moment.fabric->width, rib().fabric->width, 1e-3 * rib().fabric->width);
  // without what relaxing needs it is still looked at, and says so
  state.numbers.clear();
  write_fabric(request.cloth_file, state);
  const ClothMoment looked_at = last_of(request);
  std::filesystem::remove(request.cloth_file);
  EXPECT_EQ(looked_at.stage, ClothStage::as_saved);
  EXPECT_TRUE(looked_at.fabric && looked_at.measured && !looked_at.options);
  EXPECT_EQ(looked_at.diagnostics->warnings(), 1);
}

// What went wrong before the file was written is not forgotten.
TEST_F(CommandPiece, AStateOfYarnThatWentThroughYarnIsBroken) {
  State state = saved_state(*rib().relaxed, *rib().options, 1);
  state.numbers["pass_throughs"] = 2;
  ClothRequest request;
  request.cloth_file = file("crossed.h5");
  write_fabric(request.cloth_file, state);
  const ClothMoment moment = last_of(request);
  std::filesystem::remove(request.cloth_file);
  EXPECT_TRUE(moment.broken());
  EXPECT_FALSE(moment.measured);
}

std::string to_and_fro(int needles, int courses) {
  std::string text = ";!knitout-2\n;;Carriers: 1\nin 1\n";
  for (int course = 0; course < courses; ++course)
    for (int k = 0; k < needles; ++k)
      text += (course == 0 ? "tuck " : "knit ") + std::string(course % 2 == 0 ? "- f" : "+ f") +
              std::to_string(course % 2 == 0 ? needles - k : k + 1) + " 1\n";
  return text + "out 1\n";
}

TEST(KnitoutPasses, SayWhatEachPassTakesAndDoes) {
  Diagnostics diagnostics;
  const auto knitting =
      std::make_shared<const Knitting>(knit_text(request_of(to_and_fro(5, 8), ".k"), {}, diagnostics));
  ASSERT_TRUE(diagnostics.ok());
  const KnitoutPasses passes(knitting);
  ASSERT_EQ(passes.folds().size(), 8U);
  EXPECT_EQ(passes.folds()[0].first_line, 4);
  EXPECT_EQ(passes.folds()[0].last_line, 8);
  EXPECT_EQ(passes.folds()[1].label, "1 \u2192 5 knit");
  EXPECT_EQ(passes.acts(), 40);
  for (int act = 0; act < passes.acts(); ++act) {
    EXPECT_EQ(passes.place(act).line, act + 4);
    EXPECT_EQ(passes.pass_of(act), static_cast<std::size_t>(act / 5));
    EXPECT_EQ(passes.slot(act), act / 5 % 2 == 0 ? 5 - act % 5 : act % 5 + 1);
  }
  // pass by pass the same diagram
  const NeedleDiagram whole = needle_diagram(knitting->program);
  PassCache cache;
  for (std::size_t p = 0; p < whole.passes.size(); ++p) {
    const DiagramPass& pass = cache.pass(passes.diagram(), p);
    EXPECT_EQ(pass.course, whole.passes[p].course);
    for (std::size_t w = 0; w < pass.front.size(); ++w)
      EXPECT_EQ(pass.front[w].operation, whole.passes[p].front[w].operation);
  }
  for (std::size_t k = 0; k < 3 * PassCache::most_kept; ++k) cache.pass(passes.diagram(), k % 8);
  EXPECT_LE(cache.kept(), PassCache::most_kept);
}

TEST(KnittedSoFar, YarnGrowsWithTheInstructions) {
  ClothRequest request = request_of(to_and_fro(5, 8), ".k");
  request.most_loops = 0;
  const ClothMoment moment = last_of(request);
  ASSERT_TRUE(moment.fabric);
  const Fabric& fabric = *moment.fabric;
  const YarnScene scene = yarn_scene(fabric, {});
  double before = 0;
  std::uint32_t drawn_before = 0;
  for (int act = 0; act < moment.passes->acts(); ++act) {
    const int instruction = moment.passes->instruction(act);
    const std::vector<double> fed = fed_until(fabric, moment.knitting->graph, instruction);
    EXPECT_GT(fed[0], before);
    before = fed[0];
    // no loop of a later line is in it, each of an earlier one is
    for (const LoopSpan& span : fabric.loops)
      EXPECT_EQ(span.end <= fed[0] + 1e-9, span.at.line <= moment.passes->place(act).line);
    const auto runs = runs_until(scene, fabric, fed);
    ASSERT_TRUE(runs && runs->size() == 1);
    EXPECT_GT(runs->front().count, drawn_before);
    drawn_before = runs->front().count;
    EXPECT_LE(runs->front().first + runs->front().count, scene.indices.size());
  }
  EXPECT_EQ(drawn_before, scene.indices.size());
  EXPECT_FALSE(runs_until(scene, fabric, {}));
}

// A piece whose geometry takes many times as long stops at once.
TEST(ClothJob, FirstGeometryStops) {
  const ClothRequest request = request_of(to_and_fro(30, 600), ".k");
  using Clock = std::chrono::steady_clock;
  std::atomic<bool> cancelled = false;
  Clock::time_point told, knitted;
  ClothMoment last;
  make_cloth(request, cancelled, [&](ClothMoment moment) {
    last = std::move(moment);
    if (last.knitting && !last.fabric && !cancelled) {
      told = Clock::now();
      cancelled = true;
    }
  });
  const double waited = std::chrono::duration<double>(Clock::now() - told).count();
  ASSERT_TRUE(cancelled);
  EXPECT_EQ(last.stage, ClothStage::stopped);
  EXPECT_FALSE(last.fabric);
  EXPECT_LT(waited, 1.0);
}

TEST(SceneBudget, LargePiecesAreDrawnCoarser) {
  Fabric fabric = *rib().fabric;
  EXPECT_EQ(affordable_detail(fabric, 32, true), 32);
  EXPECT_EQ(sparse_fabric(fabric).every, 1);
  SceneOptions options;
  options.pixels_per_diameter = 16;
  options.look.fuzz = 0;
  const double vertices = static_cast<double>(yarn_scene(fabric, options).vertices.size());
  EXPECT_NEAR(vertices_of(fabric, 16), vertices, 0.25 * vertices);
  // a yarn of 10,000 loops
  FabricYarn& yarn = fabric.yarns[0];
  const std::vector<Vec3> once = yarn.control_points;
  while (yarn.control_points.size() < 120'000)
    yarn.control_points.insert(yarn.control_points.end(), once.begin(), once.end());
  for (const bool without_gpu : {true, false})
    EXPECT_LT(vertices_of(fabric, affordable_detail(fabric, 32, without_gpu)), 4.1e6);
  EXPECT_LT(affordable_detail(fabric, 32, true), affordable_detail(fabric, 32, false));
  EXPECT_FALSE(affords_occlusion(fabric, 8));
  const SparseFabric sparse = sparse_fabric(fabric);
  EXPECT_EQ(sparse.every, 3);
  EXPECT_LE(segments_of(sparse.fabric), 40'000U);
}

}  // namespace
}  // namespace loopwright
