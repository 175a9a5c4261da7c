// `export`, and curves of other programs in `measure`, `relax` and `render`, run as a user would.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "outputs/state.hpp"
#include "run_command.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;
constexpr double pi = std::numbers::pi;
const std::string plain = std::string(LOOPWRIGHT_SOURCE_DIR) + "/examples/structures/plain.verm";

// Rings of 4 mm radius in a chain, 5 mm apart, each standing across the one before it.
std::string chain_of_rings(int rings) {
  std::ostringstream obj;
  constexpr int points = 40;
  for (int r = 0; r < rings; ++r) {
    for (int k = 0; k < points; ++k) {
      const double x = 4 * std::cos(2 * pi * k / points) + 5 * r, across = 4 * std::sin(2 * pi * k / points);
      obj << "v " << x << ' ' << (r % 2 == 0 ? across : 0) << ' ' << (r % 2 == 0 ? 0 : across) << '\n';
    }
    obj << 'l';
    for (int k = 0; k <= points; ++k) obj << ' ' << r * points + k % points + 1;
    obj << '\n';
  }
  return obj.str();
}

nlohmann::json measured(const std::vector<std::string>& arguments, const TemporaryFolder& folder) {
  std::vector<std::string> words{"measure"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  words.insert(words.end(), {"--json", "-"});
  const CommandOutcome outcome = run_command(words, folder);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out);
}

TEST(ExportCommand, a_relaxed_cell_keeps_its_yarn_in_every_curve_format) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_command({"relax", plain, "--periodic", "-o", "cell.h5"}, folder).status, 0);
  const nlohmann::json cell = measured({"cell.h5"}, folder);
  const double yarn_mm = cell["loop_length_mm"].get<double>();
  for (const std::string name : {"cell.bcc", "cell.yarns", "cell.obj"}) {
    const CommandOutcome outcome = run_command({"export", "cell.h5", "-o", name}, folder);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("1 yarns, 1 loops"));
    const nlohmann::json back = measured({name, "--yarn", "diameter=0.37mm linear-density=72tex"}, folder);
    EXPECT_NEAR(back["yarn_m"][0].get<double>() * 1e3, yarn_mm, 5e-3 * yarn_mm) << name;
    EXPECT_NEAR(back["mass_g"].get<double>(), back["yarn_m"][0].get<double>() * 72e-3, 1e-9) << name;
    EXPECT_NEAR(back["thickness_mm"].get<double>(), cell["thickness_mm"].get<double>(), 5e-3) << name;
    EXPECT_TRUE(back["Kc"].is_null()) << name;
    EXPECT_EQ(back["loops"], 0) << name;
  }
}

TEST(ExportCommand, courses_and_needles_of_a_piece_stand_in_its_table) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_command({"export", plain, "--window", "5x4", "-o", "piece.csv"}, folder).status, 0);
  std::istringstream in(file_content(folder.file("piece.csv")));
  std::string header, row;
  std::getline(in, header);
  EXPECT_EQ(header, "yarn,x_mm,y_mm,z_mm,arc_mm,curvature_per_mm,loop,kind,side,course,needle,bed,line");
  // by loop: its course must rise with y, its needle with x
  double last_x = -1e9, last_needle = -1e9;
  bool rises = true;
  while (std::getline(in, row)) {
    std::vector<std::string> fields;
    std::istringstream words(row);
    for (std::string field; std::getline(words, field, ',');) fields.push_back(field);
    if (fields.size() < 13 || fields[6].empty()) continue;
    const double needle = std::stod(fields[10]), x = std::stod(fields[1]);
    // a wale further along x is a needle further; within a wale any x goes
    if (needle > last_needle + 0.5 && last_needle > -1e8 && x < last_x - 4) rises = false;
    last_needle = needle, last_x = x;
    EXPECT_EQ(fields[7], "0");
    EXPECT_EQ(fields[8], "1");
  }
  EXPECT_TRUE(rises);
}

