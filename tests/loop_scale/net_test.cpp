// The mass-spring net against closed forms: oscillator, damping, order of Verlet, momentum, stability bound,
// energy balance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/parallel.hpp"
#include "loop_scale/integrators.hpp"
#include "loop_scale/settle.hpp"

namespace loopwright {
namespace {

// Mass 1 on a spring of rest length `rest` from a clamped mass at the origin, pulled out by 0.1.
MassSpringNet oscillator(double stiffness, double damping, double rest = 1) {
  MassSpringNet net;
  net.mass = {1, 2};
  net.springs = {{0, 1, stiffness, {rest, 0, 0}, SpringKind::weft}};
  net.damping = damping;
  net.clamps = {{{0}, {}, {}}};
  return net;
}
NetState pulled() { return state_at_rest({{0, 0, 0}, {1.1, 0, 0}}); }

double oscillation(double stiffness, double damping, double t) {
  const double m = 2, beta = damping / (2 * m), omega = std::sqrt(stiffness / m - beta * beta);
  return 0.1 * std::exp(-beta * t) * (std::cos(omega * t) + beta / omega * std::sin(omega * t));
}

double oscillator_error(double stiffness, double damping, int steps) {
  NetKernel kernel(oscillator(stiffness, damping));
  NetState state = pulled();
  kernel.advance(state, 3.0 / steps, steps);
  return std::abs(state.x[1] - 1 - oscillation(stiffness, damping, 3.0));
}

TEST(net, oscillator_follows_its_closed_form_with_second_order) {
  for (const double damping : {0.0, 0.7, 3.0}) {
    const double coarse = oscillator_error(8, damping, 60), fine = oscillator_error(8, damping, 120);
    EXPECT_LT(coarse, 2e-3);
    EXPECT_NEAR(coarse / fine, 4, 0.15) << "damping " << damping;
  }
}

TEST(net, undamped_energy_wavers_by_the_square_of_the_step_and_does_not_drift) {
  const auto waver = [](double h) {
    NetKernel kernel(oscillator(8, 0));
    NetState state = pulled();
    const double start = kernel.energy(state).springs;
    double most = 0;
    for (double t = 0; t < 200; t += h) {
      kernel.advance(state, h, 1);
      const NetEnergy e = kernel.energy(state);
      most = std::max(most, std::abs(e.kinetic + e.springs - start) / start);
    }
    return most;
  };
  const double coarse = waver(0.1), fine = waver(0.05);
  EXPECT_LT(coarse, 0.011);  // (omega h)^2 / 4 = 0.01
  EXPECT_NEAR(coarse / fine, 4, 0.2);
}

TEST(net, the_bound_of_the_step_is_where_the_oscillator_becomes_unstable) {
  // omega^2 = K / m: 2 / omega
  NetKernel kernel(oscillator(8, 0.3));
  EXPECT_DOUBLE_EQ(kernel.stable_step(), 2 / std::sqrt(8.0 / 2));
  NetState state = pulled();
  EXPECT_THROW(kernel.advance(state, kernel.stable_step(), 1), std::invalid_argument);
  EXPECT_THROW(kernel.advance(state, NAN, 1), std::invalid_argument);
  // with damping it comes to rest just below, and the textbook form blows up just above
  kernel.advance(state, 0.995 * kernel.stable_step(), 3000);
  EXPECT_NEAR(state.x[1], 1, 1e-6);
  state = pulled();
  integrate(oscillator(8, 0.3), kernel, Integrator::verlet, 1.005 * kernel.stable_step(), 3000, state);
  const NetEnergy grown = kernel.energy(state);
  EXPECT_FALSE(grown.kinetic + grown.springs < 10 * 0.5 * 8 * 0.01);
}

// n x n masses, unit distance, joined to their neighbours.
MassSpringNet grid(int n, double weft, double warp, double mass) {
  MassSpringNet net;
  net.mass.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), mass);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int k = i * n + j;
      if (j + 1 < n) net.springs.push_back({k, k + 1, weft, {1, 0, 0}, SpringKind::weft});
      if (i + 1 < n) net.springs.push_back({k, k + n, warp, {0, 1, 0}, SpringKind::warp});
    }
  return net;
}
std::vector<Vec3> grid_places(int n) {
  std::vector<Vec3> places;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) places.push_back({static_cast<double>(j), static_cast<double>(i), 0});
  return places;
}
NetState shaken(const std::vector<Vec3>& places, double much, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, much);
  NetState state = state_at_rest(places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    state.x[i] += normal(random);
    state.y[i] += normal(random);
    state.z[i] += normal(random);
    state.vx[i] = normal(random);
    state.vy[i] = normal(random);
    state.vz[i] = normal(random);
  }
  return state;
}

