#include "mechanics/assembly_sums.hpp"

#include <algorithm>
#include <cstring>

#include "mechanics/contact/pair_input.hpp"
#include "mechanics/energies/plates.hpp"

namespace loopwright {
namespace {

void add(Vec3& to, double x, double y, double z) {
  to.x += x;
  to.y += y;
  to.z += z;
}

// to += M' column
void add_measures_transposed(const Fraction& f, const Block& column, Block& to) {
  for (std::size_t k = 0; k < 3; ++k) {
    to[k] += f[0] * column[k];
    to[3 + k] += f[1] * column[3 + k];
    to[6 + k] += f[1] * column[k];
  }
}

LOOPWRIGHT_INLINE void add_four(double* to, const Lanes& four) {
  Lanes sum;
  load(to, sum);
  sum += four;
  std::memcpy(to, &sum, sizeof sum);
}

LOOPWRIGHT_INLINE void add_to(Block& to, const Block& from) {
  Lanes first, second;
  load(from.data(), first);
  load(from.data() + 4, second);
  add_four(to.data(), first);
  add_four(to.data() + 4, second);
  to[8] += from[8];
}

// Four symmetric blocks, each in a lane of xx, xy, xz, yy, yz, zz, as the matrix has them: row by row.
class FourBlocks {
 public:
  LOOPWRIGHT_INLINE explicit FourBlocks(const std::array<Lanes, 6>& s) : last_(s[5]) {
    std::array<Lanes, lanes> front{s[0], s[1], s[2], s[3]}, back{s[4], s[5], s[4], s[5]};
    transpose(front[0], front[1], front[2], front[3]);  // xx, xy, xz, yy
    transpose(back[0], back[1], back[2], back[3]);      // yz, zz twice
    for (std::size_t l = 0; l < lanes; ++l) {
      first_[l] = __builtin_shufflevector(front[l], front[l], 0, 1, 2, 1);
      second_[l] = __builtin_shufflevector(front[l], back[l], 3, 4, 2, 6);
    }
  }
  LOOPWRIGHT_INLINE void add(std::size_t lane, Block& to) const {
    add_four(to.data(), first_[lane]);
    add_four(to.data() + 4, second_[lane]);
    to[8] += last_[lane];
  }

 private:
  std::array<Lanes, lanes> first_, second_;
  Lanes last_;
};
LOOPWRIGHT_INLINE std::array<FourBlocks, 4> four_blocks(const std::array<std::array<Lanes, 6>, 4>& s) {
  return {FourBlocks(s[0]), FourBlocks(s[1]), FourBlocks(s[2]), FourBlocks(s[3])};
}

}  // namespace

bool Assembly::touches(const Chunk& chunk, int segment) const {
  const FourNodes n = nodes_of(segment);
  return chunk.owns(n[0]) || chunk.owns(n[1]) || chunk.owns(n[2]) || chunk.owns(n[3]);
}

// The lanes' input from four segments; lanes that are left over repeat the last one.
void Assembly::gather(const std::int32_t* segments, std::size_t count, bool fractions,
                      SegmentLanes& to) const {
  to.set = !model_.natural_curvature.empty();
  to.stretch.evenness = Stretch{}.evenness;
  to.bend.natural = nullptr;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto e = static_cast<std::size_t>(segments[std::min(lane, count - 1)]);
    const auto f = static_cast<std::size_t>(model_.first[e]);
    const YarnModel::Yarn& yarn = model_.yarn_of(static_cast<int>(e));
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3& p = extended_[f + k];
      to.points[k][0][lane] = p.x;
      to.points[k][1][lane] = p.y;
      to.points[k][2][lane] = p.z;
      if (fractions)
        for (std::size_t c = 0; c < 2; ++c) to.fractions[k][c][lane] = fraction_[f + k][c];
    }
    to.stretch.stiffness[lane] = yarn.stretch_stiffness;
    to.stretch.rest_length[lane] = model_.natural_length[e];
    to.bend.stiffness[lane] = yarn.bend_stiffness;
    to.bend.rest_length[lane] = yarn.rest_length;
    if (to.set)
      for (std::size_t g = 0; g < 4; ++g) to.natural_curvature[g][lane] = model_.natural_curvature[e][g];
  }
}

