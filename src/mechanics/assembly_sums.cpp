#include "mechanics/assembly_sums.hpp"

#include <algorithm>

#include "mechanics/energies/plates.hpp"

namespace loopwright {
namespace {

void add(Vec3& to, double x, double y, double z) {
  to.x += x;
  to.y += y;
  to.z += z;
}

// to += (a symmetric block) M, M = [[xi, 0, eta], [0, eta, 0], [0, 0, 0]]
void add_times_measures(const Symmetric3& h, const Fraction& f, Block& to) {
  to[0] += h[0] * f[0];
  to[1] += h[1] * f[1];
  to[2] += h[0] * f[1];
  to[3] += h[1] * f[0];
  to[4] += h[3] * f[1];
  to[5] += h[1] * f[1];
  to[6] += h[2] * f[0];
  to[7] += h[4] * f[1];
  to[8] += h[2] * f[1];
}

// to += M' column
void add_measures_transposed(const Fraction& f, const Block& column, Block& to) {
  for (std::size_t k = 0; k < 3; ++k) {
    to[k] += f[0] * column[k];
    to[3 + k] += f[1] * column[3 + k];
    to[6 + k] += f[1] * column[k];
  }
}

void add_symmetric(const Symmetric3& s, Block& to) {
  to[0] += s[0];
  to[1] += s[1];
  to[2] += s[2];
  to[3] += s[1];
  to[4] += s[3];
  to[5] += s[4];
  to[6] += s[2];
  to[7] += s[4];
  to[8] += s[5];
}

void add_to(Block& to, const Block& from) {
  for (std::size_t k = 0; k < 9; ++k) to[k] += from[k];
}

void add_scaled(double by, const Symmetric3& from, Symmetric3& to) {
  for (std::size_t d = 0; d < 6; ++d) to[d] += by * from[d];
}

}  // namespace

FourNodes Assembly::nodes_of(int segment) const {
  const auto f = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(segment)]);
  return {model_.base[f], model_.base[f + 1], model_.base[f + 2], model_.base[f + 3]};
}

bool Assembly::touches(const Chunk& chunk, int segment) const {
  const FourNodes n = nodes_of(segment);
  return chunk.owns(n[0]) || chunk.owns(n[1]) || chunk.owns(n[2]) || chunk.owns(n[3]);
}

// The lanes' input from four segments; lanes that are left over repeat the last one.
void Assembly::gather(const std::int32_t* segments, std::size_t count, bool fractions,
                      SegmentLanes& to) const {
  to.set = !model_.natural_curvature.empty();
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
    gather(group.data(), count, chunk.matrix != nullptr, in);
    if (chunk.matrix)
      evaluate(in, term);
    else
      energies(in, term.stretch, term.bend);
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (chunk.matrix) scatter(term, lane, group[lane], chunk);
      if (!chunk.owns(
              model_.base[static_cast<std::size_t>(model_.first[static_cast<std::size_t>(group[lane])])]))
        continue;
      chunk.energy.stretch += term.stretch[lane];
      chunk.energy.bend += term.bend[lane];
    }
    count = 0;
  };
  for (int e = 0; e < model_.segments; ++e) {
    const bool wanted =
        chunk.matrix
            ? touches(chunk, e)
            : chunk.owns(model_.base[static_cast<std::size_t>(model_.first[static_cast<std::size_t>(e)])]);
    if (!wanted) continue;
    group[count++] = e;
    if (count == lanes) flush();
    if (model_.plates.stiffness > 0) add_plates(e, chunk);
  }
  flush();
}

