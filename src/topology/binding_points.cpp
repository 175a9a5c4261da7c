#include "topology/binding_points.hpp"

#include <algorithm>
#include <numeric>

namespace loopwright {
namespace {

// Sets of places that are one site, each named by its smallest member.
class Sites {
 public:
  explicit Sites(std::size_t size) : above_(size) { std::iota(above_.begin(), above_.end(), std::size_t{0}); }

  std::size_t name(std::size_t k) {
    while (above_[k] != k) k = above_[k] = above_[above_[k]];
    return k;
  }
  void unite(std::size_t a, std::size_t b) {
    a = name(a);
    b = name(b);
    above_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> above_;
};

}  // namespace

BindingPoints binding_points(const YarnGraph& graph) {
  // Place 2k is O of loop k, 2k + 1 is its P; a child's O is where its parents' P are.
  const std::size_t loops = graph.loops.size();
  Sites sites(2 * loops);
  for (const Interlacing& i : graph.interlacings)
    sites.unite(2 * i.child.position(), 2 * i.parent.position() + 1);

  BindingPoints result;
  std::vector<int> number(2 * loops, -1);
  const auto point_of = [&](std::size_t place) {
    int& n = number[sites.name(place)];
    if (n < 0) {
      n = static_cast<int>(result.points.size());
      result.points.emplace_back();
    }
    return n;
  };
  for (std::size_t k = 0; k < loops; ++k) {
    result.lower.push_back(point_of(2 * k));
    result.upper.push_back(point_of(2 * k + 1));
    result.points[static_cast<std::size_t>(result.lower[k])].lower_of.push_back(LoopId(k));
    result.points[static_cast<std::size_t>(result.upper[k])].upper_of.push_back(LoopId(k));
  }
  for (BindingPoint& point : result.points) {
    const bool has_feet = !point.lower_of.empty();
    const Loop& loop = graph.loop(has_feet ? point.lower_of.front() : point.upper_of.front());
    point.slot = has_feet ? loop.slot : loop.head_slot;
    point.bed = has_feet ? loop.bed : loop.head_bed;
  }

  for (std::size_t k = 0; k < loops; ++k) {
    const Loop& loop = graph.loops[k];
    const LoopId id(k);
    const int lower = result.lower[k], upper = result.upper[k];
    result.bonding.push_back({BondingPoint{id, BondingPlace::bottom_left, loop.bed, lower},
                              BondingPoint{id, BondingPlace::top_left, loop.head_bed, upper},
                              BondingPoint{id, BondingPlace::top_right, loop.head_bed, upper},
                              BondingPoint{id, BondingPlace::bottom_right, loop.bed, lower}});
  }
  return result;
}

std::array<BondingPoint, 4> in_yarn_order(const BindingPoints& points, const YarnGraph& graph, LoopId loop) {
  std::array<BondingPoint, 4> order = points.bonding[loop.position()];
  if (graph.loop(loop).direction == Direction::left) std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace loopwright
