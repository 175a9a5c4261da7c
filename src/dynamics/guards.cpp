// Guards: bindings that only press, where a foot and the head that it is drawn through come near each other
// beside their bindings.
#include <algorithm>
#include <cmath>

#include "dynamics/bindings.hpp"

namespace loopwright {
namespace {

constexpr int per_segment = 3;
constexpr double beyond = 1.5;  // segments past the foot and past the head
// Of the mean diameter: nearer a guard is set, farther it is taken away again.
constexpr double near = 1.15, far = 1.3;
constexpr double own = 0.4;  // diameters on both yarns: there a binding has the approach already

struct Line {
  double begin = 0;
  std::vector<Vec3> place;
  double parameter(std::size_t i) const { return begin + static_cast<double>(i) / per_segment; }
};

Line line(const SplineModel& model, std::span<const Vec3> place, int yarn, double begin, double end) {
  const double last = model.yarns[static_cast<std::size_t>(yarn)].segments();
  Line l;
  l.begin = std::max(0.0, begin - beyond);
  const auto steps = static_cast<int>((std::min(last, end + beyond) - l.begin) * per_segment);
  for (int k = 0; k <= steps; ++k)
    l.place.push_back(curve_point(model, place, yarn, l.parameter(static_cast<std::size_t>(k))).place);
  return l;
}

bool is_near(const SplineModel& model, const YarnPlace& p, const YarnPlace& q, double distance) {
  return p.yarn == q.yarn &&
         std::abs(p.t - q.t) * model.yarns[static_cast<std::size_t>(p.yarn)].rest_length_at(p.t) < distance;
}

}  // namespace

void update_guards(const SplineModel& model, std::span<const Vec3> place, std::span<const Foot> feet,
                   std::vector<SlidingBinding>& bindings) {
  const auto thickness = [&](const YarnPlace& a, const YarnPlace& b) {
    return 0.5 * (model.yarns[static_cast<std::size_t>(a.yarn)].diameter +
                  model.yarns[static_cast<std::size_t>(b.yarn)].diameter);
  };
  std::erase_if(bindings, [&](const SlidingBinding& binding) {
    return binding.guard && binding.multiplier == 0 &&
           distance(curve_point(model, place, binding.a.yarn, binding.a.t).place,
                    curve_point(model, place, binding.b.yarn, binding.b.t).place) >
               far * thickness(binding.a, binding.b);
  });
  for (const Foot& foot : feet) {
    const Line child = line(model, place, foot.child, foot.begin, foot.end),
               parent = line(model, place, foot.parent, foot.head_begin, foot.head_end);
    const std::size_t n = child.place.size(), m = parent.place.size();
    const auto d2 = [&](std::size_t i, std::size_t j) {
      return squared_norm(child.place[i] - parent.place[j]);
    };
    const double diameter = thickness({foot.child, 0}, {foot.parent, 0});
    const double reach = near * diameter + 0.1;  // samples miss the nearest places
    // Ends are left out: beyond them the approach may go on.
    for (std::size_t i = 1; i + 1 < n; ++i)
      for (std::size_t j = 1; j + 1 < m; ++j) {
        const double here = d2(i, j);
        if (here > reach * reach) continue;
        bool least = true;
        for (std::size_t k = i - 1; k <= i + 1 && least; ++k)
          for (std::size_t l = j - 1; l <= j + 1 && least; ++l) least = d2(k, l) >= here;
        if (!least) continue;
        SlidingBinding guard;
        guard.guard = true;
        guard.a = {foot.child, child.parameter(i)};
        guard.b = {foot.parent, parent.parameter(j)};
        if (foot.child == foot.parent && std::abs(guard.a.t - guard.b.t) < 2) continue;
        guard.range_a = {guard.a.t - 1.0 / per_segment, guard.a.t + 1.0 / per_segment, guard.a.t, 0};
        guard.range_b = {guard.b.t - 1.0 / per_segment, guard.b.t + 1.0 / per_segment, guard.b.t, 0};
        const double nearest = follow(model, place, guard).distance;
        if (nearest > near * diameter) continue;
        guard.distance = guard.full_distance = std::min(nearest, diameter);
        const bool known = std::any_of(bindings.begin(), bindings.end(), [&](const SlidingBinding& other) {
          return (is_near(model, guard.a, other.a, own * diameter) &&
                  is_near(model, guard.b, other.b, own * diameter)) ||
                 (is_near(model, guard.a, other.b, own * diameter) &&
                  is_near(model, guard.b, other.a, own * diameter));
        });
        if (known) continue;
        for (const SlidingBinding& other : bindings)
          if (!other.guard && other.a.yarn == guard.a.yarn && other.b.yarn == guard.b.yarn &&
              std::abs(other.a.t - guard.a.t) + std::abs(other.b.t - guard.b.t) < 3)
            guard.friction = other.friction;
        bindings.push_back(guard);
      }
  }
}

}  // namespace loopwright
