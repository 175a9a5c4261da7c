#include "geometry/interlacing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/stop.hpp"
#include "geometry/head_reading.hpp"
#include "geometry/loop_arcs.hpp"

namespace loopwright {
namespace {

// Points seen along the wale from its upper end: x and y in the picture, z the height up the wale.
class WaleSight {
 public:
  explicit WaleSight(const Vec3& wale) : up_(norm(wale) > 0 ? normalized(wale) : Vec3{0, 1, 0}) {
    const Vec3 aside = std::abs(up_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
    right_ = normalized(aside - up_ * dot(aside, up_));
    back_ = cross(up_, right_);
  }
  Vec3 seen(const Vec3& p) const { return {dot(p, right_), dot(p, back_), dot(p, up_)}; }

 private:
  Vec3 up_, right_, back_;
};

double turn(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// A loop's arc from sinker to sinker with a curtain that hangs down from it along the wale.
class Curtain {
 public:
  Curtain(const LoopArc& loop, const Vec3& wale) : sight_(wale) {
    for (int i = loop.begin; i <= loop.end; ++i) points_.push_back(sight_.seen(loop.yarn->at(i)));
    for (const Vec3& p : points_)
      for (int k = 0; k < 3; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
  }

  // Signed number of passes of a stretch of yarn: the crossings in the picture at which it is the lower one,
  // + where the arc crosses it from its right to its left. A corner on a line counts as to its left, so that
  // of the chords that share it one crosses.
  int passes(const SampledYarn& yarn, int first, int last, const Vec3& moved) const {
    int sum = 0;
    Vec3 p = sight_.seen(yarn.at(first) + moved);
    for (int i = first + 1; i <= last; ++i) {
      const Vec3 q = sight_.seen(yarn.at(i) + moved);
      if (may_pass(p, q)) sum += passes(p, q);
      p = q;
    }
    return sum;
  }

 private:
  bool may_pass(const Vec3& p, const Vec3& q) const {
    for (int k = 0; k < 2; ++k)
      if (std::max(p[k], q[k]) < low_[k] || std::min(p[k], q[k]) > high_[k]) return false;
    return std::min(p.z, q.z) < high_.z;
  }
  int passes(const Vec3& p, const Vec3& q) const {
    int sum = 0;
    double before = turn(p, q, points_.front());
    for (std::size_t k = 1; k < points_.size(); ++k) {
      const Vec3 &a = points_[k - 1], &b = points_[k];
      const double a_turn = before, b_turn = turn(p, q, b);
      before = b_turn;
      if ((a_turn >= 0) == (b_turn >= 0)) continue;
      const double p_turn = turn(a, b, p), q_turn = turn(a, b, q);
      if ((p_turn >= 0) == (q_turn >= 0)) continue;
      const double s = p_turn / (p_turn - q_turn), t = a_turn / (a_turn - b_turn);
      if (p.z + (q.z - p.z) * s < a.z + (b.z - a.z) * t) sum += b_turn > a_turn ? 1 : -1;
    }
    return sum;
  }

  static constexpr double infinity = std::numeric_limits<double>::infinity();
  WaleSight sight_;
  std::vector<Vec3> points_;
  Vec3 low_{infinity, infinity, infinity}, high_{-infinity, -infinity, -infinity};
};

// A parent, and a child at its lattice image.
class Pair {
 public:
  Pair(const LoopArcs& arcs, const Fabric& fabric, const PlacedInterlacing& interlacing,
       const LoopArc& parent, const LoopArc& child)
      : arcs_(arcs),
        parent_(parent),
        child_(child),
        moved_(fabric.lattice(interlacing.shift[0], interlacing.shift[1])),
        sense_(parent.direction == Direction::right ? interlacing.sign : -interlacing.sign),
        // A loop is drawn through one that was there before it: in one yarn that comes first.
        is_possible_(parent.yarn != child.yarn || fabric.periodic || parent.order < child.order) {
    // Where the loop before or after the child is the parent or is drawn through it as well, the reading ends
    // at the sinker between them.
    const auto is_related = [&](LoopImage beside) {
      beside.shift = {beside.shift[0] + interlacing.shift[0], beside.shift[1] + interlacing.shift[1]};
      return beside == LoopImage{interlacing.parent} ||
             std::find(parent.children.begin(), parent.children.end(), beside) != parent.children.end();
    };
    is_related_before_ = is_related(child.before), is_related_after_ = is_related(child.after);
    first_ = is_related_before_ ? child.begin : child.apex_before;
    last_ = is_related_after_ ? child.end : child.apex_after;
  }

  bool is_linked() const {
    return is_possible_ && passes_both_ways(Curtain(parent_, arcs_.wale_at(parent_)), first_, last_);
  }
  bool is_linked_in_head() const {
    return is_possible_ &&
           passes_head(arcs_, parent_, child_, moved_, sense_, !is_related_before_, !is_related_after_);
  }

 private:
  bool passes_both_ways(const Curtain& surface, int first, int last) const {
    return sense_ * surface.passes(*child_.yarn, first, child_.apex, moved_) == 1 &&
           sense_ * surface.passes(*child_.yarn, child_.apex, last, moved_) == -1;
  }

  const LoopArcs& arcs_;
  const LoopArc &parent_, &child_;
  Vec3 moved_;
  int sense_, first_ = 0, last_ = 0;
  bool is_possible_, is_related_before_ = false, is_related_after_ = false;
};

}  // namespace

InterlacingCheck check_interlacings(const Fabric& fabric) {
  InterlacingCheck check;
  check.expected = static_cast<int>(fabric.interlacings.size());
  const LoopArcs arcs(fabric);
  for (std::size_t k = 0; k < fabric.interlacings.size(); ++k) {
    stop_if_told();
    const PlacedInterlacing& interlacing = fabric.interlacings[k];
    const LoopArc *parent = arcs.find(interlacing.parent), *child = arcs.find(interlacing.child);
    bool is_intact = false;
    if (parent && child) {
      const Pair pair(arcs, fabric, interlacing, *parent, *child);
      is_intact = pair.is_linked();
      if (!is_intact && pair.is_linked_in_head()) is_intact = true, ++check.by_head;
    }
    if (is_intact)
      ++check.intact;
    else
      check.broken.push_back(static_cast<int>(k));
  }
  return check;
}

}  // namespace loopwright
