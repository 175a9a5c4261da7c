#include "mechanics/spot.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace loopwright {
namespace {

void add_run(const YarnModel& whole, const YarnState& state, int yarn, std::int32_t begin, std::int32_t end,
             const std::vector<std::uint8_t>& moves, Spot& spot) {
  const YarnModel::Yarn& from = whole.yarns[static_cast<std::size_t>(yarn)];
  YarnModel& model = spot.model;
  YarnModel::Yarn run = from;
  run.first_node = model.nodes;
  run.first_segment = model.segments;
  run.first_extended = model.extended;
  run.segments = end - begin;
  run.nodes = run.segments + 3;
  const std::int32_t first = from.first_node + (begin - from.first_segment);
  for (std::int32_t i = first; i < first + run.nodes; ++i) {
    const auto node = static_cast<std::size_t>(i);
    model.base.push_back(static_cast<std::int32_t>(spot.node_of.size()));
    model.image.push_back({0, 0});
    model.held.push_back(moves[node] != 0 ? whole.held[node] : std::uint8_t{1});
    if (!whole.point_loads.empty()) model.point_loads.push_back(whole.point_loads[node]);
    spot.node_of.push_back(i);
    spot.state.nodes.push_back(state.nodes[node]);
  }
  for (std::int32_t e = begin; e < end; ++e) {
    const auto segment = static_cast<std::size_t>(e);
    model.first.push_back(run.first_extended + (e - begin));
    model.yarn_of_segment.push_back(static_cast<std::int32_t>(model.yarns.size()));
    model.natural_length.push_back(whole.natural_length[segment]);
    if (!whole.natural_curvature.empty()) model.natural_curvature.push_back(whole.natural_curvature[segment]);
    spot.segment_in[segment] = static_cast<std::int32_t>(spot.segment_of.size());
    spot.segment_of.push_back(e);
  }
  model.nodes += run.nodes;
  model.extended += run.nodes;
  model.segments += run.segments;
  model.yarns.push_back(run);
}

bool may_move(const Spot& spot, std::int32_t segment) {
  const auto f = static_cast<std::size_t>(spot.model.first[static_cast<std::size_t>(segment)]);
  for (std::size_t k = 0; k < 4; ++k)
    if (spot.model.held[static_cast<std::size_t>(spot.model.base[f + k])] == 0) return true;
  return false;
}

}  // namespace

Spot cut_out(const YarnModel& whole, const YarnState& state, const std::vector<std::uint8_t>& moves,
             std::vector<std::int32_t> segments) {
  Spot spot;
  spot.segment_in.assign(static_cast<std::size_t>(whole.segments), -1);
  YarnModel& model = spot.model;
  model.contact = whole.contact;
  model.friction = whole.friction;
  model.samples = whole.samples;
  model.weights = whole.weights;
  model.excluded = whole.excluded;
  model.plates = whole.plates;
  model.free = {false, false, false};
  spot.state.width = state.width, spot.state.height = state.height, spot.state.skew = state.skew;
  std::sort(segments.begin(), segments.end());
  for (std::size_t k = 0; k < segments.size();) {
    const int yarn = whole.yarn_of_segment[static_cast<std::size_t>(segments[k])];
    // Pieces of one yarn that would have to know how near they are along it are one.
    const int gap =
        3 +
        static_cast<int>(std::ceil(whole.excluded / whole.yarns[static_cast<std::size_t>(yarn)].rest_length));
    std::size_t last = k;
    while (last + 1 < segments.size() && segments[last + 1] - segments[last] <= gap &&
           whole.yarn_of_segment[static_cast<std::size_t>(segments[last + 1])] == yarn)
      ++last;
    add_run(whole, state, yarn, segments[k], segments[last] + 1, moves, spot);
    k = last + 1;
  }
  return spot;
}

std::span<const ContactSlip> ChangedHistory::of(std::int32_t segment) const {
  if (const auto found = changed_.find(segment); found != changed_.end()) return found->second;
  const auto low = std::lower_bound(before_.begin(), before_.end(), segment,
                                    [](const ContactSlip& c, std::int32_t a) { return c.a < a; });
  const auto high = std::upper_bound(low, before_.end(), segment,
                                     [](std::int32_t a, const ContactSlip& c) { return a < c.a; });
  return {low, high};
}

ContactHistory ChangedHistory::inside(const Spot& spot) const {
  ContactHistory own;
  for (const std::int32_t segment : spot.segment_of)
    for (ContactSlip contact : of(segment)) {
      contact.a = spot.segment_in[static_cast<std::size_t>(contact.a)];
      contact.b = spot.segment_in[static_cast<std::size_t>(contact.b)];
      if (contact.b >= 0) own.push_back(contact);
    }
  return own;
}

void ChangedHistory::put_back(const Spot& spot, const ContactHistory& own) {
  std::map<std::int32_t, ContactHistory> now;
  for (const std::int32_t segment : spot.segment_of) {
    const bool moves = may_move(spot, spot.segment_in[static_cast<std::size_t>(segment)]);
    ContactHistory& kept = now[segment];
    for (const ContactSlip& contact : of(segment)) {
      const std::int32_t b = spot.segment_in[static_cast<std::size_t>(contact.b)];
      if (b < 0 || !(moves || may_move(spot, b))) kept.push_back(contact);
    }
  }
  for (ContactSlip contact : own) {
    if (!may_move(spot, contact.a) && !may_move(spot, contact.b)) continue;
    contact.a = spot.segment_of[static_cast<std::size_t>(contact.a)];
    contact.b = spot.segment_of[static_cast<std::size_t>(contact.b)];
    now[contact.a].push_back(contact);
  }
  const auto rank = [](const ContactSlip& c) { return std::tie(c.b, c.m, c.n); };
  for (auto& [segment, contacts] : now) {
    std::sort(contacts.begin(), contacts.end(),
              [&](const ContactSlip& a, const ContactSlip& b) { return rank(a) < rank(b); });
    changed_[segment] = std::move(contacts);
  }
}

ContactHistory ChangedHistory::whole() const {
  ContactHistory all;
  all.reserve(before_.size());
  auto next = before_.begin();
  for (const auto& [segment, contacts] : changed_) {
    for (; next != before_.end() && next->a < segment; ++next) all.push_back(*next);
    while (next != before_.end() && next->a == segment) ++next;
    all.insert(all.end(), contacts.begin(), contacts.end());
  }
  all.insert(all.end(), next, before_.end());
  return all;
}

}  // namespace loopwright
