#include "geometry/sinkers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/held_events.hpp"

namespace loopwright {
namespace {

constexpr double float_gap = 2.2;  // between a float and what it passes, in r

struct Pass {
  double x = 0, y = 0, z = 0;
};

class SinkerPlacer {
 public:
  SinkerPlacer(const YarnGraph& graph, const GeometryOptions& options, const std::vector<LoopSigns>& signs,
               const PlacedPiece& piece)
      : graph_(graph),
        options_(options),
        signs_(signs),
        piece_(piece),
        events_(held_events(graph)),
        stacks_(stacks_of_heads(graph)),
        r_(options.shape_radius()),
        sx_(options.wale_pitch / 8),
        sy_(options.course_pitch / 7) {}

  PlacedSinker end(LoopId id, bool first) const {
    const double side = first ? entry_side(id) : exit_side(id);
    PlacedSinker sinker;
    const TypePoint near = point(id, LoopPart::span, hanging(id, side));
    const TypePoint last = point(id, LoopPart::sinker, near.position + Vec3{side * sx_, -0.5 * sy_, 0});
    sinker.points = first ? std::vector<TypePoint>{last, near} : std::vector<TypePoint>{near, last};
    sinker.middle = first ? 0 : 1;
    return sinker;
  }

  PlacedSinker between(int yarn, int gap) const {
    const Float& yarn_float =
        graph_.yarns[static_cast<std::size_t>(yarn)].floats[static_cast<std::size_t>(gap)];
    const LoopId from = yarn_float.from, to = yarn_float.to;
    const Vec3 begin = hanging(from, exit_side(from)), end_point = hanging(to, entry_side(to));
    PlacedSinker sinker;
    sinker.extra_length = extra_length(graph_.loop(from), graph_.loop(to));
    std::vector<Pass> passes;
    const double pitch = 8 * sx_;
    const bool short_span = std::abs(end_point.x - begin.x) < 0.75 * pitch;
    if (!short_span) passes = passed(yarn, gap, begin, end_point);
    if (short_span) {
      Vec3 middle = (begin + end_point) / 2;
      // Between two loops that go through one head both ways the sinker goes round that head's leg, below it.
      const Loop &first = graph_.loop(from), &second = graph_.loop(to);
      const bool both_ways =
          first.side != second.side &&
          std::find_first_of(first.parents.begin(), first.parents.end(), second.parents.begin(),
                             second.parents.end()) != first.parents.end();
      if (both_ways) middle.y -= 2 * sy_;
      // A turn at a selvedge swings out a little.
      if (exit_side(from) == entry_side(to)) middle.x += exit_side(from) * 0.5 * sx_;
      sinker.points = {point(from, LoopPart::sinker, middle)};
      return sinker;
    }
    std::vector<Vec3> way{begin};
    for (const Pass& pass : passes) {
      const double ahead = end_point.x > begin.x ? 1 : -1;
      for (const double side : {-ahead, ahead}) way.push_back({pass.x + side * 2.6 * sx_, pass.y, pass.z});
    }
    way.push_back(end_point);
    way = fill(way, pitch);
    sinker.middle = middle_of(way);
    for (std::size_t k = 0; k < way.size(); ++k)
      sinker.points.push_back(point(from, k == sinker.middle ? LoopPart::sinker : LoopPart::span, way[k]));
    return sinker;
  }

 private:
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
  Vec3 hanging(LoopId id, double side) const {
    const std::size_t i = id.position();
    const LoopSigns& sign = signs_[i];
    // Where the foot reaches behind several heads, the sinker does not come back in between them.
    const double foot = sign.s * sign.foot + 0.6;
    const double z = sign.s * std::min(sign.s * sign.foot_layer - 1.5, foot);
    return piece_.layout.lower[i] + Vec3{4 * side * sx_, -3 * sy_ * piece_.layout.y_scale_lower[i], z * r_};
  }

  double extra_length(const Loop& from, const Loop& to) const {
    const double missed = std::max(0.0, std::abs(to.slot - from.slot) - 1);
    const double change = is_front(from.bed) == is_front(to.bed) ? 0 : options_.bed_change;
    return missed * options_.needle_pitch * (1 + options_.float_slack) + change;
  }

