// Beam models: their geometry, and what CalculiX makes of them.
#include "outputs/exchange/write_beams.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "outputs/exchange/beam_chains.hpp"
#include "outputs/state_material.hpp"
#include "plain_fabric.hpp"
#include "temporary_folder.hpp"

namespace loopwright {
namespace {

using test::content;

// B = 0.02 mN mm^2 and EA from its round section of 0.5 mm: E = B / (pi r^4 / 4), EA = 4 B / r^2.
constexpr double bend = 2e-5, radius = 0.25, axial = 4 * bend / (radius * radius);

State straight_state(double length_mm, int segments) {
  State state{test::straight_yarn(length_mm / 0.5, segments), {}, {}};
  state.fabric.diameter_mm = 0.5;
  YarnMaterial material;
  material.reference_bend_N_m2 = bend * 1e-6;
  set_state_material(state, material);
  return state;
}

double length_of(const BeamChain& chain) {
  double length = 0;
  for (std::size_t k = 1; k < chain.places.size(); ++k)
    length += distance(chain.places[k], chain.places[k - 1]);
  return length;
}

class BeamsTest : public test::TemporaryFolder {
 protected:
  // Runs `name`.inp in the folder; the numbers that follow the node's in the .dat file, its last mention
  // first. Empty where there is no CalculiX.
  bool run(const std::string& name) {
    const std::string command = "cd '" + folder_.string() + "' && timeout 60 ccx " + name + " > ccx.log 2>&1";
    return std::system(command.c_str()) == 0 &&
           content(in_folder("ccx.log")).find("Job finished") != std::string::npos;
  }
  static bool has_ccx() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

