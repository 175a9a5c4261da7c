#include "mechanics/segment_lanes.hpp"

#include <cstring>

namespace loopwright {
namespace {

// Fractional coordinates as the control points' own are taken to the middle: v, a, j.
using MiddleFractions = std::array<std::array<Lanes, 2>, 3>;

// Nine numbers of four segments, which are apart in the lanes, to a block for each of them.
LOOPWRIGHT_INLINE void to_blocks(const std::array<Lanes, 9>& entries, Block& of_0, Block& of_1, Block& of_2,
                                 Block& of_3) {
  const auto four = [&](std::size_t first) LOOPWRIGHT_INLINE_LAMBDA {
    Lanes a = entries[first], b = entries[first + 1], c = entries[first + 2], d = entries[first + 3];
    transpose(a, b, c, d);
    std::memcpy(of_0.data() + first, &a, sizeof a);
    std::memcpy(of_1.data() + first, &b, sizeof b);
    std::memcpy(of_2.data() + first, &c, sizeof c);
    std::memcpy(of_3.data() + first, &d, sizeof d);
  };
  four(0);
  four(4);
  of_0[8] = entries[8][0];
  of_1[8] = entries[8][1];
  of_2[8] = entries[8][2];
  of_3[8] = entries[8][3];
}

// Border and corner from the Hessian by v, a and j: blocks times M of these, then M' times that.
LOOPWRIGHT_INLINE void add_measures(const SegmentTerm<Lanes>& term, const MiddleFractions& f,
                                    SegmentLanesTerm& out) {
  // place in `own` of the pair of orders i, j
  constexpr std::array<std::array<std::size_t, 3>, 3> own_at{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
  std::array<std::array<Lanes, 9>, 3> by_order;
  for (std::size_t i = 0; i < 3; ++i) {
    Lanes xx{}, yx{}, zx{}, xy{}, yy{}, zy{}, xs{}, ys{}, zs{};
    for (std::size_t j = 0; j < 3; ++j) {
      const Lanes &xi = f[j][0], &eta = f[j][1];
      const Lanes &h_xx = term.own[0][own_at[i][j]], &h_yy = term.own[1][own_at[i][j]];
      const Lanes &h_xy = term.mixed[0][3 * i + j], &h_yx = term.mixed[0][3 * j + i];
      const Lanes &h_zx = term.mixed[1][3 * j + i], &h_zy = term.mixed[2][3 * j + i];
      xx += h_xx * xi, yx += h_yx * xi, zx += h_zx * xi;
      xy += h_xy * eta, yy += h_yy * eta, zy += h_zy * eta;
      xs += h_xx * eta, ys += h_yx * eta, zs += h_zx * eta;
    }
    by_order[i] = {xx, xy, xs, yx, yy, ys, zx, zy, zs};
  }
  std::array<std::array<Lanes, 9>, 4> border;
  for (std::size_t c = 0; c < 9; ++c)
    spread(by_order[0][c], by_order[1][c], by_order[2][c], border[0][c], border[1][c], border[2][c],
           border[3][c]);
  for (std::size_t k = 0; k < 4; ++k)
    to_blocks(border[k], out.border[0][k], out.border[1][k], out.border[2][k], out.border[3][k]);
  clear(out.corner);
  clear(out.measures);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      out.corner[c] += f[i][0] * by_order[i][c];
      out.corner[3 + c] += f[i][1] * by_order[i][3 + c];
      out.corner[6 + c] += f[i][1] * by_order[i][c];
    }
    out.measures[0] += f[i][0] * term.gradient[i][0];
    out.measures[1] += f[i][1] * term.gradient[i][1];
    out.measures[2] += f[i][1] * term.gradient[i][0];
  }
}

}  // namespace

LOOPWRIGHT_WIDE void evaluate(const SegmentLanes& s, SegmentLanesTerm& out) {
  Middle<Lanes> middle;
  middle_of(s.points, middle);
  const GaussPoints<Lanes> points(middle);
  SegmentTerm<Lanes> term;
  std::array<PointLaw<Lanes>, 4> law;
  s.stretch.add(points, law, term);
  out.stretch = term.energy;
  term.energy = Lanes{};
  BendOf<Lanes> bend = s.bend;
  bend.natural = s.set ? &s.natural_curvature : nullptr;
  bend.add(points, law, term);
  out.bend = term.energy;
  if (s.set)
    for (std::size_t g = 0; g < 4; ++g) term.add_point<true>(points, g, law[g]);
  else
    for (std::size_t g = 0; g < 4; ++g) term.add_point<false>(points, g, law[g]);
  spread_gradient(term.gradient, out.gradient);
  SegmentBlocks<Lanes> blocks;
  spread_hessian(term, blocks);
  for (std::size_t k = 0; k < 10; ++k)
    to_blocks(blocks[k], out.blocks[0][k], out.blocks[1][k], out.blocks[2][k], out.blocks[3][k]);
  MiddleFractions fractions;
  middle_of(s.fractions, fractions);
  add_measures(term, fractions, out);
}

LOOPWRIGHT_WIDE void energies(const SegmentLanes& s, Lanes& stretch, Lanes& bend) {
  Middle<Lanes> middle;
  middle_of(s.points, middle);
  const GaussPoints<Lanes> points(middle);
  stretch = bend = Lanes{};
  s.stretch.add_energy(points, stretch);
  BendOf<Lanes> law = s.bend;
  law.natural = s.set ? &s.natural_curvature : nullptr;
  law.add_energy(points, bend);
}

}  // namespace loopwright
