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

ContactHistory history_in(const Spot& spot, const ContactHistory& history) {
  ContactHistory own;
  for (ContactSlip contact : history) {
    contact.a = spot.segment_in[static_cast<std::size_t>(contact.a)];
    contact.b = spot.segment_in[static_cast<std::size_t>(contact.b)];
    if (contact.a >= 0 && contact.b >= 0) own.push_back(contact);
  }
  return own;
}

void put_back(const Spot& spot, const ContactHistory& own, YarnState& state, ContactHistory& history) {
  for (std::size_t i = 0; i < spot.node_of.size(); ++i)
    state.nodes[static_cast<std::size_t>(spot.node_of[i])] = spot.state.nodes[i];
  std::erase_if(history, [&](const ContactSlip& contact) {
    const std::int32_t a = spot.segment_in[static_cast<std::size_t>(contact.a)],
                       b = spot.segment_in[static_cast<std::size_t>(contact.b)];
    return a >= 0 && b >= 0 && (may_move(spot, a) || may_move(spot, b));
  });
  for (ContactSlip contact : own) {
    if (!may_move(spot, contact.a) && !may_move(spot, contact.b)) continue;
    contact.a = spot.segment_of[static_cast<std::size_t>(contact.a)];
    contact.b = spot.segment_of[static_cast<std::size_t>(contact.b)];
    history.push_back(contact);
  }
  const auto key = [](const ContactSlip& c) { return std::tie(c.a, c.b, c.m, c.n); };
  std::sort(history.begin(), history.end(),
            [&](const ContactSlip& a, const ContactSlip& b) { return key(a) < key(b); });
}

}  // namespace loopwright
