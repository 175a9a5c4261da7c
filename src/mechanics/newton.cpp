#include "mechanics/newton.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "mechanics/linear/conjugate_gradient.hpp"
#include "mechanics/linear/schwarz.hpp"
#include "mechanics/safe_step.hpp"

namespace loopwright {
namespace {

double largest_force(const Unknowns& g) {
  double largest = 0;
  for (const Vec3& f : g.u) largest = std::max(largest, squared_norm(f));
  return std::sqrt(largest);
}

double largest_measure_force(const Unknowns& g) {
  return std::max({std::abs(g.g[0]), std::abs(g.g[1]), std::abs(g.g[2])});
}

}  // namespace

NewtonResult newton(const YarnModel& model, YarnState& state, const NewtonOptions& options, double first_shift) {
  NewtonResult result;
  Assembly assembly(model);
  Cholesky cholesky;
  Schwarz schwarz;
  BlockMatrix hessian;
  Unknowns gradient, step;
  const double outer = model.contact.outer;
  double shift = first_shift, loose = 0.6;  // loose: how far past contact the pair list reaches, in d
  constexpr int most_inner = 24, most_patched = 200, patch_nodes = 1200;
  constexpr int few_nodes = 1000;  // small fabrics are factored anew at every step
  const bool patched = model.nodes > 8000 && !model.periodic;
  bool fresh = false;
  int usual_inner = 40;
  bool lagged = false;  // the factor at hand may serve as preconditioner
  const bool trace = std::getenv("LOOPWRIGHT_TRACE") != nullptr;

  for (result.iterations = 0;; ++result.iterations) {
    const auto t0 = std::chrono::steady_clock::now();
    const auto since = [&](auto a) { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - a).count(); };
    const double range = outer + loose;
    assembly.update_pairs(state, range);
    result.energy = assembly.hessian(state, gradient, hessian);
    result.residual = largest_force(gradient);
    const double t_assembly = since(t0);
    result.measure_residual = largest_measure_force(gradient);
    result.converged = result.residual < options.tolerance && result.measure_residual < options.tolerance;
    if (options.on_iteration && !options.on_iteration(result.iterations, result.residual)) result.stopped = true;
    if (result.converged || result.stopped || result.iterations >= options.most_iterations) break;

    assembly.metric(hessian);
    hessian.measure_metric = {1, 1, 1};
    const double t_metric = since(t0);
    int raised = 0, inner = 0;
    bool solved = false;
    const double accuracy = std::clamp(0.3 * result.residual, 1e-3, 0.05);
    if (patched) {
      // Large fabrics: conjugate gradients with a Schwarz preconditioner, factored anew when it has grown stale.
      if (!schwarz.ready()) schwarz.set_patches(state.nodes, model.held, hessian, patch_nodes);
      while (!solved) {
        if (!lagged) {
          ++result.factorisations;
          lagged = schwarz.factor(hessian, shift);
          fresh = true;
        }
        ConjugateGradientResult cg;
        if (lagged)
          cg = conjugate_gradient(hessian, shift, [&](const Unknowns& r, Unknowns& z) { schwarz.solve(r, z); }, gradient, accuracy,
                                  fresh ? most_patched : std::min(most_patched, 2 * usual_inner + 10), step);
        inner += cg.iterations;
        solved = cg.converged || (fresh && lagged && !cg.indefinite);
        if (fresh && solved) usual_inner = cg.iterations;
        if (!solved) {
          if (!lagged || (fresh && cg.indefinite)) {
            shift = std::max(4 * shift, 1e-4);
            if (++raised > 60) {
              result.shift = shift;
              return result;
            }
          }
          lagged = false;
        }
        fresh = false;
      }
    }
    // The factor of an earlier step serves as preconditioner while it is good: on middling pieces a factor costs as much
    // as tens of products and solves.
    else if (lagged && model.nodes > few_nodes) {
      const ConjugateGradientResult cg = conjugate_gradient(
          hessian, shift, [&](const Unknowns& r, Unknowns& z) { cholesky.solve(r, z); }, gradient, accuracy, most_inner, step);
      inner = cg.iterations;
      solved = cg.converged;
      lagged = solved && inner <= most_inner / 2;
    }
    while (!solved) {
      // Factor H + shift D, raising the shift until it is positive definite.
      ++result.factorisations;
      if (cholesky.factor(hessian, shift)) {
        cholesky.solve(gradient, step);
        ++inner;
        solved = lagged = true;
      } else {
        shift = std::max(4 * shift, 1e-4);
        if (++raised > 60) {
          result.shift = shift;
          return result;
        }
      }
    }
    result.linear_iterations += inner;
    for (Vec3& v : step.u) v = -v;
    for (double& v : step.g) v = -v;

    const double t_factor = since(t0);
    const double slope = dot(gradient, step);
    const YarnState target = assembly.moved(state, step, 1);
    const SafeStep safe = safe_step(model, assembly, state, target, range, outer, 0.7);
    double scale = safe.scale;
    const double energy = result.energy.total();
    double next_energy = 0;
    YarnState next;
    int cuts = 0;
    for (;; ++cuts) {
      next = assembly.moved(state, step, scale);
      next_energy = assembly.energy(next).total();
      if (next_energy <= energy + 1e-4 * scale * slope + 1e-13 * std::abs(energy)) break;
      if (cuts >= 40) {
        scale = 0;
        break;
      }
      scale *= 0.5;
    }
    if (trace)
      std::fprintf(stderr, "  it %3d E %.9g (b %.6g c %.4g s %.3g) res %.3e mres %.2e shift %.2e raised %d cg %d scale %.3g cuts %d ratio %.3g loose %.3g W %.4f H %.4f pairs %zu  ms %.0f %.0f %.0f %.0f nnz %.3g\n",
                   result.iterations, energy, result.energy.bend, result.energy.contact, result.energy.stretch, result.residual,
                   result.measure_residual, shift, raised, inner, scale, cuts, safe.pair_ratio, safe.loose_motion, state.width, state.height,
                   assembly.pairs().size(), t_assembly, t_metric, t_factor, since(t0), cholesky.factor_entries());
    if (scale == 0) {
      if (shift > 1e12) break;
      shift = std::max(16 * shift, 1e-3);
      continue;
    }
    // Predicted decrease of the quadratic model along the taken step.
    const double predicted = -(scale * slope + 0.5 * scale * scale * (-slope));
    const double gain = predicted > 0 ? (energy - next_energy) / predicted : 1;
    if (scale > 0.9 && gain > 0.5) {
      shift = raised == 0 ? shift * 0.1 : shift * 0.5;
      if (shift < 1e-9) shift = 1e-9;
    } else if (scale < 0.1 || gain < 0.1) {
      shift = std::max(shift * 3, 1e-6);
    } else if (raised == 0 && scale > 0.4) {
      shift *= 0.5;
    }
    // A step held back by the pair list's reach alone: look farther next time.
    if (safe.loose_motion * safe.scale > 0.4 * (range - outer) && safe.pair_ratio * safe.scale < 0.4)
      loose = std::min(2 * loose, 2.4);
    else
      loose = std::max(0.6, 0.7 * loose);
    // The step as it was taken must be certified; one that is not counts as a possible pass-through.
    if (!(safe.pair_ratio * scale < 1) || !(safe.loose_motion * scale < 0.5 * (range - outer))) ++result.crossings;
    state = std::move(next);
    assembly.accept(state);
  }
  result.shift = shift;
  return result;
}

}  // namespace loopwright
