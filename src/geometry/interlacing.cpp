#include "geometry/interlacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <unordered_map>

#include "base/stop.hpp"

namespace loopwright {
namespace {

constexpr int samples_per_segment = 4;
// Of a loop's length, from its top: where the neck of its head is, how far its foot reaches, how far yarn may
// slide.
constexpr double neck = 0.38, foot_reach = 0.56, most_slide = 0.42, climb_window = 0.1, next_foot = 0.5;
constexpr double leaning_head = 0.15;
constexpr double tuck_skirt = 0.12;  // how far below a tuck its surface reaches

// One yarn as a polyline that can be asked beyond its ends where it is periodic.
class SampledYarn {
 public:
  SampledYarn(const Fabric& fabric, const FabricYarn& yarn)
      : points_(polyline(fabric, yarn, samples_per_segment)),
        periodic_(yarn.periodic),
        shift_(fabric.lattice(yarn.shift[0], yarn.shift[1])),
        length_(yarn.segment_rest_length) {
    if (periodic_) points_.pop_back();
  }
  Vec3 at(int i) const {
    const int n = static_cast<int>(points_.size());
    if (!periodic_) return points_[static_cast<std::size_t>(std::clamp(i, 0, n - 1))];
    const int turns = i >= 0 ? i / n : -((n - 1 - i) / n);
    return points_[static_cast<std::size_t>(i - turns * n)] + shift_ * turns;
  }
  int clamp(int i) const { return periodic_ ? i : std::clamp(i, 0, static_cast<int>(points_.size()) - 1); }
  int index(double t) const { return static_cast<int>(std::lround(t * samples_per_segment)); }
  double steps(double rest_length) const { return rest_length / length_ * samples_per_segment; }

 private:
  std::vector<Vec3> points_;
  bool periodic_;
  Vec3 shift_;
  double length_;
};

struct LoopWindow {
  const SampledYarn* yarn = nullptr;
  double loop = 0;                         // a loop's length in samples
  int begin = 0, apex = 0, end = 0;        // nominal, in samples
  double half_before = 0, half_after = 0;  // of the loop's own yarn, floats left out
  Direction direction = Direction::right;
  LoopId id, previous, next;  // itself and its neighbours in the yarn
  std::vector<LoopId> children;
  int order = 0;  // place in Fabric::loops
  bool tuck = false;
};

Vec3 centroid(const LoopWindow& window) {
  const int first = window.yarn->clamp(window.apex - static_cast<int>(window.half_before));
  const int last = window.yarn->clamp(window.apex + static_cast<int>(window.half_after));
  Vec3 sum;
  for (int i = first; i <= last; ++i) sum += window.yarn->at(i);
  return sum / (last - first + 1);
}

// Climbs along `up` from the nominal apex to the top of the head.
int top_of_head(const LoopWindow& window, const Vec3& up) {
  const int reach = std::max(2, static_cast<int>(climb_window * window.loop));
  const int limit = static_cast<int>(most_slide * window.loop);
  int top = window.apex;
  while (true) {
    int best = top;
    for (int i = top - reach; i <= top + reach; ++i) {
      const int k = window.yarn->clamp(i);
      if (std::abs(k - window.apex) > limit) continue;
      if (dot(up, window.yarn->at(k)) > dot(up, window.yarn->at(best)) + 1e-12) best = k;
    }
    if (best == top) return top;
    top = best;
  }
}

std::vector<Vec3> piece(const SampledYarn& yarn, int first, int last, const Vec3& moved) {
  std::vector<Vec3> points;
  first = yarn.clamp(first);
  last = yarn.clamp(last);
  for (int i = first; i <= last; ++i) points.push_back(yarn.at(i) + moved);
  return points;
}

// A closed polygon with a fan of triangles. Its centre is that of the head, where children are drawn through,
// so that the surface stays near the head's plane even where the legs lean away or change the side.
class Fan {
 public:
  explicit Fan(std::vector<Vec3> rim) : rim_(std::move(rim)), low_(rim_.front()), high_(rim_.front()) {
    for (const Vec3& p : rim_)
      for (int k = 0; k < 3; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
    const std::size_t legs = rim_.size() / 4;
    Vec3 sum;
    for (std::size_t i = legs; i < rim_.size() - legs; ++i) sum += rim_[i];
    centre_ = sum / static_cast<double>(rim_.size() - 2 * legs);
  }

  // Signed number of passes of the polyline; + along the right-hand normal of the rim's sense. A zero counts
  // as positive everywhere, by the same value for all triangles that share it, so that a pass through an edge
  // or a corner counts once.
  int passes(std::span<const Vec3> line) const {
    int sum = 0;
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      if (near(line[k], line[k + 1])) sum += passes(line[k], line[k + 1]);
    return sum;
  }

 private:
  bool near(const Vec3& p, const Vec3& q) const {
    for (int k = 0; k < 3; ++k)
      if (std::max(p[k], q[k]) < low_[k] || std::min(p[k], q[k]) > high_[k]) return false;
    return true;
  }
  int passes(const Vec3& p, const Vec3& q) const {
    const Vec3 along = q - p, spoke_normal = cross(along, centre_ - p);
    const auto spoke = [&](const Vec3& a) { return dot(spoke_normal, a - p) >= 0; };
    int sum = 0;
    bool before = spoke(rim_.back());
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      const Vec3& a = i > 0 ? rim_[i - 1] : rim_.back();
      const Vec3& b = rim_[i];
      const bool after = spoke(b);
      const bool spoke_a = before;
      before = after;
      if (spoke_a == after) continue;  // the line must see the two spokes on different sides
      const bool rim_side = dot(cross(along, a - p), b - p) >= 0;
      if (rim_side != spoke_a) continue;
      const Vec3 normal = cross(a - centre_, b - centre_);
      const bool p_above = dot(normal, p - centre_) >= 0, q_above = dot(normal, q - centre_) >= 0;
      if (p_above != q_above) sum += q_above ? 1 : -1;
    }
    return sum;
  }

