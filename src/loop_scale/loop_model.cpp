#include "loop_scale/loop_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "geometry/held_events.hpp"
#include "geometry/layout.hpp"
#include "geometry/type_points.hpp"
#include "loop_scale/settle.hpp"
#include "loop_scale/tube_walls.hpp"

namespace loopwright {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

std::vector<Vec3> places_of(const BindingPoints& points, const Layout& layout) {
  std::vector<Vec3> places;
  for (const BindingPoint& point : points.points)
    places.push_back(point.lower_of.empty() ? layout.upper[point.upper_of.front().position()]
                                            : layout.lower[point.lower_of.front().position()]);
  return places;
}

class NetBuilder {
 public:
  NetBuilder(const YarnGraph& graph, const LoopModelOptions& options, const LoopYarn& yarn,
             const BindingPoints& points, const std::vector<Vec3>& start,
             const std::vector<std::int8_t>& walls)
      : graph_(graph),
        options_(options),
        points_(points),
        start_(start),
        walls_(walls),
        table_(measured_connections()),
        length_(yarn.loop_length),
        stiffness_(stiffness_unit(yarn)),
        slots_per_wale_(slots_per_wale(graph)) {}

  MassSpringNet build() {
    net_.law = options_.law;
    add_warps();
    add_wefts();
    if (options_.coupling) couple();
    if (options_.shear > 0) add_shear();
    if (options_.bend > 0 || options_.fold > 0) add_second_neighbours();
    if (options_.passing > 0) add_passings();
    return std::move(net_);
  }

 private:
  static constexpr std::int32_t none = -1;

  // The connection's stiffness without what the coupling gives back: pulled alone, both together are as
  // stiff as was measured.
  double own_stiffness(const Connection& connection, double coupling) const {
    return connection.stiffness * stiffness_ / (options_.coupling ? 1 + coupling : 1);
  }
  // The start's z says which end of an odd connection is in front.
  Vec3 rest_of(const Connection& connection, std::int32_t a, std::int32_t b, double x, double y) const {
    const double dz = start_[at(b)].z - start_[at(a)].z;
    const Vec3 rest = connection.rest * length_;
    return {x * rest.x, y * rest.y, dz == 0 ? 0 : std::copysign(rest.z, dz)};
  }

  bool odd_warp(std::size_t k) const {
    const Loop& loop = graph_.loops[k];
    return !loop.children.empty() && graph_.loop(loop.children.front()).side != loop.side;
  }

  // By loop: how many wales its head was moved against those of its neighbours. Where a whole stretch of
  // needles was moved together (decreases far from the edge) the cloth there was moved and no loop leans; a
  // loop that crosses another (cable) leans as far as it was moved.
  std::vector<double> leans_in_course() const {
    constexpr std::ptrdiff_t reach = 5;  // neighbours on each side
    std::vector<double> leans(graph_.loops.size(), 0);
    std::vector<bool> crosses(graph_.loops.size(), false);
    for (const LegCrossing& crossing : graph_.leg_crossings)
      crosses[crossing.front.position()] = crosses[crossing.back.position()] = true;
    const auto moved = [&](LoopId id) {
      return (graph_.loop(id).head_slot - graph_.loop(id).slot) / slots_per_wale_;
    };
    std::vector<double> near;
    for (const GraphYarn& yarn : graph_.yarns)
      for (std::size_t k = 0; k < yarn.loops.size(); ++k) {
        const LoopId id = yarn.loops[k];
        double& lean = leans[id.position()];
        lean = moved(id);
        if (std::abs(lean) <= 0.4 || crosses[id.position()]) continue;
        near.clear();
        for (const std::ptrdiff_t step : {-1, 1})
          for (std::ptrdiff_t i = 1; i <= reach; ++i) {
            const std::ptrdiff_t other = static_cast<std::ptrdiff_t>(k) + i * step;
            if (other < 0 || other >= static_cast<std::ptrdiff_t>(yarn.loops.size())) break;
            const LoopId neighbour = yarn.loops[static_cast<std::size_t>(other)];
            if (graph_.loop(neighbour).direction != graph_.loop(id).direction) break;
            near.push_back(moved(neighbour));
          }
        if (near.empty()) continue;
        const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
        std::nth_element(near.begin(), middle, near.end());
        lean -= *middle;
      }
    return leans;
  }

