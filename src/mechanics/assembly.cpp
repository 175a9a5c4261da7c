#include "mechanics/assembly.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/parallel.hpp"
#include "mechanics/energies/bend.hpp"
#include "mechanics/energies/plates.hpp"
#include "mechanics/energies/stretch.hpp"

namespace loopwright {
namespace {

using Fraction = std::array<double, 2>;

Fraction operator+(const Fraction& a, const Fraction& b) { return {a[0] + b[0], a[1] + b[1]}; }

// H M for a 3 x 3 block H and M = [[xi, 0, eta], [0, eta, 0], [0, 0, 0]].
Block times_measures(const Block& h, const Fraction& f) {
  return {h[0] * f[0], h[1] * f[1], h[0] * f[1], h[3] * f[0], h[4] * f[1],
          h[3] * f[1], h[6] * f[0], h[7] * f[1], h[6] * f[1]};
}

// out += M' C
void add_measures_transposed(const Fraction& f, const Block& c, Block& out) {
  for (std::size_t k = 0; k < 3; ++k) {
    out[k] += f[0] * c[k];
    out[3 + k] += f[1] * c[3 + k];
    out[6 + k] += f[1] * c[k];
  }
}

void add(Block& to, const Block& from) {
  for (std::size_t k = 0; k < 9; ++k) to[k] += from[k];
}

Block unpacked(const Symmetric3& s) { return {s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5]}; }

Block transposed(const Block& b) { return {b[0], b[3], b[6], b[1], b[4], b[7], b[2], b[5], b[8]}; }

// What one chunk of control points adds to sums over the whole fabric.
struct Partial {
  EnergyParts energy;
  Measures gradient{};
  Block corner{};
};

// to[k][l] += weight[k] weight[l] hessian for k <= l
void add_weighted(const std::array<double, 4>& weight, const Symmetric3& hessian,
                  std::array<std::array<Symmetric3, 4>, 4>& to) {
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t l = k; l < 4; ++l) {
      const double w = weight[k] * weight[l];
      for (std::size_t d = 0; d < 6; ++d) to[k][l][d] += w * hessian[d];
    }
}

void clear_values(BlockMatrix& matrix) {
  matrix.block.assign(matrix.column.size(), Block{});
  matrix.border.assign(static_cast<std::size_t>(matrix.rows()), Block{});
  matrix.corner = {};
}

constexpr int few_nodes = 400;  // for which a table of all places in the matrix is cheap (640 kB)

// Chunks are ranges of control points that depend on the fabric alone.
int chunk_count(int nodes) { return std::clamp(nodes / 3000, 1, 16); }

}  // namespace

Assembly::Assembly(const YarnModel& model) : model_(model) {}

double Assembly::law_scale(int a, int b) const {
  return 0.5 * (model_.yarn_of(a).diameter + model_.yarn_of(b).diameter);
}

bool Assembly::in_contact(const SegmentPair& pair) const {
  const double reach = model_.contact.outer * law_scale(pair.a, pair.b);
  return pair.distance2 < reach * reach;
}

void Assembly::prepare(const YarnState& state) {
  expand(model_, state, extended_);
  place_samples(model_, extended_, places_);
}

void Assembly::drop_places() {
  places_ = {};
  std::vector<Vec3>().swap(extended_);
  std::vector<Fraction>().swap(fraction_);
}

void Assembly::update_pairs(const YarnState& state, double range) {
  prepare(state);
  find_segment_pairs(model_, state, places_, range, pairs_);
}

std::vector<Fraction> Assembly::fractions(const YarnState& state) const {
  std::vector<Fraction> f(state.nodes.size(), Fraction{0, 0});
  if (!(state.width > 0) || !(state.height > 0)) return f;
  for (std::size_t i = 0; i < f.size(); ++i) {
    f[i][1] = state.nodes[i].y / state.height;
    f[i][0] = (state.nodes[i].x - f[i][1] * state.skew) / state.width;
  }
  return f;
}

