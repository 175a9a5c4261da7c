#include "experiments/curl.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace loopwright {
namespace {

constexpr int none = -1;

// Loops as a net: places and neighbours, by their index in Fabric::loops.
struct LoopNet {
  std::vector<Vec3> place;
  std::vector<int> left, right, below, above;

  static int reached(const std::vector<int>& way, std::size_t from, int steps) {
    int at = static_cast<int>(from);
    for (int k = 0; k < steps && at != none; ++k) at = way[static_cast<std::size_t>(at)];
    return at;
  }
};

Vec3 middle_of(const Fabric& fabric, const LoopSpan& span) {
  const FabricYarn& yarn = fabric.yarns[static_cast<std::size_t>(span.yarn)];
  constexpr int samples = 24;
  Vec3 sum;
  for (int k = 0; k < samples; ++k)
    sum += position(fabric, yarn, span.begin + (span.end - span.begin) * (k + 0.5) / samples);
  return sum / samples;
}

LoopNet net_of(const Fabric& fabric) {
  const std::size_t count = fabric.loops.size();
  LoopNet net;
  for (std::vector<int>* way : {&net.left, &net.right, &net.below, &net.above}) way->assign(count, none);
  std::map<LoopId, int> index;
  std::vector<int> order;
  for (std::size_t k = 0; k < count; ++k) {
    net.place.push_back(middle_of(fabric, fabric.loops[k]));
    index[fabric.loops[k].loop] = static_cast<int>(k);
    if (fabric.loops[k].kind != LoopKind::tuck) order.push_back(static_cast<int>(k));
  }
  // Neighbours in a course follow each other on a yarn that keeps its direction.
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const LoopSpan &p = fabric.loops[static_cast<std::size_t>(a)],
                   &q = fabric.loops[static_cast<std::size_t>(b)];
    return p.yarn != q.yarn ? p.yarn < q.yarn : p.apex < q.apex;
  });
  for (std::size_t k = 1; k < order.size(); ++k) {
    const auto a = static_cast<std::size_t>(order[k - 1]), b = static_cast<std::size_t>(order[k]);
    const LoopSpan &p = fabric.loops[a], &q = fabric.loops[b];
    if (p.yarn != q.yarn || p.direction != q.direction) continue;
    const bool rightward = p.direction == Direction::right;
    (rightward ? net.right : net.left)[a] = static_cast<int>(b);
    (rightward ? net.left : net.right)[b] = static_cast<int>(a);
  }
  for (const PlacedInterlacing& i : fabric.interlacings) {
    const auto parent = index.find(i.parent), child = index.find(i.child);
    if (parent == index.end() || child == index.end()) continue;
    net.above[static_cast<std::size_t>(parent->second)] = child->second;
    net.below[static_cast<std::size_t>(child->second)] = parent->second;
  }
  return net;
}

}  // namespace

std::vector<LoopCurvature> loop_curvatures(const Fabric& fabric, int apart) {
  if (apart < 1) throw std::invalid_argument("curvature needs loops that are one or more apart");
  const LoopNet net = net_of(fabric);
  std::vector<LoopCurvature> all;
  for (std::size_t k = 0; k < net.place.size(); ++k) {
    const int left = net.reached(net.left, k, apart), right = net.reached(net.right, k, apart),
              below = net.reached(net.below, k, apart), above = net.reached(net.above, k, apart);
    if (left == none || right == none || below == none || above == none) continue;
    const auto at = [&](int loop) { return net.place[static_cast<std::size_t>(loop)]; };
    const Vec3 course = at(right) - at(left), wale = at(above) - at(below), here = net.place[k];
    const Vec3 normal = normalized(cross(course, wale));
    const auto curvature = [&](const Vec3& a, const Vec3& b) {
      const double step = 0.5 * (distance(a, here) + distance(b, here));
      return dot(a - 2.0 * here + b, normal) / (step * step);
    };
    all.push_back({fabric.loops[k].loop, curvature(at(left), at(right)), curvature(at(below), at(above))});
  }
  return all;
}

Curl curl(const Fabric& fabric, int apart) {
  const std::vector<LoopCurvature> loops = loop_curvatures(fabric, apart);
  if (loops.empty())
    throw std::invalid_argument("curl needs loops with neighbours on every side: 5 x 5 at least");
  Curl mean;
  mean.loops = static_cast<int>(loops.size());
  double course2 = 0, wale2 = 0;
  for (const LoopCurvature& one : loops) {
    mean.course += one.course / mean.loops;
    mean.wale += one.wale / mean.loops;
    course2 += one.course * one.course / mean.loops;
    wale2 += one.wale * one.wale / mean.loops;
  }
  mean.course_error = std::sqrt(std::max(0.0, course2 - mean.course * mean.course) / mean.loops);
  mean.wale_error = std::sqrt(std::max(0.0, wale2 - mean.wale * mean.wale) / mean.loops);
  return mean;
}

}  // namespace loopwright
