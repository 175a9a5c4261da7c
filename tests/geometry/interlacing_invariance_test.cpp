// The reading of interlacings is a linking number: maps of space that yarn goes along with leave it as it is,
// and what is not linked stays unlinked.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "geometry/interlacing.hpp"
#include "geometry/pieces.hpp"

namespace loopwright {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

const std::vector<std::vector<std::string>> charts{{"f"}, {"fb"}, {"f", "b"}, {"fb", "bf"}};

Fabric piece_of(const std::vector<std::string>& chart) {
  return whole_fabric(piece_of_text(chart_programme(chart, 12, 13)));
}

// The same curves in twice as many segments, so that control points that are moved by a map carry the curve
// with them.
Fabric refined(Fabric fabric) {
  for (FabricYarn& yarn : fabric.yarns) {
    const std::vector<Vec3> q = std::move(yarn.control_points);
    yarn.control_points = {(q[0] + q[1]) / 2};
    for (std::size_t i = 1; i + 1 < q.size(); ++i) {
      yarn.control_points.push_back((q[i - 1] + q[i] * 6 + q[i + 1]) / 8);
      yarn.control_points.push_back((q[i] + q[i + 1]) / 2);
    }
    yarn.held.assign(yarn.control_points.size(), 0);
    yarn.segment_rest_length /= 2;
  }
  for (LoopSpan& span : fabric.loops) span.begin *= 2, span.apex *= 2, span.end *= 2;
  return fabric;
}

void move(Fabric& fabric, const std::function<Vec3(const Vec3&)>& map) {
  for (FabricYarn& yarn : fabric.yarns)
    for (Vec3& q : yarn.control_points) q = map(q);
}

Vec3 turned(const Vec3& p, const Vec3& axis, double angle) {
  return p * std::cos(angle) + cross(axis, p) * std::sin(angle) +
         axis * (dot(axis, p) * (1 - std::cos(angle)));
}

// Turns what is near `centre` by `angle`, less and less farther out: space is twisted, never torn.
std::function<Vec3(const Vec3&)> twist(const Vec3& centre, const Vec3& axis, double angle, double radius) {
  return [=](const Vec3& p) {
    const double share = std::clamp(2 - norm(p - centre) / radius, 0.0, 1.0);
    return centre + turned(p - centre, axis, angle * share * share * (3 - 2 * share));
  };
}

// Pairs that are not in the record: the loop below a parent, and the one beside it in its yarn.
std::vector<PlacedInterlacing> wrong_pairs(const Fabric& fabric) {
  std::map<LoopId, std::size_t> place;
  for (std::size_t k = 0; k < fabric.loops.size(); ++k) place[fabric.loops[k].loop] = k;
  std::map<LoopId, LoopId> parent_of;
  for (const PlacedInterlacing& pair : fabric.interlacings) parent_of[pair.child] = pair.parent;
  std::vector<PlacedInterlacing> wrong;
  for (PlacedInterlacing pair : fabric.interlacings) {
    const std::size_t beside = place.at(pair.parent) + 1;
    const auto below = parent_of.find(pair.parent);
    if (below != parent_of.end()) wrong.push_back({below->second, pair.child, pair.sign, {0, 0}});
    if (beside < fabric.loops.size() && parent_of[pair.child] != fabric.loops[beside].loop)
      wrong.push_back({fabric.loops[beside].loop, pair.child, pair.sign, {0, 0}});
  }
  return wrong;
}

// How many of the others are taken for interlaced, beside the pairs that are.
int accepted(const Fabric& fabric, const std::vector<PlacedInterlacing>& others) {
  Fabric with = fabric;
  with.interlacings.insert(with.interlacings.begin(), others.begin(), others.end());
  const InterlacingCheck check = check_interlacings(with);
  const auto refused = std::count_if(check.broken.begin(), check.broken.end(),
                                     [&](int k) { return k < static_cast<int>(others.size()); });
  return static_cast<int>(others.size()) - static_cast<int>(refused);
}

TEST(InterlacingReading, DoesNotDependOnHowFarLoopsLean) {
  for (const auto& chart : charts) {
    const Fabric straight = refined(refined(piece_of(chart)));
    const std::vector<PlacedInterlacing> wrong = wrong_pairs(straight);
    ASSERT_GT(wrong.size(), 200u);
    for (const double angle : {-80.0, 45.0, 80.0})
      for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6, 0, 0.8}}) {
        // every loop, by a shear in the plane, out of it or both; then some, while those round them stand
        Fabric leaning = straight;
        const double along = std::tan(angle * degree);
        move(leaning, [&](const Vec3& p) { return p + Vec3{axis.z, 0, axis.x} * (along * p.y); });
        Fabric twisted = straight;
        move(twisted, twist({0.5, 0.3, 0}, axis, angle * degree, 5));
        for (Fabric* fabric : {&leaning, &twisted}) {
          InterlacingCheck check = check_interlacings(*fabric);
          EXPECT_EQ(check.intact, check.expected) << chart[0] << ", " << angle;
          EXPECT_LE(check.by_head, 2) << chart[0] << ", " << angle;
          EXPECT_EQ(accepted(*fabric, wrong), 0) << chart[0] << ", " << angle;
          for (PlacedInterlacing& pair : fabric->interlacings) pair.sign = -pair.sign;
          EXPECT_EQ(check_interlacings(*fabric).intact, 0) << chart[0] << ", " << angle;
        }
      }
  }
}

