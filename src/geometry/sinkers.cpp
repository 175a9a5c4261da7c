#include "geometry/sinkers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stop.hpp"
#include "geometry/hairpins.hpp"
#include "geometry/held_events.hpp"

namespace loopwright {
namespace {

constexpr double float_gap = 2.2;        // between a float and what it passes, in r
constexpr double hairpin_radius = 0.75;  // in diameters

// Where a float passes held loops: a place, and the turn of the cloth there.
struct Pass {
  Vec3 place;  // before the turn
  Rotation turn;
};

// The yarn between two loops, from half a wale beside the one to half a wale beside the other.
struct Way {
  Vec3 begin, end;            // where it is
  Vec3 flat_begin, flat_end;  // in the flat layout, where x is the needles'
  double ahead() const { return flat_end.x > flat_begin.x ? 1 : -1; }
};

class SinkerPlacer {
 public:
  SinkerPlacer(const YarnGraph& graph, const GeometryOptions& options, const std::vector<LoopSigns>& signs,
               const Layout& flat, const PlacedPiece& piece)
      : graph_(graph),
        options_(options),
        signs_(signs),
        flat_(flat),
        piece_(piece),
        events_(held_events(graph)),
        stacks_(stacks_of_heads(graph)),
        r_(options.shape_radius()),
        sx_(options.wale_pitch / 8),
        sy_(options.course_pitch / 7) {}

  PlacedSinker end(LoopId id, bool first) const {
    const double side = first ? entry_side(id) : exit_side(id);
    PlacedSinker sinker;
    const TypePoint near = point(id, LoopPart::span, hanging(piece_.layout, id, side));
    const Vec3 on = piece_.layout.lower_turn(id) * Vec3{side * sx_, -0.5 * sy_, 0};
    const TypePoint last = point(id, LoopPart::sinker, near.position + on);
    sinker.points = first ? std::vector<TypePoint>{last, near} : std::vector<TypePoint>{near, last};
    sinker.middle = first ? 0 : 1;
    return sinker;
  }

  PlacedSinker between(int yarn, int gap) const {
    const Float& yarn_float =
        graph_.yarns[static_cast<std::size_t>(yarn)].floats[static_cast<std::size_t>(gap)];
    const LoopId from = yarn_float.from, to = yarn_float.to;
    const Layout& layout = piece_.layout;
    const Way whole{hanging(layout, from, exit_side(from)), hanging(layout, to, entry_side(to)),
                    hanging(flat_, from, exit_side(from)), hanging(flat_, to, entry_side(to))};
    PlacedSinker sinker;
    sinker.extra_length = extra_length(graph_.loop(from), graph_.loop(to));
    const double pitch = 8 * sx_;
    if (rows_waited(graph_, from, to) > 0) {
      const std::vector<Vec3> way = waiting(yarn, gap, whole);
      for (std::size_t k = 1; k < way.size(); ++k) sinker.extra_length += distance(way[k - 1], way[k]);
      place_along(sinker, from, way);
      return sinker;
    }
    if (along_course(from, to, whole) < 0.75 * pitch) {
      Vec3 middle = (whole.begin + whole.end) / 2;
      // Between two loops that go through one head both ways the sinker goes round that head's leg, below it.
      const Loop &first = graph_.loop(from), &second = graph_.loop(to);
      const bool both_ways =
          first.side != second.side &&
          std::find_first_of(first.parents.begin(), first.parents.end(), second.parents.begin(),
                             second.parents.end()) != first.parents.end();
      const Rotation turn = layout.lower_turn(from);
      if (both_ways) middle -= turn.y * (2 * sy_);
      // A turn at a selvedge swings out a little.
      const bool turns = exit_side(from) == entry_side(to);
      if (turns) middle += turn.x * (exit_side(from) * 0.5 * sx_);
      if (both_ways && turns) middle = outside_legs(first, turn, exit_side(from), middle);
      sinker.points = {point(from, LoopPart::sinker, middle)};
      return sinker;
    }
    std::vector<Vec3> way{whole.begin};
    pass_by(way, yarn, gap, yarn_float.passed, whole);
    way.push_back(whole.end);
    open_hairpins(way, piece_.loops[from.position()].points.back().position,
                  piece_.loops[to.position()].points.front().position, hairpin_radius * 2 * r_);
    place_along(sinker, from, way);
    return sinker;
  }

