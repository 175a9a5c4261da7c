// The promise of this stage: every interlacing of the machine's record is there in the first curves.
#include "geometry/interlacing.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "geometry/pieces.hpp"

namespace loopwright {
namespace {

struct Chart {
  const char* name;
  std::vector<std::string> rows;
};
const std::vector<Chart> charts{{"plain", {"f"}},
                                {"reverse plain", {"b"}},
                                {"rib 1x1", {"fb"}},
                                {"rib 2x1", {"ffb"}},
                                {"garter", {"f", "b"}},
                                {"moss", {"fb", "bf"}},
                                {"basket", {"ffbb", "ffbb", "bbff", "bbff"}}};

TEST(interlacing, charts_as_pieces) {
  for (const Chart& chart : charts) {
    const Piece piece = piece_of_text(chart_programme(chart.rows, 12, 13));
    const Fabric fabric = whole_fabric(piece);
    const InterlacingCheck check = check_interlacings(fabric);
    EXPECT_EQ(check.expected, 12 * 12) << chart.name;
    EXPECT_EQ(check.intact, check.expected) << chart.name;
    EXPECT_GT(min_clearance(fabric).distance, 0.4) << chart.name;
  }
}

TEST(interlacing, charts_as_periodic_cells) {
  for (const Chart& chart : charts) {
    const Fabric fabric = chart_cell(chart.rows);
    const InterlacingCheck check = check_interlacings(fabric);
    EXPECT_EQ(check.expected, static_cast<int>(chart.rows.size() * chart.rows[0].size())) << chart.name;
    EXPECT_EQ(check.intact, check.expected) << chart.name;
    EXPECT_GT(min_clearance(fabric).distance, 0.4) << chart.name;
  }
}

struct RealFile {
  const char* path;
  int broken = 0;          // interlacings of the whole piece that are known to be wrong, at its bind-off
  double clearance = 0.2;  // of the middle window
};

// Fabrics of the programmes that others wrote. Whole pieces and windows of 16 x 16.
class Corpus : public testing::TestWithParam<RealFile> {};

TEST_P(Corpus, every_interlacing_is_right) {
  const std::filesystem::path file = corpus() / GetParam().path;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the corpus is not at " << corpus();
  const Piece piece = piece_of_text(text_of(file));
  const InterlacingCheck check = check_interlacings(whole_fabric(piece));
  EXPECT_EQ(check.expected, static_cast<int>(piece.graph.interlacings.size()));
  EXPECT_GE(check.intact, check.expected - GetParam().broken);

  const LoopSelection middle = middle_window(piece.graph, piece.placed.layout, 16, 16);
  const Fabric window = fabric_of(piece, cut_window(piece.graph, piece.options, piece.placed, middle));
  const InterlacingCheck window_check = check_interlacings(window);
  EXPECT_GT(window_check.expected, 200);
  EXPECT_EQ(window_check.intact, window_check.expected);
  EXPECT_GT(min_clearance(window).distance, GetParam().clearance);
}

INSTANTIATE_TEST_SUITE_P(
    files, Corpus,
    testing::Values(RealFile{"files/singlejersey.knitout"}, RealFile{"files/rib-1x1.knitout"},
                    RealFile{"files/rib-2x2.knitout"}, RealFile{"files/garter.knitout"},
                    RealFile{"files/interlock.knitout"}, RealFile{"files/lace.knitout"},
                    RealFile{"files/halfmilano.knitout"}, RealFile{"files/fullrib.knitout"},
                    RealFile{"files/birdseye_sheet.k"}, RealFile{"files/simple_lace.k"},
                    RealFile{"files/cable_swatch_2_cable.k"}, RealFile{"files/stockenette_tube.k", 1},
                    RealFile{"files/single_color_brioche.k", 16}, RealFile{"files/RibTube.k", 0, 0.1},
                    RealFile{"knitdb/2_1_004Stockinette.knitout"}, RealFile{"knitdb/60_1_074Cable_2.knitout"},
                    RealFile{"knitdb/74_3_124lace_rib.knitout", 0, 0.15},
                    RealFile{"knitdb/82_3_155Josephine.knitout", 0, 0.15},
                    RealFile{"knitdb/11_2_039TexturedTrellis.knitout"}),
    [](const testing::TestParamInfo<RealFile>& tested) {
      std::string name = std::filesystem::path(tested.param.path).stem().string();
      for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
      return name;
    });

// Moves the part of a loop where its first leg crosses its parent's head to the other side of it.
void push_leg_through(Fabric& fabric, const LoopSpan& span, double z) {
  FabricYarn& yarn = fabric.yarns[static_cast<std::size_t>(span.yarn)];
  const double length = span.end - span.begin;
  for (std::size_t i = 0; i < yarn.control_points.size(); ++i) {
    const double t = static_cast<double>(i) - 1;  // where control point i has most weight
    const double share = (t - span.begin) / length;
    if (share > 0.1 && share < 0.22) yarn.control_points[i].z += z;
  }
}

TEST(interlacing, a_leg_pushed_through_its_parent_is_found_and_named) {
  for (const Chart& chart : {charts[0], charts[2], charts[4], charts[5]}) {
    const Piece piece = piece_of_text(chart_programme(chart.rows, 12, 13));
    Fabric fabric = whole_fabric(piece);
    for (std::size_t k = 30; k < 110; k += 17) {
      Fabric wrong = fabric;
      const PlacedInterlacing& pair = fabric.interlacings[k];
      for (const LoopSpan& span : fabric.loops)
        if (span.loop == pair.child) push_leg_through(wrong, span, -4.0 * pair.sign);
      const InterlacingCheck check = check_interlacings(wrong);
      EXPECT_EQ(check.broken, std::vector<int>{static_cast<int>(k)}) << chart.name;
      EXPECT_EQ(check.intact, check.expected - 1) << chart.name;
    }
  }
}

// How many of the pairs parent' - child, where parent' is a loop `offset` farther along the parent's yarn and
// the two are not interlaced, are taken for interlaced, on either side.
int wrong_pairs_found(const Fabric& fabric, int offset) {
  std::map<LoopId, std::size_t> place;
  for (std::size_t k = 0; k < fabric.loops.size(); ++k) place[fabric.loops[k].loop] = k;
  std::set<std::pair<LoopId, LoopId>> true_pairs;
  for (const PlacedInterlacing& pair : fabric.interlacings) true_pairs.insert({pair.parent, pair.child});
  Fabric wrong = fabric;
  wrong.interlacings.clear();
  for (PlacedInterlacing pair : fabric.interlacings) {
    const auto k = static_cast<std::ptrdiff_t>(place.at(pair.parent)), other = k + offset;
    if (other < 0 || other >= std::ssize(fabric.loops)) continue;
    const LoopSpan& parent = fabric.loops[static_cast<std::size_t>(other)];
    if (parent.yarn != fabric.loops[static_cast<std::size_t>(k)].yarn) continue;
    pair.parent = parent.loop;
    if (true_pairs.count({pair.parent, pair.child}) > 0) continue;
    wrong.interlacings.push_back(pair);
    pair.sign = -pair.sign;
    wrong.interlacings.push_back(pair);
  }
  EXPECT_FALSE(wrong.interlacings.empty());
  return check_interlacings(wrong).intact;
}

TEST(interlacing, loops_beside_the_parent_and_the_other_side_are_not_taken_for_it) {
  for (const Chart& chart : charts) {
    Fabric fabric = whole_fabric(piece_of_text(chart_programme(chart.rows, 12, 13)));
    for (const int offset : {-2, -1, 1, 2}) EXPECT_EQ(wrong_pairs_found(fabric, offset), 0) << chart.name;
    for (PlacedInterlacing& pair : fabric.interlacings) pair.sign = -pair.sign;
    EXPECT_EQ(check_interlacings(fabric).intact, 0) << chart.name;
  }
}

TEST(interlacing, a_whole_course_on_the_wrong_side_is_found) {
  Fabric fabric = chart_cell({"f"});
  for (Vec3& q : fabric.yarns[0].control_points) q.z = -q.z;
  EXPECT_EQ(check_interlacings(fabric).intact, 0);
}

TEST(interlacing, does_not_depend_on_where_the_fabric_lies_in_space) {
  const Piece piece = piece_of_text(chart_programme({"fb", "bf"}, 8, 8));
  Fabric fabric = whole_fabric(piece);
  for (FabricYarn& yarn : fabric.yarns)
    for (Vec3& q : yarn.control_points) {
      const Vec3 turned{0.6 * q.x - 0.8 * q.z, q.y, 0.8 * q.x + 0.6 * q.z};
      q = Vec3{turned.y, -turned.x, turned.z} + Vec3{100, -3, 7};
    }
  const InterlacingCheck check = check_interlacings(fabric);
  EXPECT_EQ(check.intact, check.expected);
}

TEST(interlacing, heads_are_found_anew_after_yarn_has_slid) {
  for (const Chart& chart : charts) {
    for (const double slide : {-0.35, -0.2, 0.2, 0.35}) {
      Fabric fabric = chart_cell(chart.rows);
      // Yarn that slides is yarn whose loops lie elsewhere on it.
      for (LoopSpan& span : fabric.loops) {
        const double by = slide * (span.end - span.begin);
        span.begin += by;
        span.apex += by;
        span.end += by;
      }
      const InterlacingCheck check = check_interlacings(fabric);
      EXPECT_EQ(check.intact, check.expected) << chart.name << " slid by " << slide;
    }
  }
}

TEST(clearance, two_straight_yarns) {
  Fabric fabric;
  for (const double z : {0.0, 0.7}) {
    FabricYarn yarn;
    for (int k = 0; k < 9; ++k) {
      const double along = k - 4;
      yarn.control_points.push_back(z > 0 ? Vec3{0.3, along, z} : Vec3{along, 0.2, 0});
    }
    yarn.held.assign(9, 0);
    fabric.yarns.push_back(yarn);
  }
  const Clearance clearance = min_clearance(fabric);
  EXPECT_NEAR(clearance.distance, 0.7, 1e-12);
  EXPECT_NEAR(clearance.t_a, 3.3, 1e-9);  // x = t - 3 on the first yarn
  EXPECT_NEAR(clearance.t_b, 3.2, 1e-9);
}

TEST(clearance, images_of_a_periodic_yarn) {
  Fabric fabric;
  fabric.periodic = true;
  fabric.width = 8;
  fabric.height = 0.9;
  FabricYarn yarn;
  yarn.periodic = true;
  yarn.shift = {1, 0};
  for (int k = 0; k < 8; ++k) yarn.control_points.push_back({static_cast<double>(k), 0, 0});
  yarn.held.assign(8, 0);
  fabric.yarns.push_back(yarn);
  EXPECT_NEAR(min_clearance(fabric).distance, 0.9,
              1e-12);  // the next course; its own neighbours do not count
}

}  // namespace
}  // namespace loopwright
