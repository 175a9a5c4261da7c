#include "mechanics/hot_spots.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/newton.hpp"
#include "mechanics/segment_grid.hpp"
#include "mechanics/spot.hpp"

namespace loopwright {
namespace {

// Hot: this many times the force that all but a two-hundredth of the control points stay below.
constexpr double stands_out = 4;
constexpr double usual_share = 0.995;
constexpr std::size_t most_hot_share = 100;  // no more than one in so many may be hot
constexpr double with_it = 2;                // d round hot control points that move as well
constexpr double known = 2;                  // d beyond contact to which yarn round these is known
constexpr int most_iterations = 25;
constexpr std::size_t most_nodes = 6000;

// Control points whose forces stand out, hottest first.
std::vector<std::int32_t> hot_nodes(const YarnModel& model, const Unknowns& gradient, double tolerance,
                                    double& usual) {
  std::vector<double> force(gradient.u.size());
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = norm(gradient.u[i]);
  std::vector<double> sorted = force;
  const auto at =
      sorted.begin() + static_cast<std::ptrdiff_t>(usual_share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  usual = *at;
  const double hot_from = std::max(stands_out * usual, 10 * tolerance);
  std::vector<std::int32_t> hot;
  for (std::int32_t i = 0; i < model.nodes; ++i)
    if (force[static_cast<std::size_t>(i)] > hot_from) hot.push_back(i);
  if (hot.size() > force.size() / most_hot_share) hot.clear();
  std::sort(hot.begin(), hot.end(), [&](std::int32_t a, std::int32_t b) {
    const double fa = force[static_cast<std::size_t>(a)], fb = force[static_cast<std::size_t>(b)];
    return fa != fb ? fa > fb : a < b;
  });
  return hot;
}

// Brings the spot round a hot control point to rest; marks what moved.
bool settle(const YarnModel& whole, std::int32_t hottest, const std::vector<std::uint8_t>& is_hot,
            double tolerance, YarnState& state, ContactHistory& history, std::vector<std::uint8_t>& done,
            SpotsReport& report) {
  const SegmentGrid grid(whole, state);
  // What moves: the hot control points that hang together, and what lies within `with_it` of their yarn.
  std::vector<std::uint8_t> moves(state.nodes.size(), 0), listed(static_cast<std::size_t>(whole.segments), 0);
  const auto segments_of = [&](std::int32_t node, const auto& visit) {
    const auto yarn =
        std::upper_bound(whole.yarns.begin(), whole.yarns.end(), node,
                         [](std::int32_t i, const YarnModel::Yarn& y) { return i < y.first_node; }) -
        1;
    const std::int32_t on_yarn = node - yarn->first_node;
    for (std::int32_t e = std::max(0, on_yarn - 3); e <= std::min(on_yarn, yarn->segments - 1); ++e)
      visit(yarn->first_segment + e);
  };
  const auto nodes_of = [&](std::int32_t segment, const auto& visit) {
    const auto f = static_cast<std::size_t>(whole.first[static_cast<std::size_t>(segment)]);
    for (std::size_t k = 0; k < 4; ++k) visit(whole.base[f + k]);
  };
  std::vector<std::int32_t> to_visit{hottest};
  std::size_t moving = 0;
  while (!to_visit.empty()) {
    const std::int32_t node = to_visit.back();
    to_visit.pop_back();
    if (done[static_cast<std::size_t>(node)] != 0) continue;
    done[static_cast<std::size_t>(node)] = 1;
    segments_of(node, [&](std::int32_t own) {
      grid.each_near(own, with_it, [&](std::int32_t near) {
        nodes_of(near, [&](std::int32_t i) {
          const auto at = static_cast<std::size_t>(i);
          if (moves[at] == 0) moves[at] = 1, ++moving;
          if (is_hot[at] != 0 && done[at] == 0) to_visit.push_back(i);
        });
      });
    });
    if (moving > most_nodes) return false;
  }
  const double range = whole.contact.outer + known;
  std::vector<std::int32_t> segments;
  for (std::int32_t i = 0; i < whole.nodes; ++i) {
    if (moves[static_cast<std::size_t>(i)] == 0) continue;
    segments_of(i, [&](std::int32_t own) {
      if (listed[static_cast<std::size_t>(own)] == 2) return;
      grid.each_near(own, range, [&](std::int32_t near) {
        auto& mark = listed[static_cast<std::size_t>(near)];
        if (mark == 0) mark = 1, segments.push_back(near);
      });
      listed[static_cast<std::size_t>(own)] = 2;
    });
  }
  Spot spot = cut_out(whole, state, moves, std::move(segments));
  if (spot.node_of.size() > most_nodes) return false;
  ContactHistory own = history_in(spot, history);
  const YarnState before = spot.state;
  const auto went_too_far = [&] {
    for (std::size_t i = 0; i < before.nodes.size(); ++i)
      if (distance(before.nodes[i], spot.state.nodes[i]) > 0.9 * known) return true;
    return false;
  };
  NewtonOptions options;
  options.tolerance = tolerance;
  options.most_iterations = most_iterations;
  bool near = true;  // at no time so far away that yarn which is not known here could be met
  options.on_iteration = [&](int, double) { return near = near && !went_too_far(); };
  const NewtonResult rest = newton(spot.model, spot.state, options, 1e-3, &own);
  report.iterations += rest.iterations;
  if (!near || rest.crossings > 0) return false;
  put_back(spot, own, state, history);
  return true;
}

}  // namespace

SpotsReport settle_hot_spots(const YarnModel& model, const Unknowns& gradient, double tolerance,
                             YarnState& state, ContactHistory& history) {
  SpotsReport report;
  const bool twisted = std::any_of(model.yarns.begin(), model.yarns.end(),
                                   [](const YarnModel::Yarn& yarn) { return yarn.twist_stiffness > 0; });
  const bool closed = std::any_of(model.yarns.begin(), model.yarns.end(),
                                  [](const YarnModel::Yarn& yarn) { return yarn.periodic; });
  if (model.periodic || twisted || closed) return report;
  double usual = 0;
  const std::vector<std::int32_t> hot = hot_nodes(model, gradient, tolerance, usual);
  if (hot.empty()) return report;
  std::vector<std::uint8_t> is_hot(gradient.u.size(), 0), done(gradient.u.size(), 0);
  for (const std::int32_t i : hot) is_hot[static_cast<std::size_t>(i)] = 1;
  const double enough = std::max(usual, tolerance);
  for (const std::int32_t i : hot)
    if (done[static_cast<std::size_t>(i)] == 0 &&
        settle(model, i, is_hot, enough, state, history, done, report))
      ++report.spots;
  return report;
}

}  // namespace loopwright