 private:
  void place_along(PlacedSinker& sinker, LoopId from, const std::vector<Vec3>& corners) const {
    const std::vector<Vec3> way = fill(corners, 8 * sx_);
    sinker.middle = middle_of(way);
    for (std::size_t k = 0; k < way.size(); ++k)
      sinker.points.push_back(point(from, k == sinker.middle ? LoopPart::sinker : LoopPart::span, way[k]));
  }

  // A yarn that waits while the cloth grows leaves it at its edge, runs up outside it, and comes back where
  // it is knitted again. Carriers that wait side by side keep their yarns apart.
  std::vector<Vec3> waiting(int yarn, int gap, const Way& whole) const {
    const Float& yarn_float =
        graph_.yarns[static_cast<std::size_t>(yarn)].floats[static_cast<std::size_t>(gap)];
    const LoopId from = yarn_float.from, to = yarn_float.to;
    const int back = graph_.loop(to).instruction;
    std::vector<PassedLoop> leaving, coming;
    for (const PassedLoop& passed : yarn_float.passed)
      (is_held_at(graph_.loop(passed.loop), back) ? coming : leaving).push_back(passed);
    const auto outside = [&](const Layout& layout, LoopId id, double side,
                             const std::vector<PassedLoop>& passes) {
      double beyond = 0;
      for (const PassedLoop& held : passes)
        beyond = std::max(beyond, side * (held.slot - graph_.loop(id).slot));
      const double out = beyond * layout.slot_pitch + 4 * sx_ + 2.5 * r_ * yarn;
      return hanging(layout, id, side) + layout.lower_turn(id) * Vec3{side * out, 0, 0};
    };
    const double exit = exit_side(from), entry = entry_side(to);
    const Way out{whole.begin, outside(piece_.layout, from, exit, leaving), whole.flat_begin,
                  outside(flat_, from, exit, leaving)};
    const Way in{outside(piece_.layout, to, entry, coming), whole.end, outside(flat_, to, entry, coming),
                 whole.flat_end};
    std::vector<Vec3> way{out.begin};
    pass_by(way, yarn, gap, leaving, out);
    way.insert(way.end(), {out.end, in.begin});
    pass_by(way, yarn, gap, coming, in);
    way.push_back(in.end);
    return way;
  }

  void pass_by(std::vector<Vec3>& way, int yarn, int gap, const std::vector<PassedLoop>& loops,
               const Way& whole) const {
    for (const Pass& pass : passed(yarn, gap, loops, whole))
      for (const double side : {-whole.ahead(), whole.ahead()})
        way.push_back(pass.turn * (pass.place + Vec3{side * 2.6 * sx_, 0, 0}));
  }

  TypePoint point(LoopId id, LoopPart part, Vec3 position) const {
    TypePoint p;
    p.position = position;
    p.loop = id;
    p.part = part;
    p.at = graph_.loop(id).at;
    return p;
  }
  double entry_side(LoopId id) const { return graph_.loop(id).direction == Direction::left ? 1 : -1; }
  double exit_side(LoopId id) const { return -entry_side(id); }