// A straight yarn along x, and another whose loop goes up before it; where its feet come from is `behind`.
Fabric yarn_over(double before, double behind, double feet = -1.2) {
  Fabric fabric;
  FabricYarn laid, drawn;
  for (int k = 0; k <= 16; ++k) laid.control_points.push_back({k - 8.0, 0, 0});
  const std::vector<Vec3> half{{-6, 2.5, behind},   {-4.5, 2, behind}, {-3, 1, behind},
                               {-2, feet, behind},  {-1.6, feet, 0},   {-1.4, feet, before},
                               {-1.3, 0.5, before}, {-1.2, 2, before}, {-1.2, 3.5, before},
                               {-0.9, 5, before},   {0, 5.8, before}};
  drawn.control_points = half;
  for (std::size_t k = half.size() - 1; k-- > 0;)
    drawn.control_points.push_back({-half[k].x, half[k].y, half[k].z});
  int order = 0;
  for (FabricYarn* yarn : {&laid, &drawn}) {
    yarn->held.assign(yarn->control_points.size(), 0);
    LoopSpan span;
    span.loop = LoopId(static_cast<std::size_t>(order));
    span.yarn = span.course = order++;
    span.end = yarn->segments();
    span.apex = span.end / 2;
    fabric.loops.push_back(span);
    fabric.yarns.push_back(*yarn);
  }
  fabric.interlacings.push_back({LoopId(0), LoopId(1), 1, {0, 0}});
  return fabric;
}

TEST(InterlacingReading, AStraightYarnOverIsSeen) {
  EXPECT_EQ(check_interlacings(yarn_over(1, -1)).intact, 1);
  for (const double angle : {-80.0, -40.0, 40.0, 80.0}) {
    Fabric leaning = yarn_over(1, -1);
    const double along = std::tan(angle * degree);
    move(leaning, [&](const Vec3& p) { return p + Vec3{1, 0, 0.5} * (along * p.y); });
    EXPECT_EQ(check_interlacings(leaning).intact, 1) << angle;
  }
  // from before the yarn to behind it: a rear stitch
  Fabric rear = yarn_over(-1, 1);
  EXPECT_EQ(check_interlacings(rear).intact, 0);
  rear.interlacings[0].sign = -1;
  EXPECT_EQ(check_interlacings(rear).intact, 1);
  // wholly before it, wholly behind it, and over it instead of under it
  for (const Fabric& lost : {yarn_over(1, 0.8), yarn_over(-1, -0.8), yarn_over(1, -1, 1.2)})
    EXPECT_EQ(check_interlacings(lost).intact, 0);
}

// Draws a loop out of its parent's head: its yarn runs from sinker to sinker behind it.
void draw_out(Fabric& fabric, const LoopSpan& span, int sign) {
  FabricYarn& yarn = fabric.yarns[static_cast<std::size_t>(span.yarn)];
  const Vec3 a = position(fabric, yarn, span.begin), b = position(fabric, yarn, span.end);
  for (std::size_t i = 0; i < yarn.control_points.size(); ++i) {
    const double share = (static_cast<double>(i) - 1 - span.begin) / (span.end - span.begin);
    if (share < 0 || share > 1) continue;
    yarn.control_points[i] = a + (b - a) * share + Vec3{0, 0, -2.5 * sign * std::sin(180 * degree * share)};
  }
}

TEST(InterlacingReading, ALoopDrawnOutOfItsParentIsLost) {
  for (const auto& chart : charts) {
    const Fabric fabric = piece_of(chart);
    for (std::size_t k = 14; k < fabric.interlacings.size(); k += 13) {
      const PlacedInterlacing& pair = fabric.interlacings[k];
      Fabric drawn = fabric;
      for (const LoopSpan& span : fabric.loops)
        if (span.loop == pair.child) draw_out(drawn, span, pair.sign);
      // itself and what hung in it, nothing else
      std::vector<int> lost;
      for (std::size_t i = 0; i < fabric.interlacings.size(); ++i)
        if (fabric.interlacings[i].child == pair.child || fabric.interlacings[i].parent == pair.child)
          lost.push_back(static_cast<int>(i));
      EXPECT_EQ(check_interlacings(drawn).broken, lost) << chart[0] << ", pair " << k;
    }
  }
}

}  // namespace
}  // namespace loopwright
