// Curve formats: what is written is read back, what others wrote is read, what is damaged is refused.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

#include "geometry/fit_fabric.hpp"
#include "geometry/interlacing.hpp"
#include "geometry/linking.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/exchange/bytes.hpp"
#include "outputs/exchange/curve_distance.hpp"
#include "outputs/exchange/curves_to_fabric.hpp"
#include "outputs/exchange/write_curves.hpp"
#include "outputs/write_obj.hpp"
#include "plain_fabric.hpp"
#include "temporary_folder.hpp"

namespace loopwright {
namespace {

using test::content;
using testing::ElementsAre;
using testing::HasSubstr;
constexpr double pi = std::numbers::pi;

class CurvesTest : public test::TemporaryFolder {
 protected:
  static std::filesystem::path corpus() {
    const char* set = std::getenv("LOOPWRIGHT_CORPUS");
    return std::filesystem::path(set != nullptr ? set : LOOPWRIGHT_CORPUS_DEFAULT) / "files";
  }
};

// Largest distance of places on one yarn from another, in mm, compared at equal shares of arc length.
double apart_mm(const Fabric& a, const FabricYarn& ya, const Fabric& b, const FabricYarn& yb) {
  const auto at_share = [](const Fabric& fabric, const FabricYarn& yarn) {
    constexpr int fine = 64, shares = 200;
    const std::vector<Vec3> line = polyline(fabric, yarn, fine);
    std::vector<double> arc{0};
    for (std::size_t k = 1; k < line.size(); ++k) arc.push_back(arc.back() + distance(line[k], line[k - 1]));
    std::vector<Vec3> places;
    std::size_t k = 0;
    for (int s = 0; s <= shares; ++s) {
      const double wanted = arc.back() * s / shares;
      while (k + 2 < arc.size() && arc[k + 1] < wanted) ++k;
      const double step = arc[k + 1] - arc[k];
      places.push_back((line[k] + (line[k + 1] - line[k]) * (step > 0 ? (wanted - arc[k]) / step : 0)) *
                       fabric.diameter_mm);
    }
    return places;
  };
  const std::vector<Vec3> pa = at_share(a, ya), pb = at_share(b, yb);
  double most = 0;
  for (std::size_t k = 0; k < pa.size(); ++k) most = std::max(most, distance(pa[k], pb[k]));
  return most;
}

// A piece of plain, and a ring beside it.
Fabric piece_and_ring() {
  Fabric fabric = test::plain_piece(4, 3);
  std::vector<Vec3> circle;
  for (int k = 0; k < 24; ++k)
    circle.push_back(Vec3{30 + 5 * std::cos(pi * k / 12), 5 * std::sin(pi * k / 12), 1});
  FabricYarn ring;
  ring.yarn = YarnId(3);
  ring.carrier = CarrierId(1);
  ring.colour = "#b03020";
  ring.periodic = true;
  ring.control_points = periodic_control_points(circle, {});
  ring.held.assign(24, 0);
  ring.segment_rest_length = 10 * pi / 24;
  fabric.yarns.push_back(ring);
  return fabric;
}

TEST_F(CurvesTest, every_curve_format_comes_back_as_it_went) {
  const Fabric fabric = piece_and_ring();
  write_bcc(in_folder("a.bcc"), fabric);
  write_bcc_bspline(in_folder("b.bcc"), fabric);
  write_yarns(in_folder("a.yarns"), fabric);
  write_obj_lines(in_folder("a.obj"), fabric);
  for (const char* name : {"a.bcc", "b.bcc", "a.yarns", "a.obj"}) {
    const CurveFile file = read_curve_file(in_folder(name));
    const CurveFabric back = fabric_of_curves(file);
    ASSERT_EQ(back.fabric.yarns.size(), 4U) << name;
    EXPECT_FALSE(back.diameter_guessed) << name;
    EXPECT_NEAR(back.fabric.diameter_mm, 0.5, 1e-6) << name;
    EXPECT_LT(back.departure, 0.02) << name;
    for (std::size_t y = 0; y < 4; ++y) {
      const FabricYarn &was = fabric.yarns[y], &is = back.fabric.yarns[y];
      EXPECT_EQ(is.periodic, was.periodic) << name;
      // the .yarns ring begins at the middle of its first edge, others where it did
      if (is.periodic && std::string(name) == "a.yarns") continue;
      EXPECT_LT(apart_mm(fabric, was, back.fabric, is), 0.02 * 0.5) << name << " yarn " << y;
    }
    const double length = 0.5 * arc_length(fabric, fabric.yarns[3]);
    EXPECT_NEAR(0.5 * arc_length(back.fabric, back.fabric.yarns[3]), length, 3e-3 * length) << name;
  }
}

TEST_F(CurvesTest, bspline_bcc_holds_the_control_points_themselves) {
  const Fabric fabric = piece_and_ring();
  write_bcc_bspline(in_folder("a.bcc"), fabric);
  const CurveFile file = read_curve_file(in_folder("a.bcc"));
  EXPECT_EQ(file.basis, CurveBasis::bspline);
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    ASSERT_EQ(file.curves[y].points.size(), fabric.yarns[y].control_points.size());
    for (std::size_t k = 0; k < file.curves[y].points.size(); ++k)
      EXPECT_LT(distance(file.curves[y].points[k], fabric.yarns[y].control_points[k] * 0.5), 2e-6);
  }
}

TEST_F(CurvesTest, cells_are_repeated_and_go_on_where_the_next_one_begins) {
  const Fabric cell = test::plain_cell();
  ExportOptions options;
  options.repeats = {3, 2};
  write_bcc(in_folder("a.bcc"), cell, options);
  const CurveFile file = read_curve_file(in_folder("a.bcc"));
  ASSERT_EQ(file.curves.size(), 6U);
  // the last but one point of a Catmull-Rom curve is its end, the second its beginning
  const std::vector<Vec3>&first = file.curves[0].points, &second = file.curves[1].points;
  EXPECT_LT(distance(first[first.size() - 2], second[1]), 1e-6);
  EXPECT_LT(distance(first[first.size() - 1], second[2]), 1e-6);
}

// Distances of a curve's places from a circle of radius 5.
double off_circle(CurveBasis basis, const std::vector<Vec3>& points) {
  CurveFile file;
  file.basis = basis;
  file.curves.push_back({points, true, 0.5, ""});
  const Fabric fabric = fabric_of_curves(file).fabric;
  double most = 0;
  for (const Vec3& p : polyline(fabric, fabric.yarns[0], 8)) most = std::max(most, std::abs(norm(p) - 5));
  return most;
}

TEST_F(CurvesTest, each_basis_draws_the_circle_that_its_points_mean) {
  constexpr int n = 24;
  const auto circle = [](double radius, double steps) {
    std::vector<Vec3> points;
    for (int k = 0; k < steps; ++k)
      points.push_back({radius * std::cos(2 * pi * k / steps), radius * std::sin(2 * pi * k / steps), 0});
    return points;
  };
  const double c = std::cos(2 * pi / n);
  EXPECT_LT(off_circle(CurveBasis::through_points, circle(5, n)), 2e-3);
  EXPECT_LT(off_circle(CurveBasis::catmull_rom, circle(5, n)), 2e-3);
  // a uniform cubic B-spline of a regular polygon passes at (2 + cos) / 3 of its radius, a quadratic one at
  // (3 + cos) / 4
  EXPECT_LT(off_circle(CurveBasis::bspline, circle(5 * 3 / (2 + c), n)), 2e-3);
  EXPECT_LT(off_circle(CurveBasis::midpoint_quadratic, circle(5 * 4 / (3 + c), n)), 2e-3);
  // four Bezier quarters with the usual handles
  const double k = 4.0 / 3 * std::tan(pi / 8) * 5;
  EXPECT_LT(off_circle(CurveBasis::bezier, {{5, 0, 0},
                                            {5, k, 0},
                                            {k, 5, 0},
                                            {0, 5, 0},
                                            {-k, 5, 0},
                                            {-5, k, 0},
                                            {-5, 0, 0},
                                            {-5, -k, 0},
                                            {-k, -5, 0},
                                            {0, -5, 0},
                                            {k, -5, 0},
                                            {5, -k, 0}}),
            5e-3);
}

TEST_F(CurvesTest, where_z_points_up_it_is_turned_to_y) {
  CurveFile file;
  file.z_up = true;
  file.curves.push_back({{{0, 0, 0}, {0, 0, 10}, {0, 0, 20}}, false, 0.5, ""});
  const Fabric fabric = fabric_of_curves(file).fabric;
  const Vec3 end = position(fabric, fabric.yarns[0], fabric.yarns[0].segments());
  EXPECT_LT(distance(end, {0, 20, 0}), 1e-9);
  // held at both ends
  const auto& held = fabric.yarns[0].held;
  EXPECT_THAT((std::vector<int>{held[0], held[1], held[2], held[held.size() - 1]}), ElementsAre(1, 1, 0, 1));
}

TEST_F(CurvesTest, unit_and_diameter_may_be_said_and_the_diameter_is_estimated_where_it_is_not) {
  // two straight curves 3 units apart
  CurveFile file;
  for (const double y : {0.0, 3.0}) {
    FileCurve line;
    for (int k = 0; k <= 40; ++k) line.points.push_back({1.0 * k, y, 0});
    file.curves.push_back(line);
  }
  const CurveFabric guessed = fabric_of_curves(file);
  EXPECT_TRUE(guessed.diameter_guessed);
  EXPECT_NEAR(guessed.fabric.diameter_mm, 3, 1e-9);
  CurveOptions options;
  options.unit_mm = 10;
  EXPECT_NEAR(fabric_of_curves(file, options).fabric.diameter_mm, 30, 1e-8);
  options.diameter_mm = 2;
  const CurveFabric said = fabric_of_curves(file, options);
  EXPECT_FALSE(said.diameter_guessed);
  EXPECT_NEAR(arc_length(said.fabric, said.fabric.yarns[0]) * said.fabric.diameter_mm, 400, 1e-6);
  file.curves.pop_back();
  EXPECT_THAT([&] { fabric_of_curves(file); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("--yarn diameter")));
}

TEST_F(CurvesTest, edges_of_blender_are_chained_in_any_order) {
  const CurveFile file = read_obj_curves(
      "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nl 3 4\nl 1 2\nl 3 2\n"
      "v 9 0 0\nv 9 1 0\nv 8 1 0\nv 8 0 0\nl -1 -2\nl 5 6\nl 6 7\nl 8 5\n",
      "a.obj");
  ASSERT_EQ(file.curves.size(), 2U);
  EXPECT_FALSE(file.curves[0].closed);
  EXPECT_EQ(file.curves[0].points.size(), 4U);
  EXPECT_TRUE(file.curves[1].closed);
  EXPECT_EQ(file.curves[1].points.size(), 4U);
}

TEST_F(CurvesTest, faults_of_an_obj_file_are_told_with_their_line) {
  const auto fault = [](const char* text, const char* said) {
    EXPECT_THAT([&] { read_obj_curves(text, "a.obj"); },
                testing::ThrowsMessage<FileError>(testing::AllOf(HasSubstr("a.obj"), HasSubstr(said))))
        << text;
  };
  fault("v 0 0 0\nv 1 zero 0\n", "a.obj:2: a place needs three numbers");
  fault("v 0 0 0\nv 1 0 0\nl 1 3\n", "a.obj:3: '3' is not one of the 2 places");
  fault("v 0 0 0\nl 1\n", "a.obj:2: a line needs two places");
  fault("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "surfaces are not");
  fault("v 0 0 nan\n", "three numbers");
  fault("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nl 1 2\nl 2 3\nl 2 4\n", "does not branch");
  fault("", "no lines");
}

std::string bcc_header(const char* kind, std::uint64_t curves) {
  std::string bytes("BCC\x44", 4);
  bytes += kind;
  append_bytes(bytes, std::uint8_t{3});
  append_bytes(bytes, std::uint8_t{1});
  append_bytes(bytes, curves);
  append_bytes(bytes, std::uint64_t{99});
  bytes.append(40, '\0');
  return bytes;
}

TEST_F(CurvesTest, damaged_bcc_is_refused_with_the_byte) {
  const auto fault = [](const std::string& bytes, const char* said) {
    EXPECT_THAT([&] { read_bcc(bytes, "a.bcc"); }, testing::ThrowsMessage<FileError>(HasSubstr(said)));
  };
  fault("PNG", "does not begin with the letters BCC");
  fault(std::string("BCC\x44", 4) + "C0", "ends within its header");
  fault(bcc_header("C0", 0), "no curve");
  fault(bcc_header("C0", 1ULL << 60), "too short");
  fault(bcc_header("XY", 1), "kind 'XY'");
  std::string many = bcc_header("C0", 1);
  append_bytes(many, std::int32_t{-2147483647 - 1});
  fault(many, "byte 64: curve 0 is to have 2147483648 points");
  std::string nan = bcc_header("PL", 1);
  append_bytes(nan, std::int32_t{1});
  for (const float v : {0.0F, std::nanf(""), 0.0F}) append_bytes(nan, v);
  fault(nan, "not a number");
  std::string wide = bcc_header("C0", 1);
  wide[3] = '\x48';
  fault(wide, "4 bytes are read");
}

TEST_F(CurvesTest, damaged_yarns_are_refused_with_the_byte) {
  write_yarns(in_folder("a.yarns"), test::plain_piece(2, 2));
  const std::string good = content(in_folder("a.yarns"));
  EXPECT_EQ(read_yarns(good, "a").curves.size(), 2U);
  const auto fault = [](const std::string& bytes, const char* said) {
    EXPECT_THAT([&] { read_yarns(bytes, "a.yarns"); }, testing::ThrowsMessage<FileError>(HasSubstr(said)));
  };
  fault("", "ends before the chunk 'f3..'");
  fault("f3..\xff\xff\xff\xff", "longer than the rest");
  fault("yarn" + good.substr(4), "it is not a .yarns file");
  fault(good.substr(0, 100), "longer than the rest");
  std::string overlap = good;
  const std::size_t yarns = good.find("yarn");
  overlap[yarns + 8 + 16] = 0;  // the second yarn begins at point 0
  overlap[yarns + 8 + 17] = 0;
  fault(overlap, "another yarn's");
}

TEST_F(CurvesTest, yarns_hold_lines_and_unloaded_lengths) {
  const Fabric fabric = test::plain_piece(3, 2);
  write_yarns(in_folder("a.yarns"), fabric);
  const std::string bytes = content(in_folder("a.yarns"));
  // source lines of the pieces: row + 1
  const std::size_t lines = bytes.find("src.") + 8;
  std::uint32_t line = 0;
  std::memcpy(&line, bytes.data() + lines, 4);
  EXPECT_EQ(line, 1U);
  // checkpoints of the first yarn: three loops and the end
  ByteReader in(std::string_view(bytes).substr(bytes.find("chk.") + 8));
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    std::uint32_t point = 0, unit = 1;
    float length = -1;
    ASSERT_TRUE(in.read(point) && in.read(length) && in.read(unit));
    EXPECT_EQ(point, static_cast<std::uint32_t>(k * 16 * 4));
    EXPECT_EQ(unit, 0U);
    if (k == 3) {
      EXPECT_EQ(length, 0);
    }
    sum += length;
  }
  const FabricYarn& yarn = fabric.yarns[0];
  EXPECT_NEAR(sum, yarn.segment_rest_length * yarn.segments() * 0.5, 1e-5);
}

// What the authors of the files say of them: the certificates of linking numbers beside the models of
// antequ/fastlinkingnumbers (Qu and James, ACM Transactions on Graphics 40(4), 106, 2021).
TEST_F(CurvesTest, linking_numbers_of_models_by_others_agree_with_their_certificates) {
  if (!std::filesystem::exists(corpus() / "glove.bcc")) GTEST_SKIP() << "the corpus of real files is absent";
  struct Model {
    const char* name;
    std::size_t curves;
    std::vector<LinkedPair> linked;
  };
  for (const Model& model : {Model{"glove.bcc", 70, {}}, Model{"knittubeinit.bcc", 39, {}},
                             Model{"knittubebroken.bcc", 39, {{5, 6, -2}}}}) {
    const CurveFile file = read_curve_file(corpus() / model.name);
    CurveOptions options;
    options.diameter_mm = 0.2;
    const Fabric fabric = fabric_of_curves(file, options).fabric;
    ASSERT_EQ(fabric.yarns.size(), model.curves);
    for (const FabricYarn& yarn : fabric.yarns) EXPECT_TRUE(is_closed(yarn));
    EXPECT_EQ(linking_numbers(fabric), model.linked) << model.name;
  }
}

// The same ball of two wound rings, as Blender and as Houdini write it (their headers: 9600 points, 2
// curves).
TEST_F(CurvesTest, blender_and_houdini_files_of_one_model_are_alike) {
  if (!std::filesystem::exists(corpus() / "blenderobj.obj"))
    GTEST_SKIP() << "the corpus of real files is absent";
  for (const char* name : {"blenderobj.obj", "houdiniobj.obj"}) {
    const CurveFile file = read_curve_file(corpus() / name);
    ASSERT_EQ(file.curves.size(), 2U) << name;
    for (const FileCurve& curve : file.curves) {
      EXPECT_TRUE(curve.closed) << name;
      EXPECT_NEAR(static_cast<double>(curve.points.size()), 4800, 1) << name;
    }
  }
}

}  // namespace
}  // namespace loopwright
