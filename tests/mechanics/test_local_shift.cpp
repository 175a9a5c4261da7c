// A large piece is shifted where it must be, not everywhere: what is found of the places, and what is done
// about them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fabrics.hpp"
#include "mechanics/linear/conjugate_gradient.hpp"
#include "mechanics/linear/schwarz.hpp"
#include "mechanics/local_shift.hpp"

namespace loopwright {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::Not;

constexpr double range = 1.6, share = 0.7;

// Straight yarns along y, 1.3 d apart in x; yarn k has number k.
Fabric row_of_yarns(int count) {
  std::vector<FabricYarn> yarns;
  for (int k = 0; k < count; ++k)
    yarns.push_back(free_yarn(9, 1.4, [k](int i) { return Vec3{1.3 * k, 1.4 * i, 0}; }));
  return fabric_of(std::move(yarns));
}

// Plain, as it is while yarn grows in: the first geometry may lie too close.
struct HeldPlain {
  YarnModel model;
  YarnState state;
  Assembly assembly;

  explicit HeldPlain(const Fabric& fabric)
      : model(build_yarn_model(fabric, without_core())), state(build_yarn_state(fabric)), assembly(model) {
    assembly.update_pairs(state, range);
  }
  static ModelOptions without_core() {
    ModelOptions options = frictionless().model;
    options.material.contact.core = -1;
    return options;
  }
};

struct Row {
  Fabric fabric;
  YarnModel model;
  YarnState state;
  Assembly assembly;

