// Steps in time of yarns that bindings hold together: what all steps share, and the implicit one by Newton's
// method.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/motion_solver.hpp"
#include "dynamics/yarn_motion.hpp"

namespace loopwright {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double largest_free(const SplineModel& model, const std::vector<Vec3>& v) {
  double largest = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (model.held[i] == 0) largest = std::max(largest, squared_norm(v[i]));
  return std::sqrt(largest);
}

}  // namespace

StepReport YarnMotion::step(double dt, std::span<const Vec3> held_place) {
  if (!(dt > 0) || !std::isfinite(dt)) throw std::invalid_argument("a time step must be a positive number");
  if (!held_place.empty() && held_place.size() != state_.place.size())
    throw std::invalid_argument("held places must be one for each control point");
  // Held points move evenly through the step.
  const std::vector<Vec3> from = state_.place;
  const auto held_velocity = [&](std::size_t i) {
    return held_place.empty() ? Vec3{} : (held_place[i] - from[i]) / dt;
  };
  for (std::size_t i = 0; i < from.size(); ++i)
    if (model_.held[i] != 0 && options_.stepper == MotionStepper::explicit_euler)
      state_.velocity[i] = held_velocity(i);
  StepReport report;
  if (contact_) grow_core();
  if (options_.stepper == MotionStepper::explicit_euler) return explicit_step(dt);

  // A step that fails is tried in halves, each half again if need be; the next step starts with what went
  // well.
  double done = 0;
  const double least = std::ldexp(1.0, -options_.most_halvings);
  while (done < 1 - 1e-12) {
    const double part = std::min(part_, 1 - done);
    const MotionState before = state_;
    const Bindings bindings_before = bindings_;
    const std::vector<Vec3> multiplier_before = multiplier_;
    const ContactHistory history_before = solver_->assembly ? solver_->assembly->history() : ContactHistory{};
    const int newton_before = report.newton;
    for (std::size_t i = 0; i < from.size(); ++i)
      if (model_.held[i] != 0) state_.velocity[i] = held_velocity(i);
    const bool good =
        contact_ ? contact_step(part * dt, report) : implicit_step(part * dt, report, part <= least);
    if (!good && part > least) {
      ++report.halvings;
      part_ = 0.5 * part;
      state_ = before;
      bindings_ = bindings_before;
      multiplier_ = multiplier_before;
      if (solver_->assembly) solver_->assembly->set_history(history_before);
      continue;
    }
    // At the smallest part what was reached is kept: the report says that it is not to the tolerance.
    if (!good) report.converged = false;
    done += part;
    state_.time = before.time + part * dt;
    if (good && report.newton - newton_before <= options_.most_newton / 2) part_ = std::min(1.0, 2 * part_);
  }
  return report;
}