  // Lowest and highest z near height y of what belongs to a held loop: its legs, the head below, the feet
  // above.
  void z_range(LoopId held, double y, double& low, double& high) const {
    const double window = 2.5 * sy_;
    const auto take = [&](const PlacedLoop& loop) {
      for (std::size_t k = 0; k + 1 < loop.points.size(); ++k)
        for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          const Vec3 p = loop.points[k].position * (1 - u) + loop.points[k + 1].position * u;
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

  std::vector<Pass> passed(int yarn, int gap, const Vec3& begin, const Vec3& end_point) const {
    const Float& yarn_float =
        graph_.yarns[static_cast<std::size_t>(yarn)].floats[static_cast<std::size_t>(gap)];
    std::vector<PassedLoop> loops = yarn_float.passed;
    add_own_wales(yarn_float, begin, end_point, loops);
    const double pitch = 8 * sx_, ahead = end_point.x > begin.x ? 1 : -1;
    const double margin = 0.3 * pitch;
    std::stable_sort(loops.begin(), loops.end(), [&](const PassedLoop& a, const PassedLoop& b) {
      return ahead * a.slot < ahead * b.slot;
    });
    std::vector<Pass> passes;
    for (std::size_t k = 0; k < loops.size();) {
      std::size_t next = k;
      double front_bound = std::numeric_limits<double>::infinity(), back_bound = -front_bound;
      double y_sum = 0, x_sum = 0;
      while (next < loops.size() && std::abs(loops[next].slot - loops[k].slot) < 0.3) {
        const PassedLoop& held = loops[next++];
        const double x = held.slot * piece_.layout.slot_pitch;
        const double line =
            begin.y + (end_point.y - begin.y) * std::clamp((x - begin.x) / (end_point.x - begin.x), 0.0, 1.0);
        const double share = events_.share_of_float(held.loop, yarn, gap);
        const double y = lies_flat(held.loop) ? line : height_on(held.loop, line, share);
        y_sum += y;
        x_sum += leg_centre(held, y);
        double low = std::numeric_limits<double>::infinity(), high = -low;
        z_range(held.loop, y, low, high);
        if (low > high) low = high = piece_.layout.lower[held.loop.position()].z;
        if (is_front(held.bed)) front_bound = std::min(front_bound, low - float_gap * r_);
        if (!is_front(held.bed)) back_bound = std::max(back_bound, high + float_gap * r_);
      }
      const double count = static_cast<double>(next - k);
      k = next;
      Pass pass;
      pass.x = x_sum / count;
      pass.y = y_sum / count;
      const bool fronts = std::isfinite(front_bound), backs = std::isfinite(back_bound);
      pass.z = fronts && backs ? (front_bound + back_bound) / 2 : fronts ? front_bound : back_bound;
      if (ahead * (pass.x - begin.x) > margin && ahead * (end_point.x - pass.x) > margin)
        passes.push_back(pass);
    }
    return passes;
  }

  // A float that leaves or enters on the far side also passes the wale of its own loop.
  void add_own_wales(const Float& yarn_float, const Vec3& begin, const Vec3& end_point,
                     std::vector<PassedLoop>& loops) const {
    const double low = std::min(begin.x, end_point.x), high = std::max(begin.x, end_point.x);
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
  double height_on(LoopId held, double line, double share) const {
    const std::size_t i = held.position();
    const double count = static_cast<double>(std::max<std::size_t>(events_.of_loop[i].size(), 1));
    double low = piece_.layout.lower[i].y + 3.6 * sy_ * piece_.layout.y_scale_lower[i];
    double high = piece_.layout.upper[i].y - 4 * sy_ * piece_.layout.y_scale_upper[i];
    if (low > high) low = high = (low + high) / 2;
    const double centre = low + (high - low) * share, reach = 0.3 * (high - low) / count;
    return std::clamp(line, centre - reach, centre + reach);
  }

  bool lies_flat(LoopId id) const {
    const Vec3 step = piece_.layout.upper[id.position()] - piece_.layout.lower[id.position()];
    return step.y < 0.3 * std::abs(step.x);
  }
  // Where a held loop's legs are at height y; a loop that lies flat is passed at the needle.
  double leg_centre(const PassedLoop& held, double y) const {
    const Vec3& low = piece_.layout.lower[held.loop.position()];
    const Vec3& high = piece_.layout.upper[held.loop.position()];
    if (lies_flat(held.loop)) return held.slot * piece_.layout.slot_pitch;
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
  const PlacedPiece& piece_;
  HeldEvents events_;
  std::vector<std::vector<LoopId>> stacks_;
  double r_, sx_, sy_;
};

}  // namespace

void place_sinkers(const YarnGraph& graph, const GeometryOptions& options,
                   const std::vector<LoopSigns>& signs, PlacedPiece& piece) {
  const SinkerPlacer placer(graph, options, signs, piece);
  std::vector<std::vector<PlacedSinker>> sinkers(graph.yarns.size());
  for (std::size_t y = 0; y < graph.yarns.size(); ++y) {
    const GraphYarn& yarn = graph.yarns[y];
    if (yarn.loops.empty()) continue;
    sinkers[y].push_back(placer.end(yarn.loops.front(), true));
    for (std::size_t k = 0; k + 1 < yarn.loops.size(); ++k)
      sinkers[y].push_back(placer.between(static_cast<int>(y), static_cast<int>(k)));
    sinkers[y].push_back(placer.end(yarn.loops.back(), false));
  }
  piece.sinkers = std::move(sinkers);
}

}  // namespace loopwright