  // By loop: for how many tucks and floats it grew while it was held. Nothing passes a loop at the selvedge,
  // but it is held as long as those beside it, and grows as they do.
  std::vector<double> events_in_row() const {
    const HeldEvents events = held_events(graph_);
    std::vector<double> counts(graph_.loops.size());
    for (std::size_t k = 0; k < counts.size(); ++k) {
      // what the other wall of a tube does meanwhile needs no room
      const auto own = [&](const HeldEvent& event) {
        if (event.tuck.valid()) return walls_[k] * walls_[event.tuck.position()] >= 0;
        const Float& passing = graph_.yarns[at(event.yarn)].floats[at(event.gap)];
        return walls_[k] * walls_[passing.to.position()] >= 0;
      };
      counts[k] = static_cast<double>(std::count_if(events.of_loop[k].begin(), events.of_loop[k].end(), own));
    }
    std::vector<double> grown = counts;
    for (const GraphYarn& yarn : graph_.yarns)
      for (std::size_t i = 0; i + 1 < yarn.loops.size(); ++i) {
        const LoopId one = yarn.loops[i], other = yarn.loops[i + 1];
        if (graph_.loop(one).direction != graph_.loop(other).direction) continue;
        const bool first = i == 0 || turns(yarn, i - 1),
                   last = i + 2 == yarn.loops.size() || turns(yarn, i + 1);
        if (first) grown[one.position()] = std::max(grown[one.position()], counts[other.position()]);
        if (last) grown[other.position()] = std::max(grown[other.position()], counts[one.position()]);
      }
    return grown;
  }
  // Whether a yarn turns between its loops `order` and `order` + 1.
  bool turns(const GraphYarn& yarn, std::size_t order) const {
    return graph_.loop(yarn.loops[order]).direction != graph_.loop(yarn.loops[order + 1]).direction;
  }

  void add_warps() {
    // Held loops draw yarn as they are passed; tucks are lower: as in geometry's layout.
    const std::vector<double> grown = events_in_row();
    warp_of_.assign(graph_.loops.size(), none);
    const std::vector<double> leans = leans_in_course();
    std::set<std::pair<std::int32_t, std::int32_t>> known;
    for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
      const std::int32_t a = points_.lower[k], b = points_.upper[k];
      if (a == b) continue;
      const Loop& loop = graph_.loops[k];
      const Connection& connection = odd_warp(k) ? table_.warp_odd : table_.warp_even;
      double high = 1 + std::min(2.5, 0.45 * grown[k]);
      if (loop.kind == LoopKind::tuck) high = 0.6;
      Vec3 rest = rest_of(connection, a, b, 0, high);
      // a head that was moved to another wale: the yarn goes over there
      const double lean = leans[k];
      if (std::abs(lean) > 0.4) rest.x = lean * table_.weft_even.rest.x * length_;
      warp_of_[k] = static_cast<std::int32_t>(net_.springs.size());
      if (!known.insert({a, b}).second) {
        // plated and stacked loops share both ends: one spring is as stiff as all of them
        for (std::size_t s = 0; s < net_.springs.size(); ++s)
          if (net_.springs[s].a == a && net_.springs[s].b == b) {
            net_.springs[s].stiffness += own_stiffness(connection, connection.coupling);
            warp_of_[k] = static_cast<std::int32_t>(s);
          }
        continue;
      }
      net_.springs.push_back({a, b, own_stiffness(connection, connection.coupling), rest, SpringKind::warp});
    }
  }

