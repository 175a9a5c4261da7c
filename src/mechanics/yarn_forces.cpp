#include "mechanics/yarn_forces.hpp"

#include <algorithm>
#include <limits>

#include "mechanics/contact/pair_input.hpp"

namespace loopwright {
namespace {

std::vector<double> tensions(const Fabric& fabric, const YarnModel& model) {
  std::vector<double> tension;
  tension.reserve(static_cast<std::size_t>(model.segments));
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    for (int e = 0; e < model.yarns[y].segments; ++e) {
      const double length = arc_length(fabric, fabric.yarns[y], e, e + 1);
      tension.push_back(model.yarns[y].stretch_stiffness * (length / model.yarns[y].rest_length - 1));
    }
  return tension;
}

// Contact forces on all samples, B/d^2.
std::vector<Vec3> sample_forces(const YarnModel& model, const YarnState& state) {
  SamplePlaces places;
  const std::vector<SegmentPair> pairs = pairs_within(model, state, model.contact.outer, places);

  const auto count = static_cast<std::size_t>(model.samples);
  std::vector<Vec3> forces(static_cast<std::size_t>(model.segments) * count);
  ContactTerm out;
  for (const SegmentPair& pair : pairs) {
    const YarnModel::Yarn &a = model.yarn_of(pair.a), &b = model.yarn_of(pair.b);
    const auto first_a = static_cast<std::size_t>(pair.a) * count,
               first_b = static_cast<std::size_t>(pair.b) * count;
    const ContactPairInput in = pair_input(model, places, pair, state.lattice(pair.m, pair.n));
    evaluate(in, model.contact.scaled(0.5 * (a.diameter + b.diameter)), model.weights, out);
    if (!out.active) continue;
    for (std::size_t k = 0; k < count; ++k) {
      const Lanes &on_a = out.a.sample[k][0], &on_b = out.b.sample[k][0];
      forces[first_a + k] -= {on_a[0], on_a[1], on_a[2]};
      forces[first_b + k] += {on_b[0], on_b[1], on_b[2]};
    }
    // the law is silent inside a core: say it
    if (std::isinf(out.energy))
      for (std::size_t k = 0; k < count; ++k) forces[first_a + k].x = forces[first_b + k].x = out.energy;
  }
  return forces;
}

}  // namespace

YarnForces yarn_forces(const Fabric& fabric, const ModelOptions& options) {
  const YarnModel model = build_yarn_model(fabric, options);
  const YarnState state = build_yarn_state(fabric);
  YarnForces result;
  result.tension = tensions(fabric, model);
  const std::vector<Vec3> forces = sample_forces(model, state);
  result.samples = model.samples;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const double rest = model.yarn_of(static_cast<int>(k) / model.samples).rest_length;
    result.contact.push_back(norm(forces[k]) * model.samples / rest);
  }
  return result;
}

}  // namespace loopwright
