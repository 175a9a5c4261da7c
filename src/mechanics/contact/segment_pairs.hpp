// Which segments of yarn are near each other, periodic images included.
#pragma once
#include <cstdint>
#include <vector>

#include "mechanics/yarn_model.hpp"

namespace loopwright {

// Places of all contact samples, structure of arrays: sample k of segment e at e * samples + k.
struct SamplePlaces {
  std::vector<double> x, y, z;
  std::vector<SampleBox> boxes;  // [segment]
};

// Segment b, taken at lattice image (m, n), near segment a. Each unordered pair appears once.
struct SegmentPair {
  std::int32_t a = 0, b = 0;
  std::int8_t m = 0, n = 0;
  bool same_yarn = false;  // the image continues a's own yarn: arc_offset is then meant
  double arc_offset = 0;   // arc of b's first sample minus that of a's first sample along the unwrapped yarn
  double distance2 = 0;    // smallest squared distance of samples that can touch, when the list was made
};

void expand(const YarnModel& model, const YarnState& state, std::vector<Vec3>& extended);
void place_samples(const YarnModel& model, const std::vector<Vec3>& extended, SamplePlaces& places);

// All pairs with some samples closer than `range` that can touch (same-yarn pairs wholly inside the excluded
// arc are left out), sorted by (a, b, m, n). Uniform grid of cells over segments and the lattice images that
// reach the piece.
void find_segment_pairs(const YarnModel& model, const YarnState& state, const SamplePlaces& places,
                        double range, std::vector<SegmentPair>& pairs);
// The same from the state alone: pairs nearer than `reach` diameters of the thickest yarn. `places` are made.
std::vector<SegmentPair> pairs_within(const YarnModel& model, const YarnState& state, double reach,
                                      SamplePlaces& places);

}  // namespace loopwright