  void add_wefts() {
    weft_after_.assign(graph_.loops.size(), none);
    for (const GraphYarn& yarn : graph_.yarns)
      for (std::size_t k = 0; k + 1 < yarn.loops.size(); ++k) {
        const LoopId from = yarn.loops[k], to = yarn.loops[k + 1];
        if (!joined_by_weft(points_, from, to)) continue;
        const Loop &first = graph_.loop(from), &second = graph_.loop(to);
        const std::int32_t a = points_.lower[from.position()], b = points_.lower[to.position()];
        const double step = (second.slot - first.slot) / slots_per_wale_;
        const double wales = std::max(std::abs(step), 1.0);
        const bool is_turn = turns(yarn, k);
        // Round the edge of a tube the face is the same, seen from outside, where it differs from front to
        // rear.
        const bool over = walls_[from.position()] * walls_[to.position()] < 0;
        const bool odd =
            over ? first.side == second.side : !is_turn && first.side != second.side && wales < 1.5;
        const Connection& connection = odd ? table_.weft_odd : table_.weft_even;
        Vec3 rest = rest_of(connection, a, b, step < 0 ? -wales : wales, 0);
        if (is_turn && !over && std::abs(step) < 0.5) {
          // straight over to the other bed, or up to the next row
          const Vec3 way = start_[at(b)] - start_[at(a)];
          rest = norm(way) > 0 ? normalized(way) * norm(rest) : rest;
        }
        const double rows = rows_waited(graph_, from, to);
        if (rows > 0) rest.y += rows * table_.warp_even.rest.y * length_;
        weft_after_[from.position()] = static_cast<std::int32_t>(net_.springs.size());
        if (over) over_edge_.insert(weft_after_[from.position()]);
        net_.springs.push_back(
            {a, b, own_stiffness(connection, connection.coupling) / (wales + rows), rest, SpringKind::weft});
      }
  }

  // Each loop's warp spring with the weft springs on both sides of it.
  void couple() {
    for (const GraphYarn& yarn : graph_.yarns)
      for (std::size_t k = 0; k < yarn.loops.size(); ++k) {
        const std::size_t loop = yarn.loops[k].position();
        const std::int32_t warp = warp_of_[loop];
        if (warp == none) continue;
        std::vector<std::int32_t> wefts;
        if (k > 0 && weft_after_[yarn.loops[k - 1].position()] != none)
          wefts.push_back(weft_after_[yarn.loops[k - 1].position()]);
        if (weft_after_[loop] != none) wefts.push_back(weft_after_[loop]);
        const Connection& high = odd_warp(loop) ? table_.warp_odd : table_.warp_even;
        for (const std::int32_t weft : wefts) {
          const bool odd = net_.springs[at(weft)].rest.z != 0;
          const Connection& wide = odd ? table_.weft_odd : table_.weft_even;
          const double rho = std::min(high.coupling, wide.coupling);
          const double share = 1 / static_cast<double>(wefts.size());
          net_.couplings.push_back({warp, weft, share * rho * high.stiffness * stiffness_ / (1 - rho * rho),
                                    std::sqrt(wide.stiffness / high.stiffness)});
        }
      }
  }

  // Diagonals of the cell that two neighbours in a course span.
  void add_shear() {
    for (const GraphYarn& yarn : graph_.yarns)
      for (std::size_t k = 0; k + 1 < yarn.loops.size(); ++k) {
        const std::size_t from = yarn.loops[k].position(), to = yarn.loops[k + 1].position();
        const std::int32_t weft = weft_after_[from];
        if (weft == none || warp_of_[from] == none || warp_of_[to] == none) continue;
        const Spring along = net_.springs[at(weft)];
        const Vec3 up_from = net_.springs[at(warp_of_[from])].rest,
                   up_to = net_.springs[at(warp_of_[to])].rest;
        const double stiffness = options_.shear * along.stiffness;
        add_if_new(points_.lower[from], points_.upper[to], stiffness, along.rest + up_to, SpringKind::shear);
        add_if_new(points_.lower[to], points_.upper[from], stiffness, up_from - along.rest,
                   SpringKind::shear);
      }
  }

