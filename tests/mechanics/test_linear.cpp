// The two-level solver: its coarse space against products with the whole matrix, its factors against the
// matrix. (Iterations on pieces of two sizes: tests/pipeline/held_piece_test.cpp.)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fabrics.hpp"
#include "mechanics/assembly.hpp"
#include "mechanics/binding_space.hpp"
#include "mechanics/linear/dense_cholesky.hpp"
#include "mechanics/linear/schwarz.hpp"

namespace loopwright {
namespace {

// A held piece, a model of it and its Hessian with metric at the first geometry.
struct Problem {
  Fabric fabric;
  YarnModel model;
  YarnState state;
  BlockMatrix hessian;
  Unknowns gradient;

  Problem(const std::string& courses, int n)
      : fabric(knitted(courses, "held", std::to_string(n) + " wales x " + std::to_string(n) + " courses")) {
    ModelOptions options = frictionless().model;
    options.material.contact.core = -1;  // as while yarn grows in: the first geometry may lie too close
    model = build_yarn_model(fabric, options);
    state = build_yarn_state(fabric);
    Assembly assembly(model);
    assembly.update_pairs(state, 1.6);
    assembly.hessian(state, gradient, hessian);
    assembly.metric(hessian);
    hessian.measure_metric = {1, 1, 1};
  }
};

Unknowns wave(std::size_t n, double phase) {
  Unknowns x;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 0.37 * static_cast<double>(i) + phase;
    x.u.push_back({std::sin(t), std::cos(1.7 * t), std::sin(0.3 * t + 1)});
  }
  x.g = {0.3, -0.2, 0.1};
  return x;
}

constexpr double shift = 1e3;  // enough for every matrix here to be positive definite

TEST(BindingSpace, RowsSumToOneAndHeldPointsAreEmpty) {
  const Fabric piece = knitted("g", "held", "6 wales x 5 courses");
  const CoarseSpace space = binding_space(piece);
  std::size_t i = 0, held = 0;
  for (const FabricYarn& yarn : piece.yarns)
    for (std::size_t k = 0; k < yarn.held.size(); ++k, ++i) {
      const auto& weight = space.rows[i].weight;
      held += yarn.held[k];
      EXPECT_NEAR(weight[0] + weight[1] + weight[2] + weight[3], yarn.held[k] != 0 ? 0 : 1, 1e-12);
    }
  EXPECT_EQ(i, space.rows.size());
  EXPECT_GT(held, 0u);
  // One for each loop's feet, one more for each head of the last course, which nothing is drawn through.
  EXPECT_LE(space.points, 6 * 5 + 6);
  EXPECT_GE(space.points, 6 * 5);
}

TEST(BindingSpace, AHeadFollowsTheLoopDrawnThroughIt) {
  const Fabric piece = knitted("g", "held", "5 wales x 5 courses");
  const CoarseSpace space = binding_space(piece);
  std::vector<std::size_t> first{0};
  for (const FabricYarn& yarn : piece.yarns) first.push_back(first.back() + yarn.control_points.size());
  const auto row_at = [&](const LoopSpan& s, double t) {
    return space.rows[first[static_cast<std::size_t>(s.yarn)] + static_cast<std::size_t>(std::lround(t)) + 1];
  };
  int compared = 0;
  for (const PlacedInterlacing& i : piece.interlacings) {
    const auto span = [&](LoopId id) {
      return *std::find_if(piece.loops.begin(), piece.loops.end(),
                           [&](const LoopSpan& s) { return s.loop == id; });
    };
    const LoopSpan parent = span(i.parent), child = span(i.child);
    const CoarseSpace::Row head = row_at(parent, parent.apex),
                           foot = row_at(child, child.begin + 0.25 * (child.apex - child.begin) + 0.5);
    if (head.weight[0] == 0 || foot.weight[0] == 0) continue;
    EXPECT_EQ(head.point[0], foot.point[0]);
    ++compared;
  }
  EXPECT_GT(compared, 4);
}

// P' A P from columns of P, by products with the whole matrix.
TEST(CoarseSpaces, ProjectionIsTheMatrixSeenThroughTheMap) {
  const Problem problem("g", 5);
  for (const CoarseSpace& space :
       {binding_space(problem.fabric), plate_space(problem.state.nodes, problem.model.held, 3, 2)}) {
    BlockMatrix coarse;
    space.project(problem.hessian, shift, coarse);
    ASSERT_EQ(coarse.rows(), space.points);
    Unknowns c = wave(static_cast<std::size_t>(space.points), 0.2);
    c.g = {};  // coarse matrices leave the measures out
    Unknowns direct;
    multiply(coarse, c, direct);
    Unknowns fine, product, seen;
    fine.u.assign(problem.state.nodes.size(), Vec3{});
    space.add_prolonged(c.u, fine.u);
    multiply(problem.hessian, shift, fine, product);
    space.restricted(product.u, seen.u);
    for (std::size_t i = 0; i < seen.u.size(); ++i)
      EXPECT_LT(norm(seen.u[i] - direct.u[i]), 1e-9 * (1 + norm(seen.u[i])));
  }
}

// A plate whose splines lie on a slope turns as a rigid body: u.z = x and u.x = -z.
TEST(PlateSpace, TurnsRigidly) {
  const Problem problem("g", 6);
  const CoarseSpace space = plate_space(problem.state.nodes, problem.model.held, 4, 3);
  double low_x = 1e9, low_z = 1e9, high_z = -1e9;
  for (const Vec3& p : problem.state.nodes) {
    low_x = std::min(low_x, p.x);
    low_z = std::min(low_z, p.z);
    high_z = std::max(high_z, p.z);
  }
  std::vector<Vec3> c(static_cast<std::size_t>(space.points)), u(problem.state.nodes.size());
  ASSERT_EQ(space.plate.number.size(), 6u * 5u);
  for (int spline = 0; spline < 30; ++spline)
    if (const std::int32_t point = space.plate.number[static_cast<std::size_t>(spline)]; point >= 0)
      c[static_cast<std::size_t>(point)].z = (spline % 6 - 0.5) * space.plate.width;
  space.add_prolonged(c, u);
  int inside = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Vec3& p = problem.state.nodes[i];
    double share = 0;  // of all nine splines: 1 where none was left out
    space.each_entry(i, [&](std::int32_t, double w, double, double) { share += w; });
    const bool whole = problem.model.held[i] == 0 && std::abs(share - 1) < 1e-9;
    if (!whole) continue;
    ++inside;
    EXPECT_NEAR(u[i].z, p.x - low_x, 1e-4);
    EXPECT_NEAR(u[i].x, -(p.z - 0.5 * (low_z + high_z)), 1e-5);
    EXPECT_NEAR(u[i].y, 0, 1e-5);
  }
  EXPECT_GT(inside, 50);
}