YarnState Assembly::moved(const YarnState& state, const Unknowns& step, double scale) const {
  const std::vector<Fraction> f = fractions(state);
  YarnState next = state;
  for (std::size_t i = 0; i < f.size(); ++i) {
    next.nodes[i] += scale * step.u[i];
    next.nodes[i].x += scale * (f[i][0] * step.g[0] + f[i][1] * step.g[2]);
    next.nodes[i].y += scale * f[i][1] * step.g[1];
  }
  next.width += scale * step.g[0];
  next.height += scale * step.g[1];
  next.skew += scale * step.g[2];
  return next;
}

Vec3 Assembly::remembered_slip(const SegmentPair& pair) const {
  const auto key = [](const auto& p) { return std::tie(p.a, p.b, p.m, p.n); };
  const auto at =
      std::lower_bound(remembered_.begin(), remembered_.end(), pair,
                       [&](const ContactSlip& c, const SegmentPair& p) { return key(c) < key(p); });
  return at != remembered_.end() && key(*at) == key(pair) ? at->slip : Vec3{};
}

// Place of the contact on yarn a minus its place on yarn b, from the extended points of the state last
// prepared.
Vec3 Assembly::relative_place(const FrictionContact& contact, const YarnState& state) const {
  const auto fa = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(contact.a)]);
  const auto fb = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(contact.b)]);
  Vec3 r = -state.lattice(contact.m, contact.n);
  for (std::size_t k = 0; k < 4; ++k)
    r += contact.law.weight_a[k] * extended_[fa + k] - contact.law.weight_b[k] * extended_[fb + k];
  return r;
}

void Assembly::accept(const YarnState& state) {
  if (model_.friction == 0) return;
  expand(model_, state, extended_);
  for (FrictionContact& contact : friction_)
    contact.law.slip = contact.law.slip_after(relative_place(contact, state));
  remembered_.clear();
  remembered_.reserve(friction_.size());
  for (const FrictionContact& contact : friction_)
    if (contact.law.load > 0)
      remembered_.push_back({contact.a, contact.b, contact.m, contact.n, contact.law.slip});
}

EnergyParts Assembly::energy(const YarnState& state) {
  EnergyParts parts = terms(state, nullptr, nullptr);
  for (const FrictionContact& contact : friction_)
    parts.friction += contact.law.energy(relative_place(contact, state));
  return parts;
}

EnergyParts Assembly::hessian(const YarnState& state, Unknowns& gradient, BlockMatrix& hessian) {
  return terms(state, &gradient, &hessian);
}

