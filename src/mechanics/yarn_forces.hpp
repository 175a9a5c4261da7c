// The forces in a fabric's yarns, segment by segment, as a picture or table shows them.
#pragma once
#include <vector>

#include "mechanics/yarn_model.hpp"

namespace loopwright {

// Of all segments of all yarns in turn.
struct YarnForces {
  std::vector<double> tension;  // [segment] B/d^2; negative where the yarn is shorter than unloaded
  int samples = 1;              // contact samples per segment, at the middles of its equal parts
  std::vector<double> contact;  // [segment * samples + k] what other yarn presses with, per length, B/d^3
};

// Tension is the stretch stiffness times the segment's mean strain (energies/stretch.hpp). Contact is the
// magnitude of the sum of all forces at a contact sample (energies/contact.hpp): two forces that pinch a yarn
// from both sides cancel. Infinite in segments that reach into a core. Throws std::invalid_argument as
// build_yarn_model() does.
YarnForces yarn_forces(const Fabric& fabric, const ModelOptions& options);

}  // namespace loopwright
