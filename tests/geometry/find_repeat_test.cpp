// A repeat that nobody stated: found in the yarn graph of a knitout programme, and cut out as a cell.
#include "geometry/find_repeat.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>
#include <sstream>

#include "geometry/fit_fabric.hpp"
#include "geometry/interlacing.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "notation/read_program.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

struct Knitted {
  Program program;
  YarnGraph graph;
};

Knitted run(Program program, Diagnostics& diagnostics) {
  Knitted knitted;
  knitted.program = std::move(program);
  knitted.graph = build_yarn_graph(knitted.program, run_machine(knitted.program, diagnostics), diagnostics);
  return knitted;
}

// `rear(wale, course)`: which loops show their rear; each is moved to its bed before it is knitted through.
// `yarn(course)`: 1 or 2, at least two courses each.
Knitted swatch(
    int wales, int courses, const std::function<bool(int, int)>& rear,
    const std::function<int(int)>& yarn = [](int) { return 1; }) {
  std::ostringstream text;
  text << ";!knitout-2\n;;Carriers: 1 2\nin 1\n";
  for (int w = wales - 1; w >= 0; --w) text << "knit - f" << w << " 1\n";
  std::string on(static_cast<std::size_t>(wales), 'f');
  bool second_in = false;
  for (int c = 0; c < courses; ++c) {
    if (c > 0 && yarn(c) == 2 && yarn(c - 1) == 1 && !second_in) {
      text << "in 2\n";
      second_in = true;
    }
    for (int w = 0; w < wales; ++w) {
      char& at = on[static_cast<std::size_t>(w)];
      const char wanted = rear(w, c) ? 'b' : 'f';
      if (at != wanted) text << "xfer " << at << w << ' ' << wanted << w << '\n';
      at = wanted;
    }
    for (int k = 0; k < wales; ++k) {
      const int w = c % 2 == 0 ? k : wales - 1 - k;
      text << "knit " << (c % 2 == 0 ? '+' : '-') << ' ' << on[static_cast<std::size_t>(w)] << w << ' '
           << yarn(c) << '\n';
    }
  }
  text << "out 1\n" << (second_in ? "out 2\n" : "");
  Diagnostics diagnostics("swatch.k");
  Knitted knitted = run(read_knitout(text.str(), diagnostics), diagnostics);
  EXPECT_TRUE(diagnostics.ok()) << diagnostics;
  return knitted;
}

LoopSelection inner(const YarnGraph& graph, int margin, int wales) {
  LoopSelection inside(graph.loops.size(), 0);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Loop& loop = graph.loops[i];
    inside[i] =
        loop.slot >= margin && loop.slot < wales - margin && !loop.parents.empty() && !loop.children.empty()
            ? 1
            : 0;
  }
  return inside;
}

Fabric cell_of(const Knitted& knitted, const FoundRepeat& repeat) {
  const GeometryOptions options = make_geometry_options(knitted.program);
  const PlacedPiece piece = place_type_points(knitted.graph, options);
  return fit_fabric(cut_periodic_cell(knitted.graph, options, piece, repeat.range), knitted.graph, options);
}

struct Case {
  const char* name;
  int wales, courses;
  std::function<bool(int, int)> rear;
};

TEST(FindRepeat, FindsTheSmallestRepeatOfFaces) {
  const std::vector<Case> cases = {
      {"plain", 1, 1, [](int, int) { return false; }},
      {"garter", 1, 2, [](int, int c) { return c % 2 == 1; }},
      {"rib 1x1", 2, 1, [](int w, int) { return w % 2 == 1; }},
      {"moss", 2, 2, [](int w, int c) { return (w + c) % 2 == 1; }},
      {"rib 6x3", 9, 1, [](int w, int) { return w % 9 < 3; }},
      {"rib 3x2", 5, 1, [](int w, int) { return w % 5 < 2; }},
      {"basket", 6, 4, [](int w, int c) { return (w % 6 < 3) != (c % 4 < 2); }},
  };
  for (const Case& c : cases) {
    const Knitted knitted = swatch(28, 20, c.rear);
    const auto repeat = find_repeat(knitted.graph, inner(knitted.graph, 2, 28));
    ASSERT_TRUE(repeat) << c.name;
    EXPECT_EQ(repeat->range.wales, c.wales) << c.name;
    EXPECT_EQ(repeat->courses, c.courses) << c.name;
    const Fabric cell = cell_of(knitted, *repeat);
    EXPECT_EQ(static_cast<int>(cell.loops.size()), c.wales * c.courses) << c.name;
    const InterlacingCheck check = check_interlacings(cell);
    EXPECT_EQ(check.intact, c.wales * c.courses) << c.name;
    EXPECT_EQ(check.expected, check.intact) << c.name;
  }
}

TEST(FindRepeat, StripesOfTwoYarnsRepeatAsStripes) {
  const Knitted knitted = swatch(
      20, 24, [](int, int) { return false; }, [](int c) { return c % 4 < 2 ? 1 : 2; });
  const auto repeat = find_repeat(knitted.graph, inner(knitted.graph, 2, 20));
  ASSERT_TRUE(repeat);
  EXPECT_EQ(repeat->courses, 4);
  const Fabric cell = cell_of(knitted, *repeat);
  EXPECT_EQ(cell.yarns.size(), 4U);
  EXPECT_EQ(check_interlacings(cell).intact, 4);
}