  std::vector<Vec3> rim_;
  Vec3 low_, high_, centre_;
};

// The rim of a parent's head: its arc down to the neck. A tuck's arc is wide and may be drawn nearly
// straight, so that a chord would leave no surface: its rim goes round by way of two points below its ends,
// where the loop drawn through it passes.
std::vector<Vec3> rim_of(const LoopWindow& parent, int head, const Vec3& up) {
  const double neck_share = neck / 0.5;
  std::vector<Vec3> rim =
      piece(*parent.yarn, head - static_cast<int>(std::lround(neck_share * parent.half_before)),
            head + static_cast<int>(std::lround(neck_share * parent.half_after)), Vec3{});
  if (parent.tuck && norm(up) > 0) {
    const double spacing = distance(parent.yarn->at(head), parent.yarn->at(parent.yarn->clamp(head + 1)));
    const Vec3 down = normalized(up) * (-tuck_skirt * parent.loop * spacing);
    const Vec3 first = rim.front() + down, last = rim.back() + down;
    rim.push_back(last);
    rim.push_back(first);
  }
  return rim;
}

// With the parent's head at `head` and the top of the child's at `child_head`, in samples. A foot is followed
// to the middle of its sinker and, `beyond`, into the next loop's foot: where the parent's head was moved
// aside, the middle of the sinker lies between its legs, and only what comes after it is surely outside.
bool is_intact(const LoopWindow& parent, int head, const LoopWindow& child, int child_head, bool beyond,
               const Vec3& moved, int sign, const Vec3& skirt_up = {}) {
  const Fan fan(rim_of(parent, head, skirt_up));
  const int slide = child_head - child.apex;
  const double reach = foot_reach * child.loop, more = next_foot * child.loop;
  const auto related = [&](LoopId neighbour) {  // the parent itself, or drawn through it as well
    return neighbour == parent.id ||
           std::find(parent.children.begin(), parent.children.end(), neighbour) != parent.children.end();
  };
  const double before = beyond && !related(child.previous) ? more : 0,
               after = beyond && !related(child.next) ? more : 0;
  const int first =
      static_cast<int>(std::max(static_cast<double>(child.begin + slide), child_head - reach) - before);
  const int last =
      static_cast<int>(std::min(static_cast<double>(child.end + slide), child_head + reach) + after);
  // The normal that the sense of the yarn gives to the rim points to the front or to the rear.
  const int sense = parent.direction == Direction::left ? 1 : -1;
  return sense * fan.passes(piece(*child.yarn, first, child_head, moved)) == sign &&
         sense * fan.passes(piece(*child.yarn, child_head, last, moved)) == -sign;
}

// The wale direction at every loop: from loops to their children, averaged along the yarn, so that a single
// leaning loop (lace, cable) does not mislead, with a little of the whole piece's where there are few
// neighbours.
std::vector<Vec3> wale_directions(const Fabric& fabric,
                                  const std::unordered_map<LoopId, LoopWindow>& windows) {
  constexpr std::size_t neighbours = 8;
  const std::size_t n = fabric.loops.size();
  std::vector<Vec3> sums(n + 1);
  Vec3 whole;
  for (const PlacedInterlacing& interlacing : fabric.interlacings) {
    const auto parent = windows.find(interlacing.parent), child = windows.find(interlacing.child);
    if (parent == windows.end() || child == windows.end()) continue;
    const Vec3 step = centroid(child->second) + fabric.lattice(interlacing.shift[0], interlacing.shift[1]) -
                      centroid(parent->second);
    sums[static_cast<std::size_t>(parent->second.order) + 1] += step;
    whole += step;
  }
  for (std::size_t k = 0; k < n; ++k) sums[k + 1] += sums[k];
  if (norm(whole) > 0) whole = normalized(whole);
  std::vector<Vec3> directions(n);
  std::size_t yarn_begin = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (fabric.loops[k].yarn != fabric.loops[yarn_begin].yarn) yarn_begin = k;
    std::size_t last = k;
    while (last + 1 < n && last < k + neighbours && fabric.loops[last + 1].yarn == fabric.loops[k].yarn)
      ++last;
    const std::size_t first = std::max(yarn_begin, k > neighbours ? k - neighbours : 0);
    directions[k] = sums[last + 1] - sums[first] + whole;
  }
  return directions;
}

}  // namespace