void Assembly::build_pattern(BlockMatrix& matrix) const {
  const auto nodes = static_cast<std::size_t>(model_.nodes);
  // Count, fill with repetitions, then sort and make unique row by row.
  std::vector<std::int32_t> start(nodes + 1, 0);
  const auto segment_nodes = [&](int e) {
    std::array<std::int32_t, 4> n;
    const auto f = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(e)]);
    for (std::size_t k = 0; k < 4; ++k) n[k] = model_.base[f + k];
    return n;
  };
  const auto each_block = [&](const auto& visit) {
    for (int e = 0; e < model_.segments; ++e) {
      const auto n = segment_nodes(e);
      for (const auto i : n)
        for (const auto j : n) visit(i, j);
    }
    for (const std::int32_t at : active_) {
      const SegmentPair& p = pairs_[static_cast<std::size_t>(at)];
      const auto na = segment_nodes(p.a), nb = segment_nodes(p.b);
      for (const auto i : na)
        for (const auto j : nb) {
          visit(i, j);
          visit(j, i);
        }
    }
  };
  if (model_.nodes <= few_nodes) {
    // Few control points: a table of all blocks says where each one is, and nothing need be sorted.
    matrix.places.assign(nodes * nodes, -1);
    each_block([&](std::int32_t i, std::int32_t j) {
      matrix.places[static_cast<std::size_t>(i) * nodes + static_cast<std::size_t>(j)] = 0;
    });
    matrix.row_start.assign(nodes + 1, 0);
    matrix.column.clear();
    for (std::size_t i = 0; i < nodes; ++i) {
      for (std::size_t j = 0; j < nodes; ++j)
        if (std::int32_t& at = matrix.places[i * nodes + j]; at == 0) {
          at = static_cast<std::int32_t>(matrix.column.size());
          matrix.column.push_back(static_cast<std::int32_t>(j));
        }
      matrix.row_start[i + 1] = static_cast<std::int32_t>(matrix.column.size());
    }
    clear_values(matrix);
    return;
  }
  matrix.places.clear();
  each_block([&](std::int32_t i, std::int32_t) { ++start[static_cast<std::size_t>(i) + 1]; });
  for (std::size_t i = 0; i < nodes; ++i) start[i + 1] += start[i];
  std::vector<std::int32_t> columns(static_cast<std::size_t>(start[nodes])),
      fill(start.begin(), start.end() - 1);
  each_block([&](std::int32_t i, std::int32_t j) {
    columns[static_cast<std::size_t>(fill[static_cast<std::size_t>(i)]++)] = j;
  });
  matrix.row_start.assign(nodes + 1, 0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto begin = columns.begin() + start[i], end = columns.begin() + start[i + 1];
    std::sort(begin, end);
    const auto last = std::unique(begin, end);
    // Behind the rows before it: they have left room.
    const auto to = columns.begin() + static_cast<std::ptrdiff_t>(kept);
    if (to != begin) std::copy(begin, last, to);
    kept += static_cast<std::size_t>(last - begin);
    matrix.row_start[i + 1] = static_cast<std::int32_t>(kept);
  }
  matrix.column.assign(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(kept));
  std::vector<std::int32_t>().swap(columns);
  clear_values(matrix);
}

void Assembly::metric(BlockMatrix& matrix) const {
  constexpr double own_motion = 1e-3;  // keeps rigid motion and the sliding of whole yarns finite
  matrix.metric.assign(matrix.column.size(), 0);
  const auto add_to = [&](std::int32_t i, std::int32_t j, double v) {
    const bool held_i = model_.held[static_cast<std::size_t>(i)],
               held_j = model_.held[static_cast<std::size_t>(j)];
    if (held_i || held_j) return;
    matrix.metric[matrix.place(i, j)] += v;
  };
  const auto base_of = [&](std::size_t k) { return model_.base[k]; };
  for (std::int32_t i = 0; i < model_.nodes; ++i) add_to(i, i, own_motion);
  for (const YarnModel::Yarn& yarn : model_.yarns) {
    const int links = yarn.periodic ? yarn.nodes : yarn.nodes - 1;
    for (int k = 0; k < links; ++k) {
      const auto i = base_of(static_cast<std::size_t>(yarn.first_extended + k)),
                 j = base_of(static_cast<std::size_t>(yarn.first_extended + k + 1));
      add_to(i, i, 1);
      add_to(j, j, 1);
      add_to(i, j, -1);
      add_to(j, i, -1);
    }
  }
  // Segments in contact: relative motion of their middles (weights 1/48, 23/48, 23/48, 1/48).
  constexpr std::array<double, 4> middle{1 / 48.0, 23 / 48.0, 23 / 48.0, 1 / 48.0};
  for (const std::int32_t at : active_) {
    const SegmentPair& pair = pairs_[static_cast<std::size_t>(at)];
    if (pair.same_yarn) continue;
    const auto fa = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(pair.a)]),
               fb = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(pair.b)]);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = 0; l < 4; ++l) {
        const double w = middle[k] * middle[l];
        add_to(base_of(fa + k), base_of(fa + l), w);
        add_to(base_of(fb + k), base_of(fb + l), w);
        add_to(base_of(fa + k), base_of(fb + l), -w);
        add_to(base_of(fb + l), base_of(fa + k), -w);
      }
  }
}