  // T0 or T8 as it hangs from a loop's own binding point, half a wale beside it.
  Vec3 hanging(const Layout& layout, LoopId id, double side) const {
    const std::size_t i = id.position();
    const LoopSigns& sign = signs_[i];
    // Where the foot reaches behind several heads, the sinker does not come back in between them.
    const double foot = sign.s * sign.foot + 0.6;
    const double z = sign.s * std::min(sign.s * sign.foot_layer - 1.5, foot);
    const double high = sy_ * layout.y_scale_lower[i];
    return layout.from_lower(id, {4 * side * sx_, -3 * high, z * r_}, 1.5 * high);
  }
  // Whether a loop that stands upright leans away from a side, so that its legs lie on it.
  bool comes_from(LoopId id, double side) const {
    return !lies_flat(id) && side * piece_.layout.step(id).x < -3 * sx_;
  }

  // A place beside the heads that a loop is drawn through, moved out past their legs where these lean that
  // way.
  Vec3 outside_legs(const Loop& loop, const Rotation& turn, double side, const Vec3& place) const {
    Vec3 own = turn.transposed(place);
    for (const LoopId parent : loop.parents) {
      if (!comes_from(parent, side)) continue;
      for (const TypePoint& leg : piece_.loops[parent.position()].points) {
        const Vec3 p = turn.transposed(leg.position);
        if (std::abs(p.y - own.y) < 2.5 * sy_) own.x = side * std::max(side * own.x, side * p.x + 2 * r_);
      }
    }
    return turn * own;
  }

  // How far the yarn goes along the course; the whole distance where the two loops face different ways, as
  // round the edge of a tube.
  double along_course(LoopId from, LoopId to, const Way& way) const {
    const Layout& layout = piece_.layout;
    const Rotation a = layout.lower_turn(from), b = layout.lower_turn(to);
    if (dot(a.x, b.x) < 0.3) return distance(way.begin, way.end);
    const Rotation turn = layout.is_flat() ? a : mean_rotation({a.x + b.x, a.y + b.y, a.z + b.z}, a);
    return std::abs(turn.transposed(way.end).x - turn.transposed(way.begin).x);
  }

  double extra_length(const Loop& from, const Loop& to) const {
    double gone = std::abs(to.slot - from.slot);
    // Where the yarn turns and the piece was moved on its needles before the next row (decreases all along
    // it), the loop that the yarn leaves was moved as well.
    if (from.direction != to.direction) gone = std::min(gone, std::abs(to.slot - from.head_slot));
    const double missed = std::max(0.0, gone - 1);
    const double change = is_front(from.bed) == is_front(to.bed) ? 0 : options_.bed_change;
    return missed * options_.needle_pitch * (1 + options_.float_slack) + change;
  }

  // Lowest and highest z near height y of what belongs to a held loop: its legs, the head below, the feet
  // above.
  void z_range(LoopId held, const Rotation& turn, double y, double& low, double& high) const {
    const double window = 2.5 * sy_;
    const auto take = [&](const PlacedLoop& loop) {
      for (std::size_t k = 0; k + 1 < loop.points.size(); ++k)
        for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          const Vec3 p = turn.transposed(loop.points[k].position * (1 - u) + loop.points[k + 1].position * u);
          if (std::abs(p.y - y) > window) continue;
          low = std::min(low, p.z);
          high = std::max(high, p.z);
        }
    };
    take(piece_.loops[held.position()]);
    const Loop& loop = graph_.loop(held);
    for (const LoopId parent : loop.parents) take(piece_.loops[parent.position()]);
    for (const LoopId child : loop.children) take(piece_.loops[child.position()]);
  }

