// When Newton's method ends.
#include <gtest/gtest.h>

#include <cmath>

#include "mechanics/fabrics.hpp"
#include "mechanics/newton.hpp"

namespace loopwright {
namespace {

// 60 straight yarns far apart, 140 control points each, of which `loud` stand 0.1 d beside their place.
struct Sheet {
  YarnModel model;
  YarnState state;
};
Sheet sheet(int loud) {
  std::vector<FabricYarn> yarns;
  for (int line = 0; line < 60; ++line)
    yarns.push_back(free_yarn(140, 1, [line](int i) { return Vec3{1.0 * i, 3.0 * line, 0}; }));
  const Fabric fabric = fabric_of(std::move(yarns));
  Sheet made{build_yarn_model(fabric, frictionless().model), build_yarn_state(fabric)};
  for (int k = 0; k < loud; ++k) made.state.nodes[static_cast<std::size_t>(70 + 140 * k)].z += 0.1;
  return made;
}

NewtonResult run(int loud, double tolerance, double mostly_quiet) {
  Sheet piece = sheet(loud);
  NewtonOptions options;
  options.tolerance = tolerance;
  options.mostly_quiet = mostly_quiet;
  options.most_iterations = 30;
  return newton(piece.model, piece.state, options, 1e-3);
}

TEST(Newton, ALargePieceMayLeaveItsLastPlacesToALaterRun) {
  // A fifth of the largest force: no place stands out enough to be settled by itself as a hot spot.
  const double force = run(2, INFINITY, 0).residual / 5;
  const NewtonResult left = run(2, force, force);
  EXPECT_TRUE(left.quiet);
  EXPECT_FALSE(left.converged);
  EXPECT_EQ(left.iterations, 0) << "two places of sixty";
  const NewtonResult many = run(40, force, force);
  EXPECT_GT(many.iterations, 0) << "more than a two-hundredth of the control points";
  EXPECT_TRUE(many.quiet || many.converged);
  const NewtonResult whole = run(2, force, 0);
  EXPECT_FALSE(whole.quiet);
  EXPECT_TRUE(whole.converged);
}

}  // namespace
}  // namespace loopwright
