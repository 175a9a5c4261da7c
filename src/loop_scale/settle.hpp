// From a start to the stable state: Verlet with damping until nothing pulls and nothing moves, with the
// energy's balance.
#pragma once
#include <functional>
#include <vector>

#include "loop_scale/net_kernel.hpp"

namespace loopwright {

// Where the energy went: springs + kinetic + weight + dissipated = start + work by loads and clamps, up to
// the error of the integration, which falls with the square of the step.
struct EnergyBalance {
  NetEnergy start, now;
  double dissipated = 0;  // by damping: sum of K_d V^2 h
  double work = 0;        // of loads and clamps

  double error() const {
    return now.kinetic + now.springs + now.weight + dissipated - start.kinetic - start.springs -
           start.weight - work;
  }
};

struct SettleOptions {
  double step_share = 0.5;  // of the largest stable step
  int most_steps = 200'000;
  // Stable state: no free mass feels more than this share of the mean K_s times rest length of the springs,
  // and none moves faster than this share of the mean rest length per stable step.
  double tolerance = 1e-5;
  int check_every = 50;  // steps
  bool balance = false;  // follow the energy; two evaluations a step instead of one
  // Called at the start and after every check; false stops.
  std::function<bool(const NetState&, int steps)> on_check;
};

struct SettleResult {
  bool settled = false;
  int steps = 0;
  double step = 0;              // h
  double force = 0, speed = 0;  // largest, in the shares that `tolerance` is compared with
  EnergyBalance balance;        // dissipated and work only if asked for
};

// Damping that would stop a wave as wide as the net within a swing: twice the mass times the frequency of a
// square piece of as many masses, held nowhere.
double settling_damping(const MassSpringNet& net);

// Advances `state`. Throws std::invalid_argument for options out of range.
SettleResult settle(NetKernel& kernel, const MassSpringNet& net, NetState& state,
                    const SettleOptions& options = {});

// `steps` steps of length h with the balance followed; adds to `balance` (start it with kernel.energy).
void advance_with_balance(NetKernel& kernel, double h, int steps, NetState& state, EnergyBalance& balance);

}  // namespace loopwright
