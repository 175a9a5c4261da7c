#include "mechanics/hot_spots.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "mechanics/newton.hpp"

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

// Segments by the place of their middle, in cubes.
class SegmentGrid {
 public:
  SegmentGrid(const YarnModel& model, const YarnState& state) {
    const auto count = static_cast<std::size_t>(model.segments);
    middle_.resize(count);
    reach_.resize(count);
    for (std::size_t e = 0; e < count; ++e) {
      const auto f = static_cast<std::size_t>(model.first[e]);
      const auto at = [&](std::size_t k) { return state.nodes[static_cast<std::size_t>(model.base[f + k])]; };
      middle_[e] = (at(0) + 23 * at(1) + 23 * at(2) + at(3)) / 48;
      // The curve lies in the hull of its control points, within those of its middle span's.
      for (std::size_t k = 0; k < 4; ++k) reach_[e] = std::max(reach_[e], distance(at(k), middle_[e]));
      largest_ = std::max(largest_, reach_[e]);
      cubes_[key(middle_[e])].push_back(static_cast<std::int32_t>(e));
    }
  }
  // Segments of which some point may lie within `distance` of some point of `segment`.
  template <class Visit>
  void each_near(std::int32_t segment, double within, const Visit& visit) const {
    const Vec3& from = middle_[static_cast<std::size_t>(segment)];
    const double own = reach_[static_cast<std::size_t>(segment)], far = within + own + largest_;
    const auto [x0, y0, z0] = key(from - Vec3{far, far, far});
    const auto [x1, y1, z1] = key(from + Vec3{far, far, far});
    for (int x = x0; x <= x1; ++x)
      for (int y = y0; y <= y1; ++y)
        for (int z = z0; z <= z1; ++z) {
          const auto cube = cubes_.find({x, y, z});
          if (cube == cubes_.end()) continue;
          for (const std::int32_t e : cube->second)
            if (distance(from, middle_[static_cast<std::size_t>(e)]) <
                within + own + reach_[static_cast<std::size_t>(e)])
              visit(e);
        }
  }

 private:
  using Key = std::tuple<int, int, int>;
  static Key key(const Vec3& p) {
    constexpr double side = 4;
    return {static_cast<int>(std::floor(p.x / side)), static_cast<int>(std::floor(p.y / side)),
            static_cast<int>(std::floor(p.z / side))};
  }
  std::vector<Vec3> middle_;
  std::vector<double> reach_;
  double largest_ = 0;
  std::map<Key, std::vector<std::int32_t>> cubes_;
};

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

// A part of the piece as a model of its own: what moves, and the yarn round it, held.
struct Spot {
  YarnModel model;
  YarnState state;
  std::vector<std::int32_t> node_of, segment_of;  // of the piece
  std::vector<std::int32_t> segment_in;           // [segment of the piece] here, or -1
};

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

bool may_move(const Spot& spot, std::int32_t segment) {
  const auto f = static_cast<std::size_t>(spot.model.first[static_cast<std::size_t>(segment)]);
  for (std::size_t k = 0; k < 4; ++k)
    if (spot.model.held[static_cast<std::size_t>(spot.model.base[f + k])] == 0) return true;
  return false;
}

// Contacts of which at least one side may have moved: as they are now.
void put_back(const Spot& spot, const ContactHistory& own, ContactHistory& history) {
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
  for (std::size_t i = 0; i < spot.node_of.size(); ++i)
    state.nodes[static_cast<std::size_t>(spot.node_of[i])] = spot.state.nodes[i];
  put_back(spot, own, history);
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
