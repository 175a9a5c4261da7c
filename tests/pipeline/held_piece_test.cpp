// Held pieces of a repeated notation start as copies of their relaxed cell: inside they are at rest before
// the first step, friction included.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/parallel.hpp"
#include "mechanics/linear/conjugate_gradient.hpp"
#include "mechanics/linear/schwarz.hpp"
#include "mechanics/newton.hpp"
#include "pipeline.hpp"

namespace loopwright {
namespace {

struct Start {
  Fabric fabric;
  RelaxOptions options;
};

Start start_of(const std::string& structure, int n, double set = 0, double liveliness_per_m = 0) {
  const std::filesystem::path file =
      std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples/structures" / (structure + ".verm");
  Diagnostics diagnostics(file);
  FabricOptions size;
  size.size_wales = size.size_courses = n;
  size.edges = Edges::held;
  Knitting knitting = knit_with(file, size, diagnostics);
  EXPECT_TRUE(diagnostics.ok());
  knitting.program.settings.set = set;
  for (YarnData& yarn : knitting.program.yarns) yarn.liveliness_per_m = liveliness_per_m;
  const PieceRequest request{.start_from_cell = true};
  Start start{first_geometry(knitting, request), {}};
  start.options = relax_options(start.fabric, knitting.program, request);
  std::optional<Fabric> started = start_from_relaxed_cell(knitting, request, start.fabric, start.options);
  EXPECT_TRUE(started.has_value()) << structure;
  if (started) start.fabric = std::move(*started);
  return start;
}

// Largest force on any control point that the frame does not hold, with or without the cell's history.
double largest_force(const Start& start, bool with_history) {
  const YarnModel model = build_yarn_model(start.fabric, start.options.model);
  const YarnState state = build_yarn_state(start.fabric);
  Assembly assembly(model);
  if (with_history) assembly.set_history(start.options.history);
  assembly.update_pairs(state, model.contact.outer + 0.6);
  Unknowns gradient;
  BlockMatrix hessian;
  assembly.hessian(state, gradient, hessian);
  double most = 0;
  for (const Vec3& force : gradient.u) most = std::max(most, norm(force));
  return most;
}

double held_share(const Fabric& fabric) {
  double held = 0, all = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    held +=
        static_cast<double>(std::count_if(yarn.held.begin(), yarn.held.end(), [](auto h) { return h != 0; }));
    all += static_cast<double>(yarn.held.size());
  }
  return held / all;
}

class HeldPiece : public testing::TestWithParam<const char*> {};

TEST_P(HeldPiece, IsAtRestBeforeTheFirstStep) {
  const Start start = start_of(GetParam(), 10);
  EXPECT_FALSE(start.options.history.empty());
  const double carried = largest_force(start, true), dropped = largest_force(start, false);
  EXPECT_LT(carried, 2 * start.options.tolerance);
  EXPECT_GT(dropped, 20 * carried) << "without its history friction holds nothing";
  EXPECT_LT(held_share(start.fabric), 0.55) << "a frame that holds everything is no frame";
}

// The yarn of its cell was set where that came to rest, and so is the piece's: at rest with less bend energy.
TEST_P(HeldPiece, OfSetYarnIsAtRestToo) {
  const Start set = start_of(GetParam(), 10, 0.5), straight = start_of(GetParam(), 10);
  for (const FabricYarn& yarn : set.fabric.yarns)
    EXPECT_EQ(yarn.natural_curvature.size(), static_cast<std::size_t>(yarn.segments()));
  EXPECT_LT(largest_force(set, true), 2 * set.options.tolerance);
  const auto bend = [](const Start& start) {
    const YarnModel model = build_yarn_model(start.fabric, start.options.model);
    const YarnState state = build_yarn_state(start.fabric);
    Assembly assembly(model);
    assembly.update_pairs(state, model.contact.outer + 0.6);
    return assembly.energy(state).bend;
  };
  EXPECT_LT(bend(set), 0.4 * bend(straight));
}

// The twist of a yarn is the same all along it, so where it was cut tells everywhere: nothing in plain and
// garter, whose loops are not twisted by their way, a little elsewhere.
TEST_P(HeldPiece, OfLivelyYarnIsAtRestButForItsEnds) {
  const Start start = start_of(GetParam(), 8, 0, 40);
  EXPECT_GT(start.options.model.material.twist_stiffness, 0);
  const std::string structure = GetParam();
  const bool untwisted = structure == "plain" || structure == "garter";
  EXPECT_LT(largest_force(start, true), untwisted ? 2 * start.options.tolerance : 0.02);
}

TEST_P(HeldPiece, RestsInFewStepsWithAllInterlacings) {
  const Start start = start_of(GetParam(), 8);
  const RelaxResult rest = relax(start.fabric, start.options);
  EXPECT_TRUE(rest.converged);
  // Nothing but the frame's measures is left to find: what the piece has cut off, the frame bears.
  EXPECT_LE(rest.newton_iterations, 5);
  EXPECT_EQ(rest.pass_throughs, 0);
  const InterlacingCheck check = check_interlacings(rest.fabric);
  EXPECT_EQ(check.intact, check.expected);
  EXPECT_GT(check.expected, 40);
}

INSTANTIATE_TEST_SUITE_P(Structures, HeldPiece,
                         testing::Values("plain", "rib", "garter", "half_cardigan", "full_cardigan", "cable",
                                         "lace"),
                         [](const auto& structure) { return std::string(structure.param); });

// Iterations that the two-level solver needs for the step after a pull on the frame.
int first_step_iterations(const Start& start) {
  const YarnModel model = build_yarn_model(start.fabric, start.options.model);
  YarnState state = build_yarn_state(start.fabric);
  Assembly assembly(model);
  assembly.set_history(start.options.history);
  assembly.update_pairs(state, model.contact.outer + 0.6);
  Unknowns gradient, step;
  BlockMatrix hessian;
  assembly.hessian(state, gradient, hessian);
  assembly.metric(hessian);
  hessian.measure_metric = {1, 1, 1};
  gradient.g[0] -= 1;
  Schwarz schwarz;
  schwarz.set_patches(state.nodes, model.held, hessian, model.binding_points);
  constexpr double shift = 0.1;
  EXPECT_TRUE(schwarz.factor(hessian, shift));
  const ConjugateGradientResult solved = conjugate_gradient(
      hessian, shift, [&](const Unknowns& r, Unknowns& z) { schwarz.solve(r, z); }, gradient, 1e-3,
      {.most = 300}, step);
  EXPECT_TRUE(solved.converged);
  Unknowns product;
  multiply(hessian, shift, step, product);
  axpy(-1, gradient, product);
  EXPECT_LT(std::sqrt(dot(product, product)), 0.05 * std::sqrt(dot(gradient, gradient)));
  return solved.iterations;
}

TEST(TwoLevelSolver, IterationsDoNotGrowWithThePiece) {
  for (const char* structure : {"plain", "rib"}) {
    const int small = first_step_iterations(start_of(structure, 20)),
              large = first_step_iterations(start_of(structure, 40));
    EXPECT_GT(small, 5) << structure;
    EXPECT_LE(large, 1.5 * small) << structure << ": " << small << " with 400 loops, " << large
                                  << " with 1600";
  }
}

TEST(TwoLevelSolver, IsTheSameToTheLastBitForAnyNumberOfThreads) {
  Start start = start_of("plain", 28);
  start.options.model.free.width = false;  // pulled, so that factors grow old
  start.fabric.width *= 1.01;
  for (FabricYarn& yarn : start.fabric.yarns)
    for (Vec3& p : yarn.control_points) p.x *= 1.01;
  start.options.most_iterations = 5;
  std::vector<RelaxResult> results;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    results.push_back(relax(start.fabric, start.options));
  }
  set_thread_count(0);
  EXPECT_GT(results[0].factorisations, 1) << "an old factor is to be given up";
  EXPECT_EQ(results[0].linear_iterations, results[1].linear_iterations);
  EXPECT_EQ(results[0].residual, results[1].residual);
  for (std::size_t y = 0; y < start.fabric.yarns.size(); ++y) {
    const auto &one = results[0].fabric.yarns[y].control_points,
               &other = results[1].fabric.yarns[y].control_points;
    for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(norm(one[i] - other[i]), 0) << y << ' ' << i;
  }
}

}  // namespace
}  // namespace loopwright