void Assembly::add_segments(Chunk& chunk) const {
  std::array<std::int32_t, lanes> group;
  std::size_t count = 0;
  SegmentLanes in;
  SegmentLanesTerm term;
  const auto flush = [&] {
    if (count == 0) return;
    gather(group.data(), count, chunk.gradient != nullptr, in);
    if (chunk.gradient)
      evaluate(in, term);
    else
      energies(in, term.stretch, term.bend);
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (chunk.gradient) scatter(term, lane, group[lane], chunk);
      if (!chunk.owns(nodes_of(group[lane])[0])) continue;
      chunk.energy.stretch += term.stretch[lane];
      chunk.energy.bend += term.bend[lane];
      if (chunk.of_segments)
        (*chunk.of_segments)[static_cast<std::size_t>(group[lane])] += term.stretch[lane] + term.bend[lane];
    }
    count = 0;
  };
  for (int e = 0; e < model_.segments; ++e) {
    if (!(chunk.gradient ? touches(chunk, e) : chunk.owns(nodes_of(e)[0]))) continue;
    group[count++] = e;
    if (chunk.matrix) UpperBlocks(*chunk.matrix, diagonal_, chunk.low, chunk.high).fetch(nodes_of(e));
    if (count == lanes) flush();
    if (model_.plates.stiffness > 0) add_plates(e, chunk);
    if (chunk.matrix && model_.yarn_of(e).twist_stiffness > 0) add_twist(e, chunk);
  }
  flush();
}

LOOPWRIGHT_WIDE void Assembly::scatter(const SegmentLanesTerm& term, std::size_t lane, int segment,
                                       Chunk& chunk) const {
  const FourNodes n = nodes_of(segment);
  const bool whole = chunk.owns(n[0]);
  for (std::size_t k = 0; k < 4; ++k) {
    if (!chunk.owns(n[k])) continue;
    const auto& g = term.gradient[k];
    add(chunk.gradient->u[static_cast<std::size_t>(n[k])], g[0][lane], g[1][lane], g[2][lane]);
  }
  for (std::size_t k = 0; whole && k < 3; ++k) chunk.measures[k] += term.measures[k][lane];
  if (!chunk.matrix) return;
  for (std::size_t k = 0; k < 4; ++k)
    if (chunk.owns(n[k])) add_to(chunk.matrix->border[static_cast<std::size_t>(n[k])], term.border[lane][k]);
  const UpperBlocks upper(*chunk.matrix, diagonal_, chunk.low, chunk.high);
  upper.each_own(n, [&](std::size_t k, std::size_t l, Block& to, bool transposed) {
    const Block& block = term.blocks[lane][block_of_points[k][l]];
    if (!transposed)
      add_to(to, block);
    else
      for (std::size_t c = 0; c < 9; ++c) to[c] += block[3 * (c % 3) + c / 3];
  });
  for (std::size_t c = 0; whole && c < 9; ++c) chunk.corner[c] += term.corner[c][lane];
}

void Assembly::add_plates(int segment, Chunk& chunk) const {
  const Plates flat{model_.plates.stiffness, model_.plates.low, model_.plates.high,
                    model_.yarn_of(segment).rest_length, model_.samples};
  if (!flat.touch(places_.boxes[static_cast<std::size_t>(segment)])) return;
  const auto f = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(segment)]);
  SegmentDofs x;
  for (std::size_t i = 0; i < 12; ++i) x[i] = extended_[f + i / 3][static_cast<int>(i % 3)];
  const LocalTerm<12> pushed = flat.evaluate(x, model_.weights);
  if (pushed.energy == 0) return;
  const FourNodes n = nodes_of(segment);
  if (chunk.owns(n[0])) chunk.energy.plates += pushed.energy;
  if (!chunk.gradient) return;
  // Along z alone, which no measure changes.
  for (std::size_t k = 0; k < 4; ++k)
    if (chunk.owns(n[k])) chunk.gradient->u[static_cast<std::size_t>(n[k])].z += pushed.gradient[3 * k + 2];
  if (!chunk.matrix) return;
  UpperBlocks(*chunk.matrix, diagonal_, chunk.low, chunk.high)
      .each_own(n, [&](std::size_t k, std::size_t l, Block& to, bool) {
        to[8] += pushed.hessian[3 * k + 2][3 * l + 2];
      });
}