void Assembly::scatter(const SegmentLanesTerm& term, std::size_t lane, int segment, Chunk& chunk) const {
  const FourNodes n = nodes_of(segment);
  const UpperBlocks upper(*chunk.matrix, diagonal_, chunk.low, chunk.high);
  for (std::size_t k = 0; k < 4; ++k) {
    if (!chunk.owns(n[k])) continue;
    const auto& g = term.gradient[k];
    add(chunk.gradient->u[static_cast<std::size_t>(n[k])], g[0][lane], g[1][lane], g[2][lane]);
    Block& border = chunk.matrix->border[static_cast<std::size_t>(n[k])];
    for (std::size_t c = 0; c < 9; ++c) border[c] += term.border[k][c][lane];
  }
  upper.each_own(n, [&](std::size_t k, std::size_t l, Block& to, bool transposed) {
    const auto& block = term.blocks[block_of_points[k][l]];
    if (!transposed)
      for (std::size_t c = 0; c < 9; ++c) to[c] += block[c][lane];
    else
      for (std::size_t c = 0; c < 9; ++c) to[c] += block[3 * (c % 3) + c / 3][lane];
  });
  if (!chunk.owns(n[0])) return;
  for (std::size_t k = 0; k < 3; ++k) chunk.measures[k] += term.measures[k][lane];
  for (std::size_t c = 0; c < 9; ++c) chunk.corner[c] += term.corner[c][lane];
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
  if (!chunk.matrix) return;
  // Along z alone, which no measure changes.
  for (std::size_t k = 0; k < 4; ++k)
    if (chunk.owns(n[k])) chunk.gradient->u[static_cast<std::size_t>(n[k])].z += pushed.gradient[3 * k + 2];
  UpperBlocks(*chunk.matrix, diagonal_, chunk.low, chunk.high)
      .each_own(n, [&](std::size_t k, std::size_t l, Block& to, bool) {
        to[8] += pushed.hessian[3 * k + 2][3 * l + 2];
      });
}

// Reads the pair's samples; false where its boxes are too far apart for contact.
bool Assembly::contact_input(const SegmentPair& pair, const Vec3& image, double reach,
                             ContactPairInput& in) const {
  const SampleBox &box_a = places_.boxes[static_cast<std::size_t>(pair.a)],
                  &box_b = places_.boxes[static_cast<std::size_t>(pair.b)];
  if (squared_distance(box_a, {image.x, image.y, image.z}, box_b) >= reach * reach) return false;
  const std::size_t a0 = static_cast<std::size_t>(pair.a * model_.samples),
                    b0 = static_cast<std::size_t>(pair.b * model_.samples);
  const YarnModel::Yarn &ya = model_.yarn_of(pair.a), &yb = model_.yarn_of(pair.b);
  in.a = {&places_.x[a0], &places_.y[a0], &places_.z[a0]};
  in.b = {&places_.x[b0], &places_.y[b0], &places_.z[b0]};
  in.image = {image.x, image.y, image.z};
  in.box_b = &box_b;
  in.count = model_.samples;
  in.weight = ya.rest_length * yb.rest_length / (model_.samples * model_.samples);
  in.arc_offset = in.spacing = in.excluded = 0;
  if (pair.same_yarn) {
    in.arc_offset = pair.arc_offset;
    in.spacing = ya.rest_length / model_.samples;
    in.excluded = model_.excluded * ya.diameter;
  }
  return true;
}

void Assembly::add_contacts(Chunk& chunk) {
  ContactPairInput in;
  ContactFold fold;
  const auto owns_first = [&](int segment) {
    return chunk.owns(model_.base[static_cast<std::size_t>(model_.first[static_cast<std::size_t>(segment)])]);
  };
  const std::size_t candidates = chunk.matrix ? active_.size() : pairs_.size();
  for (std::size_t k = 0; k < candidates; ++k) {
    const SegmentPair& pair = pairs_[chunk.matrix ? static_cast<std::size_t>(active_[k]) : k];
    const bool whole = owns_first(pair.a);
    if (!whole && !(chunk.matrix && (touches(chunk, pair.a) || touches(chunk, pair.b)))) continue;
    const double scale = law_scale(pair.a, pair.b);
    if (!contact_input(pair, chunk.state->lattice(pair.m, pair.n), model_.contact.outer * scale, in))
      continue;
    const ContactLaw law = scale == 1 ? model_.contact : model_.contact.scaled(scale);
    if (!chunk.matrix) {
      chunk.energy.contact += folded_energy(in, law);
      continue;
    }
    fold_contact(in, law, model_.weights, products_, fold);
    if (!fold.active) continue;
    if (whole) chunk.energy.contact += fold.energy;
    if (model_.friction > 0) {
      const FrictionContact rub = add_friction(pair, *chunk.state, fold);
      if (whole) friction_[k] = rub;
    }
    scatter(fold, pair, chunk);
  }
}

