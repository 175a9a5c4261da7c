// Every structure of the library, read from its notation, with every binding: nothing may come apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/structures.hpp"
#include "dynamics/yarn_motion.hpp"
#include "geometry/interlacing.hpp"

namespace loopwright {
namespace {

struct Stepping {
  double dt = 0;
  int steps = 0;
  MotionStepper stepper = MotionStepper::explicit_euler;
};

// Held in its frame, in the state of repose (the paper's start), shaken, in a medium that takes energy.
YarnMotion shaken(const SmallPiece& piece, const std::string& binding, MotionStepper stepper) {
  const bool contact = binding == "contact";
  SplineModel model = spline_model(piece.fabric, piece.material, 1, true);
  model.drag = 0.5;
  MotionState state = motion_state(piece.fabric);
  for (std::size_t i = 0; i < state.velocity.size(); ++i) {
    const Vec3& p = state.place[i];
    if (model.held[i] == 0)
      state.velocity[i] = {0.3 * std::sin(0.4 * p.y), 0.3 * std::sin(0.5 * p.x),
                           0.3 * std::cos(0.3 * p.x + p.y)};
  }
  Bindings bindings;
  std::optional<FabricContact> shells;
  if (binding == "barycentric") bindings = barycentric_bindings(model, state.place, feet(piece.fabric), 100);
  if (binding == "sliding") bindings = sliding_bindings(model, state.place, feet(piece.fabric), 0.25);
  if (contact) {
    ModelOptions options;
    options.material = piece.material;
    options.material.friction = 0.25;
    shells = fabric_contact(piece.fabric, options);
    shells->full_core = shells->model.contact.core;  // the core that first curves have room for
  }
  MotionOptions options;
  options.stepper = stepper;
  options.tolerance = 0.05;
  options.constraint_tolerance = 1e-6;
  options.most_newton = 25;
  return YarnMotion(std::move(model), std::move(state), std::move(bindings), options, std::move(shells));
}

class Structures : public testing::TestWithParam<std::filesystem::path> {
 protected:
  SmallPiece piece() const {
    // intarsia needs both its fields; a spacer is three layers
    const std::string name = GetParam().stem();
    return small_piece(GetParam(), name == "intarsia" ? "12 wales x 4 courses"
                                   : name == "spacer" ? "4 wales x 2 courses"
                                                      : "4 wales x 4 courses");
  }

  // Bindings hold crossings and know nothing of the yarn between them: where purl loops turn tightly, legs
  // can swing through each other and take an interlacing along. Contact never loses one.
  int may_lose(const std::string& binding) const {
    const std::string name = GetParam().stem();
    if (binding == "barycentric") return name == "moss" ? 3 : name == "racked_rib" ? 2 : 0;
    return 0;
  }

  // `rise`: by how much a step may raise the energy, as a share of what there was (sliding bindings that meet
  // become one, at a new distance).
  void expect_sound(const SmallPiece& small, const std::string& binding, const Stepping& run, double off,
                    double rise) {
    const InterlacingCheck before = check_interlacings(small.fabric);
    ASSERT_EQ(before.intact, before.expected);
    ASSERT_GT(before.expected, 0);
    YarnMotion motion = shaken(small, binding, run.stepper);
    if (binding == "barycentric") {
      EXPECT_GE(motion.bindings().barycentric.size(), 1u);
    }
    if (binding == "sliding") {
      EXPECT_GE(motion.bindings().sliding.size(), 1u);
    }
    motion.step(run.dt);  // contact's energy is known from the first step on
    const double start = motion.energy().total();
    double last = start, worst = 0;
    int steps_off = 0, not_converged = 0;
    for (int k = 1; k < run.steps; ++k) {
      const StepReport report = motion.step(run.dt);
      if (!report.converged) ++not_converged;
      ASSERT_EQ(report.pass_throughs, 0) << binding << ", step " << k;
      const double now = motion.energy().total();
      ASSERT_TRUE(std::isfinite(now)) << binding << ", step " << k;
      worst = std::max(worst, now - last);
      last = now;
      if (motion.constraint_error() > off) ++steps_off;
    }
    EXPECT_LT(worst, rise * start) << binding;
    // A sliding binding whose nearest approach has ended goes on downhill and may be off for a step.
    EXPECT_LE(steps_off, binding == "sliding" ? run.steps / 20 : 0) << binding;
    EXPECT_LE(not_converged, binding == "sliding" ? 2 : 0) << binding;
    EXPECT_LT(last, start) << binding;
    const InterlacingCheck after = check_interlacings(with_places(small.fabric, motion.state().place));
    EXPECT_GE(after.intact, after.expected - may_lose(binding)) << binding;
  }
};

TEST_P(Structures, KeepTogetherWithBarycentricBindings) {
  const SmallPiece small = piece();
  expect_sound(small, "barycentric", {0.008, 300, MotionStepper::explicit_euler}, 1e-9, 1e-3);
  expect_sound(small, "barycentric", {0.5, 6, MotionStepper::implicit_euler}, 1e-6, 1e-6);
}

TEST_P(Structures, KeepTogetherWithSlidingBindings) {
  const SmallPiece small = piece();
  expect_sound(small, "sliding", {0.008, 200, MotionStepper::explicit_euler}, 0.05, 0.05);
  expect_sound(small, "sliding", {0.25, 4, MotionStepper::implicit_euler}, 1e-5, 0.05);
}

TEST_P(Structures, KeepTogetherByContact) {
  // racked rib starts with yarns that nearly touch: every step of it is cut many times
  const int steps = GetParam().stem() == "racked_rib" ? 2 : 6;
  expect_sound(piece(), "contact", {0.25, steps, MotionStepper::implicit_euler}, 1e-9, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Library, Structures, testing::ValuesIn(library()),
                         [](const testing::TestParamInfo<std::filesystem::path>& file) {
                           return file.param.stem().string();
                         });

}  // namespace
}  // namespace loopwright
