#include "outputs/write_obj.hpp"

#include <gmock/gmock.h>

#include <map>
#include <numbers>
#include <sstream>

#include "outputs/tube_mesh.hpp"
#include "plain_fabric.hpp"
#include "temporary_folder.hpp"

namespace loopwright {
namespace {

using test::content;

class ObjTest : public test::TemporaryFolder {};

// Just enough of an OBJ reader: v, vn, l and triangular f.
struct Obj {
  std::vector<Vec3> v, vn;
  std::vector<std::vector<std::size_t>> lines;
  std::vector<std::array<std::size_t, 3>> faces, face_normals;
  int objects = 0;
};

Obj obj_of(const std::string& text) {
  Obj obj;
  std::istringstream in(text);
  for (std::string row; std::getline(in, row);) {
    std::istringstream words(row);
    std::string key;
    words >> key;
    Vec3 p;
    if (key == "v" && words >> p.x >> p.y >> p.z) obj.v.push_back(p);
    if (key == "vn" && words >> p.x >> p.y >> p.z) obj.vn.push_back(p);
    if (key == "o") ++obj.objects;
    if (key == "l") {
      obj.lines.emplace_back();
      for (std::size_t i = 0; words >> i;) obj.lines.back().push_back(i - 1);
    }
    if (key == "f") {
      std::array<std::size_t, 3> place{}, normal{};
      char slash = 0;
      for (std::size_t k = 0; k < 3; ++k) words >> place[k] >> slash >> slash >> normal[k];
      for (std::size_t k = 0; k < 3; ++k) place[k] -= 1, normal[k] -= 1;
      obj.faces.push_back(place);
      obj.face_normals.push_back(normal);
    }
  }
  return obj;
}

// By the divergence theorem; positive for outward triangles of a closed surface.
double volume(const Obj& obj) {
  double six = 0;
  for (const auto& f : obj.faces) six += dot(obj.v[f[0]], cross(obj.v[f[1]], obj.v[f[2]]));
  return six / 6;
}

// Every directed edge once, and once the other way: closed and consistently oriented.
bool watertight(const Obj& obj) {
  std::map<std::pair<std::size_t, std::size_t>, int> edges;
  for (const auto& f : obj.faces)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{f[k], f[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges)
    if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
  return !edges.empty();
}

TEST_F(ObjTest, LinesHaveTheLengthOfTheYarnsInMillimetres) {
  const Fabric fabric = test::plain_piece(5, 3);
  write_obj_lines(in_folder("a.obj"), fabric, {32, 12, {1, 1}});
  const std::string text = content(in_folder("a.obj"));
  EXPECT_THAT(text, ::testing::HasSubstr("# unit: millimetre"));
  const Obj obj = obj_of(text);
  ASSERT_EQ(obj.lines.size(), 3U);
  EXPECT_EQ(obj.objects, 3);
  for (std::size_t y = 0; y < 3; ++y) {
    double length = 0;
    for (std::size_t k = 1; k < obj.lines[y].size(); ++k)
      length += distance(obj.v.at(obj.lines[y][k]), obj.v.at(obj.lines[y][k - 1]));
    const double expected = arc_length(fabric, fabric.yarns[y]) * fabric.diameter_mm;
    EXPECT_NEAR(length, expected, 1e-4 * expected);
  }
  // ends of the first yarn: gamma(pi) and five wales on
  EXPECT_NEAR(obj.v[obj.lines[0].back()].x - obj.v[obj.lines[0].front()].x,
              5 * test::plain_wale_spacing * 0.5, 1e-7);
}

TEST_F(ObjTest, TubesAreClosedOutwardAndHoldTheYarnsVolume) {
  const Fabric fabric = test::plain_piece(3, 2);
  write_obj_tubes(in_folder("a.obj"), fabric, {12, 16, {1, 1}});
  const Obj obj = obj_of(content(in_folder("a.obj")));
  EXPECT_TRUE(watertight(obj));
  double expected = 0;
  for (const FabricYarn& yarn : fabric.yarns) expected += std::numbers::pi / 4 * arc_length(fabric, yarn);
  expected *= std::pow(fabric.diameter_mm, 3);
  EXPECT_NEAR(volume(obj), expected, 5e-3 * expected);
  // normals agree with the triangles that they belong to
  for (std::size_t f = 0; f < obj.faces.size(); ++f) {
    const auto& [a, b, c] = obj.faces[f];
    const Vec3 across = cross(obj.v[b] - obj.v[a], obj.v[c] - obj.v[a]);
    for (const std::size_t n : obj.face_normals[f]) {
      EXPECT_NEAR(norm(obj.vn.at(n)), 1, 2e-5);
      EXPECT_GT(dot(across, obj.vn.at(n)), 0);
    }
  }
}

TEST_F(ObjTest, StraightTubeHasTheVolumeOfItsPrism) {
  for (const int sides : {3, 4, 7, 24}) {
    write_obj_tubes(in_folder("a.obj"), test::straight_yarn(10, 20, 0.6), {1, sides, {1, 1}});
    const Obj obj = obj_of(content(in_folder("a.obj")));
    EXPECT_TRUE(watertight(obj));
    EXPECT_NEAR(volume(obj), std::numbers::pi / 4 * 0.36 * 10, 1e-6) << sides << " sides";
  }
}

TEST_F(ObjTest, RepeatsOfACellJoin) {
  const Fabric cell = test::plain_cell();
  write_obj_lines(in_folder("a.obj"), cell, {4, 12, {3, 2}});
  const Obj obj = obj_of(content(in_folder("a.obj")));
  ASSERT_EQ(obj.lines.size(), 6U);
  for (const std::size_t row : {0U, 3U})
    for (std::size_t m = 0; m < 2; ++m)
      EXPECT_LT(distance(obj.v[obj.lines[row + m].back()], obj.v[obj.lines[row + m + 1].front()]), 1e-8);
  // the tubes' rings join too: frames of a periodic yarn end where they began
  const auto rings = tube_rings(cell, cell.yarns[0], 6);
  EXPECT_LT(distance(rings.front().normal, rings.back().normal), 1e-9);
  EXPECT_LT(distance(rings.front().tangent, rings.back().tangent), 1e-12);
}

// On a helix the frame that does not twist falls behind the Frenet frame by the torsion times the length,
// which is known in closed form.
TEST(TubeRings, FramesDoNotTwist) {
  Fabric helix;
  FabricYarn yarn;
  const double r = 2, c = 0.7, step = 2 * std::numbers::pi / 64;
  const auto curve = [&](double t) { return Vec3{r * std::cos(t), r * std::sin(t), c * t}; };
  for (int i = -1; i <= 65; ++i) yarn.control_points.push_back(test::control_point_on(curve, i * step, step));
  helix.yarns.push_back(yarn);
  const auto rings = tube_rings(helix, helix.yarns[0], 8);
  // Frenet normals at both ends of a full turn are (-1, 0, 0)
  const auto angle_to_frenet = [](const TubeRing& ring) {
    const Vec3 frenet{-1, 0, 0};
    return std::atan2(dot(frenet, ring.binormal), dot(frenet, ring.normal));
  };
  const double speed = std::hypot(r, c), torsion = c / (r * r + c * c);
  const double turned =
      std::remainder(angle_to_frenet(rings.back()) - angle_to_frenet(rings.front()), 2 * std::numbers::pi);
  EXPECT_NEAR(turned, std::remainder(torsion * speed * 2 * std::numbers::pi, 2 * std::numbers::pi), 5e-3);
  for (const TubeRing& ring : rings) {
    EXPECT_NEAR(norm(ring.normal), 1, 1e-12);
    EXPECT_NEAR(dot(ring.normal, ring.tangent), 0, 1e-12);
    EXPECT_LT(distance(cross(ring.tangent, ring.normal), ring.binormal), 1e-12);
  }
}

}  // namespace
}  // namespace loopwright