InterlacingCheck check_interlacings(const Fabric& fabric) {
  InterlacingCheck check;
  check.expected = static_cast<int>(fabric.interlacings.size());
  std::vector<SampledYarn> yarns;
  for (const FabricYarn& yarn : fabric.yarns) yarns.emplace_back(fabric, yarn);

  // A loop's own half length: the shorter half of the median loop, so that floats do not count.
  std::vector<double> halves;
  for (const LoopSpan& span : fabric.loops)
    if (span.kind != LoopKind::tuck)
      halves.push_back(std::min(span.apex - span.begin, span.end - span.apex) *
                       fabric.yarns[static_cast<std::size_t>(span.yarn)].segment_rest_length);
  double half = 1;
  if (!halves.empty()) {
    const auto middle = halves.begin() + static_cast<std::ptrdiff_t>(halves.size() / 2);
    std::nth_element(halves.begin(), middle, halves.end());
    half = *middle;
  }

  std::unordered_map<LoopId, LoopWindow> windows;
  for (std::size_t k = 0; k < fabric.loops.size(); ++k) {
    const LoopSpan& span = fabric.loops[k];
    const SampledYarn& yarn = yarns[static_cast<std::size_t>(span.yarn)];
    LoopWindow window;
    window.yarn = &yarn;
    window.loop = 2 * yarn.steps(half);
    window.begin = yarn.index(span.begin);
    window.apex = yarn.index(span.apex);
    window.end = yarn.index(span.end);
    window.half_before = std::min<double>(window.apex - window.begin, window.loop / 2);
    window.half_after = std::min<double>(window.end - window.apex, window.loop / 2);
    window.direction = span.direction;
    window.order = static_cast<int>(k);
    window.tuck = span.kind == LoopKind::tuck;
    window.id = span.loop;
    if (k > 0 && fabric.loops[k - 1].yarn == span.yarn) window.previous = fabric.loops[k - 1].loop;
    if (k + 1 < fabric.loops.size() && fabric.loops[k + 1].yarn == span.yarn)
      window.next = fabric.loops[k + 1].loop;
    windows.emplace(span.loop, window);
  }
  for (const PlacedInterlacing& interlacing : fabric.interlacings)
    if (const auto parent = windows.find(interlacing.parent); parent != windows.end())
      parent->second.children.push_back(interlacing.child);
  const std::vector<Vec3> directions = wale_directions(fabric, windows);
  for (std::size_t k = 0; k < fabric.interlacings.size(); ++k) {
    stop_if_told();
    const PlacedInterlacing& interlacing = fabric.interlacings[k];
    const auto parent = windows.find(interlacing.parent), child = windows.find(interlacing.child);
    bool intact = parent != windows.end() && child != windows.end();
    if (intact) {
      const Vec3& up = directions[static_cast<std::size_t>(parent->second.order)];
      const Vec3& child_up = directions[static_cast<std::size_t>(child->second.order)];
      const Vec3 moved = fabric.lattice(interlacing.shift[0], interlacing.shift[1]);
      // Where the heads were fitted; if that is not it, yarn may have slid, and they are found anew.
      const LoopWindow &above = child->second, &below = parent->second;
      const int head = top_of_head(below, up), child_head = top_of_head(above, child_up);
      // Either may have slid without the other. Where a loop leans (lace) its top is not where its head is:
      // the parent's is looked for a little to both sides as well.
      const int aside = static_cast<int>(leaning_head * below.loop);
      const std::array<std::array<int, 2>, 8> readings{{{below.apex, above.apex},
                                                        {head, child_head},
                                                        {below.apex, child_head},
                                                        {head, above.apex},
                                                        {below.apex - aside, above.apex},
                                                        {below.apex + aside, above.apex},
                                                        {head - aside, child_head},
                                                        {head + aside, child_head}}};
      intact = false;
      for (const bool beyond : {false, true})
        for (const auto& [at, child_at] : readings)
          intact = intact || is_intact(below, at, above, child_at, beyond, moved, interlacing.sign) ||
                   (below.tuck && is_intact(below, at, above, child_at, beyond, moved, interlacing.sign, up));
    }
    if (intact)
      ++check.intact;
    else
      check.broken.push_back(static_cast<int>(k));
  }
  return check;
}

}  // namespace loopwright
