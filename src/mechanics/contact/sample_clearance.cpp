#include "mechanics/contact/sample_clearance.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/contact/segment_pairs.hpp"

namespace loopwright {

double smallest_clearance(const YarnModel& model, const YarnState& state, double most) {
  std::vector<Vec3> extended;
  SamplePlaces places;
  std::vector<SegmentPair> pairs;
  expand(model, state, extended);
  place_samples(model, extended, places);
  double largest_diameter = 0;
  for (const YarnModel::Yarn& y : model.yarns) largest_diameter = std::max(largest_diameter, y.diameter);
  find_segment_pairs(model, state, places, most * largest_diameter, pairs);
  double nearest = most;
  for (const SegmentPair& pair : pairs) {
    const double diameter = 0.5 * (model.yarn_of(pair.a).diameter + model.yarn_of(pair.b).diameter);
    nearest = std::min(nearest, std::sqrt(pair.distance2) / diameter);
  }
  return nearest;
}

}  // namespace loopwright
