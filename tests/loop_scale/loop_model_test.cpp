// The structure model (tables 1 and 2, equations (1) to (5)) and the nets of figures 5 to 9 on knitted
// graphs, and the correlation of curves and masses.
#include "loop_scale/loop_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/paper_loop.hpp"
#include "geometry/pieces.hpp"
#include "loop_scale/settle.hpp"

namespace loopwright {
namespace {

constexpr int wales = 7, courses = 8;

struct KnittedModel {
  Piece piece;
  LoopModel model;

  // Loop of a course and wale, both from 0.
  LoopId loop(int course, int wale) const {
    const bool right = course % 2 == 0;
    return LoopId(course * wales + (right ? wale : wales - 1 - wale));
  }
  Vec3 lower(int course, int wale) const { return model.start[index(course, wale, true)]; }
  Vec3 upper(int course, int wale) const { return model.start[index(course, wale, false)]; }
  std::size_t index(int course, int wale, bool low) const {
    const std::size_t k = loop(course, wale).position();
    return static_cast<std::size_t>(low ? model.points.lower[k] : model.points.upper[k]);
  }
  double r() const { return model.geometry.shape_radius(); }
};

KnittedModel knitted(const std::vector<std::string>& chart, const LoopModelOptions& options = {}) {
  Piece piece = piece_of_text(chart_programme(chart, wales, courses));
  LoopModel model = build_loop_model(piece.graph, piece.program, options);
  return {std::move(piece), std::move(model)};
}

const std::vector<std::string> plain{"f"}, rib{"fb"}, purl{"f", "b"};

TEST(structure_model, table_1_and_equations_1_and_2) {
  const KnittedModel k = knitted(plain);
  const double r = k.r();
  const Vec3 o = k.lower(3, 3);
  for (int m = -1; m <= 1; ++m)
    for (int n = -1; n <= 1; ++n) {
      EXPECT_LT(distance(k.lower(3 + m, 3 + n), o + Vec3{8 * n * r, 7 * m * r, 0}), 1e-6 * r);
      EXPECT_LT(distance(k.upper(3 + m, 3 + n), o + Vec3{8 * n * r, 7 * (m + 1) * r, 0}), 1e-6 * r);
      // P of the loop below is O
      EXPECT_EQ(k.index(3 + m - 1, 3 + n, false), k.index(3 + m, 3 + n, true));
    }
}

// The nine type value points of a loop among all its points, from left to right.
std::array<Vec3, 9> nine_points(const KnittedModel& k, int course, int wale) {
  const LoopId id = k.loop(course, wale);
  const std::vector<TypePoint>& points =
      k.piece.graph.yarns[0].loops.empty() ? k.model.curves.yarns[0].points : k.model.curves.yarns[0].points;
  std::size_t first = 0;
  while (points[first].loop != id || points[first].part != LoopPart::foot) ++first;
  // A, T1, B, T2, A', T3, B', T4 and back
  const std::array<std::ptrdiff_t, 9> places{-1, 1, 3, 5, 7, 9, 11, 13, 15};
  std::array<Vec3, 9> t;
  for (std::size_t i = 0; i < 9; ++i)
    t[i] = points[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(first) + places[i])].position;
  if (k.piece.graph.loop(id).direction == Direction::left) std::reverse(t.begin(), t.end());
  return t;
}

TEST(structure_model, table_2_in_plain) {
  const KnittedModel k = knitted(plain);
  const double r = k.r();
  for (const int course : {2, 3})
    for (const int wale : {2, 4}) {
      const std::array<Vec3, 9> t = nine_points(k, course, wale);
      const std::array<Vec3, 9> paper = paper_loop(k.lower(course, wale), k.upper(course, wale),
                                                   k.lower(course, wale - 1), k.lower(course, wale + 1), r);
      for (std::size_t i = 0; i < 9; ++i) EXPECT_LT(distance(t[i], paper[i]), 1e-6 * r) << "T" << i;
    }
}

TEST(structure_model, rib_starts_at_twice_the_thickness_with_mirrored_loops) {
  const KnittedModel k = knitted(rib);
  const double r = k.r();
  for (const int wale : {2, 3, 4}) {
    const double s = wale % 2 == 0 ? 1 : -1;
    const Vec3 o = k.lower(3, wale);
    EXPECT_NEAR(o.z, 2.5 * s * r, 1e-9);
    EXPECT_NEAR(k.lower(3, wale + 1).x - o.x, 8 * r, 1e-9);  // width and height unchanged
    EXPECT_NEAR(k.upper(3, wale).y - o.y, 7 * r, 1e-6 * r);
    const std::array<Vec3, 9> t = nine_points(k, 3, wale);
    const std::array<Vec3, 9> table{{{-4, -3, -2.5 * s},
                                     {-1, 0, 0},
                                     {-2, 3.5, 1.5 * s},
                                     {-3, 7, 0},
                                     {0, 10, -1.5 * s},
                                     {3, 7, 0},
                                     {2, 3.5, 1.5 * s},
                                     {1, 0, 0},
                                     {4, -3, -2.5 * s}}};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_LT(distance(t[i], o + table[i] * r), 1e-6 * r) << "T" << i;
  }
  double low = 0, high = 0;
  for (const TypePoint& p : k.model.curves.yarns[0].points) {
    low = std::min(low, p.position.z);
    high = std::max(high, p.position.z);
  }
  EXPECT_NEAR((high - low) / r + 2, 10, 1e-6);  // 2 M, M = 5 r
}

TEST(structure_model, purl_starts_with_inclined_warp_springs) {
  const KnittedModel k = knitted(purl);
  const double r = k.r();
  for (const int course : {2, 3, 4}) {
    const double s = course % 2 == 0 ? 1 : -1;
    EXPECT_NEAR(k.lower(course, 3).z, 2.5 * s * r, 1e-9);
    EXPECT_NEAR(k.upper(course, 3).z, -2.5 * s * r, 1e-9);
    EXPECT_NEAR(k.upper(course, 3).y - k.lower(course, 3).y, 7 * r, 1e-6 * r);
  }
}

int count(const MassSpringNet& net, SpringKind kind) {
  return static_cast<int>(std::count_if(net.springs.begin(), net.springs.end(),
                                        [kind](const Spring& s) { return s.kind == kind; }));
}

TEST(loop_net, springs_of_figures_7_to_9) {
  for (const auto& chart : {plain, rib, purl}) {
    const KnittedModel k = knitted(chart);
    EXPECT_EQ(k.model.net.mass.size(), static_cast<std::size_t>(wales * (courses + 1)));
    EXPECT_EQ(count(k.model.net, SpringKind::warp), wales * courses);
    EXPECT_EQ(count(k.model.net, SpringKind::weft), (wales - 1) * courses);
    EXPECT_EQ(static_cast<int>(k.model.net.springs.size()), wales * courses + (wales - 1) * courses);
    double mass = 0;
    for (const double m : k.model.net.mass) mass += m;
    EXPECT_NEAR(mass, loop_mass(k.model.yarn) * wales * courses, 1e-12 * mass);
  }
}

TEST(loop_net, traditional_net_of_figure_5) {
  const MassSpringNet net = traditional_net(6, 5, 1, 1, 1, {1, 0.5, 0.1});
  EXPECT_EQ(count(net, SpringKind::weft), 5 * 5);
  EXPECT_EQ(count(net, SpringKind::warp), 6 * 4);
  EXPECT_EQ(count(net, SpringKind::shear), 2 * 5 * 4);
  EXPECT_EQ(count(net, SpringKind::bend), 4 * 5 + 6 * 3);
}

// Mean distance of neighbours along a course and of courses, inside the piece, at the stable state.
struct Spacings {
  double wale = 0, course = 0, thickness = 0;
};
Spacings settled_spacings(const KnittedModel& k, double tolerance = 1e-7) {
  NetKernel kernel(k.model.net);
  NetState state = state_at_rest(k.model.start);
  SettleOptions options;
  options.tolerance = tolerance;
  EXPECT_TRUE(settle(kernel, k.model.net, state, options).settled);
  const auto place = [&](int course, int wale) { return state.position(k.index(course, wale, true)); };
  const double l = k.model.yarn.loop_length;
  return {(place(3, 5) - place(3, 1)).x / 4 / l, (place(6, 3) - place(2, 3)).y / 4 / l,
          std::abs(place(3, 3).z -
                   (std::abs(place(3, 4).z - place(3, 3).z) > 1e-6 ? place(3, 4) : place(4, 3)).z) /
              l};
}

TEST(loop_net, stable_state_has_the_relaxed_cells_spacings) {
  LoopModelOptions vector;
  vector.law = SpringLaw::vector;
  const Spacings flat = settled_spacings(knitted(plain));
  EXPECT_NEAR(flat.wale, 0.2456, 1e-5);
  EXPECT_NEAR(flat.course, 0.1890, 1e-5);
  const Spacings ribbed = settled_spacings(knitted(rib, vector));
  EXPECT_NEAR(ribbed.wale, 0.1368, 1e-5);  // the start was 8/34 = 0.2353
  EXPECT_NEAR(ribbed.thickness, 0.2019, 1e-5);
  const Spacings garter = settled_spacings(knitted(purl, vector));
  EXPECT_NEAR(garter.course, 0.1258, 1e-5);  // the start was 7/34 = 0.2059
  EXPECT_NEAR(garter.thickness, 0.1650, 1e-5);
}

TEST(loop_net, springs_along_themselves_with_folds_find_the_same_rib) {
  // weft springs alone may turn, so rib may unfold; springs between second neighbours keep its fold
  LoopModelOptions fold;
  fold.fold = 0.25;
  const Spacings kept = settled_spacings(knitted(rib, fold));
  EXPECT_NEAR(kept.wale, 0.1368, 1e-4);
  EXPECT_NEAR(kept.thickness, 0.2019, 1e-4);
  // without them every spring is at its length, and yet the rib is flatter and wider
  const Spacings turned = settled_spacings(knitted(rib), 1e-3);
  EXPECT_NEAR(std::hypot(turned.thickness, turned.wale), std::hypot(0.1368, 0.2019), 2e-3);
  EXPECT_GT(turned.wale, 1.2 * 0.1368);
}

TEST(loop_net, pulled_plain_answers_with_its_springs_and_narrows_with_the_coupling) {
  // top clamped, bottom pulled: force per wale = K_warp * extension
  const auto pulled = [](bool coupling, double share) {
    LoopModelOptions options;
    options.coupling = coupling;
    options.clamps = {PiecePlace::top};
    options.pulls = {{PiecePlace::bottom, 1, {}, {}}};
    KnittedModel k = knitted(plain, options);
    // so strong that plain stretches by `share` without coupling
    const double unit = stiffness_unit(k.model.yarn), l = k.model.yarn.loop_length;
    for (Load& load : k.model.net.loads) load.force = Vec3{0, -1, 0} * (share * 0.1890 * l * 2940.2 * unit);
    return settled_spacings(k);
  };
  const Spacings free = pulled(false, 0.05);
  EXPECT_NEAR(free.course / 0.1890, 1.05, 1e-4);
  EXPECT_NEAR(free.wale / 0.2456, 1, 1e-3);
  const Spacings coupled = pulled(true, 0.02);
  // small pull far from the clamp: uniaxial stiffness as measured, dw/dc = -rho sqrt(K_warp / K_weft)
  EXPECT_NEAR(coupled.course / 0.1890, 1.02, 3e-3);
  const double dw = coupled.wale - 0.2456, dc = coupled.course - 0.1890;
  EXPECT_NEAR(dw / dc, -0.3257 * std::sqrt(2940.2 / 1003.3), 0.1);
}

TEST(loop_net, places_of_a_piece) {
  const KnittedModel k = knitted(plain);
  const auto places = [&](PiecePlace place) {
    return masses_at(k.piece.graph, k.model.points, k.model.start, place);
  };
  EXPECT_EQ(places(PiecePlace::top).size(), static_cast<std::size_t>(wales));
  EXPECT_EQ(places(PiecePlace::bottom).size(), static_cast<std::size_t>(wales));
  EXPECT_EQ(places(PiecePlace::left).size(), static_cast<std::size_t>(courses));
  EXPECT_EQ(places(PiecePlace::right).size(), static_cast<std::size_t>(courses));
  EXPECT_EQ(places(PiecePlace::corner),
            std::vector<std::int32_t>{static_cast<std::int32_t>(k.index(courses - 1, wales - 1, false))});
  EXPECT_EQ(places(PiecePlace::wale),
            std::vector<std::int32_t>{static_cast<std::int32_t>(k.index(courses - 1, wales / 2, false))});
  for (const char* name : {"top", "bottom", "left", "right", "corner", "wale", "course"})
    EXPECT_TRUE(place_named(name)) << name;
  EXPECT_FALSE(place_named("middle"));
}

std::vector<Vec3> shaken(const std::vector<Vec3>& places, double much) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, much);
  std::vector<Vec3> moved = places;
  for (Vec3& p : moved) p += {normal(random), normal(random), normal(random)};
  return moved;
}

