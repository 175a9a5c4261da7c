#include "mechanics/energies/contact.hpp"

namespace loopwright {
namespace {

constexpr std::size_t enough_pairs = 64;  // of samples in contact, to be gone through together

// Numbers of samples. Not bytes: these might be part of anything, for all the compiler knows.
using SampleNumber = std::uint16_t;

// The samples of a that are nearer to the box round b's than the root of outer2; how many is returned.
LOOPWRIGHT_INLINE std::size_t rows_near(const ContactPairInput& in, double outer2, SampleNumber* rows) {
  const auto n = static_cast<std::size_t>(in.count);
  std::size_t count = 0, i = 0;
  for (; i + lanes <= n; i += lanes) {
    Lanes d2{};
    for (std::size_t c = 0; in.box_b && c < 3; ++c) {
      Lanes place;
      load((c == 0 ? in.a.x : c == 1 ? in.a.y : in.a.z) + i, place);
      place -= in.image[c];
      const Lanes before = in.box_b->low[c] - place, after = place - in.box_b->high[c];
      Lanes gap = before > after ? before : after;
      gap = gap > 0.0 ? gap : Lanes{};
      d2 += gap * gap;
    }
    for (std::size_t l = 0; l < lanes; ++l) {
      rows[count] = static_cast<SampleNumber>(i + l);
      count += d2[l] < outer2 ? 1 : 0;
    }
  }
  for (; i < n; ++i) {
    rows[count] = static_cast<SampleNumber>(i);
    count += !in.box_b || squared_distance(in.a.x[i] - in.image[0], in.a.y[i] - in.image[1],
                                           in.a.z[i] - in.image[2], *in.box_b) < outer2
                 ? 1
                 : 0;
  }
  return count;
}

// Pairs of samples in contact, found row by row (a sample of a with all of b).
struct TouchingPairs {
  static constexpr std::size_t most = enough_pairs + most_contact_samples + lanes;
  std::array<SampleNumber, most> i, j;
  std::array<double, most> distance2;
  std::size_t count = 0;

