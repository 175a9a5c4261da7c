#include "experiments/sensitivity.hpp"

#include <cmath>
#include <stdexcept>

#include "experiments/membrane.hpp"
#include "experiments/rest_hessian.hpp"
#include "mechanics/linear/cholesky.hpp"

namespace loopwright {
namespace {

constexpr double step = 1e-4;  // of the differences, relative

// A yarn of the model: everything in d and B. The number of contact samples does not change with it.
struct ModelPoint {
  YarnModel model;
  YarnState state;
};

ModelPoint model_point(const ChangedYarn& changed, int samples) {
  ModelOptions options = changed.options.model;
  options.material.friction = 0;
  ModelPoint point{build_yarn_model(changed.fabric, options), build_yarn_state(changed.fabric)};
  point.model.samples = samples;
  point.model.weights = sample_weights(samples);
  point.model.held[0] = 1;
  return point;
}

// Gradient and Hessian over the control points (the first pinned) and the measures in `free`.
RestHessian derivatives(ModelPoint point, const FreeMeasures& free) {
  point.model.free = free;
  RestHessian at{std::move(point.model), std::move(point.state), {}, {}};
  Assembly assembly(at.model);
  assembly.update_pairs(at.state, 1.01 * at.model.contact.outer);
  assembly.hessian(at.state, at.gradient, at.hessian);
  at.hessian.metric.assign(at.hessian.column.size(), 0);
  return at;
}

Unknowns difference(const Unknowns& a, const Unknowns& b, double scale) {
  Unknowns d = a;
  axpy(-1, b, d);
  for (Vec3& u : d.u) u = scale * u;
  for (double& g : d.g) g *= scale;
  return d;
}

// The stiffness at a place moved by `scale` times `motion`, of changed yarn.
MembraneStiffness stiffness_along(const ChangedYarn& changed, int samples, const Unknowns& motion,
                                  double scale) {
  ModelPoint point = model_point(changed, samples);
  Assembly assembly(point.model);
  point.state = assembly.moved(point.state, motion, scale);
  const Fabric moved = with_state(changed.fabric, point.state);
  return membrane_stiffness(moved, derivatives(std::move(point), {true, true, true}),
                            changed.options.model.material.reference_bend_N_m2);
}

}  // namespace

std::string name_of(YarnQuantity quantity) {
  switch (quantity) {
    case YarnQuantity::loop_length:
      return "loop-length";
    case YarnQuantity::diameter:
      return "diameter";
    case YarnQuantity::core_diameter:
      return "core-diameter";
    case YarnQuantity::bend_stiffness:
      return "bend-stiffness";
    case YarnQuantity::stretch_stiffness:
      return "stretch-stiffness";
    case YarnQuantity::shell_stiffness:
      return "shell-stiffness";
    case YarnQuantity::shell_exponent:
      return "shell-exponent";
  }
  return {};
}

ChangedYarn with_quantity(const Fabric& fabric, const RelaxOptions& options, YarnQuantity quantity,
                          double factor) {
  ChangedYarn changed{fabric, options};
  YarnMaterial& m = changed.options.model.material;
  const auto scale_rest = [&](double by) {
    for (FabricYarn& yarn : changed.fabric.yarns) yarn.segment_rest_length *= by;
  };
  switch (quantity) {
    case YarnQuantity::loop_length:
      scale_rest(factor);
      break;
    case YarnQuantity::diameter:  // d is the unit of all that is in the model: EA d^2/B, kc d^5/B
      scale_rest(1 / factor);
      m.stretch_stiffness *= factor * factor;
      m.contact.stiffness *= std::pow(factor, 5);
      m.contact.core /= factor;
      changed.fabric.diameter_mm *= factor;
      break;
    case YarnQuantity::core_diameter:
      m.contact.core *= factor;
      break;
    case YarnQuantity::bend_stiffness:
      m.stretch_stiffness /= factor;
      m.contact.stiffness /= factor;
      m.reference_bend_N_m2 *= factor;
      break;
    case YarnQuantity::stretch_stiffness:
      m.stretch_stiffness *= factor;
      break;
    case YarnQuantity::shell_stiffness:
      m.contact.stiffness *= factor;
      break;
    case YarnQuantity::shell_exponent:
      m.contact.exponent *= factor;
      break;
  }
  return changed;
}

std::vector<Sensitivity> sensitivities(const RelaxResult& rest, const RelaxOptions& given) {
  const Fabric& fabric = rest.fabric;
  const FreeMeasures free = given.model.free;
  if (!fabric.periodic || !(free.width || free.height))
    throw std::invalid_argument("sensitivities are those of a periodic cell whose size is free");
  RelaxOptions options = given;
  if (!(options.model.material.reference_bend_N_m2 > 0))
    options.model.material.reference_bend_N_m2 = 1;  // relative changes need no unit
  const int samples = build_yarn_model(fabric, options.model).samples;
  const RestHessian at = derivatives(model_point({fabric, options}, samples), free);
  Cholesky factor;
  if (!factor.factor(at.hessian, 0))
    throw std::runtime_error(
        "the cell is not at a minimum of its energy: its size depends on more than its yarn");
  // The adjoint states of both sizes.
  std::array<Unknowns, 2> adjoint;
  for (std::size_t k = 0; k < 2; ++k) {
    Unknowns unit;
    unit.u.resize(fabric.yarns.empty() ? 0 : at.gradient.u.size());
    unit.g[k] = 1;
    factor.solve(unit, adjoint[k]);
  }

  std::vector<Sensitivity> all;
  for (const YarnQuantity quantity : yarn_quantities) {
    const ChangedYarn more = with_quantity(fabric, options, quantity, std::exp(step)),
                      less = with_quantity(fabric, options, quantity, std::exp(-step));
    const Unknowns change = difference(derivatives(model_point(more, samples), free).gradient,
                                       derivatives(model_point(less, samples), free).gradient, 0.5 / step);
    Sensitivity s;
    s.quantity = quantity;
    const double unit = quantity == YarnQuantity::diameter ? 1 : 0;  // sizes in d grow with it in mm
    if (free.width) s.width = unit - dot(adjoint[0], change) / fabric.width;
    if (free.height) s.height = unit - dot(adjoint[1], change) / fabric.height;

    Unknowns motion;
    factor.solve(change, motion);
    const MembraneStiffness up = stiffness_along(more, samples, motion, -step),
                            down = stiffness_along(less, samples, motion, step);
    const auto slope = [](double high, double low) { return std::log(high / low) / (2 * step); };
    s.course_modulus = slope(up.course_modulus, down.course_modulus);
    s.wale_modulus = slope(up.wale_modulus, down.wale_modulus);
    s.shear_modulus = slope(up.shear_modulus, down.shear_modulus);
    all.push_back(s);
  }
  return all;
}

SizeDeviation size_deviation(std::span<const Sensitivity> sensitivities,
                             std::span<const Deviation> deviations) {
  SizeDeviation variance;
  for (const Deviation& one : deviations) {
    if (!(one.share >= 0) || !std::isfinite(one.share))
      throw std::invalid_argument("a standard deviation must be a number of 0 or more");
    for (const Sensitivity& s : sensitivities)
      if (s.quantity == one.quantity) {
        variance.width += std::pow(s.width * one.share, 2);
        variance.height += std::pow(s.height * one.share, 2);
      }
  }
  return {std::sqrt(variance.width), std::sqrt(variance.height)};
}

}  // namespace loopwright
