#include "geometry/mend_crossings.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "geometry/fit_fabric.hpp"
#include "geometry/interlacing.hpp"
#include "geometry/type_points.hpp"
#include "geometry/window.hpp"
#include "topology/binding_points.hpp"

namespace loopwright {
namespace {

// Factors on what the template has at a binding point, and how far it turns toward the points beside it.
struct Change {
  double tilt = 1, height = 1, width = 1, turn = 0;
};

// Numbers in [0, 1) that are the same on every machine: splitmix64 (Steele, Lea, Flood, OOPSLA 2014).
class Draws {
 public:
  double next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
  }
  double between(double low, double high) { return low + (high - low) * next(); }

 private:
  std::uint64_t state_ = 0;
};

using Pair = std::pair<LoopId, LoopId>;
using Changes = std::map<int, Change>;  // by binding point

class Mender {
 public:
  Mender(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat, const Layout& layout)
      : graph_(graph), options_(options), flat_(flat), base_(layout), points_(binding_points(graph)) {}

  // Of the interlacings among the selected loops.
  std::set<Pair> wrong(const Layout& layout, const LoopSelection& part) const {
    const PlacedPiece piece = place_type_points(graph_, options_, flat_, layout);
    const Fabric fabric = fit_fabric(cut_window(graph_, options_, piece, part), graph_, options_);
    std::set<Pair> pairs;
    for (const int k : check_interlacings(fabric).broken) {
      const PlacedInterlacing& interlacing = fabric.interlacings[static_cast<std::size_t>(k)];
      pairs.insert({interlacing.parent, interlacing.child});
    }
    return pairs;
  }

  LoopSelection whole() const { return LoopSelection(graph_.loops.size(), 1); }
  // The loops round wrong pairs, as far as the check there looks.
  LoopSelection near(const std::set<Pair>& pairs) const {
    constexpr int along_wale = 3, along_yarn = 12;
    LoopSelection part(graph_.loops.size(), 0);
    std::vector<LoopId> reached;
    const auto reach = [&](LoopId id) {
      if (part[id.position()] != 0) return;
      part[id.position()] = 1;
      reached.push_back(id);
    };
    for (const Pair& pair : pairs) reach(pair.first), reach(pair.second);
    for (int step = 0; step < along_wale; ++step) {
      const std::vector<LoopId> last = reached;
      for (const LoopId id : last)
        for (const std::vector<LoopId>* list : {&graph_.loop(id).parents, &graph_.loop(id).children})
          for (const LoopId next : *list) reach(next);
    }
    const std::vector<LoopId> columns = reached;
    for (const LoopId id : columns) {
      const std::vector<LoopId>& yarn = graph_.yarns[graph_.loop(id).yarn.position()].loops;
      const int order = graph_.loop(id).order, last = static_cast<int>(yarn.size()) - 1;
      for (int k = std::max(0, order - along_yarn); k <= std::min(last, order + along_yarn); ++k)
        reach(yarn[static_cast<std::size_t>(k)]);
    }
    return part;
  }

  // The binding point where the two are interlaced, then the far ends of both.
  std::array<int, 3> points_of(const Pair& pair) const {
    return {points_.lower[pair.second.position()], points_.lower[pair.first.position()],
            points_.upper[pair.second.position()]};
  }

  Changes drawn(const std::set<Pair>& pairs) {
    Changes changes;
    for (const Pair& pair : pairs)
      for (const int point : points_of(pair)) {
        const bool is_crossing = point == points_of(pair).front();
        const Change change{draws_.between(0, 2), draws_.between(0.6, 1.5), draws_.between(0.7, 1.15),
                            is_crossing ? draws_.between(0, 1) : 0};
        if (is_crossing || draws_.next() < 0.5) changes.insert({point, change});
      }
    return changes;
  }

  Layout changed(const Layout& from, const Changes& changes) const {
    Layout layout = from;
    for (const auto& [point, change] : changes) {
      const BindingPoint& at = points_.points[static_cast<std::size_t>(point)];
      const Rotation turn = layout.is_flat() ? Rotation{} : turned(at, change.turn);
      for (const LoopId id : at.lower_of) {
        const std::size_t i = id.position();
        layout.y_scale_lower[i] = base_.y_scale_lower[i] * change.height;
        layout.x_scale_lower[i] = base_.x_scale_lower[i] * change.width;
        if (!layout.is_flat()) layout.turn_lower[i] = turn;
        if (!layout.tilt_lower.empty()) layout.tilt_lower[i] = times(base_.tilt_lower[i], change.tilt);
      }
      for (const LoopId id : at.upper_of) {
        const std::size_t i = id.position();
        layout.y_scale_upper[i] = base_.y_scale_upper[i] * change.height;
        layout.x_scale_upper[i] = base_.x_scale_upper[i] * change.width;
        if (!layout.is_flat()) layout.turn_upper[i] = turn;
        if (!layout.tilt_upper.empty()) layout.tilt_upper[i] = times(base_.tilt_upper[i], change.tilt);
      }
    }
    return layout;
  }

