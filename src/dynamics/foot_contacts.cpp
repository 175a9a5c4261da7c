// Where the feet of loops touch the heads that they are drawn through, from the curves of a fabric.
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "dynamics/bindings.hpp"

namespace loopwright {
namespace {

constexpr int per_segment = 8;
// Of half a loop's own yarn, from its top: how much of it is head and upper leg, where children are drawn
// through; how far a foot reaches beyond the half; what lies above the feet's contacts.
constexpr double head_share = 0.68, foot_reach = 1.12, above_feet = 0.3;
constexpr double farthest_touch = 1.6, least_apart = 0.6;  // diameters

struct Sample {
  double t = 0;
  Vec3 place;
};

std::vector<Sample> samples(const SplineModel& model, std::span<const Vec3> place, int yarn, double begin,
                            double end) {
  std::vector<Sample> line;
  const int steps = std::max(2, static_cast<int>(std::ceil((end - begin) * per_segment)));
  for (int k = 0; k <= steps; ++k) {
    const double t = begin + (end - begin) * k / steps;
    line.push_back({t, curve_point(model, place, yarn, t).place});
  }
  return line;
}

struct Touch {
  YarnPlace child, parent;
  double distance = 0;
};

// Nearest approaches of two stretches of yarn: pairs of samples nearer to each other than all eight
// neighbouring pairs, nearest first.
std::vector<Touch> nearest_approaches(const std::vector<Sample>& child, int child_yarn,
                                      const std::vector<Sample>& parent, int parent_yarn) {
  const std::size_t n = child.size(), m = parent.size();
  std::vector<double> d(n * m);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j) d[i * m + j] = distance(child[i].place, parent[j].place);
  std::vector<Touch> found;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j) {
      bool least = true;
      for (std::size_t k = i > 0 ? i - 1 : 0; k <= std::min(i + 1, n - 1); ++k)
        for (std::size_t l = j > 0 ? j - 1 : 0; l <= std::min(j + 1, m - 1); ++l)
          if (d[k * m + l] < d[i * m + j]) least = false;
      // Pieces of one yarn next to each other along it do not touch.
      const bool own = child_yarn == parent_yarn && std::abs(child[i].t - parent[j].t) < 2;
      if (least && !own)
        found.push_back({{child_yarn, child[i].t}, {parent_yarn, parent[j].t}, d[i * m + j]});
    }
  std::sort(found.begin(), found.end(),
            [](const Touch& a, const Touch& b) { return a.distance < b.distance; });
  return found;
}

// Where one line crosses over the other as seen along z: a foot that is drawn through a head is seen behind
// its leg at one place and in front of its top at another.
std::vector<Touch> crossings(const std::vector<Sample>& child, int child_yarn,
                             const std::vector<Sample>& parent, int parent_yarn, double farthest) {
  std::vector<Touch> found;
  for (std::size_t i = 0; i + 1 < child.size(); ++i)
    for (std::size_t j = 0; j + 1 < parent.size(); ++j) {
      const Vec3 a = child[i + 1].place - child[i].place, b = parent[j + 1].place - parent[j].place,
                 r = parent[j].place - child[i].place;
      const double det = a.x * b.y - a.y * b.x;
      if (det == 0) continue;
      const double u = (r.x * b.y - r.y * b.x) / det, v = (r.x * a.y - r.y * a.x) / det;
      if (u < 0 || u >= 1 || v < 0 || v >= 1) continue;
      const double d = norm(child[i].place + u * a - parent[j].place - v * b);
      const double s = child[i].t + u * (child[i + 1].t - child[i].t),
                   t = parent[j].t + v * (parent[j + 1].t - parent[j].t);
      if (d < farthest && !(child_yarn == parent_yarn && std::abs(s - t) < 2))
        found.push_back({{child_yarn, s}, {parent_yarn, t}, d});
    }
  std::sort(found.begin(), found.end(),
            [](const Touch& a, const Touch& b) { return a.distance < b.distance; });
  return found;
}

}  // namespace

std::vector<Foot> feet(const Fabric& fabric) {
  std::unordered_map<LoopId, const LoopSpan*> spans;
  for (const LoopSpan& span : fabric.loops) spans[span.loop] = &span;
  std::vector<Foot> all;
  for (const PlacedInterlacing& interlacing : fabric.interlacings) {
    const auto parent = spans.find(interlacing.parent), child = spans.find(interlacing.child);
    if (parent == spans.end() || child == spans.end()) continue;
    const LoopSpan &p = *parent->second, &c = *child->second;
    // Half a loop's own yarn: floats beside it are left out.
    const double parent_half = std::min(p.apex - p.begin, p.end - p.apex),
                 child_half = std::min(c.apex - c.begin, c.end - c.apex);
    const auto end = static_cast<double>(fabric.yarns[static_cast<std::size_t>(c.yarn)].segments());
    for (const bool first_foot : {true, false}) {
      const double reach = std::min(first_foot ? c.apex - c.begin : c.end - c.apex, foot_reach * child_half);
      Foot foot{c.yarn, p.yarn, 0, 0, p.apex - head_share * parent_half, p.apex + head_share * parent_half};
      foot.begin = std::max(0.0, first_foot ? c.apex - reach : c.apex + above_feet * reach);
      foot.end = std::min(end, first_foot ? c.apex - above_feet * reach : c.apex + reach);
      all.push_back(foot);
    }
  }
  return all;
}

FootContacts foot_contacts(const SplineModel& model, std::span<const Vec3> place, const Foot& foot) {
  const std::vector<Sample> head = samples(model, place, foot.parent, foot.head_begin, foot.head_end),
                            line = samples(model, place, foot.child, foot.begin, foot.end);
  const SplineYarn& yarn = model.yarns[static_cast<std::size_t>(foot.child)];
  const double diameter = 0.5 * (yarn.diameter + model.yarns[static_cast<std::size_t>(foot.parent)].diameter);
  // Crossings first; where yarns lie side by side instead, the nearest approaches.
  std::vector<Touch> touches = crossings(line, foot.child, head, foot.parent, farthest_touch * diameter);
  const std::vector<Touch> approaches = nearest_approaches(line, foot.child, head, foot.parent);
  touches.insert(touches.end(), approaches.begin(), approaches.end());
  FootContacts contacts;
  for (const Touch& touch : touches) {
    if (!contacts.touch.empty()) {
      const auto& [a, b] = contacts.touch[0];
      const double apart = std::max(distance(curve_point(model, place, foot.child, touch.child.t).place,
                                             curve_point(model, place, foot.child, a.t).place),
                                    distance(curve_point(model, place, foot.parent, touch.parent.t).place,
                                             curve_point(model, place, foot.parent, b.t).place));
      if (touch.distance > farthest_touch * diameter || apart < least_apart * diameter) continue;
    }
    contacts.touch.emplace_back(touch.child, touch.parent);
    contacts.distance.push_back(touch.distance);
    if (contacts.touch.size() == 2) break;
  }
  return contacts;
}

}  // namespace loopwright