  LOOPWRIGHT_INLINE void add_row(const ContactPairInput& in, std::size_t row, double outer2) {
    const auto n = static_cast<std::size_t>(in.count);
    const double px = in.a.x[row] - in.image[0], py = in.a.y[row] - in.image[1],
                 pz = in.a.z[row] - in.image[2];
    std::array<double, most_contact_samples> d2;
    if (squared_distances(px, py, pz, in.b, n, outer2, d2.data()) >= outer2) return;
    if (in.excluded > 0)
      for (std::size_t k = 0; k < n; ++k) {
        const double along = in.arc_offset + (static_cast<double>(k) - static_cast<double>(row)) * in.spacing;
        if (std::abs(along) < in.excluded) d2[k] = outer2;
      }
    std::size_t next = count;
    for (std::size_t k = 0; k < n; ++k) {
      i[next] = static_cast<SampleNumber>(row);
      j[next] = static_cast<SampleNumber>(k);
      distance2[next] = d2[k];
      next += d2[k] < outer2 ? 1 : 0;
    }
    count = next;
  }
  // Lanes behind the last pair repeat it.
  LOOPWRIGHT_INLINE void fill_up() {
    for (std::size_t k = count; k % lanes != 0; ++k) {
      i[k] = i[count - 1];
      j[k] = j[count - 1];
      distance2[k] = distance2[count - 1];
    }
  }
};

// What is summed before it goes to control points: for every sample of a that is touched the sum over b's of
// K_ij, lanes: by the weights of b's control points.
struct RowSums {
  std::array<std::array<Lanes, 6>, most_contact_samples> of;
};

LOOPWRIGHT_INLINE void start(std::size_t samples, ContactSide& side) {
  for (std::size_t k = 0; k < samples; ++k) {
    clear(side.sample[k]);
    side.touched[k] = false;
  }
}

// Forces and Hessians of the pairs found so far, to the samples and rows.
LOOPWRIGHT_INLINE void add_pairs(const ContactPairInput& in, TouchingPairs& pairs, const ContactLaw& law,
                                 const SampleWeights& weights, ContactTerm& term, RowSums& rows) {
  const double weight = in.weight;
  pairs.fill_up();
  alignas(Lanes) std::array<std::array<Lanes, 3>, TouchingPairs::most> of_pair;
  for (std::size_t k = 0; k < pairs.count; k += lanes) {
    Lanes x, y, z, d2, D, energy, slope, curvature;
    for (std::size_t l = 0; l < lanes; ++l) {
      const std::size_t i = pairs.i[k + l], j = pairs.j[k + l];
      x[l] = in.a.x[i] - in.image[0] - in.b.x[j];
      y[l] = in.a.y[i] - in.image[1] - in.b.y[j];
      z[l] = in.a.z[i] - in.image[2] - in.b.z[j];
    }
    load(&pairs.distance2[k], d2);
    square_root(d2, D);
    law.evaluate(D, energy, slope, curvature);
    const Lanes inverse = 1.0 / D;
    x *= inverse;
    y *= inverse;
    z *= inverse;
    const Lanes f = weight * slope, across = f * inverse, along = weight * curvature - across;
    Lanes fx = f * x, fy = f * y, fz = f * z, e = weight * energy;
    const Lanes ax = along * x, ay = along * y;
    Lanes xx = ax * x + across, xy = ax * y, xz = ax * z, yy = ay * y + across, yz = ay * z,
          zz = along * z * z + across, none{}, none_either{};
    transpose(fx, fy, fz, e);
    transpose(xx, xy, xz, yy);
    transpose(yz, zz, none, none_either);
    of_pair[k] = {fx, xx, yz};
    of_pair[k + 1] = {fy, xy, zz};
    of_pair[k + 2] = {fz, xz, none};
    of_pair[k + 3] = {e, yy, none_either};
  }
  for (std::size_t k = 0; k < pairs.count;) {
    // All of one sample of a together.
    const std::size_t i = pairs.i[k];
    std::array<Lanes, 3> sum;
    std::array<Lanes, 6> row;
    clear(sum);
    clear(row);
    for (; k < pairs.count && pairs.i[k] == i; ++k) {
      const std::array<Lanes, 3>& p = of_pair[k];
      const std::size_t j = pairs.j[k];
      Lanes w;
      load(weights[j].data(), w);
      for (std::size_t c = 0; c < 3; ++c) {
        sum[c] += p[c];
        term.b.sample[j][c] += p[c];
      }
      term.b.touched[j] = true;
      for (std::size_t c = 0; c < 4; ++c) row[c] += w * p[1][c];
      row[4] += w * p[2][0];
      row[5] += w * p[2][1];
    }
    term.a.sample[i] = sum;
    term.a.touched[i] = true;
    rows.of[i] = row;
  }
  pairs.count = 0;
}

// One side's samples to its control points; sign: of its gradient. `between`: of side a, by `rows`.
template <bool with_between>
LOOPWRIGHT_INLINE void fold(std::size_t samples, const SampleWeights& weights, double sign, ContactSide& side,
                            const RowSums& rows, std::array<std::array<Lanes, 6>, 4>& between) {
  std::array<SampleNumber, most_contact_samples> touched;
  std::size_t count = 0;
  Lanes place{};
  std::array<Lanes, 3> gradient;
  clear(gradient);
  side.size = 0;
  for (std::size_t k = 0; k < samples; ++k) {
    if (!side.touched[k]) continue;
    touched[count++] = static_cast<SampleNumber>(k);
    const Lanes& f = side.sample[k][0];
    Lanes w;
    load(weights[k].data(), w);
    const double size = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    side.size += size;
    place += size * w;
    for (std::size_t c = 0; c < 3; ++c) gradient[c] += (sign * f[c]) * w;
  }
  side.place = place;
  side.gradient = gradient;
  // One control point after the other, so that its sums stay in registers.
  for (std::size_t a = 0; a < 4; ++a) {
    std::array<Lanes, 6> own, other;
    clear(own);
    clear(other);
    for (std::size_t t = 0; t < count; ++t) {
      const std::size_t k = touched[t];
      const std::array<Lanes, 3>& s = side.sample[k];
      Lanes w;
      load(weights[k].data(), w);
      const double wa = weights[k][a];
      const Lanes both = wa * w;
      for (std::size_t c = 0; c < 4; ++c) own[c] += s[1][c] * both;
      own[4] += s[2][0] * both;
      own[5] += s[2][1] * both;
      if constexpr (with_between)
        for (std::size_t c = 0; c < 6; ++c) other[c] -= wa * rows.of[k][c];
    }
    side.hessian[a] = own;
    if constexpr (with_between) between[a] = other;
  }
}

LOOPWRIGHT_INLINE void sum_of(const Lanes& x, double& sum) { sum = (x[0] + x[1]) + (x[2] + x[3]); }

}  // namespace

LOOPWRIGHT_WIDE double contact_energy(const ContactPairInput& in, const ContactLaw& law) {
  const double outer2 = law.outer * law.outer;
  std::array<SampleNumber, most_contact_samples + lanes> rows;
  const std::size_t near = rows_near(in, outer2, rows.data());
  TouchingPairs pairs;
  double energy = 0;
  for (std::size_t r = 0; r < near; ++r) {
    pairs.add_row(in, rows[r], outer2);
    if (pairs.count == 0 || (pairs.count < enough_pairs && r + 1 < near)) continue;
    pairs.fill_up();
    for (std::size_t k = 0; k < pairs.count; k += lanes) {
      Lanes d2, D, value, slope, curvature;
      load(&pairs.distance2[k], d2);
      square_root(d2, D);
      law.evaluate(D, value, slope, curvature);
      for (std::size_t l = 0; l < lanes && k + l < pairs.count; ++l) energy += value[l];
    }
    pairs.count = 0;
  }
  return in.weight * energy;
}

LOOPWRIGHT_WIDE void evaluate(const ContactPairInput& in, const ContactLaw& law, const SampleWeights& weights,
                              ContactTerm& term) {
  const double outer2 = law.outer * law.outer;
  const auto n = static_cast<std::size_t>(in.count);
  std::array<SampleNumber, most_contact_samples + lanes> rows;
  const std::size_t near = rows_near(in, outer2, rows.data());
  TouchingPairs pairs;
  RowSums sums;
  term.active = false;
  for (std::size_t r = 0; r < near; ++r) {
    pairs.add_row(in, rows[r], outer2);
    if (pairs.count == 0 || (pairs.count < enough_pairs && r + 1 < near)) continue;
    if (!term.active) {
      term.active = true;
      start(n, term.a);
      start(n, term.b);
    }
    add_pairs(in, pairs, law, weights, term, sums);
  }
  if (!term.active) return;
  fold<true>(n, weights, 1, term.a, sums, term.between);
  fold<false>(n, weights, -1, term.b, sums, term.between);
  Lanes whole{};
  for (std::size_t k = 0; k < n; ++k) whole += term.a.sample[k][0];
  term.push = {whole[0], whole[1], whole[2]};
  term.energy = whole[3];
}

LOOPWRIGHT_WIDE void border(const ContactTerm& term, const std::array<std::array<double, 2>, 4>& fractions_a,
                            const std::array<std::array<double, 2>, 4>& fractions_b, ContactBorder& out) {
  // Lanes over the points that are summed over, but for b's with a's, where they are b's rows.
  std::array<Lanes, 2> fa, fb;
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t l = 0; l < 4; ++l) {
      fa[c][l] = fractions_a[l][c];
      fb[c][l] = fractions_b[l][c];
    }
  constexpr std::array<std::array<std::size_t, 2>, 8> sums{
      {{0, 0}, {1, 1}, {0, 1}, {1, 0}, {3, 1}, {2, 0}, {4, 1}, {2, 1}}};  // entry, fraction
  constexpr std::array<std::size_t, 9> of_sum{0, 1, 2, 3, 4, 1, 5, 6, 7};
  std::array<Lanes, 8> b_with_a{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t s = 0; s < 8; ++s)
      b_with_a[s] += term.between[k][sums[s][0]] * fractions_a[k][sums[s][1]];
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<double, 8> a, b;
    for (std::size_t s = 0; s < 8; ++s) {
      const auto [entry, f] = sums[s];
      sum_of(term.a.hessian[k][entry] * fa[f] + term.between[k][entry] * fb[f], a[s]);
      sum_of(term.b.hessian[k][entry] * fb[f], b[s]);
      b[s] += b_with_a[s][k];
    }
    for (std::size_t c = 0; c < 9; ++c) {
      out.a[k][c] = a[of_sum[c]];
      out.b[k][c] = b[of_sum[c]];
    }
  }
}

}  // namespace loopwright