  std::map<int, std::array<double, 3>> displacements(const std::string& name) const {
    std::istringstream in(content(in_folder(name + ".dat")));
    std::map<int, std::array<double, 3>> moved;
    for (std::string row; std::getline(in, row);) {
      std::istringstream words(row);
      int node = 0;
      std::array<double, 3> u{};
      if (words >> node >> u[0] >> u[1] >> u[2]) moved[node] = u;
    }
    return moved;
  }
};

TEST_F(BeamsTest, a_cell_is_cut_at_its_faces_and_loses_no_yarn) {
  const Fabric cell = test::plain_cell();
  ExportOptions options;
  options.per_segment = 16;
  const BeamChains beams = beam_chains(cell, options);
  // the formula's loop is wider and higher than its cell: it leaves through all four faces
  EXPECT_GE(beams.cuts.size(), 3U);
  EXPECT_EQ(beams.chains.size(), beams.cuts.size());
  double length = 0;
  for (const BeamChain& chain : beams.chains) {
    length += length_of(chain);
    for (const Vec3& p : chain.places) {
      EXPECT_GE(p.x, -1e-9);
      EXPECT_LE(p.x, cell.width + 1e-9);
      EXPECT_GE(p.y, -1e-9);
      EXPECT_LE(p.y, cell.height + 1e-9);
    }
  }
  EXPECT_NEAR(length, arc_length(cell, cell.yarns[0]), 1e-3 * length);
  for (const auto& [out, in] : beams.cuts) {
    const Vec3 apart = beams.chains[out.chain].places[out.node] - beams.chains[in.chain].places[in.node];
    const bool across = out.face == CellFace::left || out.face == CellFace::right;
    EXPECT_EQ(std::abs(apart.x), across ? cell.width : 0);
    EXPECT_EQ(std::abs(apart.y), across ? 0 : cell.height);
    EXPECT_EQ(apart.z, 0);
  }
}

TEST_F(BeamsTest, a_skewed_cell_is_cut_along_its_slanting_faces) {
  Fabric cell = test::plain_cell();
  cell.skew = 0.7;
  const BeamChains beams = beam_chains(cell, {});
  for (const BeamChain& chain : beams.chains)
    for (const Vec3& p : chain.places) {
      const double eta = p.y / cell.height, xi = (p.x - eta * cell.skew) / cell.width;
      EXPECT_GE(std::min(xi, eta), -0.02);  // between cuts the yarn may bulge out and back
      EXPECT_LE(std::max(xi, eta), 1.02);
    }
  double length = 0;
  for (const BeamChain& chain : beams.chains) length += length_of(chain);
  EXPECT_NEAR(length, arc_length(cell, cell.yarns[0]), 5e-3 * length);
}

TEST_F(BeamsTest, nodes_elements_and_sets_of_a_piece) {
  State state{test::plain_piece(4, 3, 8), {}, {}};
  ExportOptions options;
  options.per_segment = 2;
  for (const bool quadratic : {false, true}) {
    options.quadratic_beams = quadratic;
    write_beams(in_folder("a.inp"), state, BeamDialect::abaqus, options);
    const std::string text = content(in_folder("a.inp"));
    std::istringstream in(text);
    std::string card;
    std::size_t nodes = 0, elements = 0;
    for (std::string row; std::getline(in, row);) {
      if (row.starts_with("**")) continue;
      if (row[0] == '*') {
        card = row;
        continue;
      }
      if (card.starts_with("*NODE")) ++nodes;
      if (card.starts_with("*ELEMENT")) {
        ++elements;
        EXPECT_EQ(std::count(row.begin(), row.end(), ','), quadratic ? 3 : 2);
      }
    }
    EXPECT_EQ(nodes, 3U * (4 * 8 * 2 + 1));
    EXPECT_EQ(elements, 3U * 4 * 8 * 2 / (quadratic ? 2 : 1));
    for (const char* card_wanted :
         {"NSET=EDGE_LEFT", "NSET=EDGE_RIGHT", "NSET=EDGE_BOTTOM", "NSET=EDGE_TOP", "NSET=YARN_ENDS",
          "NSET=HELD", "ELSET=YARN_2", "*SURFACE, TYPE=ELEMENT, NAME=SURFACE_YARN_2"})
      EXPECT_THAT(text, testing::HasSubstr(card_wanted));
  }
}

TEST_F(BeamsTest, calculix_bends_a_straight_yarn_like_the_closed_form) {
  if (!has_ccx()) GTEST_SKIP() << "CalculiX (Debian package calculix-ccx) is not installed";
  constexpr double length = 20, across = 1e-8, along = 1e-5;
  const State state = straight_state(length, 32);
  ExportOptions options;
  options.quadratic_beams = true;
  write_beams(in_folder("yarn.inp"), state, BeamDialect::calculix, options);
  constexpr int last = 32 * 4 + 1;
  std::ofstream(in_folder("pull.inp"))
      << "*INCLUDE, INPUT=yarn.inp\n*BOUNDARY\n1, 1, 6\n*STEP\n*STATIC\n"
      << "*CLOAD\n"
      << last << ", 2, " << across << "\n"
      << last << ", 1, " << along << "\n*NODE PRINT, NSET=NODES\nU\n*END STEP\n";
  ASSERT_TRUE(run("pull")) << content(in_folder("ccx.log"));
  auto u = displacements("pull");
  ASSERT_EQ(u.size(), std::size_t{last});
  // a cantilever: F L^3 / (3 B)
  const double deflection = across * length * length * length / (3 * bend);
  EXPECT_NEAR(u[last][1], deflection, 2e-3 * deflection);
  // a bar: F x / (EA), over its middle half. CalculiX replaces the circle by an eight-node square with
  // bulging sides: a bar of one element written by hand is 1.5 % too soft as well.
  const double longer = u[97][0] - u[33][0], expected = along * length / 2 / axial;
  EXPECT_NEAR(longer, expected, 2e-2 * expected);
  EXPECT_GT(longer, expected);
}

TEST_F(BeamsTest, calculix_pulls_a_periodic_cell_by_its_control_node) {
  if (!has_ccx()) GTEST_SKIP() << "CalculiX (Debian package calculix-ccx) is not installed";
  // A straight yarn that goes on in the next cell, its period beginning in the middle of the cell: pulled
  // with F at CELL_X it grows by F W / (EA).
  State state = straight_state(20, 32);
  Fabric& cell = state.fabric;
  cell.periodic = true;
  cell.width = 40, cell.height = 10;
  FabricYarn& yarn = cell.yarns[0];
  yarn.periodic = true;
  yarn.shift = {1, 0};
  yarn.control_points.clear();
  for (int k = 0; k < 32; ++k) yarn.control_points.push_back({20.0 + 1.25 * (k - 1), 5, 0});
  yarn.held.assign(32, 0);
  ExportOptions options;
  options.quadratic_beams = true;
  write_beams(in_folder("cell.inp"), state, BeamDialect::calculix, options);
  const std::string text = content(in_folder("cell.inp"));
  int control = 0, left = 0;
  std::sscanf(text.c_str() + text.find("NSET=CELL_X\n") + 12, "%d", &control);
  std::sscanf(text.c_str() + text.find("NSET=EDGE_LEFT\n") + 15, "%d", &left);
  ASSERT_EQ(control, 130);
  std::ofstream(in_folder("pull.inp")) << "*INCLUDE, INPUT=cell.inp\n*BOUNDARY\n"
                                       << left << ", 1, 6\n"
                                       << control << ", 2, 3\n"
                                       << control + 1 << ", 1, 3\n"
                                       << "*STEP\n*STATIC\n*CLOAD\n"
                                       << control << ", 1, 1e-5\n*NODE PRINT, NSET=NODES\nU\n"
                                       << "*NODE PRINT, NSET=CELL_X\nU\n*END STEP\n";
  ASSERT_TRUE(run("pull")) << content(in_folder("ccx.log"));
  auto u = displacements("pull");
  const double expected = 1e-5 * 20 / axial;
  // the end element's own softness under a point force counts here (see above)
  EXPECT_NEAR(u[control][0], expected, 0.06 * expected);
  EXPECT_NEAR(u[97][0] - u[33][0], expected / 2, 2e-2 * expected);
}

TEST_F(BeamsTest, calculix_takes_a_whole_plain_cell) {
  if (!has_ccx()) GTEST_SKIP() << "CalculiX (Debian package calculix-ccx) is not installed";
  State state{test::plain_cell(), {}, {}};
  YarnMaterial material;
  material.reference_bend_N_m2 = 1e-8;
  set_state_material(state, material);
  for (const int per_segment : {1, 4}) {
    ExportOptions options;
    options.per_segment = per_segment;
    write_beams(in_folder("cell.inp"), state, BeamDialect::calculix, options);
    const std::string text = content(in_folder("cell.inp"));
    int x = 0;
    std::sscanf(text.c_str() + text.find("NSET=CELL_X\n") + 12, "%d", &x);
    std::ofstream(in_folder("pull.inp")) << "*INCLUDE, INPUT=cell.inp\n*BOUNDARY\n1, 1, 6\n"
                                         << x << ", 1, 1, 0.01\n"
                                         << x << ", 2, 3\n"
                                         << x + 1 << ", 1, 3\n*STEP\n*STATIC\n"
                                         << "*NODE PRINT, NSET=NODES\nU\n*END STEP\n";
    ASSERT_TRUE(run("pull")) << content(in_folder("ccx.log"));
    auto u = displacements("pull");
    int left = 0, right = 0;
    std::sscanf(text.c_str() + text.find("NSET=EDGE_LEFT\n") + 15, "%d", &left);
    std::sscanf(text.c_str() + text.find("NSET=EDGE_RIGHT\n") + 16, "%d", &right);
    EXPECT_NEAR(u[right][0] - u[left][0], 0.01, 1e-6);
    EXPECT_NEAR(u[right][1], u[left][1], 1e-6);
  }
}

}  // namespace
}  // namespace loopwright
