#include "mechanics/binding_space.hpp"

#include <algorithm>
#include <unordered_map>

namespace loopwright {
namespace {

constexpr double foot = 0.25, head = 0.75;  // shares of half a loop from the middle of its sinker to its top

// Binding points of a loop: its feet's and its head's.
struct Ends {
  std::int32_t feet = 0, head = 0;
};

std::vector<Ends> ends_of_loops(const Fabric& fabric) {
  std::unordered_map<LoopId, std::size_t> place;
  const std::size_t n = fabric.loops.size();
  std::vector<Ends> ends(n);
  for (std::size_t k = 0; k < n; ++k) {
    place.emplace(fabric.loops[k].loop, k);
    ends[k] = {static_cast<std::int32_t>(k), static_cast<std::int32_t>(n + k)};
  }
  for (const PlacedInterlacing& i : fabric.interlacings) {
    const auto parent = place.find(i.parent), child = place.find(i.child);
    if (parent != place.end() && child != place.end()) ends[parent->second].head = ends[child->second].feet;
  }
  return ends;
}

void add(CoarseSpace::Row& row, std::int32_t point, double weight) {
  if (weight == 0) return;
  for (std::size_t k = 0; k < 4; ++k) {
    if (row.weight[k] != 0 && row.point[k] != point) continue;
    row.point[k] = point;
    row.weight[k] += weight;
    return;
  }
}

}  // namespace

CoarseSpace binding_space(const Fabric& fabric) {
  CoarseSpace space;
  if (fabric.loops.empty()) return space;
  const std::vector<Ends> ends = ends_of_loops(fabric);
  std::vector<std::vector<std::size_t>> on_yarn(fabric.yarns.size());
  for (std::size_t k = 0; k < fabric.loops.size(); ++k)
    on_yarn[static_cast<std::size_t>(fabric.loops[k].yarn)].push_back(k);

  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& yarn = fabric.yarns[y];
    auto& spans = on_yarn[y];
    std::sort(spans.begin(), spans.end(), [&fabric](std::size_t a, std::size_t b) {
      return fabric.loops[a].begin < fabric.loops[b].begin;
    });
    std::size_t at = 0;
    for (std::size_t i = 0; i < yarn.control_points.size(); ++i) {
      CoarseSpace::Row& row = space.rows.emplace_back();
      if (spans.empty() || (i < yarn.held.size() && yarn.held[i] != 0)) continue;
      const double t = static_cast<double>(i) - 1;  // where this control point weighs most
      while (at + 1 < spans.size() && t >= fabric.loops[spans[at + 1]].begin) ++at;
      const LoopSpan& s = fabric.loops[spans[at]];
      const bool before = t < s.apex;
      const double half = before ? s.apex - s.begin : s.end - s.apex;
      const double share = half > 0 ? std::clamp((before ? t - s.begin : s.end - t) / half, 0.0, 1.0) : 0;
      const Ends& own = ends[spans[at]];
      if (share >= foot) {
        const double up = std::min(1.0, (share - foot) / (head - foot));
        add(row, own.feet, 1 - up);
        add(row, own.head, up);
      } else {
        const bool first = at == 0, last = at + 1 == spans.size();
        const Ends& other = before ? (first ? own : ends[spans[at - 1]]) : (last ? own : ends[spans[at + 1]]);
        const double ours = 0.5 + 0.5 * share / foot;
        add(row, own.feet, ours);
        add(row, other.feet, 1 - ours);
      }
    }
  }
  space.points = static_cast<int>(2 * fabric.loops.size());
  space.drop_empty_columns();
  return space;
}

}  // namespace loopwright
