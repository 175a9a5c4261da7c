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

// All that the spots of one call share.
class SpotSettler {
 public:
  SpotSettler(const YarnModel& whole, const std::vector<std::int32_t>& hot, double tolerance,
              YarnState& state, const ContactHistory& history)
      : whole_(whole), tolerance_(tolerance), state_(state), grid_(whole, state), history_(history) {
    is_hot_.assign(state.nodes.size(), 0);
    for (const std::int32_t i : hot) is_hot_[static_cast<std::size_t>(i)] = 1;
    done_.assign(state.nodes.size(), 0);
  }
  bool is_done(std::int32_t node) const { return done_[static_cast<std::size_t>(node)] != 0; }
  bool settle(std::int32_t hottest, SpotsReport& report);
  ContactHistory history() const { return history_.whole(); }

 private:
  template <class Visit>
  void segments_of(std::int32_t node, const Visit& visit) const {
    const auto yarn =
        std::upper_bound(whole_.yarns.begin(), whole_.yarns.end(), node,
                         [](std::int32_t i, const YarnModel::Yarn& y) { return i < y.first_node; }) -
        1;
    const std::int32_t on_yarn = node - yarn->first_node;
    for (std::int32_t e = std::max(0, on_yarn - 3); e <= std::min(on_yarn, yarn->segments - 1); ++e)
      visit(yarn->first_segment + e);
  }
  std::vector<std::int32_t> moving_with(std::int32_t hottest, std::vector<std::uint8_t>& moves);
  std::vector<std::int32_t> segments_round(const std::vector<std::int32_t>& moving) const;

  const YarnModel& whole_;
  double tolerance_;
  YarnState& state_;
  SegmentGrid grid_;  // of the places before the first spot
  double gone_ = 0;   // d that any control point has moved since, at most
  ChangedHistory history_;
  std::vector<std::uint8_t> is_hot_, done_;
};

// The hot control points that hang together with this one, and what lies within `with_it` of their yarn.
std::vector<std::int32_t> SpotSettler::moving_with(std::int32_t hottest, std::vector<std::uint8_t>& moves) {
  std::vector<std::int32_t> moving, to_visit{hottest};
  while (!to_visit.empty() && moving.size() <= most_nodes) {
    const std::int32_t node = to_visit.back();
    to_visit.pop_back();
    if (is_done(node)) continue;
    done_[static_cast<std::size_t>(node)] = 1;
    segments_of(node, [&](std::int32_t own) {
      grid_.each_near(own, with_it, [&](std::int32_t near) {
        const auto f = static_cast<std::size_t>(whole_.first[static_cast<std::size_t>(near)]);
        for (std::size_t k = f; k < f + 4; ++k) {
          const std::int32_t i = whole_.base[k];
          const auto at = static_cast<std::size_t>(i);
          if (moves[at] == 0) moves[at] = 1, moving.push_back(i);
          if (is_hot_[at] != 0 && !is_done(i)) to_visit.push_back(i);
        }
      });
    });
  }
  return moving;
}

// All that these could meet on a way of less than `known`.
std::vector<std::int32_t> SpotSettler::segments_round(const std::vector<std::int32_t>& moving) const {
  enum : std::uint8_t { unseen, found, visited };
  std::vector<std::uint8_t> mark(static_cast<std::size_t>(whole_.segments), unseen);
  std::vector<std::int32_t> segments;
  for (const std::int32_t i : moving)
    segments_of(i, [&](std::int32_t own) {
      if (mark[static_cast<std::size_t>(own)] == visited) return;
      grid_.each_near(own, whole_.contact.outer + known + 2 * gone_, [&](std::int32_t near) {
        if (auto& its = mark[static_cast<std::size_t>(near)]; its == unseen)
          its = found, segments.push_back(near);
      });
      mark[static_cast<std::size_t>(own)] = visited;
    });
  return segments;
}

// Brings the spot round a hot control point to rest, if its steps are sure.
bool SpotSettler::settle(std::int32_t hottest, SpotsReport& report) {
  std::vector<std::uint8_t> moves(state_.nodes.size(), 0);
  const std::vector<std::int32_t> moving = moving_with(hottest, moves);
  if (moving.size() > most_nodes) return false;
  Spot spot = cut_out(whole_, state_, moves, segments_round(moving));
  if (spot.node_of.size() > most_nodes) return false;
  ContactHistory own = history_.inside(spot);
  const YarnState before = spot.state;
  const auto way = [&] {
    double most = 0;
    for (std::size_t i = 0; i < before.nodes.size(); ++i)
      most = std::max(most, distance(before.nodes[i], spot.state.nodes[i]));
    return most;
  };
  NewtonOptions options;
  options.tolerance = tolerance_;
  options.most_iterations = most_iterations;
  bool near = true;  // at no time so far away that yarn which is not known here could be met
  options.on_iteration = [&](int, double) { return near = near && way() < 0.9 * known; };
  const NewtonResult rest = newton(spot.model, spot.state, options, 1e-3, &own);
  report.iterations += rest.iterations;
  if (!near || rest.crossings > 0) return false;
  gone_ += way();
  for (std::size_t i = 0; i < spot.node_of.size(); ++i)
    state_.nodes[static_cast<std::size_t>(spot.node_of[i])] = spot.state.nodes[i];
  history_.put_back(spot, own);
  return true;
}

}  // namespace

bool may_have_hot_spots(const YarnModel& model) {
  return !model.periodic &&
         std::none_of(model.yarns.begin(), model.yarns.end(),
                      [](const YarnModel::Yarn& yarn) { return yarn.twist_stiffness > 0 || yarn.periodic; });
}

SpotsReport settle_hot_spots(const YarnModel& model, const Unknowns& gradient, double tolerance,
                             YarnState& state, const ContactHistory& history) {
  SpotsReport report;
  if (!may_have_hot_spots(model)) return report;
  double usual = 0;
  const std::vector<std::int32_t> hot = hot_nodes(model, gradient, tolerance, usual);
  if (hot.empty()) return report;
  SpotSettler settler(model, hot, std::max(usual, tolerance), state, history);
  for (const std::int32_t i : hot)
    if (!settler.is_done(i) && settler.settle(i, report)) ++report.spots;
  if (report.spots > 0) report.history = settler.history();
  return report;
}

}  // namespace loopwright