  std::vector<Pass> passed(int yarn, int gap, std::vector<PassedLoop> loops, const Way& way) const {
    const Float& yarn_float =
        graph_.yarns[static_cast<std::size_t>(yarn)].floats[static_cast<std::size_t>(gap)];
    add_own_wales(yarn_float, way, loops);
    // what is in the other wall of a tube is passed already
    std::erase_if(loops, [&](const PassedLoop& held) {
      return !piece_.layout.in_one_wall(held.loop, yarn_float.from) ||
             !piece_.layout.in_one_wall(held.loop, yarn_float.to);
    });
    const double pitch = 8 * sx_, ahead = way.ahead();
    const double margin = 0.3 * pitch;
    std::stable_sort(loops.begin(), loops.end(), [&](const PassedLoop& a, const PassedLoop& b) {
      return ahead * a.slot < ahead * b.slot;
    });
    std::vector<Pass> passes;
    for (std::size_t k = 0; k < loops.size();) {
      std::size_t next = k;
      double front_bound = std::numeric_limits<double>::infinity(), back_bound = -front_bound;
      double y_sum = 0, x_sum = 0;
      Pass pass;
      pass.turn = piece_.layout.turn(loops[k].loop);
      const Vec3 begin = pass.turn.transposed(way.begin), end = pass.turn.transposed(way.end);
      while (next < loops.size() && std::abs(loops[next].slot - loops[k].slot) < 0.3) {
        const PassedLoop& held = loops[next++];
        const double x = held.slot * piece_.layout.slot_pitch;
        const double gone =
            std::clamp((x - way.flat_begin.x) / (way.flat_end.x - way.flat_begin.x), 0.0, 1.0);
        const Vec3 line = begin + (end - begin) * gone;
        const double share = events_.share_of_float(held.loop, yarn, gap);
        const bool flat = lies_flat(held.loop);
        const double y = flat ? line.y : height_on(held.loop, pass.turn, line.y, share);
        y_sum += y;
        // a loop that lies flat is passed at its needle
        x_sum += !flat ? leg_centre(held.loop, pass.turn, y) : piece_.layout.is_flat() ? x : line.x;
        double low = std::numeric_limits<double>::infinity(), high = -low;
        z_range(held.loop, pass.turn, y, low, high);
        if (low > high) low = high = pass.turn.transposed(piece_.layout.lower[held.loop.position()]).z;
        if (is_front(held.bed)) front_bound = std::min(front_bound, low - float_gap * r_);
        if (!is_front(held.bed)) back_bound = std::max(back_bound, high + float_gap * r_);
      }
      const double count = static_cast<double>(next - k);
      k = next;
      const bool fronts = std::isfinite(front_bound), backs = std::isfinite(back_bound);
      pass.place = {x_sum / count, y_sum / count,
                    fronts && backs ? (front_bound + back_bound) / 2
                    : fronts        ? front_bound
                                    : back_bound};
      if (ahead * (pass.place.x - begin.x) > margin && ahead * (end.x - pass.place.x) > margin)
        passes.push_back(pass);
    }
    return passes;
  }

  // A float that leaves or enters on the far side also passes the wale of its own loop.
  void add_own_wales(const Float& yarn_float, const Way& way, std::vector<PassedLoop>& loops) const {
    const double low = std::min(way.flat_begin.x, way.flat_end.x),
                 high = std::max(way.flat_begin.x, way.flat_end.x);
    const auto add = [&](LoopId id, LoopId of, Bed bed) {
      const Loop& own = graph_.loop(of);
      const double x = own.slot * piece_.layout.slot_pitch;
      if (x <= low || x >= high) return;
      for (const PassedLoop& known : loops)
        if (known.loop == id) return;
      PassedLoop passed_loop;
      passed_loop.loop = id;
      passed_loop.slot = own.slot;
      passed_loop.bed = bed;
      loops.push_back(passed_loop);
    };
    const auto on_own_bed = graph_.loop(yarn_float.to).bed;
    const Loop& from = graph_.loop(yarn_float.from);
    if (std::abs(from.head_slot - from.slot) < 0.3) add(yarn_float.from, yarn_float.from, from.bed);
    const std::vector<LoopId>& parents = graph_.loop(yarn_float.to).parents;
    for (const LoopId parent : parents) add(parent, yarn_float.to, on_own_bed);
    // Loops of the same stack that the loop is not drawn through lay on the facing needle.
    if (parents.empty()) return;
    for (const LoopId other : stacks_[parents.front().position()])
      if (std::find(parents.begin(), parents.end(), other) == parents.end() && other < yarn_float.to)
        add(other, yarn_float.to, is_front(on_own_bed) ? Bed::back : Bed::front);
  }

