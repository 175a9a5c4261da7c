// What a pair of segments in contact gives, taken from their samples to their control points.
#pragma once
#include "mechanics/energies/contact.hpp"

namespace loopwright {

// Products of the spline weights of each sample, for control points k <= l in the order 00 01 02 03 11 12 13
// 22 23 33.
using WeightProducts = std::array<std::array<double, 10>, most_contact_samples>;
WeightProducts weight_products(const SampleWeights& weights, int samples);

struct ContactFold {
  double energy = 0;
  bool active = false;
  // Sizes of the samples' forces on either side, summed with their weights at the four control points, and
  // summed plain; the force on a. For friction's place, load and normal.
  std::array<double, 4> place_a, place_b;
  double size_a = 0, size_b = 0;
  std::array<double, 3> push;
  std::array<std::array<double, 3>, 4> gradient_a, gradient_b;
  std::array<Symmetric3, 10> own_a, own_b;           // blocks of one side's control points k <= l
  std::array<std::array<Symmetric3, 4>, 4> between;  // blocks of a's with b's
};

// Sets `fold.active`, and the rest if it is true.
void fold_contact(const ContactPairInput& in, const ContactLaw& law, const SampleWeights& weights,
                  const WeightProducts& products, ContactFold& fold);

// contact_energy(), compiled for this processor.
double folded_energy(const ContactPairInput& in, const ContactLaw& law);

}  // namespace loopwright
