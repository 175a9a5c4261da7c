#include "mechanics/contact_fold.hpp"

#include "base/wide.hpp"

namespace loopwright {
namespace {

using Sides = std::array<std::array<double, 3>, most_contact_samples>;

// One side's samples to its control points.
LOOPWRIGHT_INLINE void fold_side(std::size_t samples, const std::array<bool, most_contact_samples>& touched,
                                 const Sides& force,
                                 const std::array<Symmetric3, most_contact_samples>& hessian,
                                 const SampleWeights& weights, const WeightProducts& products,
                                 std::array<std::array<double, 3>, 4>& gradient,
                                 std::array<Symmetric3, 10>& own, std::array<double, 4>& place,
                                 double& size) {
  gradient = {};
  own = {};
  place = {};
  size = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    if (!touched[i]) continue;
    const std::array<double, 3>& f = force[i];
    const double f_size = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    size += f_size;
    for (std::size_t k = 0; k < 4; ++k) {
      place[k] += f_size * weights[i][k];
      for (std::size_t c = 0; c < 3; ++c) gradient[k][c] += weights[i][k] * f[c];
    }
    for (std::size_t p = 0; p < 10; ++p)
      for (std::size_t c = 0; c < 6; ++c) own[p][c] += products[i][p] * hessian[i][c];
  }
}

}  // namespace

WeightProducts weight_products(const SampleWeights& weights, int samples) {
  WeightProducts products{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(samples); ++i)
    for (std::size_t k = 0, at = 0; k < 4; ++k)
      for (std::size_t l = k; l < 4; ++l) products[i][at++] = weights[i][k] * weights[i][l];
  return products;
}

LOOPWRIGHT_WIDE void fold_contact(const ContactPairInput& in, const ContactLaw& law,
                                  const SampleWeights& weights, const WeightProducts& products,
                                  ContactFold& fold) {
  ContactPairOutput out;
  contact_terms(in, law, weights, true, out);
  fold.active = out.active;
  if (!out.active) return;
  fold.energy = out.energy;
  const auto n = static_cast<std::size_t>(in.count);
  fold_side(n, out.touched_a, out.gradient_a, out.hessian_a, weights, products, fold.gradient_a, fold.own_a,
            fold.place_a, fold.size_a);
  fold_side(n, out.touched_b, out.gradient_b, out.hessian_b, weights, products, fold.gradient_b, fold.own_b,
            fold.place_b, fold.size_b);
  fold.push = {};
  for (std::size_t i = 0; i < n; ++i)
    if (out.touched_a[i])
      for (std::size_t c = 0; c < 3; ++c) fold.push[c] += out.gradient_a[i][c];
  fold.between = out.between;
}

LOOPWRIGHT_WIDE double folded_energy(const ContactPairInput& in, const ContactLaw& law) {
  return contact_energy(in, law);
}

}  // namespace loopwright
