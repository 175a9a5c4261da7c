// Sliding bindings of a fabric, and how far their places may go in a step.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "dynamics/bindings.hpp"

namespace loopwright {
namespace {

bool moves(const SplineModel& model, std::span<const Vec3> place, const YarnPlace& at) {
  const int first = curve_point(model, place, at.yarn, at.t).first;
  for (int i = 0; i < 4; ++i)
    if (model.held[static_cast<std::size_t>(first + i)] == 0) return true;
  return false;
}

}  // namespace

std::vector<SlideStop> slide_stops(const SplineModel& model, std::span<const SlidingBinding> bindings) {
  struct End {
    double t;
    std::size_t binding;
    bool is_a;
  };
  std::vector<std::vector<End>> on_yarn(model.yarns.size());
  for (std::size_t k = 0; k < bindings.size(); ++k)
    for (const bool is_a : {true, false}) {
      const YarnPlace& at = is_a ? bindings[k].a : bindings[k].b;
      on_yarn[static_cast<std::size_t>(at.yarn)].push_back({at.t, k, is_a});
    }
  std::vector<SlideStop> stops;
  for (std::size_t y = 0; y < on_yarn.size(); ++y) {
    std::vector<End>& ends = on_yarn[y];
    std::sort(ends.begin(), ends.end(), [](const End& p, const End& q) {
      return std::tie(p.t, p.binding, p.is_a) < std::tie(q.t, q.binding, q.is_a);
    });
    const auto diameter_of_other = [&](const End& end) {
      const SlidingBinding& binding = bindings[end.binding];
      return model.yarns[static_cast<std::size_t>(end.is_a ? binding.b.yarn : binding.a.yarn)].diameter;
    };
    for (std::size_t k = 1; k < ends.size(); ++k) {
      const End &p = ends[k - 1], &q = ends[k];
      const double length = model.yarns[y].rest_length_at(p.t);
      const double thickness = 0.5 * (diameter_of_other(p) + diameter_of_other(q)) / length;
      stops.push_back({p.binding, q.binding, p.is_a, q.is_a, std::min(thickness, q.t - p.t)});
    }
  }
  return stops;
}

void set_ranges(const SplineModel& model, std::span<const Vec3> place, std::span<const SlideStop> stops,
                std::span<SlidingBinding> bindings) {
  constexpr double most_slide = 0.25;   // in a step
  constexpr double least_valley = 0.3;  // of a valley's curvature across yarns that cross at right angles
  for (SlidingBinding& binding : bindings) {
    const CurvePoint a = curve_point(model, place, binding.a.yarn, binding.a.t),
                     b = curve_point(model, place, binding.b.yarn, binding.b.t);
    const Vec3 r = a.place - b.place;
    const double unit_s = squared_norm(a.slope), unit_t = squared_norm(b.slope);
    // The least curvature of 1/2 |r|^2 over arc lengths; where yarns wrap each other or lie side by side it
    // is all but flat.
    const double ss = 1 + dot(r, a.curve) / unit_s, tt = 1 - dot(r, b.curve) / unit_t,
                 st = -dot(a.slope, b.slope) / std::sqrt(unit_s * unit_t);
    const double least = 0.5 * (ss + tt) - std::hypot(0.5 * (ss - tt), st);
    const double drag = std::max(0.0, least_valley - least);
    binding.range_a = {binding.a.t - most_slide, binding.a.t + most_slide, binding.a.t, drag * unit_s};
    binding.range_b = {binding.b.t - most_slide, binding.b.t + most_slide, binding.b.t, drag * unit_t};
  }
  for (const SlideStop& stop : stops) {
    SlidingBinding &first = bindings[stop.first], &second = bindings[stop.second];
    SlideRange &low = stop.first_is_a ? first.range_a : first.range_b,
               &high = stop.second_is_a ? second.range_a : second.range_b;
    const double middle = 0.5 * (low.from + high.from);
    low.high = std::min(low.high, std::max(low.from, middle - 0.5 * stop.room));
    high.low = std::max(high.low, std::min(high.from, middle + 0.5 * stop.room));
  }
}
Bindings sliding_bindings(const SplineModel& model, std::span<const Vec3> place, std::span<const Foot> feet,
                          double friction) {
  constexpr double most_pull = 5;  // B/d^2: a loop of plain presses with about one
  Bindings bindings;
  std::vector<SlidingBinding>& all = bindings.sliding;
  for (const Foot& foot : feet)
    for (const auto& [a, b] : foot_contacts(model, place, foot).touch) {
      if (!moves(model, place, a) && !moves(model, place, b)) continue;
      SlidingBinding binding;
      binding.a = a;
      binding.b = b;
      binding.friction = friction;
      binding.most_pull = most_pull;
      all.push_back(binding);
    }
  // Downhill from where the yarns cross, as far as the neighbours let them: where a foot wraps a head, both
  // of its contacts would else end at one nearest approach, which holds neither side.
  constexpr int most_rounds = 100;
  constexpr double settled = 1e-6;
  bindings.guarded.assign(feet.begin(), feet.end());
  const std::vector<SlideStop> stops = slide_stops(model, all);
  double moved = 1;
  for (int round = 0; round < most_rounds && moved > settled; ++round) {
    moved = 0;
    set_ranges(model, place, stops, all);
    for (SlidingBinding& binding : all) {
      binding.distance = follow(model, place, binding).distance;
      moved = std::max({moved, std::abs(binding.a.t - binding.range_a.from),
                        std::abs(binding.b.t - binding.range_b.from)});
    }
  }
  return bindings;
}

}  // namespace loopwright
