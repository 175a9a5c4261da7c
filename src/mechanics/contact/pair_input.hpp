// What the contact energy reads of a pair of segments.
#pragma once
#include "mechanics/contact/segment_pairs.hpp"
#include "mechanics/energies/contact.hpp"

namespace loopwright {

// The samples of the pair, b's at `image` (the lattice shift of the pair in the state that `places` are of).
// It points into `places`.
inline ContactPairInput pair_input(const YarnModel& model, const SamplePlaces& places,
                                   const SegmentPair& pair, const Vec3& image) {
  const auto samples_of = [&](std::int32_t segment) {
    const std::size_t first = static_cast<std::size_t>(segment) * static_cast<std::size_t>(model.samples);
    return SampleView{&places.x[first], &places.y[first], &places.z[first]};
  };
  const YarnModel::Yarn &a = model.yarn_of(pair.a), &b = model.yarn_of(pair.b);
  ContactPairInput in{samples_of(pair.a), samples_of(pair.b), {image.x, image.y, image.z}};
  in.box_b = &places.boxes[static_cast<std::size_t>(pair.b)];
  in.count = model.samples;
  in.weight = a.rest_length * b.rest_length / (model.samples * model.samples);
  if (pair.same_yarn) {
    in.arc_offset = pair.arc_offset;
    in.spacing = a.rest_length / model.samples;
    in.excluded = model.excluded * a.diameter;
  }
  return in;
}

}  // namespace loopwright