  // Second neighbours along courses and wales.
  void add_second_neighbours() {
    const auto join = [&](std::int32_t first, std::int32_t second) {
      if (first == none || second == none) return;
      const Spring a = net_.springs[at(first)], b = net_.springs[at(second)];
      // straight on through the mass they share; parts of an odd pair undo each other's z
      if (a.b != b.a || a.a == b.b) return;
      Vec3 rest = a.rest + b.rest;
      const bool both_odd = a.rest.z != 0 && b.rest.z != 0;
      if (over_edge_.count(first) + over_edge_.count(second) > 0) {
        // round the edge of a tube: as far as in a wall
        rest = {std::abs(a.rest.x) + std::abs(b.rest.x), 0, both_odd ? 0 : a.rest.z + b.rest.z};
      } else if (a.kind == SpringKind::weft && a.rest.x * b.rest.x < 0) {
        return;  // there and back
      }
      const double share = both_odd ? options_.fold : options_.bend;
      if (share > 0) add_if_new(a.a, b.b, share * std::min(a.stiffness, b.stiffness), rest, SpringKind::bend);
    };
    for (const GraphYarn& yarn : graph_.yarns)
      for (std::size_t k = 0; k + 2 < yarn.loops.size(); ++k)
        join(weft_after_[yarn.loops[k].position()], weft_after_[yarn.loops[k + 1].position()]);
    for (std::size_t k = 0; k < graph_.loops.size(); ++k)
      for (const LoopId child : graph_.loops[k].children) join(warp_of_[k], warp_of_[child.position()]);
  }

  // A held loop that a float passes stays between the float's ends, as far from each as on the needles.
  void add_passings() {
    for (const GraphYarn& yarn : graph_.yarns)
      for (std::size_t k = 0; k + 1 < yarn.loops.size(); ++k) {
        const LoopId from = yarn.loops[k], to = yarn.loops[k + 1];
        const std::int32_t weft = weft_after_[from.position()];
        if (weft == none || graph_.loop(from).direction != graph_.loop(to).direction) continue;
        const double stiffness = options_.passing * net_.springs[at(weft)].stiffness;
        for (const PassedLoop& passed : yarn.floats[k].passed)
          for (const LoopId end : {from, to}) {
            if (walls_[passed.loop.position()] != walls_[end.position()]) continue;
            const double wales = (passed.slot - graph_.loop(end).slot) / slots_per_wale_;
            const Vec3 rest{wales * table_.weft_even.rest.x * length_, 0, 0};
            add_if_new(points_.lower[end.position()], points_.upper[passed.loop.position()], stiffness, rest,
                       SpringKind::passing);
          }
      }
  }

  void add_if_new(std::int32_t a, std::int32_t b, double stiffness, const Vec3& rest, SpringKind kind) {
    if (a == b || !(norm(rest) > 0)) return;
    if (!extra_.insert({std::min(a, b), std::max(a, b)}).second) return;
    net_.springs.push_back({a, b, stiffness, rest, kind});
  }

  const YarnGraph& graph_;
  const LoopModelOptions& options_;
  const BindingPoints& points_;
  const std::vector<Vec3>& start_;
  const std::vector<std::int8_t>& walls_;
  ConnectionTable table_;
  double length_, stiffness_, slots_per_wale_;
  MassSpringNet net_;
  std::vector<std::int32_t> warp_of_, weft_after_;  // [loop] spring
  std::set<std::int32_t> over_edge_;                // weft springs from wall to wall of a tube
  std::set<std::pair<std::int32_t, std::int32_t>> extra_;
};

