// How near yarns are that may touch, as contact sees them.
#pragma once
#include "mechanics/yarn_model.hpp"

namespace loopwright {

// Smallest distance of contact samples of yarns that may touch, in units of their mean diameter; at most
// `most`.
double smallest_clearance(const YarnModel& model, const YarnState& state, double most);

}  // namespace loopwright