// The yarn's couple times the second derivatives of its turn.
void Assembly::add_twist(int segment, Chunk& chunk) const {
  const auto f = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(segment)]);
  const double couple =
      twist_.couple(static_cast<std::size_t>(model_.yarn_of_segment[static_cast<std::size_t>(segment)]));
  SegmentBlocks<double> blocks = turn_hessian(arc_ends(&extended_[f]));
  for (Block& block : blocks)
    for (double& entry : block) entry *= couple;
  const FourNodes n = nodes_of(segment);
  UpperBlocks(*chunk.matrix, diagonal_, chunk.low, chunk.high)
      .each_own(n, [&](std::size_t k, std::size_t l, Block& to, bool transposed) {
        const Block& block = blocks[block_of_points[k][l]];
        for (std::size_t c = 0; c < 9; ++c) to[c] += block[transposed ? 3 * (c % 3) + c / 3 : c];
      });
  const bool whole = chunk.owns(n[0]);
  for (std::size_t k = 0; k < 4; ++k) {
    if (!whole && !chunk.owns(n[k])) continue;
    Block column{};
    for (std::size_t l = 0; l < 4; ++l) {
      const Block& block = blocks[block_of_points[k][l]];
      const Fraction& fraction = fraction_[f + l];
      for (std::size_t d = 0; d < 3; ++d) {
        const double by_x = block[k <= l ? 3 * d : d], by_y = block[k <= l ? 3 * d + 1 : 3 + d];
        column[3 * d] += by_x * fraction[0];
        column[3 * d + 1] += by_y * fraction[1];
        column[3 * d + 2] += by_x * fraction[1];
      }
    }
    if (chunk.owns(n[k])) add_to(chunk.matrix->border[static_cast<std::size_t>(n[k])], column);
    if (whole) add_measures_transposed(fraction_[f + k], column, chunk.corner);
  }
}

// Reads the pair's samples; false where its boxes are too far apart for contact.
bool Assembly::contact_input(const SegmentPair& pair, const Vec3& image, double reach,
                             ContactPairInput& in) const {
  const SampleBox &box_a = places_.boxes[static_cast<std::size_t>(pair.a)],
                  &box_b = places_.boxes[static_cast<std::size_t>(pair.b)];
  if (squared_distance(box_a, {image.x, image.y, image.z}, box_b) >= reach * reach) return false;
  in = pair_input(model_, places_, pair, image);
  return true;
}

void Assembly::add_contacts(Chunk& chunk) {
  ContactPairInput in;
  ContactTerm term;
  const std::size_t candidates = chunk.gradient ? active_.size() : pairs_.size();
  for (std::size_t k = 0; k < candidates; ++k) {
    const SegmentPair& pair = pairs_[chunk.gradient ? static_cast<std::size_t>(active_[k]) : k];
    const bool whole = chunk.owns(nodes_of(pair.a)[0]);
    if (!whole && !(chunk.gradient && (touches(chunk, pair.a) || touches(chunk, pair.b)))) continue;
    const double scale = law_scale(pair.a, pair.b), reach = model_.contact.outer * scale;
    if (!chunk.gradient && !may_touch(pair, reach, *chunk.state)) continue;
    if (!contact_input(pair, chunk.state->lattice(pair.m, pair.n), reach, in)) continue;
    const ContactLaw law = scale == 1 ? model_.contact : model_.contact.scaled(scale);
    if (!chunk.gradient) {
      const double energy = contact_energy(in, law);
      chunk.energy.contact += energy;
      if (chunk.of_segments) (*chunk.of_segments)[static_cast<std::size_t>(pair.a)] += energy;
      continue;
    }
    if (chunk.matrix) {
      const UpperBlocks upper(*chunk.matrix, diagonal_, chunk.low, chunk.high);
      const FourNodes na = nodes_of(pair.a), nb = nodes_of(pair.b);
      upper.fetch(na);
      upper.fetch(nb);
      upper.fetch_between(na, nb);
    }
    evaluate(in, law, model_.weights, term);
    if (!term.active) continue;
    if (whole) chunk.energy.contact += term.energy;
    if (model_.friction > 0) {
      const FrictionContact rub = add_friction(pair, *chunk.state, term);
      if (whole) friction_[k] = rub;
    }
    scatter(term, pair, chunk);
  }
}