TEST(ExportCommand, says_what_it_cannot_do_and_leaves_nothing) {
  const TemporaryFolder folder;
  const auto fault = [&](const std::vector<std::string>& arguments, const char* said) {
    const CommandOutcome outcome = run_command(arguments, folder);
    EXPECT_EQ(outcome.status, 1) << said;
    EXPECT_THAT(outcome.err, HasSubstr(said));
  };
  fault({"export", plain, "-o", "a.xyz"}, "known are .tubes.obj .obj");
  fault({"export", plain, "--format", "iges", "-o", "a.igs"},
        "there is no format 'iges'; there are obj-tubes");
  fault({"export", plain, "--repeats", "2x2", "-o", "a.obj"}, "repeats are for a periodic cell");
  fault({"export", plain, "--repeats", "2", "-o", "a.obj"}, "COLUMNSxROWS");
  fault({"export", plain, "--repeats", "0x2", "-o", "a.obj"}, "COLUMNSxROWS");
  fault({"export", plain, "-o", "nowhere/a.obj"}, "nowhere");
  EXPECT_TRUE(folder.names().empty());
  folder.write("tubes.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  fault({"measure", "tubes.obj"}, "tubes.obj: it holds faces and no lines");
  folder.write("one.obj", "v 0 0 0\nv 1 0 0\nv 2 1 0\nl 1 2 3\n");
  fault({"measure", "one.obj"}, "--yarn diameter=0.5mm");
  fault({"measure", "one.obj", "--yarn", "thickness=1mm"}, "unknown yarn key 'thickness'");
  fault({"relax", "one.obj", "--periodic", "-o", "a.h5"}, "curves are one piece");
  folder.write("two.obj", "v 0 0 0\nv 9 0 0\nv 18 0 0\nv 0 1 0\nv 9 1 0\nv 18 1 0\nl 1 2 3\nl 4 5 6\n");
  fault({"stretch", "two.obj", "--csv", "a.csv"}, "needs loops");
}

TEST(ExportCommand, a_chain_of_rings_is_measured_relaxed_and_stays_a_chain) {
  const TemporaryFolder folder;
  folder.write("chain.obj", chain_of_rings(4));
  const std::vector<std::string> yarn{"--yarn", "diameter=1mm"};
  const nlohmann::json before = measured({"chain.obj", yarn[0], yarn[1]}, folder);
  EXPECT_EQ(before["closed_yarns"], 4);
  ASSERT_EQ(before["linked_pairs"].size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(before["linked_pairs"][k][0], k);
    EXPECT_EQ(before["linked_pairs"][k][1], k + 1);
    EXPECT_EQ(std::abs(before["linked_pairs"][k][2].get<int>()), 1);
  }
  EXPECT_NEAR(before["yarn_m"][0].get<double>(), 8 * pi * 1e-3, 1e-6);
  ASSERT_EQ(run_command({"relax", "chain.obj", yarn[0], yarn[1], "-o", "chain.h5"}, folder).status, 0);
  const nlohmann::json after = measured({"chain.h5"}, folder);
  EXPECT_EQ(after["linked_pairs"], before["linked_pairs"]);
  EXPECT_EQ(after["pass_throughs"], 0);
  EXPECT_EQ(after["converged"], true);
  // a state of curves is gone on with like any other
  EXPECT_EQ(run_command({"relax", "chain.h5", "-o", "chain.h5"}, folder).status, 0);
  EXPECT_EQ(run_command({"render", "chain.h5", "-o", "chain.png", "--picture-size", "64x48"}, folder).status,
            0);
}

TEST(ExportCommand, a_ring_of_bent_yarn_relaxes_to_a_circle) {
  // An ellipse of axes 2 : 1, free in space: least bending energy at given length is the circle, 2 pi^2 B /
  // L.
  const TemporaryFolder folder;
  std::ostringstream obj;
  constexpr int points = 60;
  for (int k = 0; k < points; ++k)
    obj << "v " << 12 * std::cos(2 * pi * k / points) << ' ' << 6 * std::sin(2 * pi * k / points) << " 0\n";
  obj << 'l';
  for (int k = 0; k <= points; ++k) obj << ' ' << k % points + 1;
  folder.write("ellipse.obj", obj.str() + "\n");
  ASSERT_EQ(run_command({"relax", "ellipse.obj", "--yarn", "diameter=1mm", "-o", "ring.h5"}, folder).status,
            0);
  const State ring = read_state(folder.file("ring.h5"));
  const FabricYarn& yarn = ring.fabric.yarns[0];
  const double length = arc_length(ring.fabric, yarn);
  Vec3 centre;
  const std::vector<Vec3> line = polyline(ring.fabric, yarn, 4);
  for (std::size_t k = 0; k + 1 < line.size(); ++k) centre += line[k] / static_cast<double>(line.size() - 1);
  for (const Vec3& p : line) EXPECT_NEAR(distance(p, centre), length / (2 * pi), 0.02 * length / (2 * pi));
}

}  // namespace
}  // namespace loopwright
