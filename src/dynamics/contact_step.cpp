// Implicit steps with the contact of src/mechanics: Newton's method on the incremental potential, every step
// of it cut so that no yarn passes through another.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/motion_solver.hpp"
#include "dynamics/yarn_motion.hpp"
#include "mechanics/contact/sample_clearance.hpp"
#include "mechanics/safe_step.hpp"

namespace loopwright {
namespace {

// As src/mechanics/newton.cpp: what of a gap one step may use up, and how far past contact pairs are looked
// for.
constexpr double gap_share = 0.7, loose = 0.6;
// The core leaves this share of the shell to the nearest pieces of yarn (as grow-in does).
constexpr double left_of_shell = 0.3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

YarnState yarn_state(const FabricContact& contact, const std::vector<Vec3>& place) {
  return {place, contact.width, contact.height, 0};
}

double core_that_fits(const FabricContact& contact, const std::vector<Vec3>& place) {
  const double outer = contact.model.contact.outer;
  const double nearest = smallest_clearance(contact.model, yarn_state(contact, place), 1.5 * outer);
  return std::min(contact.full_core, (nearest - left_of_shell * outer) / (1 - left_of_shell));
}

}  // namespace

FabricContact fabric_contact(const Fabric& fabric, const ModelOptions& options, ContactHistory history) {
  ModelOptions own = options;
  own.free = {false, false, false};
  FabricContact contact;
  contact.full_core = own.material.contact.core;
  contact.model = build_yarn_model(fabric, own);
  for (YarnModel::Yarn& yarn : contact.model.yarns)
    yarn.stretch_stiffness = yarn.bend_stiffness = yarn.twist_stiffness = 0;
  contact.width = fabric.width;
  contact.height = fabric.height;
  contact.history = std::move(history);
  // Cloth at rest under its own core is taken as it is.
  const YarnState state = build_yarn_state(fabric);
  constexpr double enough_room = 0.02;
  if (smallest_clearance(contact.model, state, 1.5) < contact.full_core + enough_room)
    contact.model.contact.core = core_that_fits(contact, state.nodes);
  return contact;
}

void YarnMotion::grow_core() {
  ContactLaw& law = contact_->model.contact;
  if (law.core >= contact_->full_core) return;
  law.core = std::max(law.core, core_that_fits(*contact_, state_.place));
}

bool YarnMotion::contact_step(double dt, StepReport& report) {
  Solver& s = *solver_;
  const YarnModel& yarns = contact_->model;
  const std::size_t n = state_.place.size();
  const double inertia = 1 / (dt * dt), drag = model_.drag / dt, outer = yarns.contact.outer;
  const std::vector<Vec3> inertial = inertial_place(dt);
  YarnState state = yarn_state(*contact_, state_.place);

  // Held points go first, cut like any other motion; what is left of their way is the next half's.
  s.assembly->update_pairs(state, outer + loose);
  YarnState held = state;
  for (std::size_t i = 0; i < n; ++i)
    if (model_.held[i] != 0) held.nodes[i] = inertial[i];
  const SafeStep led = safe_step(yarns, *s.assembly, state, held, outer + loose, outer, gap_share);
  if (led.scale < 1) return false;
  // The others too, if their velocities carry them to a better start.
  YarnState carried = held;
  carried.nodes = inertial;
  const auto start_energy = [&](const YarnState& at) {
    return incremental(at.nodes, inertial, dt) + s.assembly->energy(at).total();
  };
  if (safe_step(yarns, *s.assembly, state, carried, outer + loose, outer, gap_share).scale == 1 &&
      start_energy(carried) < start_energy(held))
    held = carried;
  state = held;

  std::vector<Vec3> g, apart(n), heavy;
  BandHessian band;
  bool settled = false;  // the last step moved nothing beyond rounding
  for (int newton = 0;; ++newton) {
    s.assembly->update_pairs(state, outer + loose);
    s.contact_energy = s.assembly->hessian(state, s.gradient, s.hessian).total();
    if (!std::isfinite(s.contact_energy)) return false;
    s.contact_measures = s.assembly->measure_forces();
    band.assign(n, {});
    const double elastic = gradient(state.nodes, g, &band);
    for (std::size_t i = 0; i < n; ++i)
      apart[i] = inertia * (state.nodes[i] - inertial[i]) + drag * (state.nodes[i] - state_.place[i]);
    weigh(apart, heavy);
    double residual = 0;
    for (std::size_t i = 0; i < n; ++i) {
      g[i] += s.gradient.u[i] + heavy[i] - lumped_[i] * model_.gravity;
      if (!model_.force.empty()) g[i] -= model_.force[i];
      if (model_.held[i] != 0) g[i] = {};
      residual = std::max(residual, norm(g[i]));
    }
    if (!std::isfinite(elastic) || !std::isfinite(residual)) return false;
    const bool converged = (residual < options_.tolerance || settled) && newton > 0;
    if (converged || newton >= options_.most_newton) {
      for (std::size_t i = 0; i < n; ++i) state_.velocity[i] = (state.nodes[i] - state_.place[i]) / dt;
      state_.place = state.nodes;
      return converged;
    }
    ++report.newton;

    // The yarns' own terms lie on the pattern that contact's matrix has from its segments.
    s.assembly->metric(s.hessian);
    s.hessian.measure_metric = {1, 1, 1};
    for (std::size_t y = 0; y < mass_.size(); ++y)
      for (std::size_t i = 0; i < mass_[y].size(); ++i)
        for (std::size_t j = i - std::min<std::size_t>(i, 3); j <= i; ++j) {
          const std::size_t p = at(model_.yarns[y].first) + i, q = at(model_.yarns[y].first) + j;
          if (model_.held[p] != 0 || model_.held[q] != 0) continue;
          Block add = band[p][3 - (i - j)];
          for (const std::size_t k : {0, 4, 8}) add[k] += mass_[y](i, j) * (inertia + drag);
          const auto row = static_cast<std::int32_t>(p), column = static_cast<std::int32_t>(q);
          Block& lower = s.hessian.block[s.hessian.place(row, column)];
          for (std::size_t k = 0; k < 9; ++k) lower[k] += add[k];
          if (p == q) continue;
          Block& upper = s.hessian.block[s.hessian.place(column, row)];
          for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 3; ++c) upper[3 * r + c] += add[3 * c + r];
        }
    for (int tries = 0;; ++tries) {
      ++report.factorisations;
      if (s.cholesky.factor(s.hessian, s.shift)) break;
      if (tries == 25) return false;
      s.shift = std::max(4 * s.shift, 1e-3);
    }
    Unknowns right;
    right.u.resize(n);
    for (std::size_t i = 0; i < n; ++i) right.u[i] = -g[i];
    s.cholesky.solve(right, s.direction);

    double slope = 0;
    for (std::size_t i = 0; i < n; ++i) slope += dot(g[i], s.direction.u[i]);
    const double energy = incremental(state.nodes, inertial, dt) + s.assembly->energy(state).total();
    const SafeStep safe = safe_step(yarns, *s.assembly, state, s.assembly->moved(state, s.direction, 1),
                                    outer + loose, outer, gap_share);
    constexpr int most_cuts = 30;
    constexpr double enough = 1e-4, least_slope = 1e-16;
    double scale = safe.scale;
    YarnState next;
    int cut = 0;
    for (; cut < most_cuts; ++cut, scale *= 0.5) {
      next = s.assembly->moved(state, s.direction, scale);
      const double then = incremental(next.nodes, inertial, dt) + s.assembly->energy(next).total();
      if (then <= energy + enough * scale * slope + 1e-12 * (1 + std::abs(energy))) break;
    }
    if (cut == most_cuts) {
      s.shift = std::max(16 * s.shift, 1e-2);
      if (s.shift > 1e9) return false;
      continue;
    }
    if (!safe.surely_apart || !(safe.pair_ratio * scale < 1) || !(safe.loose_motion * scale < 0.5 * loose))
      ++report.pass_throughs;
    settled = scale == 1 && slope > -least_slope;
    state = std::move(next);
    s.assembly->accept(state);
    s.shift = scale > 0.9 ? 0.2 * s.shift : scale < 0.1 ? std::max(2 * s.shift, 1e-4) : s.shift;
    if (s.shift < 1e-7) s.shift = 0;
  }
}

}  // namespace loopwright
