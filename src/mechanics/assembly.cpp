#include "mechanics/assembly.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "base/parallel.hpp"
#include "mechanics/assembly_sums.hpp"

namespace loopwright {

Assembly::Assembly(const YarnModel& model) : model_(model), twist_(model) {}

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
  listed_ = extended_;
  listed_measures_ = {state.width, state.height, state.skew};
}

void Assembly::find_moved() {
  moved_.assign(static_cast<std::size_t>(model_.segments), 0);
  const bool lists = listed_.size() == extended_.size();  // else no pairs have been looked for
  for (std::size_t e = 0; lists && e < moved_.size(); ++e) {
    const auto f = static_cast<std::size_t>(model_.first[e]);
    // A sample is a mean of its segment's control points.
    for (std::size_t k = f; k < f + 4; ++k)
      moved_[e] = std::max(moved_[e], squared_norm(extended_[k] - listed_[k]));
    moved_[e] = std::sqrt(moved_[e]);
  }
}

// Not if their samples were so far apart when the pairs were found that they cannot have come together.
bool Assembly::may_touch(const SegmentPair& pair, double reach, const YarnState& state) const {
  const Vec3 image{pair.m * (state.width - listed_measures_[0]) + pair.n * (state.skew - listed_measures_[2]),
                   pair.n * (state.height - listed_measures_[1]), 0};
  const double together = reach + moved_[static_cast<std::size_t>(pair.a)] +
                          moved_[static_cast<std::size_t>(pair.b)] +
                          (pair.m == 0 && pair.n == 0 ? 0 : norm(image));
  return pair.distance2 < together * together;
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

EnergyParts Assembly::energy(const YarnState& state, std::vector<double>& of_segments) {
  of_segments.assign(static_cast<std::size_t>(model_.segments), 0);
  return with_friction(state, &of_segments);
}

EnergyParts Assembly::energy(const YarnState& state) { return with_friction(state, nullptr); }

EnergyParts Assembly::with_friction(const YarnState& state, std::vector<double>* of_segments) {
  EnergyParts parts = terms(state, nullptr, nullptr, of_segments);
  for (const FrictionContact& contact : friction_)
    parts.friction += contact.law.energy(relative_place(contact, state));
  return parts;
}

EnergyParts Assembly::gradient(const YarnState& state, Unknowns& gradient) {
  return terms(state, &gradient, nullptr);
}

EnergyParts Assembly::hessian(const YarnState& state, Unknowns& gradient, BlockMatrix& hessian) {
  return terms(state, &gradient, &hessian);
}

// The couple of every yarn on its control points, and how it changes with the turn of the whole yarn.
void Assembly::add_dyads(Unknowns& gradient, BlockMatrix* hessian) {
  std::vector<Dyad> dyads = twist_.dyads(extended_, fraction_);
  std::size_t next = 0;
  for (std::size_t y = 0; y < model_.yarns.size(); ++y)
    if (model_.yarns[y].twist_stiffness > 0) dyads[next++].add_to(twist_.couple(y), gradient);
  if (!hessian) return;
  hessian->dyads = std::move(dyads);
  twist_.settle();
}

EnergyParts Assembly::terms(const YarnState& state, Unknowns* gradient, BlockMatrix* matrix,
                            std::vector<double>* of_segments) {
  prepare(state);
  const auto nodes = static_cast<std::size_t>(model_.nodes);
  const std::vector<Fraction> node_fraction = fractions(state);
  fraction_.resize(extended_.size());
  for (std::size_t k = 0; k < fraction_.size(); ++k)
    for (std::size_t c = 0; c < 2; ++c)
      fraction_[k][c] = node_fraction[static_cast<std::size_t>(model_.base[k])][c] + model_.image[k][c];
  if (gradient) {
    gradient->u.assign(nodes, Vec3{});
    gradient->g = {};
  }
  if (gradient) {
    active_.clear();
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      if (in_contact(pairs_[k])) active_.push_back(static_cast<std::int32_t>(k));
    friction_.assign(model_.friction > 0 ? active_.size() : 0, {});
  }
  if (matrix) build_pattern(*matrix);

  if (twist_.counts()) twist_.measure(state, extended_);
  if (!gradient) find_moved();
  const int chunks = chunk_count();
  std::vector<Chunk> partial(static_cast<std::size_t>(chunks));
  parallel_chunks(chunks, [&](int c) {
    Chunk& chunk = partial[static_cast<std::size_t>(c)];
    chunk.low = first_of_chunk(c);
    chunk.high = first_of_chunk(c + 1);
    chunk.state = &state;
    chunk.gradient = gradient;
    chunk.matrix = matrix;
    chunk.of_segments = of_segments;
    add_segments(chunk);
    add_contacts(chunk);
  });
  if (matrix) mirror_upper(*matrix, diagonal_);

  EnergyParts energy;
  for (const Chunk& p : partial) {
    energy.stretch += p.energy.stretch;
    energy.bend += p.energy.bend;
    energy.contact += p.energy.contact;
    energy.plates += p.energy.plates;
    for (std::size_t k = 0; k < 3; ++k)
      if (gradient) gradient->g[k] += p.measures[k];
    if (matrix)
      for (std::size_t k = 0; k < 9; ++k) matrix->corner[k] += p.corner[k];
  }
  if (twist_.counts()) {
    energy.twist = twist_.energy();
    if (gradient) add_dyads(*gradient, matrix);
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
    for (Dyad& dyad : matrix->dyads) {
      for (std::size_t i = 0; i < dyad.u.size(); ++i)
        if (model_.held[static_cast<std::size_t>(dyad.first) + i]) dyad.u[i] = {};
      for (std::size_t m = 0; m < 3; ++m)
        if (!free[m]) dyad.g[m] = 0;
    }
  }
  return energy;
}

}  // namespace loopwright