bool YarnMotion::implicit_step(double dt, StepReport& report, bool smallest) {
  prepare_friction(dt);
  const std::size_t n = state_.place.size(), joints = bindings_.barycentric.size(),
                    slides = bindings_.sliding.size(), unknowns = 3 * n,
                    rows = unknowns + 3 * joints + slides;
  const std::vector<Vec3> inertial = inertial_place(dt);
  std::vector<Vec3> x = state_.place, g, apart(n), heavy;
  for (std::size_t i = 0; i < n; ++i)
    if (model_.held[i] != 0) x[i] = inertial[i];
  const double inertia = 1 / (dt * dt), drag = model_.drag / dt;
  const auto free_point = [&](int i) { return model_.held[at(i)] == 0; };

  // |C|, summed; the free variables of the sliding bindings follow the places.
  const auto off = [&](const std::vector<Vec3>& place) {
    double sum = 0;
    for (const BarycentricBinding& binding : bindings_.barycentric) {
      const Vec3 c = binding.error(place);
      sum += std::abs(c.x) + std::abs(c.y) + std::abs(c.z);
    }
    for (SlidingBinding binding : bindings_.sliding) {
      const ShortestConnection c = follow(model_, place, binding);
      if (can_move(c)) sum += off_by(binding, c);
    }
    return sum;
  };

  // Start from where the yarns are, or from where their velocities carry them, whichever is nearer to the
  // end.
  constexpr double usual_penalty = 10;
  const auto start_merit = [&](const std::vector<Vec3>& place) {
    return incremental(place, inertial, dt) + usual_penalty * off(place);
  };
  if (start_merit(inertial) < start_merit(x)) x = inertial;

  BandHessian band;
  std::vector<double> b(rows);
  SaddleSolver& saddle = solver_->saddle;
  std::vector<ShortestConnection> now(slides);
  double shift = solver_->shift;
  bool settled = false;  // the last step moved nothing beyond rounding
  for (int newton = 0;; ++newton) {
    band.assign(n, {});
    gradient(x, g, &band);
    for (std::size_t i = 0; i < n; ++i) {
      apart[i] = inertia * (x[i] - inertial[i]) + drag * (x[i] - state_.place[i]);
      g[i] -= lumped_[i] * model_.gravity;
      if (!model_.force.empty()) g[i] -= model_.force[i];
    }
    weigh(apart, heavy);
    for (std::size_t i = 0; i < n; ++i) g[i] += heavy[i];
    const std::vector<Vec3> bare = g;  // without the bindings' forces
    double most_off = 0;
    for (std::size_t k = 0; k < joints; ++k) {
      most_off = std::max(most_off, norm(bindings_.barycentric[k].error(x)));
      for (const auto& [point, w] : bindings_.barycentric[k].weights) g[at(point)] += w * multiplier_[k];
    }
    for (std::size_t k = 0; k < slides; ++k) {
      SlidingBinding& binding = bindings_.sliding[k];
      now[k] = follow(model_, x, binding);
      // A guard counts while it presses or is pressed on.
      constexpr double press = 10;  // force for a distance that is missing
      if (binding.may_part())
        pressing_[k] = binding.multiplier + press * (now[k].distance - binding.distance) < 0 ? 1 : 0;
      if (!holds(k, now[k]))
        binding.multiplier = 0;
      else
        most_off = std::max(most_off, std::abs(now[k].distance - binding.distance));
      for (std::size_t i = 0; i < 4; ++i) {
        g[at(now[k].a.first) + i] += (binding.multiplier * now[k].a.weights.value[i]) * now[k].normal;
        g[at(now[k].b.first) + i] -= (binding.multiplier * now[k].b.weights.value[i]) * now[k].normal;
      }
    }
    const double residual = largest_free(model_, g);
    if (!std::isfinite(residual)) return false;
    if ((residual < options_.tolerance || settled) && most_off < options_.constraint_tolerance && newton > 0)
      break;
    if (newton >= options_.most_newton) {
      // Not converged; with places that are finite and bindings that hold, what was reached may still be
      // kept.
      state_.velocity = x;
      for (std::size_t i = 0; i < n; ++i) state_.velocity[i] = (x[i] - state_.place[i]) / dt;
      state_.place = x;
      return false;
    }
    ++report.newton;

    for (int tries = 0;; ++tries) {
      saddle.start(static_cast<int>(rows));
      const auto row = [&](std::size_t point, std::size_t axis) {
        return static_cast<int>(3 * point + axis);
      };
      const auto joint_row = [&](std::size_t k, std::size_t axis) {
        return static_cast<int>(unknowns + 3 * k + axis);
      };
      const auto slide_row = [&](std::size_t k) { return static_cast<int>(unknowns + 3 * joints + k); };
      // Yarns: elasticity, inertia and drag; the shift adds to the inertia.
      for (std::size_t y = 0; y < mass_.size(); ++y) {
        const auto first = at(model_.yarns[y].first);
        const BandMatrix& m = mass_[y];
        for (std::size_t i = 0; i < m.size(); ++i)
          for (std::size_t j = i - std::min<std::size_t>(i, 3); j <= i; ++j) {
            const bool held = model_.held[first + i] != 0 || model_.held[first + j] != 0;
            const double heavy_ij = m(i, j) * (inertia + drag + shift);
            for (std::size_t r = 0; r < 3; ++r)
              for (std::size_t c = 0; c < (i == j ? r + 1 : 3); ++c) {
                double v = held ? 0 : band[first + i][3 - (i - j)][3 * r + c] + (r == c ? heavy_ij : 0);
                if (held && i == j && r == c) v = 1;
                if (!held || i == j) saddle.add(row(first + i, r), row(first + j, c), v);
              }
          }
      }
      // Springs, friction and the curvature of the sliding constraints: 8 points each.
      const auto add_pair = [&](const std::array<int, 8>& point, const auto& entry) {
        for (std::size_t k = 0; k < 8; ++k)
          for (std::size_t l = 0; l <= k; ++l) {
            if (!free_point(point[k]) || !free_point(point[l])) continue;
            for (std::size_t r = 0; r < 3; ++r)
              for (std::size_t c = 0; c < (k == l ? r + 1 : 3); ++c) {
                const double v = entry(k, l, r, c);
                // Both yarns may share a point: its entry is then met twice, off the diagonal of (k, l).
                const int p = row(at(point[k]), r), q = row(at(point[l]), c);
                if (k != l && point[k] == point[l] && p == q)
                  saddle.add(p, q, 2 * v);
                else
                  saddle.add(p, q, v);
              }
          }
      };
      const auto points_of = [](const CurvePoint& a, const CurvePoint& c) {
        return std::array<int, 8>{a.first, a.first + 1, a.first + 2, a.first + 3,
                                  c.first, c.first + 1, c.first + 2, c.first + 3};
      };
      for (const OrientationSpring& spring : bindings_.springs) {
        const CurvePoint a = curve_point(model_, x, spring.a.yarn, spring.a.t),
                         c = curve_point(model_, x, spring.b.yarn, spring.b.t);
        const Vec3 r = a.place - c.place;
        const double length = norm(r);
        if (length == 0) continue;
        const Vec3 normal = r / length;
        const double across = spring.stiffness * (1 - spring.rest / length),
                     along = spring.stiffness - across;
        add_pair(points_of(a, c), [&](std::size_t k, std::size_t l, std::size_t p, std::size_t q) {
          const double wk = k < 4 ? a.weights.value[k] : -c.weights.value[k - 4],
                       wl = l < 4 ? a.weights.value[l] : -c.weights.value[l - 4];
          return wk * wl *
                 (along * normal[static_cast<int>(p)] * normal[static_cast<int>(q)] + (p == q ? across : 0));
        });
      }
      for (std::size_t k = 0; k < slides; ++k) {
        const Friction& law = friction_[k];
        if (law.load > 0) {
          Vec3 r;
          for (std::size_t i = 0; i < 4; ++i)
            r += law.weight_a[i] * x[at(start_[k].a.first) + i] -
                 law.weight_b[i] * x[at(start_[k].b.first) + i];
          const std::array<double, 6> s = law.stiffness(r);
          constexpr std::array<std::array<std::size_t, 3>, 3> place{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
          add_pair(points_of(start_[k].a, start_[k].b),
                   [&](std::size_t i, std::size_t j, std::size_t p, std::size_t q) {
                     const double wi = i < 4 ? law.weight_a[i] : -law.weight_b[i - 4],
                                  wj = j < 4 ? law.weight_a[j] : -law.weight_b[j - 4];
                     return wi * wj * s[place[p][q]];
                   });
        }
        const double load = bindings_.sliding[k].multiplier;
        const auto h = distance_hessian(now[k]);
        add_pair(points_of(now[k].a, now[k].b),
                 [&](std::size_t i, std::size_t j, std::size_t p, std::size_t q) {
                   return load * h[3 * i + p][3 * j + q];
                 });
      }
      // Constraints.
      for (std::size_t k = 0; k < joints; ++k)
        for (std::size_t c = 0; c < 3; ++c) {
          for (const auto& [point, w] : bindings_.barycentric[k].weights)
            if (free_point(point)) saddle.add(joint_row(k, c), row(at(point), c), w);
          saddle.add(joint_row(k, c), joint_row(k, c), -saddle_softness);
        }
      for (std::size_t k = 0; k < slides; ++k) {
        const std::array<int, 8> point = points_of(now[k].a, now[k].b);
        for (std::size_t i = 0; holds(k, now[k]) && i < 8; ++i)
          for (std::size_t c = 0; c < 3; ++c)
            if (free_point(point[i]))
              saddle.add(slide_row(k), row(at(point[i]), c),
                         (i < 4 ? now[k].a.weights.value[i] : -now[k].b.weights.value[i - 4]) *
                             now[k].normal[static_cast<int>(c)]);
        saddle.add(slide_row(k), slide_row(k), -saddle_softness);
      }
      ++report.factorisations;
      if (saddle.factor() && saddle.negative_pivots() == static_cast<int>(3 * joints + slides)) break;
      if (tries == 25) return false;
      shift = std::max(4 * shift, 1e-4 * inertia);
    }

    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < 3; ++c) b[3 * i + c] = model_.held[i] != 0 ? 0 : -g[i][static_cast<int>(c)];
    for (std::size_t k = 0; k < joints; ++k) {
      const Vec3 c = bindings_.barycentric[k].error(x);
      for (std::size_t a = 0; a < 3; ++a) b[unknowns + 3 * k + a] = -c[static_cast<int>(a)];
    }
    for (std::size_t k = 0; k < slides; ++k)
      b[unknowns + 3 * joints + k] = holds(k, now[k]) ? bindings_.sliding[k].distance - now[k].distance : 0;
    saddle.solve(b);

    // The whole step, unless it is longer than the yarns are thick or raises energy + penalty |C|.
    constexpr double longest = 0.3, least_step = 1e-9, enough = 1e-4;
    constexpr int most_cuts = 6;
    std::vector<Vec3> s(n);
    double largest = 0, penalty = 0, slope = 0;
    for (std::size_t i = 0; i < n; ++i) {
      s[i] = {b[3 * i], b[3 * i + 1], b[3 * i + 2]};
      largest = std::max(largest, norm(s[i]));
      if (model_.held[i] == 0) slope += dot(bare[i], s[i]);
    }
    if (!std::isfinite(largest)) return false;
    for (std::size_t k = 0; k < joints; ++k)
      for (std::size_t a = 0; a < 3; ++a)
        penalty = std::max(penalty, std::abs(multiplier_[k][static_cast<int>(a)] + b[unknowns + 3 * k + a]));
    for (std::size_t k = 0; k < slides; ++k)
      penalty = std::max(penalty, std::abs(bindings_.sliding[k].multiplier + b[unknowns + 3 * joints + k]));
    penalty = 1.5 * penalty + 1e-3;
    const double off_now = off(x), merit = incremental(x, inertial, dt) + penalty * off_now;
    slope -= penalty * off_now;
    double scale = std::min(1.0, longest / std::max(largest, 1e-300));
    std::vector<Vec3> trial(n);
    for (int cut = 0;; ++cut, scale *= 0.5) {
      for (std::size_t i = 0; i < n; ++i) trial[i] = x[i] + scale * s[i];
      const double then = incremental(trial, inertial, dt) + penalty * off(trial);
      if (then <= merit + enough * scale * slope + 1e-11 * (1 + std::abs(merit)) || cut == most_cuts) break;
    }
    settled = scale == 1 && largest < least_step;
    x.swap(trial);
    for (std::size_t k = 0; k < joints; ++k)
      for (std::size_t a = 0; a < 3; ++a)
        multiplier_[k][static_cast<int>(a)] += scale * b[unknowns + 3 * k + a];
    for (std::size_t k = 0; k < slides; ++k)
      bindings_.sliding[k].multiplier += scale * b[unknowns + 3 * joints + k];
    shift = scale == 1 ? 0.25 * shift : shift;
    if (shift < 1e-6 * inertia) shift = 0;
  }
  solver_->shift = shift;
  // Guards are set where a step begins: yarn must not pass from outside their reach to the other side in one.
  constexpr double farthest = 0.3;  // d
  double farthest_moved = 0;
  for (std::size_t i = 0; i < n; ++i) farthest_moved = std::max(farthest_moved, norm(x[i] - state_.place[i]));
  if (!bindings_.guarded.empty() && farthest_moved > farthest && !smallest) return false;
  for (std::size_t i = 0; i < n; ++i) state_.velocity[i] = (x[i] - state_.place[i]) / dt;
  state_.place = std::move(x);
  accept_friction();
  return true;
}

}  // namespace loopwright