  // Changes that mended a pair and stand at no pair that was right before.
  Changes helpful(const Changes& changes, const std::set<Pair>& before, const std::set<Pair>& after) const {
    std::set<int> keep;
    for (const Pair& pair : before)
      if (after.count(pair) == 0)
        for (const int point : points_of(pair)) keep.insert(point);
    for (const Pair& pair : after)
      if (before.count(pair) == 0)
        for (const int point : points_of(pair)) keep.erase(point);
    Changes kept;
    for (const auto& [point, change] : changes)
      if (keep.count(point) > 0) kept.insert({point, change});
    return kept;
  }

  // Rounds of trials until all in `part` are right, or `most_in_vain` of them have not helped.
  void improve(Layout& layout, const LoopSelection& part, int most_in_vain, int& rounds) {
    std::set<Pair> left = wrong(layout, part);
    for (int in_vain = 0; !left.empty() && in_vain < most_in_vain; ++in_vain) {
      ++rounds;
      const Changes all = drawn(left);
      Layout trial = changed(layout, all);
      std::set<Pair> after = wrong(trial, part);
      const Changes some = helpful(all, left, after);
      if (some.empty()) continue;
      if (some.size() < all.size()) {
        trial = changed(layout, some);
        after = wrong(trial, part);
      }
      if (after.size() >= left.size()) continue;
      layout = std::move(trial);
      left = std::move(after);
      in_vain = 0;
    }
  }

 private:
  static CrossingTilt times(const CrossingTilt& tilt, double factor) {
    return {tilt.below * factor, tilt.above * factor};
  }
  // The turn of a binding point, and so many times the mean of those at the other ends of its loops.
  Rotation turned(const BindingPoint& at, double share) const {
    Rotation own, sum{{}, {}, {}};
    const double count = static_cast<double>(at.lower_of.size() + at.upper_of.size());
    const auto add = [&](const Rotation& turn, double weight) {
      sum.x += turn.x * weight, sum.y += turn.y * weight, sum.z += turn.z * weight;
    };
    for (const LoopId id : at.lower_of) {
      own = base_.turn_lower[id.position()];
      add(base_.turn_upper[id.position()], share / count);
    }
    for (const LoopId id : at.upper_of) {
      own = base_.turn_upper[id.position()];
      add(base_.turn_lower[id.position()], share / count);
    }
    add(own, 1);
    return mean_rotation(sum, own);
  }

  const YarnGraph& graph_;
  const GeometryOptions& options_;
  const Layout& flat_;
  const Layout base_;
  BindingPoints points_;
  Draws draws_;
};

}  // namespace

MendedLayout mended_layout(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                           Layout layout, int most_rounds) {
  Mender mender(graph, options, flat, layout);
  MendedLayout mended{std::move(layout)};
  std::set<Pair> left = mender.wrong(mended.layout, mender.whole());
  mended.wrong_before = static_cast<int>(left.size());
  // Trials look at the loops round the wrong ones, then the whole piece says what they came to: cut out,
  // yarns are sampled at other places, and a narrow pass may be seen otherwise. What is left after that is
  // tried on the whole piece.
  for (bool on_whole = false; !left.empty() && mended.rounds < most_rounds;) {
    Layout trial = mended.layout;
    mender.improve(trial, on_whole ? mender.whole() : mender.near(left),
                   std::max(on_whole ? 20 : 40, most_rounds / (on_whole ? 10 : 4)), mended.rounds);
    std::set<Pair> still = mender.wrong(trial, mender.whole());
    if (still.size() < left.size()) {
      mended.layout = std::move(trial);
      left = std::move(still);
    } else if (on_whole) {
      break;
    }
    on_whole = !on_whole;
  }
  mended.wrong = static_cast<int>(left.size());
  return mended;
}

int wrong_interlacings(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                       const Layout& layout) {
  const Mender mender(graph, options, flat, layout);
  return static_cast<int>(mender.wrong(layout, mender.whole()).size());
}

PlacedPiece mended_piece(const YarnGraph& graph, const GeometryOptions& options) {
  constexpr int most_trials = 60;  // a first geometry is to be had in seconds
  const Layout flat = lay_out(graph, options);
  return place_type_points(graph, options, flat,
                           mended_layout(graph, options, flat, flat, most_trials).layout);
}

}  // namespace loopwright
