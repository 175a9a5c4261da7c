#include "mechanics/grow_in.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/contact/sample_clearance.hpp"

namespace loopwright {
namespace {

// The law of a yarn whose core grows to its whole width, and the share of the shell that its nearest pieces
// have left between them while it does.
struct Growing {
  ContactLaw whole;
  double left = 0.3;
  double tolerance = 0.1;  // of a stage, B/d^2
};

// Without its core a softer shell would let yarns be pressed together until nothing tells them apart; B/d^5.
constexpr double least_growing_stiffness = 100;

// For soft yarn: thin yarn of usual hardness, as thick as the soft law is hard. Near its core a law goes as k
// W^(1+p) / (D - Dc)^p, which tells the width of a shell of the least growing stiffness that presses as hard.
Growing thin_yarn(const ContactLaw& law) {
  const double width = law.outer - law.core,
               narrow = width * std::pow(law.stiffness / least_growing_stiffness, 1 / (1 + law.exponent)),
               diameter = (law.core + narrow) / law.outer;
  return {{diameter * law.outer, 0.5 * diameter * law.outer, least_growing_stiffness / std::pow(diameter, 5),
           law.exponent}};
}

// The soft law itself, which lets yarns nearly to its core.
Growing soft_law(const ContactLaw& law) { return {law, 0.003, 0.01}; }

ModelOptions with_law(ModelOptions options, ContactLaw law, double core) {
  law.core = core;
  options.material.contact = law;
  // A frictionless yarn can slide into rest states that it cannot leave (moss folded into itself); rubbing
  // while it grows keeps it where the first geometry put it. Afterwards the yarn's own friction counts.
  constexpr double least_growing_friction = 0.3;
  options.material.friction = std::max(options.material.friction, least_growing_friction);
  return options;
}

// Lengths of all segments as they are drawn, in d, in the model's order.
std::vector<double> drawn_lengths(const Fabric& fabric) {
  std::vector<double> lengths;
  for (const FabricYarn& yarn : fabric.yarns)
    for (int e = 0; e < yarn.segments(); ++e) lengths.push_back(arc_length(fabric, yarn, e, e + 1));
  return lengths;
}

// The yarn's hard core grows as room is made, its soft shell is there from the start. It keeps the lengths
// that it was drawn with until the core is whole, and then goes to its own in small steps: loops drawn too
// long or too short would drag yarn through whole courses before it can hold itself. `own_length`: 0 to
// begin with the lengths as drawn, 1 with those of the yarn. Jammed here: it stalled.
GrownIn grow_core(const Fabric& fabric, const ModelOptions& options, const YarnModel& full, YarnState& state,
                  const GrowingRun& run, const Growing& growing, double own_length) {
  const std::vector<double> drawn = drawn_lengths(fabric);
  double most_strain = 0;
  for (std::size_t e = 0; e < drawn.size(); ++e)
    most_strain = std::max(most_strain, std::abs(drawn[e] / full.natural_length[e] - 1));
  const auto drawn_in = [&](YarnModel model, double share) {  // 0: lengths as drawn, 1: those of the yarn
    for (std::size_t e = 0; e < drawn.size(); ++e)
      model.natural_length[e] = (1 - share) * drawn[e] + share * full.natural_length[e];
    return model;
  };

  constexpr double strain_a_stage = 0.15, enough_growth = 0.02, any_growth = 1e-4;
  constexpr int most_stalls = 10;
  const double core = growing.whole.core, outer = growing.whole.outer, left = growing.left,
               length_step = strain_a_stage / std::max(strain_a_stage, most_strain);
  int stalls = 0;
  double core_before = -std::numeric_limits<double>::infinity();
  while (true) {
    const double nearest = smallest_clearance(full, state, 1.5);
    if (!(nearest > 1e-4)) return GrownIn::touching;
    // The core for which the nearest pieces of yarn still have `left` of the shell between them; below zero
    // where they nearly touch: then the law is finite everywhere, and only the safe step parts the yarns.
    const double core_now = std::min(core, (nearest - left * outer) / (1 - left));
    // A knot drawn too tight opens only with more yarn.
    if (core_now == core || core_now < core_before + enough_growth) own_length += length_step;
    if (core_now == core && own_length >= 1) return GrownIn::yes;
    // Yarn pressed nearer than the growing law wishes, at its own length: the true law may take over.
    if (core_now > core_before + any_growth) stalls = 0;
    if (own_length >= 1 && ++stalls > most_stalls) return GrownIn::jammed;
    core_before = core_now;
    const double share = std::clamp(nearest / (core + left * (outer - core)), 0.0, 0.999);
    if (!run(drawn_in(build_yarn_model(fabric, with_law(options, growing.whole, core_now)),
                      std::min(own_length, 1.0)),
             share, growing.tolerance, 12))
      return GrownIn::stopped;
  }
}

}  // namespace

GrownIn grow_in(const Fabric& fabric, const ModelOptions& options, const YarnModel& full, YarnState& state,
                const GrowingRun& run) {
  const ContactLaw& law = full.contact;
  const auto grown = [&](const Growing& growing, double own_length) {
    return grow_core(fabric, options, full, state, run, growing, own_length);
  };
  const bool soft = law.stiffness < least_growing_stiffness;
  GrownIn outcome = grown(soft ? thin_yarn(law) : Growing{law}, 0);
  if (soft && (outcome == GrownIn::yes || outcome == GrownIn::jammed)) outcome = grown(soft_law(law), 1);
  // Soft yarn in tight loops is pressed nearer than a growing law wishes; the true law takes over if no core
  // is in another.
  const double least_room = soft ? 0.001 : 0.02;
  if (outcome == GrownIn::jammed &&
      smallest_clearance(full, state, 1.5) > law.core + least_room * (law.outer - law.core))
    outcome = GrownIn::yes;
  return outcome;
}

}  // namespace loopwright
