// Soft yarn in loops that are long for its core and short for its outer diameter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/interlacing.hpp"
#include "mechanics/contact/sample_clearance.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

// Acrylic 77 tex in loops of 7.23 mm (Ding, Sanchez, Bertoldi, Rycroft, arXiv 2307.12360; data/materials):
// outer diameter 1.05 mm, B 1.47e-8 N m^2, EA 68 N; its shell is estimated there.
constexpr double loop_length = 7.23 / 1.05;

RelaxOptions acrylic(double core_mm, double friction) {
  RelaxOptions options;
  options.model.material = {.stretch_stiffness = 68 * 1.05 * 1.05 / 0.0147,
                            .bend_stiffness = 1,
                            .contact = {.outer = 1,
                                        .core = core_mm / 1.05,
                                        .stiffness = 6e-4 * std::pow(1.05, 5) / 0.0147,
                                        .exponent = 2.4},
                            .friction = friction};
  return options;
}

// No contact sample is inside the core of another: the law is infinite there.
double room_beside_core(const Fabric& fabric, const RelaxOptions& options) {
  return smallest_clearance(build_yarn_model(fabric, options.model), build_yarn_state(fabric), 1.5) -
         options.model.material.contact.core;
}

TEST(SoftYarn, RestsInLoopsThatItsShellAloneWouldJam) {
  for (const char* courses : {"g", "ge", "g\ne", "ge\neg"})
    for (const double friction : {0.0, 0.25}) {
      SCOPED_TRACE(std::string(courses) + ", friction " + std::to_string(friction));
      const RelaxOptions options = acrylic(0.5, friction);
      const RelaxResult result = relax(knitted(courses, "periodic", "", loop_length), options);
      std::printf("%-6.2s friction %.2f: %d steps\n", courses, friction, result.newton_iterations);
      EXPECT_TRUE(result.converged) << result.message;
      EXPECT_EQ(result.pass_throughs, 0);
      const InterlacingCheck check = check_interlacings(result.fabric);
      EXPECT_EQ(check.intact, check.expected);
      EXPECT_GT(room_beside_core(result.fabric, options), 0);
      EXPECT_TRUE(std::isfinite(result.energy.total()));
    }
}

// At rest it is nearly hard yarn of its core's diameter: no looser, and its shell adds a little.
TEST(SoftYarn, IsNearlyHardYarnOfItsCore) {
  const RelaxResult soft = relax(knitted("g", "periodic", "", loop_length), acrylic(0.5, 0)),
                    hard = relax(knitted("g", "periodic", "", 7.23 / 0.5), frictionless());
  ASSERT_TRUE(soft.converged && hard.converged) << soft.message << hard.message;
  const double ratio = soft.energy.bend * loop_length / (hard.energy.bend * 7.23 / 0.5);
  std::printf("bend energy over that of hard yarn: %.3f\n", ratio);
  EXPECT_GT(ratio, 1);
  EXPECT_LT(ratio, 1.15);
}

TEST(SoftYarn, IsJammedOnlyIfItsCoreDoesNotFit) {
  const RelaxResult result = relax(knitted("g", "periodic", "", loop_length), acrylic(0.6, 0.25));
  EXPECT_FALSE(result.converged);
  EXPECT_THAT(result.message, testing::HasSubstr("jammed"));
  EXPECT_EQ(result.pass_throughs, 0);
}

}  // namespace
}  // namespace loopwright