  explicit Row(int count)
      : fabric(row_of_yarns(count)),
        model(build_yarn_model(fabric, frictionless().model)),
        state(build_yarn_state(fabric)),
        assembly(model) {
    assembly.update_pairs(state, range);
  }
  // Yarn k goes `by` along x.
  SafeStep moved(int k, double by, bool list_causes) const {
    YarnState target = state;
    const YarnModel::Yarn& yarn = model.yarns[static_cast<std::size_t>(k)];
    for (int i = 0; i < yarn.nodes; ++i) target.nodes[static_cast<std::size_t>(yarn.first_node + i)].x += by;
    return safe_step(model, assembly, state, target, range, 1, share, list_causes);
  }
};

TEST(SafeStepCauses, AreThePairsOfTheYarnThatMoves) {
  const Row row(5);
  const SafeStep step = row.moved(2, 1.2, true);
  ASSERT_FALSE(step.near.empty());
  double worst = 0;
  for (const NearPair& pair : step.near) {
    const int a = row.model.yarn_of_segment[static_cast<std::size_t>(pair.a)],
              b = row.model.yarn_of_segment[static_cast<std::size_t>(pair.b)];
    EXPECT_TRUE(a == 2 || b == 2) << a << " and " << b;
    EXPECT_EQ(std::abs(a - b), 1);
    EXPECT_GT(pair.ratio, share);
    worst = std::max(worst, pair.ratio);
  }
  EXPECT_DOUBLE_EQ(worst, step.pair_ratio);
  // Asking for them changes nothing of the step.
  const SafeStep plain = row.moved(2, 1.2, false);
  EXPECT_TRUE(plain.near.empty() && plain.far.empty());
  EXPECT_EQ(plain.scale, step.scale);
  EXPECT_EQ(plain.pair_ratio, step.pair_ratio);
}

TEST(SafeStepCauses, AreControlPointsThatGoBeyondTheListsReach) {
  const Row row(5);
  const SafeStep step = row.moved(2, 1.2, true);
  const YarnModel::Yarn& yarn = row.model.yarns[2];
  ASSERT_FALSE(step.far.empty());
  for (const FarNode& far : step.far) EXPECT_GT(far.ratio, 1);
  const auto most = std::max_element(step.far.begin(), step.far.end(),
                                     [](const FarNode& a, const FarNode& b) { return a.ratio < b.ratio; });
  EXPECT_GE(most->node, yarn.first_node);
  EXPECT_LT(most->node, yarn.first_node + yarn.nodes);
}

TEST(SafeStepCauses, AreNoneWhereTheStepIsSmall) {
  const Row row(3);
  const SafeStep step = row.moved(1, 0.05, true);
  EXPECT_TRUE(step.near.empty() && step.far.empty());
  EXPECT_EQ(step.scale, 1);
}

TEST(LocalShift, IsTheCommonOneUntilItIsRaised) {
  const Row row(3);
  LocalShift local(row.model);
  EXPECT_TRUE(local.weights(1).empty());
  local.fade();
  EXPECT_TRUE(local.weights(1).empty());
}

TEST(LocalShift, IsRaisedAtTheSegmentsNamedAndFades) {
  const Row row(3);
  LocalShift local(row.model);
  SafeStep step;
  step.near = {{row.model.yarns[1].first_segment, row.model.yarns[1].first_segment + 1, 10 * share}};
  local.raise(step, 0.5, share);
  const std::vector<float> weights = local.weights(0.5);
  ASSERT_EQ(weights.size(), static_cast<std::size_t>(row.model.nodes));
  for (int i = 0; i < row.model.nodes; ++i) {
    const bool of_yarn =
        i >= row.model.yarns[1].first_node && i < row.model.yarns[1].first_node + row.model.yarns[1].nodes;
    EXPECT_TRUE(of_yarn || weights[static_cast<std::size_t>(i)] == 1) << i;
  }
  EXPECT_FLOAT_EQ(weights[static_cast<std::size_t>(row.model.yarns[1].first_node)], 20)
      << "twice what the motion was too much";
  // A shift of its own: a larger common one covers it.
  EXPECT_THAT(local.weights(100), Each(1.0F));
  int steps = 0;
  for (; !local.empty() && steps < 100; ++steps) local.fade();
  EXPECT_GT(steps, 1);
  EXPECT_LT(steps, 20);
}

TEST(LocalShift, FindsWhereTheEnergyRises) {
  const Row row(3);
  LocalShift local(row.model);
  const auto segments = static_cast<std::size_t>(row.model.segments);
  std::vector<double> before(segments, 1), after(segments, 0.9);
  EXPECT_FALSE(local.raise(before, after, 1, 0.5));
  const std::size_t spot = static_cast<std::size_t>(row.model.yarns[2].first_segment) + 2;
  after[spot] = INFINITY;
  EXPECT_TRUE(local.raise(before, after, 1, 0.5));
  const std::vector<float> weights = local.weights(0.5);
  EXPECT_GT(weights[static_cast<std::size_t>(row.model.yarns[2].first_node) + 3], 10);
  EXPECT_EQ(weights[0], 1);
}

TEST(EnergyOfSegments, SumsToTheEnergy) {
  HeldPlain piece(knitted("g", "held", "6 wales x 6 courses"));
  std::vector<double> of_segments;
  const EnergyParts parts = piece.assembly.energy(piece.state, of_segments);
  double sum = 0;
  for (const double e : of_segments) sum += e;
  EXPECT_GT(parts.contact, 0);
  EXPECT_NEAR(sum, parts.stretch + parts.bend + parts.contact, 1e-9 * sum);
  EXPECT_EQ(parts.total(), piece.assembly.energy(piece.state).total());
}

// u' D u of the metric, which is a multiple of the identity in every block.
double metric_of(const BlockMatrix& matrix, const std::vector<Vec3>& u) {
  double sum = 0;
  for (int r = 0; r < matrix.rows(); ++r)
    for (auto e = matrix.row_start[static_cast<std::size_t>(r)];
         e < matrix.row_start[static_cast<std::size_t>(r) + 1]; ++e)
      sum += matrix.metric[static_cast<std::size_t>(e)] *
             dot(u[static_cast<std::size_t>(r)],
                 u[static_cast<std::size_t>(matrix.column[static_cast<std::size_t>(e)])]);
  return sum;
}

TEST(WeighedMetric, WeighsMotionAgainstOthersNotMotionWithThem) {
  Row row(3);
  BlockMatrix hessian;
  Unknowns gradient;
  row.assembly.hessian(row.state, gradient, hessian);
  const auto nodes = static_cast<std::size_t>(row.model.nodes);
  std::vector<float> weights(nodes, 1);
  for (int i = 0; i < row.model.yarns[1].nodes; ++i)
    weights[static_cast<std::size_t>(row.model.yarns[1].first_node + i)] = 1000;
  std::vector<Vec3> together(nodes, Vec3{1, 0, 0}), apart(nodes), elsewhere(nodes);
  apart[static_cast<std::size_t>(row.model.yarns[1].first_node) + 4] = {1, 0, 0};
  elsewhere[static_cast<std::size_t>(row.model.yarns[0].first_node) + 4] = {1, 0, 0};
  row.assembly.metric(hessian);
  const double plain_together = metric_of(hessian, together), plain_apart = metric_of(hessian, apart),
               plain_elsewhere = metric_of(hessian, elsewhere);
  row.assembly.metric(hessian, weights);
  EXPECT_NEAR(metric_of(hessian, apart), 1000 * plain_apart, 1e-6 * plain_apart);
  EXPECT_NEAR(metric_of(hessian, elsewhere), plain_elsewhere, 1e-9);
  // Rigid motion stays all but free: its own little part alone is weighed.
  EXPECT_LT(metric_of(hessian, together), 1000 * plain_together * 1.001);
  EXPECT_LT(metric_of(hessian, together) / static_cast<double>(nodes), 0.002 * metric_of(hessian, apart));
}

// A matrix without border that is diagonal, but for the coupling of its first control point and its last.
BlockMatrix diagonal(const std::vector<double>& values, double coupling = 0) {
  BlockMatrix m;
  m.row_start = {0};
  const auto add = [&m](std::size_t column, double value, double metric) {
    m.column.push_back(static_cast<std::int32_t>(column));
    m.block.push_back({value, 0, 0, 0, value, 0, 0, 0, value});
    m.metric.push_back(metric);
  };
  const std::size_t last = values.size() - 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (coupling != 0 && i == last) add(0, coupling, 0);
    add(i, values[i], 1);
    if (coupling != 0 && i == 0) add(last, coupling, 0);
    m.row_start.push_back(static_cast<std::int32_t>(m.column.size()));
  }
  m.border.assign(values.size(), Block{});
  m.corner = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  return m;
}

