#include "loop_scale/settle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace loopwright {
namespace {

struct Scales {
  double force = 0, length = 0;  // mean of K times rest length, mean rest length
};

Scales scales_of(const MassSpringNet& net) {
  Scales scales;
  for (const Spring& s : net.springs) {
    scales.force += s.stiffness * norm(s.rest);
    scales.length += norm(s.rest);
  }
  const double n = std::max<double>(static_cast<double>(net.springs.size()), 1);
  scales.force = std::max(scales.force / n, 1e-300);
  scales.length = std::max(scales.length / n, 1e-300);
  return scales;
}

}  // namespace

double settling_damping(const MassSpringNet& net) {
  double stiffness = 0, mass = 0;
  int count = 0;
  for (const Spring& s : net.springs) {
    if (s.kind != SpringKind::weft && s.kind != SpringKind::warp) continue;
    stiffness += 1 / s.stiffness;
    ++count;
  }
  for (const double m : net.mass) mass += m / static_cast<double>(net.mass.size());
  if (count == 0) return 0;
  // springs in a row share a pull, so the soft ones count: harmonic mean
  const double harmonic = count / stiffness;
  const double across = std::sqrt(static_cast<double>(net.mass.size()));
  const double omega = std::numbers::pi / across * std::sqrt(harmonic / mass);
  return 2 * mass * omega;
}

void advance_with_balance(NetKernel& kernel, double h, int steps, NetState& state, EnergyBalance& balance) {
  std::vector<Vec3> before, after, old(kernel.masses()), old_velocity(kernel.masses());
  kernel.spring_forces(state, before);
  for (int k = 0; k < steps; ++k) {
    const double old_time = state.time;
    for (std::size_t i = 0; i < old.size(); ++i) {
      old[i] = state.position(i);
      old_velocity[i] = state.velocity(i);
    }
    kernel.advance(state, h, 1);
    kernel.spring_forces(state, after);
    // trapezium rule in time for damping, loads and the forces that clamps must give
    for (std::size_t i = 0; i < old.size(); ++i) {
      const Vec3 way = state.position(i) - old[i];
      const Vec3 weight = kernel.external_force(i, state.time) - kernel.gravity_force(i);
      const Vec3 weight_before = kernel.external_force(i, old_time) - kernel.gravity_force(i);
      if (kernel.held(i)) {
        balance.work -= dot((before[i] + after[i]) / 2 + kernel.gravity_force(i), way);
        continue;
      }
      balance.work += dot((weight + weight_before) / 2, way);
      balance.dissipated +=
          kernel.damping() * h * (squared_norm(old_velocity[i]) + squared_norm(state.velocity(i))) / 2;
    }
    before.swap(after);
  }
  balance.now = kernel.energy(state);
}

SettleResult settle(NetKernel& kernel, const MassSpringNet& net, NetState& state,
                    const SettleOptions& options) {
  if (!(options.step_share > 0) || !(options.step_share < 1) || options.check_every < 1)
    throw std::invalid_argument("settle: the share of the stable step must be between 0 and 1");
  SettleResult result;
  const Scales scales = scales_of(net);
  result.step = options.step_share * kernel.stable_step();
  if (!std::isfinite(result.step)) throw std::invalid_argument("settle: the net has no springs");
  const double speed_scale = scales.length / kernel.stable_step();
  result.balance.start = kernel.energy(state);
  std::vector<Vec3> force;
  const auto look = [&] {
    kernel.accelerations(state, force);
    result.force = result.speed = 0;
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (kernel.held(i)) continue;
      result.force = std::max(result.force, norm(force[i]) * kernel.mass(i) / scales.force);
      result.speed = std::max(result.speed, norm(state.velocity(i)) / speed_scale);
    }
    result.settled = result.force < options.tolerance && result.speed < options.tolerance;
    // loads and clamps that still change are no rest
    for (const Load& load : net.loads)
      if (!load.factor.empty() && load.factor.back().first > state.time) result.settled = false;
    for (const Clamp& clamp : net.clamps)
      if (!clamp.factor.empty() && clamp.factor.back().first > state.time) result.settled = false;
    return options.on_check ? options.on_check(state, result.steps) : true;
  };
  bool go_on = look();
  while (go_on && !result.settled && result.steps < options.most_steps) {
    const int steps = std::min(options.check_every, options.most_steps - result.steps);
    if (options.balance)
      advance_with_balance(kernel, result.step, steps, state, result.balance);
    else
      kernel.advance(state, result.step, steps);
    result.steps += steps;
    go_on = look();
  }
  result.balance.now = kernel.energy(state);
  return result;
}

}  // namespace loopwright
