#include "geometry/loop_arcs.hpp"

#include <algorithm>
#include <cmath>

namespace loopwright {

SampledYarn::SampledYarn(const Fabric& fabric, const FabricYarn& yarn)
    : points_(polyline(fabric, yarn, per_segment)),
      periodic_(yarn.periodic),
      shift_(fabric.lattice(yarn.shift[0], yarn.shift[1])),
      per_length_(per_segment / yarn.segment_rest_length) {
  if (periodic_) points_.pop_back();
}

Vec3 SampledYarn::at(int i) const {
  const int n = size();
  if (!periodic_) return points_[static_cast<std::size_t>(std::clamp(i, 0, n - 1))];
  const int turns = i >= 0 ? i / n : -((n - 1 - i) / n);
  return points_[static_cast<std::size_t>(i - turns * n)] + shift_ * turns;
}

Vec3 centroid(const LoopArc& arc) {
  Vec3 sum;
  for (int i = arc.begin; i <= arc.end; ++i) sum += arc.yarn->at(i);
  return sum / (arc.end - arc.begin + 1);
}

LoopArcs::LoopArcs(const Fabric& fabric) {
  yarns_.reserve(fabric.yarns.size());
  for (const FabricYarn& yarn : fabric.yarns) yarns_.emplace_back(fabric, yarn);

  for (std::size_t first = 0; first < fabric.loops.size();) {
    std::size_t past = first;
    while (past < fabric.loops.size() && fabric.loops[past].yarn == fabric.loops[first].yarn) ++past;
    add_yarn(fabric, first, past);
    first = past;
  }
  for (const PlacedInterlacing& interlacing : fabric.interlacings)
    if (const auto parent = arcs_.find(interlacing.parent); parent != arcs_.end())
      parent->second.children.push_back({interlacing.child, interlacing.shift});

  std::vector<double> halves;
  for (const LoopSpan& span : fabric.loops)
    if (span.kind != LoopKind::tuck)
      halves.push_back(std::min(span.apex - span.begin, span.end - span.apex) *
                       fabric.yarns[static_cast<std::size_t>(span.yarn)].segment_rest_length);
  if (!halves.empty()) {
    const auto middle = halves.begin() + static_cast<std::ptrdiff_t>(halves.size() / 2);
    std::nth_element(halves.begin(), middle, halves.end());
    usual_half_ = *middle;
  }
  find_wales(fabric);
}

// The loops of one yarn: `first` to before `past` of Fabric::loops.
void LoopArcs::add_yarn(const Fabric& fabric, std::size_t first, std::size_t past) {
  const auto sample = [](double t) { return static_cast<int>(std::lround(t * SampledYarn::per_segment)); };
  const auto y = static_cast<std::size_t>(fabric.loops[first].yarn);
  const FabricYarn& yarn = fabric.yarns[y];
  const int round = yarns_[y].size();
  for (std::size_t k = first; k < past; ++k) {
    const LoopSpan& span = fabric.loops[k];
    LoopArc arc;
    arc.yarn = &yarns_[y];
    arc.order = static_cast<int>(k);
    arc.begin = sample(span.begin), arc.apex = sample(span.apex), arc.end = sample(span.end);
    arc.apex_before = arc.begin, arc.apex_after = arc.end;
    arc.direction = span.direction;
    arc.is_tuck = span.kind == LoopKind::tuck;
    // The yarn of a cell goes on in the next image.
    const bool is_first = k == first, is_last = k + 1 == past;
    if (!is_first || yarn.periodic) {
      const LoopSpan& before = fabric.loops[is_first ? past - 1 : k - 1];
      if (is_first) arc.before.shift = {-yarn.shift[0], -yarn.shift[1]};
      arc.before.loop = before.loop;
      if (before.course == span.course) arc.apex_before = sample(before.apex) - (is_first ? round : 0);
    }
    if (!is_last || yarn.periodic) {
      const LoopSpan& after = fabric.loops[is_last ? first : k + 1];
      if (is_last) arc.after.shift = yarn.shift;
      arc.after.loop = after.loop;
      if (after.course == span.course) arc.apex_after = sample(after.apex) + (is_last ? round : 0);
    }
    arcs_.emplace(span.loop, std::move(arc));
  }
}

const LoopArc* LoopArcs::find(LoopId loop) const {
  const auto found = arcs_.find(loop);
  return found == arcs_.end() ? nullptr : &found->second;
}

void LoopArcs::find_wales(const Fabric& fabric) {
  constexpr std::size_t neighbours = 8;
  const std::size_t n = fabric.loops.size();
  std::vector<Vec3> sums(n + 1);
  Vec3 whole;
  for (const PlacedInterlacing& interlacing : fabric.interlacings) {
    const LoopArc *parent = find(interlacing.parent), *child = find(interlacing.child);
    if (!parent || !child) continue;
    const Vec3 step =
        centroid(*child) + fabric.lattice(interlacing.shift[0], interlacing.shift[1]) - centroid(*parent);
    sums[static_cast<std::size_t>(parent->order) + 1] += step;
    whole += step;
  }
  for (std::size_t k = 0; k < n; ++k) sums[k + 1] += sums[k];
  if (norm(whole) > 0) whole = normalized(whole);
  wales_.resize(n);
  std::size_t yarn_begin = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (fabric.loops[k].yarn != fabric.loops[yarn_begin].yarn) yarn_begin = k;
    std::size_t last = k;
    while (last + 1 < n && last < k + neighbours && fabric.loops[last + 1].yarn == fabric.loops[k].yarn)
      ++last;
    const std::size_t first = std::max(yarn_begin, k > neighbours ? k - neighbours : 0);
    wales_[k] = sums[last + 1] - sums[first] + whole;
  }
}

}  // namespace loopwright
