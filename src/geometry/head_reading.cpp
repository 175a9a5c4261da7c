#include "geometry/head_reading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace loopwright {
namespace {

// Of a loop's length, from its top: where the neck of its head is, how far its foot reaches, how far yarn may
// slide.
constexpr double neck = 0.38, foot_reach = 0.56, most_slide = 0.42, climb_window = 0.1, next_foot = 0.5;
constexpr double tuck_skirt = 0.12;  // how far below a tuck its surface reaches

// A loop's head closed across its neck, with a fan of triangles about its middle.
class Fan {
 public:
  explicit Fan(std::vector<Vec3> rim) : rim_(std::move(rim)) {
    // The middle of the head, where children are drawn through, so that the surface stays near the head's
    // plane even where the legs lean away or change the side.
    const std::size_t legs = rim_.size() / 4;
    for (std::size_t i = legs; i < rim_.size() - legs; ++i) centre_ += rim_[i];
    centre_ = centre_ / static_cast<double>(rim_.size() - 2 * legs);
  }

  // Signed number of passes, + against the right-hand normal of the rim's sense. A zero counts as positive
  // everywhere, by the same value for all triangles that share it, so that a pass through an edge or a corner
  // counts once.
  int passes(const SampledYarn& yarn, int first, int last, const Vec3& moved) const {
    int sum = 0;
    for (int i = first; i < last; ++i) sum += passes(yarn.at(i) + moved, yarn.at(i + 1) + moved);
    return sum;
  }

 private:
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
      if (p_above != q_above) sum += q_above ? -1 : 1;
    }
    return sum;
  }

  std::vector<Vec3> rim_;
  Vec3 centre_;
};

// A loop's length in samples, floats left out.
double loop_samples(const LoopArcs& arcs, const LoopArc& loop) {
  return 2 * arcs.usual_half() * loop.yarn->per_length();
}

// Climbs along `up` from the fitted apex to the top of the head.
int top_of_head(const LoopArc& arc, double loop, const Vec3& up) {
  const int reach = std::max(2, static_cast<int>(climb_window * loop));
  const int limit = static_cast<int>(most_slide * loop);
  int top = arc.apex;
  while (true) {
    int best = top;
    for (int i = top - reach; i <= top + reach; ++i)
      if (std::abs(i - arc.apex) <= limit && dot(up, arc.yarn->at(i)) > dot(up, arc.yarn->at(best)) + 1e-12)
        best = i;
    if (best == top) return top;
    top = best;
  }
}

// The rim of a parent's head: its arc down to the neck. A tuck's arc is wide and may be drawn nearly
// straight, so that a chord would leave no surface: with a skirt its rim goes round by way of two points
// below its ends, where the loop drawn through it passes.
std::vector<Vec3> rim_of(const LoopArc& parent, double loop, int head, bool with_skirt, const Vec3& up) {
  const auto reach = [&](int half) {
    return static_cast<int>(std::lround(neck / 0.5 * std::min<double>(half, loop / 2)));
  };
  std::vector<Vec3> rim;
  for (int i = head - reach(parent.apex - parent.begin); i <= head + reach(parent.end - parent.apex); ++i)
    rim.push_back(parent.yarn->at(i));
  if (with_skirt && norm(up) > 0) {
    const double spacing = distance(parent.yarn->at(head), parent.yarn->at(head + 1));
    const Vec3 down = normalized(up) * (-tuck_skirt * loop * spacing);
    const Vec3 first = rim.front() + down, last = rim.back() + down;
    rim.push_back(last);
    rim.push_back(first);
  }
  return rim;
}

}  // namespace

bool passes_head(const LoopArcs& arcs, const LoopArc& parent, const LoopArc& child, const Vec3& moved,
                 int sense, bool may_go_before, bool may_go_after) {
  const Vec3 &up = arcs.wale_at(parent), &child_up = arcs.wale_at(child);
  const double loop = loop_samples(arcs, parent), child_loop = loop_samples(arcs, child);
  const int head = top_of_head(parent, loop, up), child_head = top_of_head(child, child_loop, child_up);
  const auto passes_at = [&](int at, int child_at, bool beyond, bool with_skirt) {
    const Fan fan(rim_of(parent, loop, at, with_skirt, up));
    const int slide = child_at - child.apex;
    const double reach = foot_reach * child_loop, more = beyond ? next_foot * child_loop : 0;
    const int first = static_cast<int>(std::max<double>(child.begin + slide, child_at - reach) -
                                       (may_go_before ? more : 0));
    const int last =
        static_cast<int>(std::min<double>(child.end + slide, child_at + reach) + (may_go_after ? more : 0));
    return sense * fan.passes(*child.yarn, first, child_at, moved) == 1 &&
           sense * fan.passes(*child.yarn, child_at, last, moved) == -1;
  };
  // Either head may have slid without the other.
  const std::array<std::array<int, 2>, 4> readings{
      {{parent.apex, child.apex}, {head, child_head}, {parent.apex, child_head}, {head, child.apex}}};
  for (const bool beyond : {false, true})
    for (const auto& [at, child_at] : readings)
      if (passes_at(at, child_at, beyond, false) || (parent.is_tuck && passes_at(at, child_at, beyond, true)))
        return true;
  return false;
}

}  // namespace loopwright