TEST(correlation, starts_at_the_structure_model) {
  for (const auto& chart : {plain, rib, purl, std::vector<std::string>{"ffb", "fbf"}}) {
    const KnittedModel k = knitted(chart);
    const YarnCurves now = curves_at(k.model, state_at_rest(k.model.start));
    for (std::size_t p = 0; p < now.yarns[0].points.size(); ++p)
      EXPECT_LT(distance(now.yarns[0].points[p].position, k.model.curves.yarns[0].points[p].position), 1e-12);
  }
}

TEST(correlation, weights_are_those_of_equations_3_to_5) {
  const KnittedModel k = knitted(plain);
  const std::vector<TypePoint>& points = k.model.curves.yarns[0].points;
  const LoopId id = k.loop(2, 3);  // formed to the right
  std::size_t first = 0;
  while (points[first].loop != id || points[first].part != LoopPart::foot) ++first;
  const auto weights = [&](std::size_t row) {
    std::vector<std::pair<std::size_t, double>> list;
    for (const CorrelationMap::Entry& e : k.model.map.row(row))
      list.emplace_back(static_cast<std::size_t>(e.column), e.weight);
    return list;
  };
  using List = std::vector<std::pair<std::size_t, double>>;
  const std::size_t o = k.index(2, 3, true), p = k.index(2, 3, false), left = k.index(2, 2, true);
  EXPECT_EQ(weights(first + 1), (List{{o, 1}}));  // T1
  EXPECT_EQ(weights(first + 5), (List{{p, 1}}));  // T3
  EXPECT_EQ(weights(first + 7), (List{{p, 1}}));  // T4
  const List leg = weights(first + 3), sinker = weights(first - 1);
  ASSERT_EQ(leg.size(), 2U);
  EXPECT_EQ(leg[0].first, o);
  EXPECT_EQ(leg[1].first, p);
  EXPECT_NEAR(leg[0].second, 0.5, 1e-6);
  ASSERT_EQ(sinker.size(), 2U);
  EXPECT_EQ(sinker[0].first, left);
  EXPECT_EQ(sinker[1].first, o);
  EXPECT_NEAR(sinker[0].second, 0.5, 1e-6);
}