  // Between the feet and the head of the held loop, in the share of that room that the order of events leaves
  // it.
  double height_on(LoopId held, const Rotation& turn, double line, double share) const {
    const Layout& layout = piece_.layout;
    const std::size_t i = held.position();
    const double count = static_cast<double>(std::max<std::size_t>(events_.of_loop[i].size(), 1));
    double low = turn.transposed(layout.lower[i]).y + 3.6 * sy_ * layout.y_scale_lower[i];
    double high = turn.transposed(layout.upper[i]).y - 4 * sy_ * layout.y_scale_upper[i];
    if (low > high) low = high = (low + high) / 2;
    const double centre = low + (high - low) * share, reach = 0.3 * (high - low) / count;
    return std::clamp(line, centre - reach, centre + reach);
  }

  bool lies_flat(LoopId id) const {
    const Vec3 step = piece_.layout.step(id);
    return step.y < 0.3 * std::abs(step.x);
  }
  // Where a held loop's legs are at height y.
  double leg_centre(LoopId held, const Rotation& turn, double y) const {
    const Vec3 low = turn.transposed(piece_.layout.lower[held.position()]);
    const Vec3 high = turn.transposed(piece_.layout.upper[held.position()]);
    const double share = high.y > low.y ? std::clamp((y - low.y) / (high.y - low.y), 0.0, 1.0) : 0.5;
    return low.x + (high.x - low.x) * share;
  }

  // No step longer than a wale, so that the curve does not swing out between far points.
  static std::vector<Vec3> fill(const std::vector<Vec3>& way, double longest) {
    std::vector<Vec3> filled{way.front()};
    for (std::size_t k = 1; k < way.size(); ++k) {
      const Vec3 from = way[k - 1], step = way[k] - from;
      const int parts = std::max(1, static_cast<int>(std::ceil(norm(step) / longest)));
      for (int part = 1; part <= parts; ++part)
        filled.push_back(from + step * (static_cast<double>(part) / parts));
    }
    return filled;
  }
  static std::size_t middle_of(const std::vector<Vec3>& way) {
    double whole = 0;
    for (std::size_t k = 1; k < way.size(); ++k) whole += distance(way[k - 1], way[k]);
    double gone = 0;
    for (std::size_t k = 1; k < way.size(); ++k) {
      const double step = distance(way[k - 1], way[k]);
      if (gone + step >= whole / 2) return whole / 2 - gone < step / 2 ? k - 1 : k;
      gone += step;
    }
    return way.size() - 1;
  }

  const YarnGraph& graph_;
  const GeometryOptions& options_;
  const std::vector<LoopSigns>& signs_;
  const Layout& flat_;
  const PlacedPiece& piece_;
  HeldEvents events_;
  std::vector<std::vector<LoopId>> stacks_;
  double r_, sx_, sy_;
};

}  // namespace

void place_sinkers(const YarnGraph& graph, const GeometryOptions& options,
                   const std::vector<LoopSigns>& signs, const Layout& flat, PlacedPiece& piece) {
  const SinkerPlacer placer(graph, options, signs, flat, piece);
  std::vector<std::vector<PlacedSinker>> sinkers(graph.yarns.size());
  for (std::size_t y = 0; y < graph.yarns.size(); ++y) {
    const GraphYarn& yarn = graph.yarns[y];
    if (yarn.loops.empty()) continue;
    sinkers[y].push_back(placer.end(yarn.loops.front(), true));
    for (std::size_t k = 0; k + 1 < yarn.loops.size(); ++k) {
      stop_if_told();
      sinkers[y].push_back(placer.between(static_cast<int>(y), static_cast<int>(k)));
    }
    sinkers[y].push_back(placer.end(yarn.loops.back(), false));
  }
  piece.sinkers = std::move(sinkers);
}

}  // namespace loopwright