TEST(FindRepeat, LeavesOutWhatTheRegionHasBesideIt) {
  // Three wales at the left are of another stitch; the rest is rib.
  const Knitted knitted = swatch(40, 16, [](int w, int c) { return w < 8 ? c % 2 == 0 : (w - 8) % 4 < 2; });
  const auto repeat = find_repeat(knitted.graph, inner(knitted.graph, 5, 40));
  ASSERT_TRUE(repeat);
  EXPECT_EQ(repeat->range.wales, 4);
  EXPECT_LT(repeat->wales_share, 1);
  EXPECT_GE(repeat->range.first_slot, 8);
  EXPECT_LE(repeat->range.first_slot + repeat->range.wales, 35);
}

TEST(FindRepeat, IsNotNearlyAllOfTheRegion) {
  // Three repeats of ten wales between four plain wales on either side: after 34 wales all is alike too,
  // trivially.
  const Knitted knitted =
      swatch(42, 16, [](int w, int c) { return w >= 6 && w < 36 && (c % 2 == 0) == ((w - 6) % 10 < 3); });
  const auto repeat = find_repeat(knitted.graph, inner(knitted.graph, 2, 42));
  ASSERT_TRUE(repeat);
  EXPECT_EQ(repeat->range.wales, 10);
}

TEST(FindRepeat, FindsNoneWhereThereIsNone) {
  std::mt19937 random(20261122);
  std::vector<std::vector<bool>> faces(20, std::vector<bool>(24));
  for (auto& course : faces)
    for (std::size_t w = 0; w < course.size(); ++w) course[w] = random() % 2 == 0;
  const Knitted knitted = swatch(24, 20, [&faces](int w, int c) {
    return faces[static_cast<std::size_t>(c)][static_cast<std::size_t>(w)];
  });
  EXPECT_FALSE(find_repeat(knitted.graph, inner(knitted.graph, 1, 24)));
  EXPECT_FALSE(find_repeat(knitted.graph, LoopSelection(knitted.graph.loops.size(), 0)));
}

// Sixty wales and courses in the middle of a swatch of KnitDB.
LoopSelection measured_part(const YarnGraph& graph) {
  int low = 1 << 30, high = -low;
  std::vector<int> passes;
  for (const Loop& loop : graph.loops) {
    low = std::min(low, static_cast<int>(loop.slot)), high = std::max(high, static_cast<int>(loop.slot));
    passes.push_back(loop.pass);
  }
  std::sort(passes.begin(), passes.end());
  passes.erase(std::unique(passes.begin(), passes.end()), passes.end());
  LoopSelection inside(graph.loops.size(), 0);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Loop& loop = graph.loops[i];
    inside[i] =
        loop.slot >= low + 12 && loop.slot < low + 72 && loop.pass >= passes[15] && loop.pass <= passes[74]
            ? 1
            : 0;
  }
  return inside;
}

TEST(FindRepeat, EverySwatchOfTheCorpusHasAWholeCell) {
  const char* set = std::getenv("LOOPWRIGHT_CORPUS");
  const std::filesystem::path folder =
      std::filesystem::path(set ? set : LOOPWRIGHT_CORPUS_DEFAULT) / "knitdb";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "the corpus is not there: " << folder;
  int swatches = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".knitout") continue;
    Diagnostics diagnostics(entry.path().string());
    const Knitted knitted = run(read_program(entry.path(), diagnostics), diagnostics);
    const auto repeat = find_repeat(knitted.graph, measured_part(knitted.graph));
    ASSERT_TRUE(repeat) << entry.path().filename();
    EXPECT_LE(repeat->range.wales, 30) << entry.path().filename();
    const InterlacingCheck check = check_interlacings(cell_of(knitted, *repeat));
    EXPECT_EQ(check.intact, check.expected) << entry.path().filename();
    // nor does yarn beside a loop run through its parent's head
    EXPECT_EQ(check.by_head, 0) << entry.path().filename();
    ++swatches;
  }
  EXPECT_GE(swatches, 46);
}

// Loops that go two needles aside beside each other, and across others: their legs keep clear of each other,
// or no step from the first geometry can be certified. With the yarn and the loops of those swatches.
TEST(FindRepeat, LegsOfCablesHaveRoom) {
  const char* set = std::getenv("LOOPWRIGHT_CORPUS");
  const std::filesystem::path folder =
      std::filesystem::path(set ? set : LOOPWRIGHT_CORPUS_DEFAULT) / "knitdb";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "the corpus is not there: " << folder;
  for (const auto& [name, least] : {std::pair{"23_1_085InterlockingDiagonals", 0.1},
                                    {"18_2_075Chain", 0.12},
                                    {"11_2_039TexturedTrellis", 0.1},
                                    {"25_2_097DiagonalDiamond", 0.045},
                                    {"64_3_090Iceberg", 0.04}}) {
    Diagnostics diagnostics;
    Program program = read_program(folder / (std::string(name) + ".knitout"), diagnostics);
    program.settings.gauge_npi = 15;
    program.settings.loop_length_mm = 6.53;
    program.settings.bed_change_mm = 1.39;
    for (YarnData& yarn : program.yarns) yarn.diameter_mm = 0.8;
    const Knitted knitted = run(std::move(program), diagnostics);
    const auto repeat = find_repeat(knitted.graph, measured_part(knitted.graph));
    ASSERT_TRUE(repeat) << name;
    const Fabric cell = cell_of(knitted, *repeat);
    EXPECT_GT(min_clearance(cell).distance, least) << name;
  }
}

}  // namespace
}  // namespace loopwright