void add_loads(const YarnGraph& graph, const LoopModelOptions& options, LoopModel& model) {
  const double metre = 1e3 / model.yarn.diameter_mm;  // in d
  std::set<std::int32_t> clamped;
  for (const PiecePlace place : options.clamps) {
    Clamp clamp;
    for (const std::int32_t i : masses_at(graph, model.points, model.start, place))
      if (clamped.insert(i).second) clamp.masses.push_back(i);
    model.net.clamps.push_back(std::move(clamp));
  }
  for (const Pull& pull : options.pulls) {
    Load load;
    load.masses = masses_at(graph, model.points, model.start, pull.place);
    if (load.masses.empty()) continue;
    const Vec3 way = norm(pull.direction) > 0 ? normalized(pull.direction) : outward(pull.place);
    load.force = way * (pull.force_cN * 1e-2 * metre / static_cast<double>(load.masses.size()));
    load.factor = pull.factor;
    model.net.loads.push_back(std::move(load));
  }
  if (options.gravity) model.net.gravity = {0, -9.81 * metre, 0};
}

}  // namespace

std::optional<PiecePlace> place_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PiecePlace>, 7> names{{{"top", PiecePlace::top},
                                                                          {"bottom", PiecePlace::bottom},
                                                                          {"left", PiecePlace::left},
                                                                          {"right", PiecePlace::right},
                                                                          {"corner", PiecePlace::corner},
                                                                          {"wale", PiecePlace::wale},
                                                                          {"course", PiecePlace::course}}};
  for (const auto& [word, place] : names)
    if (word == name) return place;
  return std::nullopt;
}

Vec3 outward(PiecePlace place) {
  switch (place) {
    case PiecePlace::bottom:
      return {0, -1, 0};
    case PiecePlace::left:
      return {-1, 0, 0};
    case PiecePlace::right:
    case PiecePlace::course:
      return {1, 0, 0};
    case PiecePlace::corner:
      return normalized({1, 1, 0});
    case PiecePlace::top:
    case PiecePlace::wale:
      break;
  }
  return {0, 1, 0};
}

GeometryOptions paper_start(const Program& program) {
  GeometryOptions options = make_geometry_options(program);
  options.wale_pitch = 8 * options.shape_radius();
  options.course_pitch = 7 * options.shape_radius();
  return options;
}

std::vector<std::int32_t> masses_at(const YarnGraph& graph, const BindingPoints& points,
                                    const std::vector<Vec3>& start, PiecePlace place) {
  // Ends of the runs of neighbours in a course, from left to right.
  std::set<std::int32_t> lefts, rights, tops, bottoms;
  for (const GraphYarn& yarn : graph.yarns)
    for (std::size_t first = 0; first < yarn.loops.size();) {
      std::size_t last = first;
      while (last + 1 < yarn.loops.size() && joined_by_weft(points, yarn.loops[last], yarn.loops[last + 1]) &&
             graph.loop(yarn.loops[last]).direction == graph.loop(yarn.loops[last + 1]).direction)
        ++last;
      std::int32_t a = points.lower[yarn.loops[first].position()],
                   b = points.lower[yarn.loops[last].position()];
      if (start[at(a)].x > start[at(b)].x) std::swap(a, b);
      lefts.insert(a);
      rights.insert(b);
      first = last + 1;
    }
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    if (graph.loops[k].children.empty()) tops.insert(points.upper[k]);
    if (graph.loops[k].parents.empty()) bottoms.insert(points.lower[k]);
  }
  const auto list = [](const std::set<std::int32_t>& set) {
    return std::vector<std::int32_t>(set.begin(), set.end());
  };
  const auto nearest = [&](const std::set<std::int32_t>& among, double x, double y) -> std::int32_t {
    std::int32_t best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const std::int32_t i : among) {
      const double off = std::hypot(start[at(i)].x - x, start[at(i)].y - y);
      if (off < least) std::tie(best, least) = std::pair(i, off);
    }
    return best;
  };
  double low = std::numeric_limits<double>::infinity(), high = -low, wide = -low, left = low;
  for (const Vec3& p : start) {
    low = std::min(low, p.y), high = std::max(high, p.y);
    left = std::min(left, p.x), wide = std::max(wide, p.x);
  }
  std::vector<std::int32_t> one;
  switch (place) {
    case PiecePlace::top:
      return list(tops);
    case PiecePlace::bottom:
      return list(bottoms);
    case PiecePlace::left:
      return list(lefts);
    case PiecePlace::right:
      return list(rights);
    case PiecePlace::corner:
      one = {nearest(tops, wide, high)};
      break;
    case PiecePlace::wale:
      one = {nearest(tops, (left + wide) / 2, high)};
      break;
    case PiecePlace::course:
      one = {nearest(rights, wide, (low + high) / 2)};
      break;
  }
  std::erase(one, -1);
  return one;
}