TEST(net, bound_of_a_plain_net_is_that_of_the_lattice) {
  // omega_max^2 = 4 (K_weft + K_warp) / m of the endless lattice
  const NetKernel kernel(grid(9, 238, 680, 5.7e-6));
  EXPECT_NEAR(kernel.stable_step(), 2 / std::sqrt(4 * (238 + 680) / 5.7e-6), 1e-12);
  EXPECT_NEAR(kernel.stable_step(), 7.9e-5, 0.05e-5);  // physics of an acrylic plain fabric
}

TEST(net, forces_are_the_slope_of_the_energy) {
  for (const SpringLaw law : {SpringLaw::along, SpringLaw::vector})
    for (const bool coupled : {false, true}) {
      if (coupled && law == SpringLaw::vector) continue;
      MassSpringNet net = grid(4, 2, 3, 1);
      net.law = law;
      net.gravity = {0.1, -0.4, 0.2};
      if (coupled) net.couplings = {{1, 0, 1.5, 0.7}, {3, 2, 0.8, -0.4}};
      const NetKernel kernel(net);
      const NetState state = shaken(grid_places(4), 0.2);
      std::vector<Vec3> a;
      kernel.accelerations(state, a);
      const auto total = [&](const NetState& s) {
        const NetEnergy e = kernel.energy(s);
        return e.springs + e.weight;
      };
      for (std::size_t i = 0; i < 16; ++i)
        for (int axis = 0; axis < 3; ++axis) {
          NetState low = state, high = state;
          (axis == 0 ? low.x : axis == 1 ? low.y : low.z)[i] -= 1e-5;
          (axis == 0 ? high.x : axis == 1 ? high.y : high.z)[i] += 1e-5;
          EXPECT_NEAR(a[i][axis], -(total(high) - total(low)) / 2e-5, 1e-8);
        }
    }
}

TEST(net, free_net_keeps_momentum_and_angular_momentum) {
  const MassSpringNet net = grid(8, 2, 5, 0.3);
  NetKernel kernel(net);
  NetState state = shaken(grid_places(8), 0.1);
  const auto momenta = [&] {
    Vec3 p, l;
    for (std::size_t i = 0; i < state.size(); ++i) {
      p += state.velocity(i) * 0.3;
      l += cross(state.position(i), state.velocity(i)) * 0.3;
    }
    return std::pair(p, l);
  };
  const auto [p0, l0] = momenta();
  kernel.advance(state, 0.5 * kernel.stable_step(), 2000);
  const auto [p1, l1] = momenta();
  EXPECT_LT(distance(p0, p1), 1e-11);
  EXPECT_LT(distance(l0, l1), 1e-9);
}

TEST(net, fast_step_is_the_textbook_step) {
  for (const double damping : {0.0, 0.6}) {
    MassSpringNet net = grid(6, 2, 5, 0.3);
    net.damping = damping;
    net.gravity = {0, -0.3, 0};
    net.loads = {{{35}, {0.2, 0.5, 0}, {{0, 0}, {1, 1}}}};
    net.clamps = {{{0, 1, 2}, {}, {}}, {{30, 31}, {0, 0.5, 0.1}, {{0.1, 0}, {0.9, 1}}}};
    NetKernel kernel(net);
    NetState fast = shaken(grid_places(6), 0.05), slow = fast;
    for (const std::size_t i : {0U, 1U, 2U, 30U, 31U})
      for (NetState* s : {&fast, &slow}) s->vx[i] = s->vy[i] = s->vz[i] = 0;
    const double h = 0.4 * kernel.stable_step();
    kernel.advance(fast, h, 20);
    kernel.advance(fast, h, 30);
    integrate(net, kernel, Integrator::verlet, h, 50, slow);
    for (std::size_t i = 0; i < fast.size(); ++i) {
      EXPECT_LT(distance(fast.position(i), slow.position(i)), 1e-12);
      if (!kernel.held(i)) {
        EXPECT_LT(distance(fast.velocity(i), slow.velocity(i)), 1e-11);
      }
    }
  }
}

