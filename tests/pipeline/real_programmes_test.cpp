// Programmes that others wrote, from file to rest: small windows of them, so that the whole road is walked in
// seconds. The full study of ten programmes is studies/real_programmes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "geometry/interlacing.hpp"
#include "pipeline.hpp"

namespace loopwright {
namespace {

std::filesystem::path corpus() {
  const char* set = std::getenv("LOOPWRIGHT_CORPUS");
  return set ? set : LOOPWRIGHT_CORPUS_DEFAULT;
}

struct Wanted {
  const char* file;
  int wales, courses;
};
void PrintTo(const Wanted& wanted, std::ostream* out) { *out << wanted.file; }

class RealProgramme : public testing::TestWithParam<Wanted> {};

TEST_P(RealProgramme, RelaxesWithEveryInterlacing) {
  const std::filesystem::path file = corpus() / "files" / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the corpus of real programmes is absent: " << file;
  PieceRequest request;
  request.window = WindowSize{GetParam().wales, GetParam().courses};
  Diagnostics diagnostics(file.string());
  const Knitting knitting = knit(file, request, diagnostics);
  ASSERT_TRUE(diagnostics.ok()) << diagnostics;

  const Fabric first = first_geometry(knitting, request);
  const Assessment before = assess(first);
  EXPECT_GT(before.interlacings.expected, 0);
  EXPECT_EQ(before.interlacings.intact, before.interlacings.expected);

  const RelaxOptions options = relax_options(first, knitting.program, request);
  const RelaxResult relaxed = relax(first, options);
  EXPECT_TRUE(relaxed.converged) << relaxed.message;
  EXPECT_LT(relaxed.residual, options.tolerance);
  EXPECT_EQ(relaxed.pass_throughs, 0);
  const Assessment after = assess(relaxed.fabric);
  EXPECT_EQ(after.interlacings.intact, after.interlacings.expected);
  EXPECT_GT(after.clearance.distance, options.model.material.contact.core);
}

INSTANTIATE_TEST_SUITE_P(Corpus, RealProgramme,
                         testing::Values(Wanted{"singlejersey.knitout", 5, 5},
                                         Wanted{"rib-1x1.knitout", 6, 5}, Wanted{"interlock.knitout", 4, 4},
                                         Wanted{"lace.knitout", 6, 5}),
                         [](const testing::TestParamInfo<Wanted>& at) {
                           std::string name = at.param.file;
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

// A whole swatch, cast on and bound off, nothing held. Its cast-on and bind-off are drawn with yarn much too
// long or short and almost touching, so that growing in has to do its work.
TEST(BoundOffSwatch, RelaxesFreeWithEveryInterlacing) {
  constexpr int last = 5, courses = 6;
  std::string text = ";!knitout-2\n;;Carriers: 1\n;;Gauge: 12\n;;Yarn-1: wool 2/28 Nm\ninhook 1\n";
  const auto line = [&text](const std::string& op, char direction, int needle) {
    text += op + ' ' + direction + " f" + std::to_string(needle) + " 1\n";
  };
  for (int n = last; n >= 0; n -= 2) line("tuck", '-', n);
  for (int n = 0; n <= last; n += 2) line("tuck", '+', n);
  text += "releasehook 1\n";
  for (int course = 0; course < courses; ++course)
    for (int n = 0; n <= last; ++n) course % 2 == 0 ? line("knit", '-', last - n) : line("knit", '+', n);
  for (int n = 0; n < last; ++n) {  // each loop onto its neighbour's needle, the yarn through both
    const std::string here = std::to_string(n), next = std::to_string(n + 1);
    text += "xfer f" + here + " b" + here + "\nrack 1\nxfer b" + here + " f" + next + "\nrack 0\n";
    line("knit", '+', n + 1);
  }
  line("knit", '-', last);
  line("knit", '+', last);
  text += "outhook 1\ndrop f" + std::to_string(last) + "\n";

  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "bound_off_swatch.k";
  std::ofstream(file) << text;
  Diagnostics diagnostics(file.string());
  const Knitting knitting = knit(file, {}, diagnostics);
  ASSERT_TRUE(diagnostics.ok()) << diagnostics;
  const Fabric first = first_geometry(knitting, {});
  const int interlacings = check_interlacings(first).intact;
  EXPECT_EQ(interlacings, static_cast<int>(first.interlacings.size()));
  EXPECT_GT(interlacings, 45);
  const RelaxResult relaxed = relax(first, relax_options(first, knitting.program, {}));
  EXPECT_TRUE(relaxed.converged) << relaxed.message;
  EXPECT_EQ(relaxed.pass_throughs, 0);
  // Nothing is drawn through the very last loop: it alone may run (the machine warns of it).
  const LoopId last_loop = relaxed.fabric.loops.back().loop;
  for (const int broken : check_interlacings(relaxed.fabric).broken)
    EXPECT_EQ(relaxed.fabric.interlacings[static_cast<std::size_t>(broken)].child, last_loop);
}

// What docs/mechanics.md shows. Its bind-off begins at the edge where the last course ended: drawn with a
// cusp there the yarn stayed folded, which passed for a jam.
TEST(SwatchExample, ComesToRest) {
  const std::filesystem::path file = std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples" / "swatch.k";
  Diagnostics diagnostics(file.string());
  const Knitting knitting = knit(file, {}, diagnostics);
  const Fabric first = first_geometry(knitting, {});
  const RelaxResult relaxed = relax(first, relax_options(first, knitting.program, {}));
  EXPECT_TRUE(relaxed.converged) << relaxed.message;
  EXPECT_EQ(relaxed.pass_throughs, 0);
  const Assessment after = assess(relaxed.fabric);
  EXPECT_EQ(after.interlacings.intact, 130);
  EXPECT_NEAR(after.measured.loop_length_mm, 5.9, 0.03) << "neither squeezed nor stretched";
}

// Without friction a moss cell has rest states folded into itself; growing in must not lead there.
TEST(PeriodicMoss, FindsTheFlatRestState) {
  const std::filesystem::path file =
      std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples" / "structures" / "moss.verm";
  PieceRequest request;
  request.periodic = true;
  request.friction = 0;
  Diagnostics diagnostics(file.string());
  const Knitting knitting = knit(file, request, diagnostics);
  const Fabric first = first_geometry(knitting, request);
  RelaxOptions options = relax_options(first, knitting.program, request);
  const RelaxResult relaxed = relax(first, options);
  ASSERT_TRUE(relaxed.converged) << relaxed.message;
  // Bend energy per loop times loop length: 42.9 at l/d = 17 (physics reference), 45 for this file's l/d of
  // 16; the folded states lie above 60.
  const Assessment after = assess(relaxed.fabric);
  const double loops = static_cast<double>(relaxed.fabric.loops.size());
  const double length = after.measured.loop_length_mm / relaxed.fabric.diameter_mm;
  EXPECT_LT(relaxed.energy.bend / loops * length, 50);
  EXPECT_EQ(after.interlacings.intact, 4);
}

}  // namespace
}  // namespace loopwright
