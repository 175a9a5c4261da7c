#include "mechanics/contact/sample_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/contact/segment_pairs.hpp"

namespace loopwright {
namespace {

// Squared distance of the contact samples of two segments of one yarn, those too near along it to touch left
// out.
double touching_distance2(const YarnModel& model, const YarnState& state, const SamplePlaces& places,
                          const SegmentPair& pair) {
  const YarnModel::Yarn& yarn = model.yarn_of(pair.a);
  const double spacing = yarn.rest_length / model.samples;
  const Vec3 image = state.lattice(pair.m, pair.n);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < model.samples; ++i)
    for (int j = 0; j < model.samples; ++j) {
      if (std::abs(pair.arc_offset + (j - i) * spacing) < model.excluded * yarn.diameter) continue;
      const auto a = static_cast<std::size_t>(pair.a * model.samples + i),
                 b = static_cast<std::size_t>(pair.b * model.samples + j);
      least = std::min(least, squared_norm(Vec3{places.x[a], places.y[a], places.z[a]} - image -
                                           Vec3{places.x[b], places.y[b], places.z[b]}));
    }
  return least;
}

}  // namespace

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
    const YarnModel::Yarn& yarn = model.yarn_of(pair.a);
    const double diameter = 0.5 * (yarn.diameter + model.yarn_of(pair.b).diameter);
    const double distance2 = pair.same_yarn ? touching_distance2(model, state, places, pair) : pair.distance2;
    nearest = std::min(nearest, std::sqrt(distance2) / diameter);
  }
  return nearest;
}

}  // namespace loopwright