// Friction: the contact's load, normal and place, weighted with the force of each sample. Its force and
// Hessian are added to the contact's.
LOOPWRIGHT_WIDE Assembly::FrictionContact Assembly::add_friction(const SegmentPair& pair,
                                                                 const YarnState& state,
                                                                 ContactTerm& term) const {
  FrictionContact rub;
  const Vec3 push{term.push[0], term.push[1], term.push[2]};
  if (!(term.a.size > 0 && term.b.size > 0 && squared_norm(push) > 0)) return rub;
  rub.a = pair.a, rub.b = pair.b, rub.m = pair.m, rub.n = pair.n;
  const Lanes wa = term.a.place / term.a.size, wb = term.b.place / term.b.size;
  for (std::size_t k = 0; k < 4; ++k) {
    rub.law.weight_a[k] = wa[k];
    rub.law.weight_b[k] = wb[k];
  }
  rub.law.normal = normalized(push);
  rub.law.load = model_.friction * norm(push);
  rub.law.slip = rub.law.tangential(remembered_slip(pair));
  rub.law.start = relative_place(rub, state);
  const Vec3 force = rub.law.force(rub.law.start);
  const Symmetric3 stiffness = rub.law.stiffness(rub.law.start);
  for (std::size_t c = 0; c < 3; ++c) {
    term.a.gradient[c] += force[static_cast<int>(c)] * wa;
    term.b.gradient[c] -= force[static_cast<int>(c)] * wb;
  }
  for (std::size_t c = 0; c < 6; ++c) {
    const Lanes by_a = stiffness[c] * wa, by_b = stiffness[c] * wb;
    for (std::size_t k = 0; k < 4; ++k) {
      term.a.hessian[k][c] += wa[k] * by_a;
      term.b.hessian[k][c] += wb[k] * by_b;
      term.between[k][c] -= wa[k] * by_b;
    }
  }
  return rub;
}

LOOPWRIGHT_WIDE void Assembly::scatter(const ContactTerm& term, const SegmentPair& pair, Chunk& chunk) const {
  const FourNodes na = nodes_of(pair.a), nb = nodes_of(pair.b);
  const auto fa = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(pair.a)]),
             fb = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(pair.b)]);
  std::array<Fraction, 4> frac_a, frac_b;
  for (std::size_t k = 0; k < 4; ++k) {
    frac_a[k] = fraction_[fa + k];
    frac_b[k] = {fraction_[fb + k][0] + pair.m, fraction_[fb + k][1] + pair.n};
  }
  const bool whole = chunk.owns(na[0]);
  const auto add_force = [&](std::int32_t node, const std::array<Lanes, 3>& gradient, std::size_t k,
                             const Fraction& fraction) {
    const Vec3 force{gradient[0][k], gradient[1][k], gradient[2][k]};
    if (chunk.owns(node)) chunk.gradient->u[static_cast<std::size_t>(node)] += force;
    if (!whole) return;
    chunk.measures[0] += fraction[0] * force.x;
    chunk.measures[1] += fraction[1] * force.y;
    chunk.measures[2] += fraction[1] * force.x;
  };
  for (std::size_t k = 0; k < 4; ++k) {
    add_force(na[k], term.a.gradient, k, frac_a[k]);
    add_force(nb[k], term.b.gradient, k, frac_b[k]);
  }
  if (!chunk.matrix) return;
  const UpperBlocks upper(*chunk.matrix, diagonal_, chunk.low, chunk.high);
  const std::array<FourBlocks, 4> of_a = four_blocks(term.a.hessian), of_b = four_blocks(term.b.hessian),
                                  between = four_blocks(term.between);
  upper.each_own(na, [&](std::size_t k, std::size_t l, Block& to, bool)
                         LOOPWRIGHT_INLINE_LAMBDA { of_a[k].add(l, to); });
  upper.each_own(nb, [&](std::size_t k, std::size_t l, Block& to, bool)
                         LOOPWRIGHT_INLINE_LAMBDA { of_b[k].add(l, to); });
  upper.each_between(na, nb, [&](std::size_t k, std::size_t l, Block& to) LOOPWRIGHT_INLINE_LAMBDA {
    between[k].add(l, to);
  });

  ContactBorder columns;
  border(term, frac_a, frac_b, columns);
  const auto add_column = [&](std::int32_t node, const Fraction& fraction, const Block& column) {
    if (chunk.owns(node)) add_to(chunk.matrix->border[static_cast<std::size_t>(node)], column);
    if (whole) add_measures_transposed(fraction, column, chunk.corner);
  };
  for (std::size_t k = 0; k < 4; ++k) {
    add_column(na[k], frac_a[k], columns.a[k]);
    add_column(nb[k], frac_b[k], columns.b[k]);
  }
}

}  // namespace loopwright