TEST(ConjugateGradient, SaysWhereTheMatrixBends) {
  const BlockMatrix matrix = diagonal({2, 1, -5, 3, 4});
  Unknowns b, x;
  b.u.assign(5, Vec3{1, 1, 1});
  const auto copy = [](const Unknowns& r, Unknowns& z) { z = r; };
  const ConjugateGradientResult bent = conjugate_gradient(matrix, 0, copy, b, 1e-6, {}, x);
  ASSERT_TRUE(bent.indefinite);
  EXPECT_THAT(bent.bent, ElementsAre(2));
  const ConjugateGradientResult lifted = conjugate_gradient(matrix, 6, copy, b, 1e-6, {}, x);
  EXPECT_TRUE(lifted.converged);
  EXPECT_TRUE(lifted.bent.empty());
}

// Two far corners that only together bend the matrix: no patch and no plate sees it, the fabric's answer to
// its width does.
TEST(Schwarz, GoesOnWhereTheAnswerToAMeasureBent) {
  constexpr int side = 30;
  std::vector<Vec3> places;
  for (int i = 0; i < side * side; ++i)
    places.push_back({static_cast<double>(i % side), static_cast<double>(i / side), 0});
  BlockMatrix m = diagonal(std::vector<double>(places.size(), 1), -2);
  m.border.front()[0] = m.border.back()[0] = 1;
  m.measure_metric = {1, 1, 1};
  Schwarz schwarz;
  const CoarseSpace no_binding_points;
  schwarz.set_patches(places, std::vector<std::uint8_t>(places.size(), 0), m, no_binding_points);
  EXPECT_FALSE(schwarz.factor(m, 0));
  EXPECT_TRUE(schwarz.indefinite().empty()) << "all patches are definite";
  constexpr double shift = 10;
  ASSERT_TRUE(schwarz.factor(m, shift));
  Unknowns x, b, found;
  x.u.assign(places.size(), Vec3{1, 2, 3});
  x.g = {4, 5, 6};
  multiply(m, shift, x, b);
  const ConjugateGradientResult solved = conjugate_gradient(
      m, shift, [&](const Unknowns& r, Unknowns& z) { schwarz.solve(r, z); }, b, 1e-9, {}, found);
  EXPECT_TRUE(solved.converged);
  EXPECT_NEAR(found.g[0], 4, 1e-6);
  EXPECT_NEAR(found.u.front().x, 1, 1e-6);
}

TEST(Schwarz, SaysWhichPatchesBendAndTakesThemAgain) {
  HeldPlain piece(knitted("g", "held", "16 wales x 16 courses"));
  BlockMatrix hessian;
  Unknowns gradient;
  piece.assembly.hessian(piece.state, gradient, hessian);
  piece.assembly.metric(hessian);
  hessian.measure_metric = {1, 1, 1};
  constexpr std::int32_t spot = 1000;
  ASSERT_EQ(piece.model.held[spot], 0);
  constexpr double shift = 1e3;
  hessian.block[hessian.place(spot, spot)] = {-1e6, 0, 0, 0, -1e6, 0, 0, 0, -1e6};
  Schwarz schwarz;
  schwarz.set_patches(piece.state.nodes, piece.model.held, hessian, piece.model.binding_points);
  EXPECT_FALSE(schwarz.factor(hessian, shift));
  const std::vector<std::int32_t> nodes = schwarz.indefinite();
  EXPECT_THAT(nodes, Contains(spot));
  EXPECT_LT(nodes.size(), static_cast<std::size_t>(piece.model.nodes) / 4)
      << "the patches round it, not the piece";
  hessian.metric[hessian.place(spot, spot)] += 2e3;
  EXPECT_TRUE(schwarz.factor_again(hessian, shift));
  EXPECT_TRUE(schwarz.indefinite().empty());
  Unknowns x;
  const ConjugateGradientResult solved = conjugate_gradient(
      hessian, shift, [&](const Unknowns& r, Unknowns& z) { schwarz.solve(r, z); }, gradient, 1e-6, {}, x);
  EXPECT_TRUE(solved.converged);
}

}  // namespace
}  // namespace loopwright
