// What stands behind the window: cloth from a text, stretching, choosing and pulling.
#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "../cloth_colours.hpp"
#include "../cloth_job.hpp"
#include "../loop_motion.hpp"
#include "../orbit.hpp"
#include "../picking.hpp"
#include "../pull_session.hpp"
#include "../stretch_session.hpp"
#include "outputs/yarn_scene.hpp"
#include "piece.hpp"

namespace loopwright {
namespace {

constexpr const char* header =
    ";!vermiculation-1\n;;Gauge: 12\n;;Bed-Gap: 2 mm\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n"
    ";;Size: 6 wales x 6 courses\n;;Edges: held\n";

ClothRequest request_of(const std::string& courses) {
  ClothRequest request;
  request.text = header + courses;
  request.suffix = ".verm";
  request.name = "test.verm";
  return request;
}

std::vector<ClothMoment> moments_of(const ClothRequest& request) {
  std::vector<ClothMoment> moments;
  const std::atomic<bool> cancelled = false;
  make_cloth(request, cancelled, [&](ClothMoment moment) { moments.push_back(std::move(moment)); });
  return moments;
}

TEST(ClothJob, GoesFromTheTextOverTheFirstGeometryToRest) {
  const std::vector<ClothMoment> moments = moments_of(request_of("ge\n"));
  ASSERT_GE(moments.size(), 3U);
  EXPECT_EQ(moments.front().stage, ClothStage::reading);
  EXPECT_EQ(moments[1].stage, ClothStage::as_knitted);
  const ClothMoment& last = moments.back();
  EXPECT_EQ(last.stage, ClothStage::at_rest);
  ASSERT_TRUE(last.relaxed && last.fabric && last.options);
  EXPECT_TRUE(last.fabric->periodic);
  EXPECT_EQ(last.interlacings.intact, 2);
  EXPECT_EQ(last.interlacings.expected, 2);
  EXPECT_FALSE(last.broken());
  // the cell of the command `relax --periodic`
  FabricOptions as_cell;
  as_cell.edges = Edges::periodic;
  Diagnostics diagnostics;
  PieceRequest periodic;
  periodic.periodic = true;
  const Knitting knitting = knit_text(request_of("ge\n"), as_cell, diagnostics);
  const RelaxRun command = run_relax(first_piece(knitting, periodic), false);
  EXPECT_NEAR(last.fabric->width, command.result.fabric.width, 1e-3 * last.fabric->width);
  EXPECT_NEAR(last.fabric->height, command.result.fabric.height, 1e-3 * last.fabric->height);
}

TEST(ClothJob, ErrorsLeaveNoCloth) {
  const std::vector<ClothMoment> moments = moments_of(request_of("gq\n"));
  ASSERT_EQ(moments.size(), 1U);
  EXPECT_EQ(moments.back().stage, ClothStage::unusable);
  EXPECT_FALSE(moments.back().fabric);
  EXPECT_EQ(moments.back().diagnostics->list().front().at.line, 8);
  EXPECT_EQ(moments_of(request_of("")).back().stage, ClothStage::unusable);
}

TEST(ClothJob, StopsWithinAStepAndShowsWhatWasReached) {
  std::atomic<bool> cancelled = false;
  ClothMoment last;
  make_cloth(request_of("ggee\neegg\n"), cancelled, [&](ClothMoment moment) {
    last = std::move(moment);
    if (last.stage == ClothStage::growing || last.stage == ClothStage::relaxing) cancelled = true;
  });
  EXPECT_TRUE(cancelled);
  EXPECT_EQ(last.stage, ClothStage::stopped);
  EXPECT_TRUE(last.fabric);
}

TEST(ClothJob, LargePiecesWaitToBeAsked) {
  ClothRequest request = request_of("ge\n");
  request.piece = PieceChoice::whole;
  request.most_loops = 10;
  EXPECT_EQ(moments_of(request).back().stage, ClothStage::as_knitted);
}

TEST(ClothMoment, IsBrokenWhereAnInterlacingIsLostOrYarnPassedThroughYarn) {
  ClothMoment moment;
  moment.interlacings.expected = 4, moment.interlacings.intact = 4;
  EXPECT_FALSE(moment.broken());
  moment.interlacings.intact = 3;
  EXPECT_TRUE(moment.broken());
  moment.interlacings.intact = 4;
  RelaxResult result;
  result.pass_throughs = 1;
  moment.relaxed = std::make_shared<const RelaxResult>(result);
  EXPECT_TRUE(moment.broken());
}

TEST(StretchSession, FollowsTheStretchTestOfTheCommand) {
  const ClothMoment cloth = moments_of(request_of("g\n")).back();
  ASSERT_TRUE(cloth.relaxed);
  StretchSession session(*cloth.relaxed, *cloth.options, StretchDirection::course);
  const StretchPoint by_hand = session.go_to(0.06);
  StretchTest test;
  test.turning_points = {0.06};
  const StretchResult by_test = stretch(*cloth.relaxed, *cloth.options, test);
  const StretchPoint& wanted = by_test.points.back();
  EXPECT_NEAR(by_hand.course_strain, wanted.course_strain, 1e-9);
  EXPECT_NEAR(by_hand.course_force, wanted.course_force, 0.02 * std::abs(wanted.course_force));
  EXPECT_NEAR(by_hand.wale_strain, wanted.wale_strain, 2e-3);
  EXPECT_EQ(by_hand.interlacings_intact, by_hand.interlacings);
  // and back: nearly the size that it had
  EXPECT_NEAR(session.go_to(0).course_strain, 0, 1e-9);
}

TEST(PullSession, ALoopFollowsTheForceAndComesBack) {
  const ClothMoment cloth = moments_of(request_of("g\n")).back();
  ASSERT_TRUE(cloth.relaxed);
  const Fabric& rest = cloth.relaxed->fabric;
  const LoopSpan& span = rest.loops.front();
  const auto head = [&](const Fabric& fabric) {
    return position(fabric, fabric.yarns[static_cast<std::size_t>(span.yarn)], span.apex);
  };
  PullSession session(*cloth.relaxed, *cloth.options, span.yarn, span.apex);
  ASSERT_TRUE(session.pull({0, 0, 1}));
  const RelaxResult& pulled = session.reached();
  EXPECT_TRUE(pulled.converged) << pulled.message;
  EXPECT_EQ(pulled.pass_throughs, 0);
  const double once = (head(pulled.fabric) - head(rest)).z;
  EXPECT_GT(once, 0.01);
  ASSERT_TRUE(session.pull({0, 0, 2}));
  EXPECT_GT((head(session.reached().fabric) - head(rest)).z, once) << "more force, more way";
  EXPECT_EQ(check_interlacings(session.reached().fabric).intact, 1);
  ASSERT_TRUE(session.pull({}));
  EXPECT_LT(std::abs((head(session.reached().fabric) - head(rest)).z), once) << "friction keeps the rest";
}

TEST(Picking, FindsTheLoopUnderTheMouse) {
  const ClothMoment cloth = moments_of(request_of("ge\n")).back();
  ASSERT_TRUE(cloth.fabric);
  const Fabric& fabric = *cloth.fabric;
  const Camera camera = fitted_camera(View::front, fabric_bounds(fabric, {3, 3}), 1.5);
  for (std::size_t i = 0; i < fabric.loops.size(); ++i) {
    const LoopSpan& span = fabric.loops[i];
    if (span.side != StitchSide::front) continue;  // rear loops lie behind
    const Vec3 head =
        position(fabric, fabric.yarns[static_cast<std::size_t>(span.yarn)], span.apex) + fabric.lattice(1, 1);
    const Vec3 away = head - camera.target;
    const Sight sight = line_of_sight(camera, 1.5, dot(away, camera.right()) / (camera.height / 2 * 1.5),
                                      dot(away, camera.up) / (camera.height / 2));
    const auto picked = yarn_at(fabric, {3, 3}, sight);
    ASSERT_TRUE(picked);
    EXPECT_LT(distance(picked->place, head), 2.5);
    EXPECT_GE(picked->loop, 0);
  }
  EXPECT_FALSE(yarn_at(fabric, {3, 3}, line_of_sight(camera, 1.5, 0.999, 0.999)));
}

TEST(Picking, ALineOfSightOfAPerspectiveCameraStartsAtTheEye) {
  Camera camera;
  camera.field_of_view_deg = 18;
  const Sight sight = line_of_sight(camera, 2, 0, 1);
  EXPECT_NEAR(sight.from.z, camera.eye_distance(), 1e-12);
  // through the top of the picture at the target
  const double along = sight.from.z / -sight.direction.z;
  EXPECT_NEAR((sight.from + sight.direction * along).y, camera.height / 2, 1e-9);
}

TEST(Colours, EverySegmentHasOneAndTheChosenLoopStandsOut) {
  const ClothMoment cloth = moments_of(request_of("ge\n")).back();
  ASSERT_TRUE(cloth.fabric);
  for (const ColourBy by : {ColourBy::tension, ColourBy::curvature, ColourBy::contact, ColourBy::loop_kind}) {
    const ClothColours colours = cloth_colours(*cloth.fabric, cloth.options->model, by, {0});
    ASSERT_EQ(colours.segments.size(), cloth.fabric->yarns.size());
    for (std::size_t y = 0; y < colours.segments.size(); ++y)
      EXPECT_EQ(static_cast<int>(colours.segments[y].size()), cloth.fabric->yarns[y].segments());
    EXPECT_GE(colours.legend.size(), 2U);
    const LoopSpan& span = cloth.fabric->loops[0];
    const int segments = cloth.fabric->yarns[0].segments();
    const auto e = static_cast<std::size_t>((static_cast<int>(span.apex) % segments + segments) % segments);
    EXPECT_EQ(colours.segments[0][e], (Rgb{235, 60, 40}));
  }
}

TEST(Colours, CurvatureIsThatOfACircle) {
  // control points on a circle of radius 5, closed
  Fabric fabric;
  FabricYarn yarn;
  yarn.periodic = true;
  constexpr int points = 40;
  for (int k = 0; k < points; ++k)
    yarn.control_points.push_back(
        {5 * std::cos(2 * M_PI * k / points), 5 * std::sin(2 * M_PI * k / points), 0});
  fabric.yarns.push_back(yarn);
  for (const double curvature : segment_curvature(fabric, fabric.yarns[0]))
    EXPECT_NEAR(curvature, 0.2, 0.002);
}

TEST(LoopMotion, APulledPointComesBackWhenLetGo) {
  ClothRequest request = request_of("g\n");
  Diagnostics diagnostics;
  LoopMotion motion(knit_text(request, {}, diagnostics), {});
  const auto settle_it = [&motion] {
    for (int k = 0; k < 4000 && motion.advance(50); ++k) {
    }
  };
  settle_it();
  const std::size_t middle = motion.state().size() / 2;
  const auto spread = [&motion] {
    StructureScene scene;
    scene.points = positions_of(motion.state());
    const Bounds box = bounds_of(scene);
    return box.upper - box.lower;
  };
  const Vec3 at_rest = spread();
  motion.grab(middle);
  EXPECT_TRUE(motion.grabbed());
  const Vec3 held = motion.state().position(middle) + Vec3{2, 3, 1};
  motion.move_grabbed({2, 3, 1});
  motion.advance(200);
  EXPECT_LT(distance(motion.state().position(middle), held), 1e-9) << "it stays in the hand";
  motion.let_go();
  settle_it();
  EXPECT_LT(motion.force(), 1e-4);
  // the same piece, wherever it lies
  EXPECT_NEAR(spread().x, at_rest.x, 0.02 * at_rest.x);
  EXPECT_NEAR(spread().y, at_rest.y, 0.02 * at_rest.y);
}

TEST(Orbit, ZoomKeepsThePlaceUnderTheMouse) {
  Camera camera;
  const Sight before = line_of_sight(camera, 1.5, 0.4, -0.3);
  const Sight after = line_of_sight(zoomed_by_mouse(camera, 3, 1.5, 0.4, -0.3), 1.5, 0.4, -0.3);
  EXPECT_NEAR(before.from.x, after.from.x, 1e-9);
  EXPECT_NEAR(before.from.y, after.from.y, 1e-9);
}

TEST(Orbit, FloorAndBarAreOfRoundLengths) {
  const FloorGrid floor = floor_grid({{0, 0, -1}, {30, 20, 1}}, 0.5, {});
  EXPECT_EQ(floor.square_mm, 1);  // 15 mm of cloth
  Camera camera;
  camera.height = 40;  // 20 mm in 800 pixels
  const ScaleBar bar = scale_bar(camera, 0.5, 1000, 800);
  EXPECT_EQ(bar.length_mm, 5);
  EXPECT_NEAR(bar.pixels, 200, 1e-9);
}

TEST(Orbit, HabitsDiffer) {
  const MouseButtons middle{.middle = true};
  EXPECT_EQ(mouse_act(MouseHabit::freecad, middle), MouseAct::pan);
  EXPECT_EQ(mouse_act(MouseHabit::blender, middle), MouseAct::turn);
  EXPECT_EQ(mouse_act(MouseHabit::blender, {.middle = true, .shift = true}), MouseAct::pan);
}

}  // namespace
}  // namespace loopwright
