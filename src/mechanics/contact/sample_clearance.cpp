#include "mechanics/contact/sample_clearance.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/contact/segment_pairs.hpp"

namespace loopwright {

double smallest_clearance(const YarnModel& model, const YarnState& state, double most) {
  SamplePlaces places;
  double nearest = most;
  for (const SegmentPair& pair : pairs_within(model, state, most, places)) {
    const double diameter = 0.5 * (model.yarn_of(pair.a).diameter + model.yarn_of(pair.b).diameter);
    nearest = std::min(nearest, std::sqrt(pair.distance2) / diameter);
  }
  return nearest;
}

}  // namespace loopwright
