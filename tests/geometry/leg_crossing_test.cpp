// Cables: where the legs of two loops cross, the one that racking carried in front lies in front.
#include <gtest/gtest.h>

#include <cmath>
#include <unordered_map>

#include "geometry/pieces.hpp"

namespace loopwright {
namespace {

std::vector<Vec3> curve_of(const Fabric& fabric, const LoopSpan& span) {
  std::vector<Vec3> points;
  const FabricYarn& yarn = fabric.yarns[static_cast<std::size_t>(span.yarn)];
  for (int i = 0; i <= 60; ++i)
    points.push_back(position(fabric, yarn, span.begin + (span.end - span.begin) * i / 60));
  return points;
}

struct Crossings {
  int count = 0, wrong = 0;
};

// Crossings of two curves as seen from the front.
Crossings crossings_of(const std::vector<Vec3>& front, const std::vector<Vec3>& back) {
  Crossings crossings;
  for (std::size_t i = 0; i + 1 < front.size(); ++i)
    for (std::size_t j = 0; j + 1 < back.size(); ++j) {
      const Vec3 p = front[i], r = front[i + 1] - p, q = back[j], s = back[j + 1] - q;
      const double area = r.x * s.y - r.y * s.x;
      if (std::abs(area) < 1e-12) continue;
      const double t = ((q.x - p.x) * s.y - (q.y - p.y) * s.x) / area;
      const double u = ((q.x - p.x) * r.y - (q.y - p.y) * r.x) / area;
      if (t < 0 || t >= 1 || u < 0 || u >= 1) continue;
      ++crossings.count;
      if ((p + r * t).z < (q + s * u).z) ++crossings.wrong;
    }
  return crossings;
}

class Cables : public testing::TestWithParam<const char*> {};

TEST_P(Cables, the_front_loop_lies_in_front) {
  const std::filesystem::path file = corpus() / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the corpus is not at " << corpus();
  const Piece piece = piece_of_text(text_of(file));
  const Fabric fabric = whole_fabric(piece);
  std::unordered_map<LoopId, const LoopSpan*> spans;
  for (const LoopSpan& span : fabric.loops) spans[span.loop] = &span;
  ASSERT_FALSE(piece.graph.leg_crossings.empty());
  for (const LegCrossing& crossing : piece.graph.leg_crossings) {
    const Crossings found =
        crossings_of(curve_of(fabric, *spans.at(crossing.front)), curve_of(fabric, *spans.at(crossing.back)));
    EXPECT_GE(found.count, 4) << "two legs cross two legs";
    EXPECT_EQ(found.wrong, 0) << "line " << piece.graph.loop(crossing.front).at.line;
  }
}

INSTANTIATE_TEST_SUITE_P(files, Cables,
                         testing::Values("files/cable.k", "files/cable_swatch_2_cable.k",
                                         "knitdb/60_1_074Cable_2.knitout", "knitdb/72_2_114Frozen_1.knitout",
                                         "knitdb/13_3_049TravelingTwists.knitout"));

}  // namespace
}  // namespace loopwright
