#include "experiments/rest_hessian.hpp"

#include <cmath>
#include <stdexcept>

#include "experiments/modes.hpp"
#include "mechanics/linear/cholesky.hpp"

namespace loopwright {

RestHessian rest_hessian(const Fabric& fabric, const ModelOptions& options, bool pinned) {
  ModelOptions elastic = options;
  elastic.material.friction = 0;
  if (fabric.periodic) elastic.free = {true, true, true};
  RestHessian at{build_yarn_model(fabric, elastic), build_yarn_state(fabric), {}, {}};
  if (pinned && fabric.periodic) at.model.held[0] = 1;
  Assembly assembly(at.model);
  assembly.update_pairs(at.state, 1.01 * at.model.contact.outer);
  assembly.hessian(at.state, at.gradient, at.hessian);
  return at;
}

RelaxResult sharp_rest(const RelaxResult& relaxed, const RelaxOptions& options, double tolerance) {
  RelaxOptions sharp = options;
  sharp.model.material.friction = 0;
  sharp.model.plates = relaxed.plates;
  sharp.grow_in = false;
  sharp.history.clear();
  sharp.tolerance = tolerance;
  RelaxResult result = relaxed;
  const auto go_on = [&] {
    RelaxResult next = relax(result.fabric, sharp);
    add_counts(next, result);
    result = std::move(next);
  };
  go_on();
  constexpr int most_ways = 5;
  constexpr double push = 0.02;  // d, root of the mean square: far less than what parts two yarns' cores
  for (int way = 0; way < most_ways && result.converged; ++way) {
    ModelOptions model = sharp.model;
    model.plates = result.plates;
    const Mode mode = lowest_modes(result.fabric, model, {.wanted = 1, .tolerance = 1e-3}).front();
    if (mode.lambda > 0) break;
    YarnState state = build_yarn_state(result.fabric);
    double length = 0;
    for (const FabricYarn& yarn : result.fabric.yarns) length += yarn.segments() * yarn.segment_rest_length;
    for (std::size_t i = 0; i < state.nodes.size(); ++i)
      state.nodes[i] += push * std::sqrt(length) * mode.shape[i];
    result.fabric = with_state(result.fabric, state);
    go_on();
  }
  return result;
}

RelaxResult elastic_rest(const Fabric& first, const RelaxOptions& options, double tolerance) {
  RelaxResult start;
  start.fabric = first;
  start.plates = options.model.plates;
  if (options.grow_in) {
    RelaxOptions grow = options;
    if (first.periodic) grow.model.free = {false, false, false};
    grow.model.material.friction = 0;
    constexpr double rough = 0.05;  // B/d^2
    grow.tolerance = rough;
    start = relax(first, grow);
    if (start.stopped) return start;
  }
  return sharp_rest(start, options, tolerance);
}

Block condensed_stiffness(const RestHessian& at) {
  // With the measures' columns taken off, the bordered system is A alone.
  BlockMatrix yarn = at.hessian;
  yarn.border.assign(yarn.border.size(), Block{});
  yarn.corner = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  yarn.metric.assign(yarn.column.size(), 0);
  Cholesky factor;
  if (!factor.factor(yarn, 0))
    throw std::runtime_error(
        "the yarn is not at a minimum of its energy: the cloth at these sizes would give way by itself");

  Block stiffness = at.hessian.corner;
  Unknowns column, response;
  const std::size_t nodes = at.hessian.border.size();
  column.u.resize(nodes);
  for (std::size_t l = 0; l < 3; ++l) {
    for (std::size_t i = 0; i < nodes; ++i)
      for (std::size_t d = 0; d < 3; ++d) column.u[i][static_cast<int>(d)] = at.hessian.border[i][3 * d + l];
    factor.solve(column, response);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < nodes; ++i)
        for (std::size_t d = 0; d < 3; ++d)
          stiffness[3 * k + l] -= at.hessian.border[i][3 * d + k] * response.u[i][static_cast<int>(d)];
  }
  return stiffness;
}

}  // namespace loopwright
