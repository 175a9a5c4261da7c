// Derivatives by yarn data against cells that are brought to rest again with other yarn.
#include "experiments/sensitivity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "experiments/membrane.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

struct Cell {
  RelaxResult rest;
  RelaxOptions options;
};

// Yarn in which every quantity counts: soft shell, thick core, some stretch. Segments and samples such that a
// little more length does not want another sample.
Cell cell_of(const char* courses, double segments, double spacing) {
  Cell cell;
  cell.options = frictionless();
  YarnMaterial& m = cell.options.model.material;
  m.stretch_stiffness = 800;
  m.contact = {.outer = 1, .core = 0.6, .stiffness = 150, .exponent = 2.4};
  m.reference_bend_N_m2 = 1e-8;
  cell.options.model.sample_spacing = spacing;
  cell.rest = elastic_rest(knitted(courses, "periodic", "", 17, segments), cell.options, 1e-9);
  return cell;
}

RelaxResult rest_with(const Cell& cell, YarnQuantity quantity, double factor, RelaxOptions& options) {
  const ChangedYarn changed = with_quantity(cell.rest.fabric, cell.options, quantity, factor);
  options = changed.options;
  RelaxResult start;
  start.fabric = changed.fabric;
  return sharp_rest(start, options, 1e-10);
}

TEST(Sensitivity, IsWhatComingToRestAgainGives) {
  for (const char* courses : {"g", "g\ne"}) {
    SCOPED_TRACE(courses);
    const Cell cell = cell_of(courses, 16, 0.2);
    ASSERT_TRUE(cell.rest.converged) << cell.rest.message;
    const std::vector<Sensitivity> found = sensitivities(cell.rest, cell.options);
    ASSERT_EQ(found.size(), yarn_quantities.size());
    for (const Sensitivity& s : found) {
      SCOPED_TRACE(name_of(s.quantity));
      constexpr double h = 2e-4;
      std::array<double, 2> width, height, course, wale, shear;
      for (const std::size_t side : {0U, 1U}) {
        RelaxOptions options;
        const RelaxResult again = rest_with(cell, s.quantity, std::exp(side == 0 ? h : -h), options);
        ASSERT_TRUE(again.converged) << again.message;
        width[side] = std::log(again.fabric.width * again.fabric.diameter_mm);
        height[side] = std::log(again.fabric.height * again.fabric.diameter_mm);
        const MembraneStiffness stiffness = membrane_stiffness(again, options);
        course[side] = std::log(stiffness.course_modulus);
        wale[side] = std::log(stiffness.wale_modulus);
        shear[side] = std::log(stiffness.shear_modulus);
      }
      const auto slope = [](const std::array<double, 2>& v) { return (v[0] - v[1]) / (2 * h); };
      EXPECT_NEAR(s.width, slope(width), 1e-3 + 1e-3 * std::abs(s.width));
      EXPECT_NEAR(s.height, slope(height), 1e-3 + 1e-3 * std::abs(s.height));
      EXPECT_NEAR(s.course_modulus, slope(course), 0.02 + 0.01 * std::abs(s.course_modulus));
      EXPECT_NEAR(s.wale_modulus, slope(wale), 0.02 + 0.01 * std::abs(s.wale_modulus));
      EXPECT_NEAR(s.shear_modulus, slope(shear), 0.02 + 0.01 * std::abs(s.shear_modulus));
    }
  }
}

// All lengths twice as large with forces between to match: every size twice, N/m of stiffness an eighth. And
// B, EA and kc twice as large change no size.
TEST(Sensitivity, DimensionsAgree) {
  const Cell cell = cell_of("g", 16, 0.2);
  const std::vector<Sensitivity> s = sensitivities(cell.rest, cell.options);
  const auto of = [&](YarnQuantity q) { return s[static_cast<std::size_t>(q)]; };
  const double forces = of(YarnQuantity::bend_stiffness).width + of(YarnQuantity::stretch_stiffness).width +
                        of(YarnQuantity::shell_stiffness).width;
  EXPECT_NEAR(forces, 0, 1e-6);
  const auto lengths = [&](auto output) {
    return output(of(YarnQuantity::loop_length)) + output(of(YarnQuantity::diameter)) +
           output(of(YarnQuantity::core_diameter)) - 2 * output(of(YarnQuantity::stretch_stiffness)) -
           5 * output(of(YarnQuantity::shell_stiffness));
  };
  EXPECT_NEAR(lengths([](const Sensitivity& one) { return one.width; }), 1, 1e-6);
  EXPECT_NEAR(lengths([](const Sensitivity& one) { return one.height; }), 1, 1e-6);
  EXPECT_NEAR(lengths([](const Sensitivity& one) { return one.course_modulus; }), -3, 1e-3);
}

// Deviations of the data against the scatter of cells with yarn drawn from them.
TEST(Sensitivity, DeviationIsThatOfDrawnYarns) {
  const Cell cell = cell_of("g", 16, 0.2);
  const std::vector<Sensitivity> s = sensitivities(cell.rest, cell.options);
  const std::vector<Deviation> deviations{{YarnQuantity::loop_length, 0.004},
                                          {YarnQuantity::bend_stiffness, 0.02},
                                          {YarnQuantity::shell_stiffness, 0.03}};
  const SizeDeviation wanted = size_deviation(s, deviations);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  constexpr int draws = 150;
  double sum = 0, squares = 0;
  for (int k = 0; k < draws; ++k) {
    ChangedYarn yarn{cell.rest.fabric, cell.options};
    for (const Deviation& one : deviations)
      yarn = with_quantity(yarn.fabric, yarn.options, one.quantity, std::exp(one.share * normal(random)));
    RelaxResult start;
    start.fabric = yarn.fabric;
    const double height = std::log(sharp_rest(start, yarn.options, 1e-7).fabric.height);
    sum += height, squares += height * height;
  }
  const double deviation = std::sqrt((squares - sum * sum / draws) / (draws - 1));
  EXPECT_NEAR(deviation, wanted.height, 0.2 * wanted.height);  // of 150 draws: 6 % at one sigma
  EXPECT_GT(wanted.height, 0.003);
}

TEST(Sensitivity, WhatCannotBeIsRefused) {
  Cell cell = cell_of("g", 16, 0.2);
  EXPECT_THROW(size_deviation({}, std::vector<Deviation>{{YarnQuantity::diameter, -0.1}}),
               std::invalid_argument);
  cell.options.model.free = {false, false, false};
  EXPECT_THROW(sensitivities(cell.rest, cell.options), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