TEST(correlation, is_linear_with_frozen_frames_and_agrees_with_differences) {
  for (const auto& chart : {plain, rib, purl}) {
    const KnittedModel k = knitted(chart);
    const CorrelationMap& map = k.model.map;
    const std::vector<Vec3> b = shaken(k.model.start, 0.3), db = shaken(std::vector<Vec3>(b.size()), 1);
    const std::vector<Rotation> frames = map.frames(b);
    std::vector<Vec3> low, high, exact, q;
    std::vector<Vec3> b_low = b, b_high = b;
    for (std::size_t i = 0; i < b.size(); ++i) {
      b_low[i] -= db[i] * 1e-4;
      b_high[i] += db[i] * 1e-4;
    }
    map.map(b_low, frames, low);
    map.map(b_high, frames, high);
    map.linear(db, exact);
    for (std::size_t r = 0; r < map.rows(); ++r)
      EXPECT_LT(distance((high[r] - low[r]) / 2e-4, exact[r]), 1e-9);
    // the transpose carries forces: f . A db = A^T f . db
    const std::vector<Vec3> f = shaken(std::vector<Vec3>(map.rows()), 1);
    std::vector<Vec3> on_masses;
    map.transposed(f, on_masses);
    double right = 0, left = 0, sum = 0;
    for (std::size_t r = 0; r < map.rows(); ++r) right += dot(f[r], exact[r]);
    for (std::size_t i = 0; i < b.size(); ++i) left += dot(on_masses[i], db[i]);
    EXPECT_NEAR(left, right, 1e-9);
    // rows sum to one
    for (std::size_t r = 0; r < map.rows(); ++r, sum = 0) {
      for (const CorrelationMap::Entry& e : map.row(r)) sum += e.weight;
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
}

TEST(correlation, turns_with_the_piece) {
  const double angle = 2.2;
  const Rotation turn{
      {std::cos(angle), 0, -std::sin(angle)}, {0, 1, 0}, {std::sin(angle), 0, std::cos(angle)}};
  const Vec3 away{3, -2, 5};
  const KnittedModel k = knitted(rib);
  std::vector<Vec3> places = k.model.start;
  for (Vec3& p : places) p = turn * p + away;
  const YarnCurves now = curves_at(k.model, state_at_rest(places));
  for (std::size_t p = 0; p < now.yarns[0].points.size(); ++p)
    EXPECT_LT(
        distance(now.yarns[0].points[p].position, turn * k.model.curves.yarns[0].points[p].position + away),
        1e-10);
}

}  // namespace
}  // namespace loopwright