TEST(net, results_do_not_depend_on_threads) {
  const int n = 200;  // several chunks
  MassSpringNet net = grid(n, 2, 5, 0.3);
  net.damping = 0.1;
  std::vector<NetState> results;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    NetKernel kernel(net);
    NetState state = shaken(grid_places(n), 0.05);
    kernel.advance(state, 0.5 * kernel.stable_step(), 7);
    results.push_back(std::move(state));
  }
  set_thread_count(0);
  for (const NetState& other : results) {
    EXPECT_EQ(other.x, results[0].x);
    EXPECT_EQ(other.vz, results[0].vz);
  }
}

TEST(net, orders_of_the_methods) {
  // error after a fixed time against a fine Verlet run, at h and h / 2
  const MassSpringNet net = [] {
    MassSpringNet n = grid(4, 2, 5, 0.3);
    n.damping = 0.05;
    return n;
  }();
  const NetKernel kernel(net);
  const auto run = [&](Integrator method, int steps) {
    NetState state = shaken(grid_places(4), 0.05);
    integrate(net, kernel, method, 1.0 / steps, steps, state);
    return state;
  };
  const NetState exact = run(Integrator::verlet, 40000);
  const auto error = [&](Integrator method, int steps) {
    const NetState state = run(method, steps);
    double sum = 0;
    for (std::size_t i = 0; i < state.size(); ++i) sum += squared_norm(state.position(i) - exact.position(i));
    return std::sqrt(sum);
  };
  EXPECT_NEAR(error(Integrator::verlet, 200) / error(Integrator::verlet, 400), 4, 0.1);
  for (const Integrator euler :
       {Integrator::explicit_euler, Integrator::semi_implicit_euler, Integrator::implicit_euler})
    EXPECT_NEAR(error(euler, 1000) / error(euler, 2000), 2, 0.1) << name_of(euler);
}

TEST(net, implicit_euler_of_an_oscillator_is_its_closed_form) {
  // V' = (V - h w^2 x) / (1 + h^2 w^2) with w^2 = 4
  const MassSpringNet net = oscillator(8, 0);
  const NetKernel kernel(net);
  NetState state = pulled();
  double x = 0.1, v = 0;
  for (int k = 0; k < 50; ++k) {
    integrate(net, kernel, Integrator::implicit_euler, 1.7, 1, state);
    v = (v - 1.7 * 4 * x) / (1 + 1.7 * 1.7 * 4);
    x += 1.7 * v;
    EXPECT_NEAR(state.x[1] - 1, x, 1e-10);
  }
}

TEST(net, wave_in_a_chain_has_the_lattice_s_frequency) {
  // longitudinal mode k of n free masses in a row: omega = 2 sqrt(K/m) sin(pi k / 2n)
  const int n = 30, mode = 3;
  MassSpringNet net;
  net.mass.assign(n, 0.5);
  std::vector<Vec3> places;
  for (int i = 0; i < n; ++i) {
    places.push_back({static_cast<double>(i), 0, 0});
    if (i > 0) net.springs.push_back({i - 1, i, 4, {1, 0, 0}, SpringKind::weft});
  }
  NetState state = state_at_rest(places);
  for (std::size_t i = 0; i < n; ++i)
    state.x[i] += 1e-4 * std::cos(std::numbers::pi * mode * (static_cast<double>(i) + 0.5) / n);
  const double start = state.x[0];
  NetKernel kernel(net);
  const double omega = 2 * std::sqrt(4 / 0.5) * std::sin(std::numbers::pi * mode / (2 * n));
  const double period = 2 * std::numbers::pi / omega;
  kernel.advance(state, period / 400, 400);
  EXPECT_NEAR(state.x[0], start, 1e-4 * 2e-3);
  kernel.advance(state, period / 400, 200);  // half a period later: the other way
  EXPECT_NEAR(state.x[0], -start, 1e-4 * 4e-3);
}

