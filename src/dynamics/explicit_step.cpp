// The explicit step: symplectic Euler, bindings as constraints on velocities.
#include <algorithm>
#include <stdexcept>

#include "dynamics/motion_solver.hpp"
#include "dynamics/yarn_motion.hpp"

namespace loopwright {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// A yarn's mass matrix with held points out of it.
BandMatrix free_mass(const BandMatrix& mass, const SplineModel& model, int first) {
  BandMatrix m = mass;
  for (std::size_t i = 0; i < m.size(); ++i)
    for (std::size_t j = i - std::min<std::size_t>(i, 3); j <= i; ++j)
      if (model.held[at(first) + i] != 0 || model.held[at(first) + j] != 0) m.at(i, j) = i == j ? 1 : 0;
  return m;
}

}  // namespace

// Bindings that may part and would pull do not count; says whether one of them did.
bool YarnMotion::let_go() {
  bool pulled = false;
  for (std::size_t k = 0; k < bindings_.sliding.size(); ++k) {
    SlidingBinding& binding = bindings_.sliding[k];
    if (!binding.may_part() || binding.multiplier < 0) continue;
    pulled = pulled || pressing_[k] != 0;
    pressing_[k] = 0;
    binding.multiplier = 0;
  }
  return pulled;
}

StepReport YarnMotion::explicit_step(double dt) {
  const std::size_t n = state_.place.size(), joints = bindings_.barycentric.size();
  prepare_friction(dt);
  const std::size_t slides = bindings_.sliding.size();  // guards come and go
  std::vector<Vec3> force, right, still(n);
  gradient(state_.place, force, nullptr);
  // Right side: momentum after the loads; held points carry theirs to their neighbours.
  for (std::size_t i = 0; i < n; ++i) {
    force[i] = lumped_[i] * model_.gravity - force[i];
    if (!model_.force.empty()) force[i] += model_.force[i];
    if (model_.held[i] == 0) still[i] = (1 - dt * model_.drag) * state_.velocity[i];
  }
  weigh(still, right);
  for (std::size_t i = 0; i < n; ++i)
    right[i] = model_.held[i] != 0 ? state_.velocity[i] : right[i] + dt * force[i];

  const auto free_point = [&](int i) { return model_.held[at(i)] == 0; };
  const double back = options_.baumgarte / dt;
  if (joints + slides == 0) {
    if (solver_->mass_factor.empty())
      for (std::size_t k = 0; k < mass_.size(); ++k)
        solver_->mass_factor.emplace_back(free_mass(mass_[k], model_, model_.yarns[k].first));
    for (std::size_t k = 0; k < mass_.size(); ++k)
      solver_->mass_factor[k].solve(
          std::span<Vec3>(right).subspan(at(model_.yarns[k].first), mass_[k].size()));
  } else {
    // Without sliding, mass and bindings are the same for x, y and z and never change: one scalar matrix.
    SaddleSolver& saddle = solver_->saddle;
    const bool scalar = slides == 0;
    const std::size_t axes = scalar ? 1 : 3;
    const auto row = [&](std::size_t point, std::size_t axis) {
      return static_cast<int>(axes * point + axis);
    };
    const auto joint_row = [&](std::size_t k, std::size_t axis) { return row(n + k, axis); };
    const auto slide_row = [&](std::size_t k) { return static_cast<int>(axes * (n + joints) + k); };
    std::vector<double> drift(slides);  // what the sliding bindings want of dD/dt
    const std::vector<Vec3> momenta = right;
    // What would pull and may part is let go, and the rest solved for again.
    constexpr int most_rounds = 4;
    for (int round = 0;; ++round) {
      if (!scalar || !solver_->explicit_factored) {
        saddle.start(static_cast<int>(axes * (n + joints) + slides));
        for (std::size_t k = 0; k < mass_.size(); ++k) {
          const auto first = at(model_.yarns[k].first);
          const BandMatrix m = free_mass(mass_[k], model_, model_.yarns[k].first);
          for (std::size_t i = 0; i < m.size(); ++i)
            for (std::size_t j = i - std::min<std::size_t>(i, 3); j <= i; ++j)
              for (std::size_t c = 0; c < axes; ++c)
                saddle.add(row(first + i, c), row(first + j, c), m(i, j));
        }
        for (std::size_t k = 0; k < joints; ++k)
          for (std::size_t c = 0; c < axes; ++c) {
            for (const auto& [point, w] : bindings_.barycentric[k].weights)
              if (free_point(point)) saddle.add(joint_row(k, c), row(at(point), c), w);
            saddle.add(joint_row(k, c), joint_row(k, c), -saddle_softness);
          }
        for (std::size_t k = 0; k < slides; ++k) {
          const ShortestConnection& c = start_[k];
          const bool held = holds(k, c);
          drift[k] = held ? -back * (c.distance - bindings_.sliding[k].distance) : 0;
          for (std::size_t i = 0; held && i < 8; ++i) {
            const int point = i < 4 ? c.a.first + static_cast<int>(i) : c.b.first + static_cast<int>(i) - 4;
            const double w = i < 4 ? c.a.weights.value[i] : -c.b.weights.value[i - 4];
            for (std::size_t axis = 0; axis < 3; ++axis) {
              const double entry = w * c.normal[static_cast<int>(axis)];
              if (free_point(point))
                saddle.add(slide_row(k), row(at(point), axis), entry);
              else
                drift[k] -= entry * state_.velocity[at(point)][static_cast<int>(axis)];
            }
          }
          saddle.add(slide_row(k), slide_row(k), -sliding_softness);
        }
        if (!saddle.factor()) throw std::runtime_error("the bindings' matrix cannot be factored");
        solver_->explicit_factored = scalar;
      }
      std::vector<Vec3> joint(joints);
      for (std::size_t k = 0; k < joints; ++k) {
        joint[k] = -back * bindings_.barycentric[k].error(state_.place);
        for (const auto& [point, w] : bindings_.barycentric[k].weights)
          if (!free_point(point)) joint[k] -= w * state_.velocity[at(point)];
      }
      const std::size_t rows = axes * (n + joints) + slides;
      std::vector<double> b(rows);
      for (int pass = 0; pass < (scalar ? 3 : 1); ++pass) {
        for (std::size_t i = 0; i < n + joints; ++i)
          for (std::size_t c = 0; c < axes; ++c) {
            const int axis = scalar ? pass : static_cast<int>(c);
            b[axes * i + c] = i < n ? momenta[i][axis] : joint[i - n][axis];
          }
        for (std::size_t k = 0; k < slides; ++k) b[axes * (n + joints) + k] = drift[k];
        saddle.solve(b);
        for (std::size_t i = 0; i < n + joints; ++i)
          for (std::size_t c = 0; c < axes; ++c) {
            const int axis = scalar ? pass : static_cast<int>(c);
            if (i < n)
              right[i][axis] = b[axes * i + c];
            else
              multiplier_[i - n][axis] = b[axes * i + c] / dt;
          }
        for (std::size_t k = 0; k < slides; ++k)
          bindings_.sliding[k].multiplier = b[axes * (n + joints) + k] / dt;
      }
      if (!let_go() || round == most_rounds) break;
    }
  }
  state_.velocity = std::move(right);
  for (std::size_t i = 0; i < n; ++i) state_.place[i] += dt * state_.velocity[i];
  accept_friction();
  state_.time += dt;
  return {};
}

}  // namespace loopwright