EnergyParts Assembly::terms(const YarnState& state, Unknowns* gradient, BlockMatrix* matrix) {
  prepare(state);
  const auto nodes = static_cast<std::size_t>(model_.nodes);
  const std::vector<Fraction> node_fraction = fractions(state);
  fraction_.resize(extended_.size());
  for (std::size_t k = 0; k < fraction_.size(); ++k)
    fraction_[k] = node_fraction[static_cast<std::size_t>(model_.base[k])] +
                   Fraction{static_cast<double>(model_.image[k][0]), static_cast<double>(model_.image[k][1])};
  if (gradient) {
    gradient->u.assign(nodes, Vec3{});
    gradient->g = {};
  }
  if (matrix) {
    active_.clear();
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      if (in_contact(pairs_[k])) active_.push_back(static_cast<std::int32_t>(k));
    build_pattern(*matrix);
    friction_.assign(model_.friction > 0 ? active_.size() : 0, {});
  }

  const int chunks = chunk_count(model_.nodes);
  std::vector<Partial> partial(static_cast<std::size_t>(chunks));
  parallel_chunks(chunks, [&](int c) {
    // This chunk owns control points [low, high): it alone writes their rows, and evaluates every element
    // that has one.
    const auto low = static_cast<std::int32_t>(static_cast<std::int64_t>(model_.nodes) * c / chunks);
    const auto high = static_cast<std::int32_t>(static_cast<std::int64_t>(model_.nodes) * (c + 1) / chunks);
    Partial& sums = partial[static_cast<std::size_t>(c)];
    const auto owned = [&](std::int32_t node) { return node >= low && node < high; };
    const auto first_of = [&](int e) {
      return static_cast<std::size_t>(model_.first[static_cast<std::size_t>(e)]);
    };
    const auto owns_segment = [&](int e) {
      return owned(model_.base[first_of(e)]);
    };  // for sums over segments
    const auto touches = [&](int e) {
      const std::size_t f = first_of(e);
      return owned(model_.base[f]) || owned(model_.base[f + 1]) || owned(model_.base[f + 2]) ||
             owned(model_.base[f + 3]);
    };
    const auto add_gradient = [&](std::size_t k, const Vec3& f, bool whole) {  // k: extended point
      const auto node = model_.base[k];
      if (owned(node)) gradient->u[static_cast<std::size_t>(node)] += f;
      if (!whole) return;
      sums.gradient[0] += fraction_[k][0] * f.x;
      sums.gradient[1] += fraction_[k][1] * f.y;
      sums.gradient[2] += fraction_[k][1] * f.x;
    };
    // Adds block h at (extended point k, extended point l with fraction fl); the row's owner keeps it.
    const auto add_block = [&](std::size_t k, std::size_t l, const Block& h, const Fraction& fk,
                               const Fraction& fl) {
      const auto row = model_.base[k];
      if (!owned(row)) return;
      add(matrix->block[matrix->place(row, model_.base[l])], h);
      const Block column = times_measures(h, fl);
      add(matrix->border[static_cast<std::size_t>(row)], column);
      add_measures_transposed(fk, column, sums.corner);
    };

    // Stretch, bend and plates.
    const bool plates = model_.plates.stiffness > 0;
    for (int e = 0; e < model_.segments; ++e) {
      if (!touches(e)) continue;
      const bool whole = owns_segment(e);
      if (!whole && !gradient) continue;
      const std::size_t f = first_of(e);
      const YarnModel::Yarn& yarn = model_.yarn_of(e);
      SegmentDofs x;
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t d = 0; d < 3; ++d) x[3 * k + d] = extended_[f + k][static_cast<int>(d)];
      const Stretch along{yarn.stretch_stiffness, model_.natural_length[static_cast<std::size_t>(e)]};
      const Bend across{yarn.bend_stiffness, yarn.rest_length};
      const Plates flat{model_.plates.stiffness, model_.plates.low, model_.plates.high, yarn.rest_length,
                        model_.samples};
      const bool pressed = plates && flat.touch(places_.boxes[static_cast<std::size_t>(e)]);
      if (!gradient) {
        sums.energy.stretch += along.energy(x);
        sums.energy.bend += across.energy(x);
        if (pressed) sums.energy.plates += flat.evaluate(x, model_.weights).energy;
        continue;
      }
      LocalTerm<12> stretch = along.evaluate(x);
      const LocalTerm<12> bend = across.evaluate(x);
      if (whole) {
        sums.energy.stretch += stretch.energy;
        sums.energy.bend += bend.energy;
      }
      if (pressed) {
        const LocalTerm<12> pushed = flat.evaluate(x, model_.weights);
        if (whole) sums.energy.plates += pushed.energy;
        if (pushed.energy > 0)
          for (std::size_t k = 0; k < 12; ++k) {
            stretch.gradient[k] += pushed.gradient[k];
            for (std::size_t l = 0; l < 12; ++l) stretch.hessian[k][l] += pushed.hessian[k][l];
          }
      }
      for (std::size_t k = 0; k < 4; ++k)
        add_gradient(f + k,
                     {stretch.gradient[3 * k] + bend.gradient[3 * k],
                      stretch.gradient[3 * k + 1] + bend.gradient[3 * k + 1],
                      stretch.gradient[3 * k + 2] + bend.gradient[3 * k + 2]},
                     whole);
      if (matrix)
        for (std::size_t k = 0; k < 4; ++k)
          for (std::size_t l = 0; l < 4; ++l) {
            Block h;
            for (std::size_t r = 0; r < 3; ++r)
              for (std::size_t s = 0; s < 3; ++s)
                h[3 * r + s] = stretch.hessian[3 * k + r][3 * l + s] + bend.hessian[3 * k + r][3 * l + s];
            add_block(f + k, f + l, h, fraction_[f + k], fraction_[f + l]);
          }
    }

    // Contact.
    ContactPairOutput out;
    const std::size_t candidates = matrix ? active_.size() : pairs_.size();
    for (std::size_t candidate = 0; candidate < candidates; ++candidate) {
      const SegmentPair& pair = pairs_[matrix ? static_cast<std::size_t>(active_[candidate]) : candidate];
      const bool touches_a = touches(pair.a), touches_b = touches(pair.b);
      if (!touches_a && !touches_b) continue;
      const bool whole = owns_segment(pair.a);
      if (!whole && !gradient) continue;
      const std::size_t a0 = static_cast<std::size_t>(pair.a * model_.samples),
                        b0 = static_cast<std::size_t>(pair.b * model_.samples);
      const YarnModel::Yarn& ya = model_.yarn_of(pair.a);
      const YarnModel::Yarn& yb = model_.yarn_of(pair.b);
      const Vec3 image = state.lattice(pair.m, pair.n);
      const double scale = law_scale(pair.a, pair.b), reach = model_.contact.outer * scale;
      if (squared_distance(places_.boxes[static_cast<std::size_t>(pair.a)], {image.x, image.y, image.z},
                           places_.boxes[static_cast<std::size_t>(pair.b)]) >= reach * reach)
        continue;
      ContactPairInput in{{&places_.x[a0], &places_.y[a0], &places_.z[a0]},
                          {&places_.x[b0], &places_.y[b0], &places_.z[b0]}};
      in.image = {image.x, image.y, image.z};
      in.box_b = &places_.boxes[static_cast<std::size_t>(pair.b)];
      in.count = model_.samples;
      in.weight = ya.rest_length * yb.rest_length / (model_.samples * model_.samples);
      if (pair.same_yarn) {
        in.arc_offset = pair.arc_offset;
        in.spacing = ya.rest_length / model_.samples;
        in.excluded = model_.excluded * ya.diameter;
      }
      const ContactLaw law = scale == 1 ? model_.contact : model_.contact.scaled(scale);
      if (!gradient) {
        sums.energy.contact += contact_energy(in, law);
        continue;
      }
      contact_terms(in, law, model_.weights, matrix != nullptr, out);
      if (!out.active) continue;
      if (whole) sums.energy.contact += out.energy;
      const Fraction shift{static_cast<double>(pair.m), static_cast<double>(pair.n)};
      const bool imaged = pair.m != 0 || pair.n != 0;
      const std::size_t fa = first_of(pair.a), fb = first_of(pair.b);
      const auto n = static_cast<std::size_t>(model_.samples);
      std::array<Fraction, 4> frac_a, frac_b;
      for (std::size_t k = 0; k < 4; ++k) {
        frac_a[k] = fraction_[fa + k];
        frac_b[k] = imaged ? fraction_[fb + k] + shift : fraction_[fb + k];
      }
      // Friction: the contact's load, normal and place, weighted with the force of each sample.
      FrictionContact rub;
      Vec3 rub_force;
      Symmetric3 rub_stiffness{};
      if (matrix && model_.friction > 0) {
        rub.a = pair.a, rub.b = pair.b, rub.m = pair.m, rub.n = pair.n;
        double force = 0, rub_total_b = 0;
        Vec3 push;
        for (std::size_t i = 0; i < n; ++i) {
          const Vec3 fa_i{out.gradient_a[i][0], out.gradient_a[i][1], out.gradient_a[i][2]};
          const double size_a = norm(fa_i),
                       size_b = norm(Vec3{out.gradient_b[i][0], out.gradient_b[i][1], out.gradient_b[i][2]});
          force += size_a;
          rub_total_b += size_b;
          push += fa_i;
          for (std::size_t k = 0; k < 4; ++k) {
            rub.law.weight_a[k] += size_a * model_.weights[i][k];
            rub.law.weight_b[k] += size_b * model_.weights[i][k];
          }
        }
        if (force > 0 && rub_total_b > 0 && squared_norm(push) > 0) {
          for (std::size_t k = 0; k < 4; ++k) {
            rub.law.weight_a[k] /= force;
            rub.law.weight_b[k] /= rub_total_b;
          }
          rub.law.normal = normalized(push);
          rub.law.load = model_.friction * norm(push);
          rub.law.slip = rub.law.tangential(remembered_slip(pair));
          rub.law.start = relative_place(rub, state);
          rub_force = rub.law.force(rub.law.start);
          rub_stiffness = rub.law.stiffness(rub.law.start);
          if (whole) friction_[candidate] = rub;
        }
      }
      for (std::size_t k = 0; k < 4; ++k) {
        Vec3 ga = rub.law.weight_a[k] * rub_force, gb = -rub.law.weight_b[k] * rub_force;
        for (std::size_t i = 0; i < n; ++i) {
          const double w = model_.weights[i][k];
          if (out.touched_a[i])
            ga += w * Vec3{out.gradient_a[i][0], out.gradient_a[i][1], out.gradient_a[i][2]};
          if (out.touched_b[i])
            gb += w * Vec3{out.gradient_b[i][0], out.gradient_b[i][1], out.gradient_b[i][2]};
        }
        add_gradient(fa + k, ga, whole);
        add_gradient(fb + k, gb, whole);
        if (whole && imaged) {
          sums.gradient[0] += shift[0] * gb.x;
          sums.gradient[1] += shift[1] * gb.y;
          sums.gradient[2] += shift[1] * gb.x;
        }
      }
      if (!matrix) continue;
      // The sides' own blocks are symmetric in their control points.
      std::array<std::array<Symmetric3, 4>, 4> aa, bb;
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = k; l < 4; ++l)
          for (std::size_t d = 0; d < 6; ++d) {
            aa[k][l][d] = rub.law.weight_a[k] * rub.law.weight_a[l] * rub_stiffness[d];
            bb[k][l][d] = rub.law.weight_b[k] * rub.law.weight_b[l] * rub_stiffness[d];
          }
      for (std::size_t i = 0; i < n; ++i) {
        if (out.touched_a[i]) add_weighted(model_.weights[i], out.hessian_a[i], aa);
        if (out.touched_b[i]) add_weighted(model_.weights[i], out.hessian_b[i], bb);
      }
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < 4; ++l) {
          Symmetric3 ab = out.between[k][l];
          for (std::size_t d = 0; d < 6; ++d)
            ab[d] -= rub.law.weight_a[k] * rub.law.weight_b[l] * rub_stiffness[d];
          const Block between = unpacked(ab);
          add_block(fa + k, fa + l, unpacked(k <= l ? aa[k][l] : aa[l][k]), frac_a[k], frac_a[l]);
          add_block(fb + k, fb + l, unpacked(k <= l ? bb[k][l] : bb[l][k]), frac_b[k], frac_b[l]);
          add_block(fa + k, fb + l, between, frac_a[k], frac_b[l]);
          add_block(fb + l, fa + k, transposed(between), frac_b[l], frac_a[k]);
        }
    }
  });

  EnergyParts energy;
  for (const Partial& p : partial) {
    energy.stretch += p.energy.stretch;
    energy.bend += p.energy.bend;
    energy.contact += p.energy.contact;
    energy.plates += p.energy.plates;
    for (std::size_t k = 0; k < 3; ++k)
      if (gradient) gradient->g[k] += p.gradient[k];
    if (matrix) add(matrix->corner, p.corner);
  }
  for (std::size_t i = 0; i < model_.point_loads.size(); ++i) {
    const Vec3& f = model_.point_loads[i];
    energy.load -= dot(f, state.nodes[i]);
    if (!gradient) continue;
    gradient->u[i] -= f;
    gradient->g[0] -= node_fraction[i][0] * f.x;
    gradient->g[1] -= node_fraction[i][1] * f.y;
    gradient->g[2] -= node_fraction[i][1] * f.x;
  }
  const std::array<bool, 3> free{model_.free.width, model_.free.height, model_.free.skew};
  if (gradient) {
    for (std::size_t i = 0; i < nodes; ++i)
      if (model_.held[i]) gradient->u[i] = {};
    measure_forces_ = gradient->g;
    for (std::size_t k = 0; k < 3; ++k) gradient->g[k] = free[k] ? gradient->g[k] - model_.load[k] : 0;
  }
  const Measures measures{state.width, state.height, state.skew};
  for (std::size_t k = 0; k < 3; ++k)
    if (free[k]) energy.load -= model_.load[k] * measures[k];
  if (matrix) {
    constexpr Block identity{1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (std::size_t i = 0; i < nodes; ++i) {
      for (auto k = static_cast<std::size_t>(matrix->row_start[i]);
           k < static_cast<std::size_t>(matrix->row_start[i + 1]); ++k) {
        const auto j = static_cast<std::size_t>(matrix->column[k]);
        if (model_.held[i] || model_.held[j]) matrix->block[k] = i == j ? identity : Block{};
      }
      for (std::size_t m = 0; m < 3; ++m)
        if (model_.held[i] || !free[m])
          for (std::size_t d = 0; d < 3; ++d) matrix->border[i][3 * d + m] = 0;
    }
    for (std::size_t m = 0; m < 3; ++m)
      for (std::size_t l = 0; l < 3; ++l)
        if (!free[m] || !free[l]) matrix->corner[3 * m + l] = m == l ? 1 : 0;
  }
  return energy;
}

}  // namespace loopwright