TEST(CompactFactor, SolvesToSinglePrecision) {
  const Problem problem("g", 6);
  Cholesky factor;
  ASSERT_TRUE(factor.factor(problem.hessian, shift));
  const Unknowns x = wave(problem.state.nodes.size(), 1);
  Unknowns b, found;
  multiply(problem.hessian, shift, x, b);
  const auto error = [&] {
    double most = 0;
    for (std::size_t i = 0; i < x.u.size(); ++i) most = std::max(most, norm(found.u[i] - x.u[i]));
    for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(found.g[k] - x.g[k]));
    return most;
  };
  factor.solve(b, found);
  EXPECT_LT(error(), 1e-8);
  const double entries = factor.factor_entries();
  factor.compact();
  EXPECT_LE(factor.factor_entries(), entries);  // CHOLMOD's hold what lies above the diagonal too
  EXPECT_GT(factor.factor_entries(), 0.5 * entries);
  factor.solve(b, found);
  EXPECT_LT(error(), 1e-2) << "six digits, less what the condition of the matrix takes";
  // The next factor works anew, and so it does after a whole one was given up.
  for (int round = 0; round < 2; ++round) {
    ASSERT_TRUE(factor.factor(problem.hessian, shift));
    factor.solve(b, found);
    EXPECT_LT(error(), 1e-8);
    factor.clear();
  }
}

// A dense factor that fails says along what the matrix is not positive, and which shifts are too small for
// it: no factor of these may succeed. In the end one does.
TEST(DenseCholesky, SaysWhichShiftsAreTooSmall) {
  const Problem p("ge", 3);
  DenseCholesky cholesky;
  Unknowns against;
  double try_shift = 1e-6;
  int failed = 0;
  for (; failed < 60 && !cholesky.factor(p.hessian, try_shift, against); ++failed) {
    if (against.u.empty()) GTEST_SKIP() << "only LAPACK's factor tells how far it got";
    Unknowns image;
    multiply(p.hessian, try_shift, against, image);
    EXPECT_LT(dot(against, image), 0) << "shift " << try_shift;
    const double too_small = shift_against(p.hessian, against);
    EXPECT_GT(too_small, try_shift);
    Unknowns other;
    EXPECT_FALSE(cholesky.factor(p.hessian, 0.999 * too_small, other));
    try_shift = 4 * std::max(try_shift, too_small);
  }
  EXPECT_GT(failed, 0);
  EXPECT_LT(failed, 60);
}

TEST(Schwarz, SaysThatTheMatrixIsNotDefinite) {
  Problem problem("g", 10);
  for (std::size_t k = static_cast<std::size_t>(problem.hessian.row_start[40]);
       k < static_cast<std::size_t>(problem.hessian.row_start[41]); ++k)
    if (problem.hessian.column[k] == 40) problem.hessian.block[k] = {-1e6, 0, 0, 0, -1e6, 0, 0, 0, -1e6};
  Schwarz schwarz;
  schwarz.set_patches(problem.state.nodes, problem.model.held, problem.hessian, problem.model.binding_points);
  EXPECT_FALSE(schwarz.factor(problem.hessian, shift));
}

}  // namespace
}  // namespace loopwright
