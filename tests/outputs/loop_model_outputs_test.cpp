// Pictures and VTK files of the loop-scale model.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "geometry/pieces.hpp"
#include "outputs/headless_gl.hpp"
#include "outputs/structure_picture.hpp"
#include "outputs/write_vtk.hpp"
#include "temporary_folder.hpp"

namespace loopwright {
namespace {

LoopModel rib_model() {
  const Piece piece = piece_of_text(chart_programme({"fb"}, 4, 3));
  return build_loop_model(piece.graph, piece.program);
}

int pixels_like(const Image& image, int red, int green, int blue) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto p = image.at(x, y);
      const auto near = [](int a, int b) { return a - b < 40 && b - a < 40; };
      count += near(p[0], red) && near(p[1], green) && near(p[2], blue) ? 1 : 0;
    }
  return count;
}

TEST(structure_picture, shows_masses_binding_points_springs_and_curves) {
  const LoopModel model = rib_model();
  StructureScene scene = structure_scene(model, state_at_rest(model.start), StructureStyle::net);
  // a red cube a mass; a blue one where a loop begins, a green one where one ends
  EXPECT_EQ(scene.cubes.size(), 16U + 12U + 12U);
  EXPECT_EQ(scene.lines.size(), 1U + model.net.springs.size());
  const Bounds bounds = bounds_of(scene);
  add_floor(scene, bounds);
  EXPECT_LT(bounds_of(scene).lower.y, bounds.lower.y);
  std::optional<StructureRenderer> renderer;
  try {
    renderer.emplace(400, 300);
  } catch (const NoOpenGl& none) {
    GTEST_SKIP() << none.what();
  }
  const Camera camera = fitted_camera(View::front, bounds_of(scene), 4.0 / 3);
  const Image image = renderer->draw(scene, camera);
  EXPECT_GT(pixels_like(image, 205, 45, 40), 40);
  EXPECT_GT(pixels_like(image, 40, 150, 70), 40);
  EXPECT_GT(pixels_like(image, 45, 85, 200), 40);
  EXPECT_GT(pixels_like(image, 20, 20, 20), 200);
  EXPECT_GT(pixels_like(image, 252, 252, 250), 400 * 300 / 2);
  // a second picture from the same renderer is the same
  EXPECT_EQ(renderer->draw(scene, camera).pixels, image.pixels);
  // front loops green, rear loops blue, nothing red
  const Image sides =
      renderer->draw(structure_scene(model, state_at_rest(model.start), StructureStyle::sides), camera);
  EXPECT_GT(pixels_like(sides, 40, 150, 70), 100);
  EXPECT_GT(pixels_like(sides, 45, 85, 200), 100);
  EXPECT_EQ(pixels_like(sides, 205, 45, 40), 0);
}

TEST(structure_picture, refuses_what_cannot_be_drawn) {
  EXPECT_THROW(bounds_of(StructureScene{}), std::invalid_argument);
  const LoopModel model = rib_model();
  NetState broken = state_at_rest(model.start);
  broken.y[3] = std::nan("");
  EXPECT_THROW(bounds_of(structure_scene(model, broken, StructureStyle::net)), std::invalid_argument);
}

std::string text_between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t a = text.find(from) + from.size();
  return text.substr(a, text.find(to, a) - a);
}

class VtkTest : public test::TemporaryFolder {};

TEST_F(VtkTest, file_holds_every_mass_spring_and_curve_in_mm) {
  const LoopModel model = rib_model();
  NetState state = state_at_rest(model.start);
  state.vx[2] = 7;
  write_vtp(in_folder("one.vtp"), model, state);
  const std::string text = text_of(in_folder("one.vtp"));
  std::size_t curve_points = 0;
  for (const CurveYarn& yarn : model.curves.yarns) curve_points += yarn.points.size();
  EXPECT_NE(text.find("NumberOfPoints=\"" + std::to_string(state.size() + curve_points) + "\""),
            std::string::npos);
  EXPECT_NE(text.find("NumberOfVerts=\"" + std::to_string(state.size()) + "\""), std::string::npos);
  EXPECT_NE(text.find("NumberOfLines=\"" + std::to_string(model.net.springs.size() + 1) + "\""),
            std::string::npos);
  std::istringstream points(
      text_between(text, "Name=\"place\" NumberOfComponents=\"3\" format=\"ascii\">", "</"));
  Vec3 first;
  points >> first.x >> first.y >> first.z;
  EXPECT_LT(distance(first, model.start[0] * model.geometry.diameter_mm), 1e-12);
  // every spring's two ends, then the yarn's points in order
  std::istringstream lines(text_between(text.substr(text.find("<Lines>")), "format=\"ascii\">", "</"));
  for (const Spring& s : model.net.springs) {
    std::int32_t a = -1, b = -1;
    lines >> a >> b;
    EXPECT_EQ(a, s.a);
    EXPECT_EQ(b, s.b);
  }
  std::size_t point = 0;
  for (std::size_t k = 0; k < curve_points; ++k) {
    lines >> point;
    EXPECT_EQ(point, state.size() + k);
  }
  write_pvd(in_folder("series.pvd"), {{0, "one.vtp"}, {0.5, "two.vtp"}});
  EXPECT_NE(text_of(in_folder("series.pvd")).find("timestep=\"0.5\" part=\"0\" file=\"two.vtp\""),
            std::string::npos);
}

}  // namespace
}  // namespace loopwright
