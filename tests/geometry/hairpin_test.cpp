// Yarn that turns back is drawn round: a cusp of the spline would stay for ever, since no energy sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "geometry/hairpins.hpp"
#include "geometry/pieces.hpp"

namespace loopwright {
namespace {

// The slowest that any segment's parameter is, as a share of its mean speed: 0 at a cusp.
double slowest(const Fabric& fabric) {
  constexpr int steps = 32;
  double least = 1;
  for (const FabricYarn& yarn : fabric.yarns)
    for (std::size_t e = 0; e + 3 < yarn.control_points.size(); ++e) {
      const Vec3* q = &yarn.control_points[e];
      double slow = 1e9, sum = 0;
      for (int k = 0; k <= steps; ++k) {
        const double u = static_cast<double>(k) / steps, v = 1 - u;
        const double speed =
            norm((q[1] - q[0]) * (v * v / 2) + (q[2] - q[1]) * (0.5 + u * v) + (q[3] - q[2]) * (u * u / 2));
        slow = std::min(slow, speed);
        sum += speed / (steps + 1);
      }
      least = std::min(least, slow / sum);
    }
  return least;
}

// Five by five loops cast on and bound off; the bind-off begins where the last course ended, at the left edge
// or, mirrored, at the right.
std::string bound_off(bool mirrored) {
  constexpr int last = 4;
  std::string text =
      ";!knitout-2\n;;Carriers: 1\n;;Gauge: 12\n;;Yarn-1: wool 2/28 Nm\n;;X-Loop-Length: 5.9 mm\ninhook 1\n";
  const auto name = [&](int needle) { return std::to_string(mirrored ? last - needle : needle); };
  const auto line = [&](const char* op, bool right, int needle) {
    text += std::string(op) + (right != mirrored ? " + f" : " - f") + name(needle) + " 1\n";
  };
  for (int n = last; n >= 0; n -= 2) line("tuck", false, n);
  for (int n = 1; n <= last; n += 2) line("tuck", true, n);
  text += "releasehook 1\n";
  for (int course = 0; course < last + 1; ++course)
    for (int n = 0; n <= last; ++n) course % 2 == 0 ? line("knit", false, last - n) : line("knit", true, n);
  for (int n = 0; n < last; ++n) {
    text += "xfer f" + name(n) + " b" + name(n) + "\nrack " + (mirrored ? "-1" : "1") + "\nxfer b" + name(n) +
            " f" + name(n + 1) + "\nrack 0\n";
    line("knit", true, n + 1);
  }
  line("knit", false, last);
  line("knit", true, last);
  return text + "outhook 1\ndrop f" + name(last) + "\n";
}

TEST(Hairpins, BindOffsTurnRound) {
  const std::filesystem::path example =
      std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples" / "swatch.k";
  for (const std::string& text : {bound_off(false), bound_off(true), text_of(example)}) {
    const Fabric fabric = whole_fabric(piece_of_text(text));
    EXPECT_GT(slowest(fabric), 0.3) << text;
    const InterlacingCheck check = check_interlacings(fabric);
    EXPECT_EQ(check.intact, check.expected);
    EXPECT_GT(check.expected, 30);
  }
}

TEST(Hairpins, OnlyFoldsAreOpened) {
  const std::vector<Vec3> straight{{0, 0, 0}, {4, 0, 0}};
  std::vector<Vec3> way = straight;
  open_hairpins(way, {-2, 1, 0}, {6, 1, 0}, 0.75);
  EXPECT_EQ(way, straight);
  // From the right, above its own way on: the leg that comes in stays above.
  open_hairpins(way, {2, 0.5, 0}, {6, 1, 0}, 0.75);
  ASSERT_EQ(way.size(), 3U);
  EXPECT_GT(way[0].y, 0.7);
  EXPECT_LT(way[1].y, -0.7);
  EXPECT_NEAR(distance(way[0], way[1]), 1.5, 1e-12);
  EXPECT_EQ(way[2], straight[1]);
  // At the end, and legs that cover each other.
  way = straight;
  open_hairpins(way, {-2, 1, 0}, {1, 0, 0}, 0.75);
  ASSERT_EQ(way.size(), 3U);
  EXPECT_EQ(way[0], straight[0]);
  EXPECT_NEAR(distance(way[1], way[2]), 1.5, 1e-12);
  EXPECT_EQ(way[1].z, 0);
}

}  // namespace
}  // namespace loopwright