LoopModel build_loop_model(const YarnGraph& graph, const Program& program, const LoopModelOptions& options) {
  if (graph.loops.empty()) throw std::invalid_argument("loop model: nothing was knitted: there is no loop");
  for (const double share : {options.shear, options.fold, options.bend, options.damping})
    if (!(share >= 0) || !std::isfinite(share))
      throw std::invalid_argument("loop model: shear, fold, bend and damping must not be negative");
  const GeometryOptions geometry = paper_start(program);
  const PlacedPiece piece = place_type_points(graph, geometry);
  BindingPoints points = binding_points(graph);
  std::vector<Vec3> start = places_of(points, piece.layout);
  YarnCurves curves = build_yarn_curves(graph, geometry);
  CorrelationMap map(graph, points, start, curves);
  const LoopYarn yarn = loop_yarn(program, geometry);
  const std::vector<std::int8_t> walls = tube_walls(graph, rounds_of(graph, points));
  MassSpringNet net = NetBuilder(graph, options, yarn, points, start, walls).build();
  // (8): the fabric's mass is shared by the binding points
  const double whole = loop_mass(yarn) * static_cast<double>(graph.loops.size());
  net.mass.assign(points.points.size(), whole / static_cast<double>(points.points.size()));
  net.damping = options.damping * settling_damping(net);
  std::vector<StitchSide> side;
  for (const Loop& loop : graph.loops) side.push_back(loop.side);
  LoopModel model{geometry,          yarn,           std::move(points), std::move(net), std::move(start),
                  std::move(curves), std::move(map), std::move(side)};
  model.wall = walls_of_points(model.points, walls);
  add_loads(graph, options, model);
  return model;
}

YarnCurves curves_at(const LoopModel& model, const NetState& state) {
  const std::vector<Vec3> places = positions_of(state);
  std::vector<Vec3> q;
  model.map.map(places, model.map.frames(places), q);
  return moved_curves(model.curves, q);
}

std::vector<Vec3> grid_places(int wales, int courses, double wide, double high) {
  std::vector<Vec3> places;
  for (int i = 0; i < courses; ++i)
    for (int j = 0; j < wales; ++j) places.push_back({j * wide, i * high, 0});
  return places;
}

MassSpringNet traditional_net(int wales, int courses, double wide, double high, double mass,
                              const TraditionalStiffness& stiffness) {
  MassSpringNet net;
  net.mass.assign(static_cast<std::size_t>(wales) * static_cast<std::size_t>(courses), mass);
  for (int i = 0; i < courses; ++i)
    for (int j = 0; j < wales; ++j) {
      const auto join = [&](int up, int across, double k, SpringKind kind) {
        const int row = i + up, column = j + across;
        if (row >= courses || column >= wales || column < 0 || !(k > 0)) return;
        net.springs.push_back({i * wales + j, row * wales + column, k, {across * wide, up * high, 0}, kind});
      };
      join(0, 1, stiffness.structural, SpringKind::weft);
      join(1, 0, stiffness.structural, SpringKind::warp);
      join(1, 1, stiffness.shear, SpringKind::shear);
      join(1, -1, stiffness.shear, SpringKind::shear);
      join(0, 2, stiffness.bending, SpringKind::bend);
      join(2, 0, stiffness.bending, SpringKind::bend);
    }
  return net;
}

}  // namespace loopwright