// Friction: the contact's load, normal and place, weighted with the force of each sample. Its force and
// Hessian are added to the fold.
Assembly::FrictionContact Assembly::add_friction(const SegmentPair& pair, const YarnState& state,
                                                 ContactFold& fold) const {
  FrictionContact rub;
  const Vec3 push{fold.push[0], fold.push[1], fold.push[2]};
  if (!(fold.size_a > 0 && fold.size_b > 0 && squared_norm(push) > 0)) return rub;
  rub.a = pair.a, rub.b = pair.b, rub.m = pair.m, rub.n = pair.n;
  for (std::size_t k = 0; k < 4; ++k) {
    rub.law.weight_a[k] = fold.place_a[k] / fold.size_a;
    rub.law.weight_b[k] = fold.place_b[k] / fold.size_b;
  }
  rub.law.normal = normalized(push);
  rub.law.load = model_.friction * norm(push);
  rub.law.slip = rub.law.tangential(remembered_slip(pair));
  rub.law.start = relative_place(rub, state);
  const Vec3 force = rub.law.force(rub.law.start);
  const Symmetric3 stiffness = rub.law.stiffness(rub.law.start);
  const auto &wa = rub.law.weight_a, &wb = rub.law.weight_b;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      fold.gradient_a[k][c] += wa[k] * force[static_cast<int>(c)];
      fold.gradient_b[k][c] -= wb[k] * force[static_cast<int>(c)];
    }
    for (std::size_t l = k; l < 4; ++l) {
      add_scaled(wa[k] * wa[l], stiffness, fold.own_a[block_of_points[k][l]]);
      add_scaled(wb[k] * wb[l], stiffness, fold.own_b[block_of_points[k][l]]);
    }
    for (std::size_t l = 0; l < 4; ++l) add_scaled(-wa[k] * wb[l], stiffness, fold.between[k][l]);
  }
  return rub;
}

void Assembly::scatter(const ContactFold& fold, const SegmentPair& pair, Chunk& chunk) const {
  const FourNodes na = nodes_of(pair.a), nb = nodes_of(pair.b);
  const auto fa = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(pair.a)]),
             fb = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(pair.b)]);
  std::array<Fraction, 4> frac_a, frac_b;
  for (std::size_t k = 0; k < 4; ++k) {
    frac_a[k] = fraction_[fa + k];
    frac_b[k] = {fraction_[fb + k][0] + pair.m, fraction_[fb + k][1] + pair.n};
  }
  const UpperBlocks upper(*chunk.matrix, diagonal_, chunk.low, chunk.high);
  const auto add_symmetric_block = [](const auto& blocks) {
    return [&blocks](std::size_t k, std::size_t l, Block& to, bool) {
      add_symmetric(blocks[block_of_points[k][l]], to);
    };
  };
  upper.each_own(na, add_symmetric_block(fold.own_a));
  upper.each_own(nb, add_symmetric_block(fold.own_b));
  upper.each_between(na, nb,
                     [&](std::size_t k, std::size_t l, Block& to) { add_symmetric(fold.between[k][l], to); });

  const bool whole = chunk.owns(na[0]);
  const auto add_row = [&](std::int32_t node, const std::array<double, 3>& force, const Fraction& fraction,
                           const Block& column) {
    if (chunk.owns(node)) {
      add(chunk.gradient->u[static_cast<std::size_t>(node)], force[0], force[1], force[2]);
      add_to(chunk.matrix->border[static_cast<std::size_t>(node)], column);
    }
    if (!whole) return;
    chunk.measures[0] += fraction[0] * force[0];
    chunk.measures[1] += fraction[1] * force[1];
    chunk.measures[2] += fraction[1] * force[0];
    add_measures_transposed(fraction, column, chunk.corner);
  };
  for (std::size_t k = 0; k < 4; ++k) {
    Block column_a{}, column_b{};
    for (std::size_t l = 0; l < 4; ++l) {
      add_times_measures(fold.own_a[block_of_points[k][l]], frac_a[l], column_a);
      add_times_measures(fold.between[k][l], frac_b[l], column_a);
      add_times_measures(fold.own_b[block_of_points[k][l]], frac_b[l], column_b);
      add_times_measures(fold.between[l][k], frac_a[l], column_b);
    }
    add_row(na[k], fold.gradient_a[k], frac_a[k], column_a);
    add_row(nb[k], fold.gradient_b[k], frac_b[k], column_b);
  }
}

}  // namespace loopwright