TEST(net, hanging_chain_settles_as_weight_and_spring_say) {
  // 5 masses hang from a clamp: spring k carries the weight of all below it
  const int n = 6;
  MassSpringNet net;
  net.mass.assign(n, 0.25);
  std::vector<Vec3> places;
  for (int i = 0; i < n; ++i) {
    places.push_back({0, -static_cast<double>(i), 0});
    if (i > 0) net.springs.push_back({i - 1, i, 40, {0, -1, 0}, SpringKind::warp});
  }
  net.clamps = {{{0}, {}, {}}};
  net.gravity = {0, -9.81, 0};
  net.damping = settling_damping(net);
  NetKernel kernel(net);
  NetState state = state_at_rest(places);
  SettleOptions options;
  options.tolerance = 1e-9;
  options.step_share = 0.2;
  options.balance = true;
  const SettleResult result = settle(kernel, net, state, options);
  EXPECT_TRUE(result.settled);
  double y = 0;
  for (int i = 1; i < n; ++i) {
    y -= 1 + 0.25 * 9.81 * (n - i) / 40;
    EXPECT_NEAR(state.y[static_cast<std::size_t>(i)], y, 1e-7);
  }
  // what fell is partly in the springs, the rest went into damping
  EXPECT_LT(std::abs(result.balance.error()), 2e-3 * result.balance.dissipated);
  EXPECT_GT(result.balance.dissipated, 0);
}

TEST(net, energy_balance_closes_with_the_square_of_the_step) {
  MassSpringNet net = grid(5, 2, 5, 0.3);
  net.damping = 0.2;
  net.gravity = {0, -0.3, 0};
  net.loads = {{{24, 23}, {0.2, 0.5, 0.1}, {{0, 0}, {1, 1}}}};
  net.clamps = {{{0, 1, 2}, {}, {}}, {{20}, {0, 0.5, 0.1}, {{0, 0}, {2, 1}}}};
  const auto error = [&](int steps) {
    NetKernel kernel(net);
    NetState state = state_at_rest(grid_places(5));
    EnergyBalance balance;
    balance.start = balance.now = kernel.energy(state);
    advance_with_balance(kernel, 2.0 / steps, steps, state, balance);
    EXPECT_GT(balance.work, 0.01);
    EXPECT_GT(balance.dissipated, 0.001);
    return std::abs(balance.error()) / balance.work;
  };
  const double coarse = error(200), fine = error(400);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.6);
}

TEST(net, coupled_cell_narrows_as_its_closed_form_says) {
  // one warp and one weft spring with a coupling: pull the warp; dw/dc = -k r / (K_weft + k r^2)
  MassSpringNet net;
  net.mass = {1, 1, 1};
  net.springs = {{0, 1, 3, {0, 1, 0}, SpringKind::warp}, {0, 2, 2, {1, 0, 0}, SpringKind::weft}};
  net.couplings = {{0, 1, 1.5, 0.8}};
  net.damping = 1;
  net.clamps = {{{0}, {}, {}}};
  net.loads = {{{1}, {0, 0.1, 0}, {}}};
  NetKernel kernel(net);
  NetState state = state_at_rest({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
  SettleOptions options;
  options.tolerance = 1e-11;
  EXPECT_TRUE(settle(kernel, net, state, options).settled);
  const double dc = state.y[1] - 1, dw = state.x[2] - 1;
  EXPECT_NEAR(dw / dc, -1.5 * 0.8 / (2 + 1.5 * 0.64), 1e-9);
  EXPECT_NEAR(0.1 / dc, 3 + 1.5 - 1.5 * 1.5 * 0.64 / (2 + 1.5 * 0.64), 1e-8);
}

TEST(net, refuses_faults) {
  const auto broken = [](auto change) {
    MassSpringNet net = grid(3, 1, 1, 1);
    change(net);
    EXPECT_THROW(NetKernel{net}, std::invalid_argument);
  };
  broken([](MassSpringNet& n) { n.mass[2] = 0; });
  broken([](MassSpringNet& n) { n.springs[0].b = 99; });
  broken([](MassSpringNet& n) { n.springs[0].stiffness = -1; });
  broken([](MassSpringNet& n) { n.clamps = {{{1}, {}, {}}, {{1}, {}, {}}}; });
  broken([](MassSpringNet& n) { n.loads = {{{1}, {}, {{1, 0}, {1, 1}}}}; });
  broken([](MassSpringNet& n) {
    n.couplings = {{0, 1, 1, 1}};
    n.law = SpringLaw::vector;
  });
}

}  // namespace
}  // namespace loopwright
