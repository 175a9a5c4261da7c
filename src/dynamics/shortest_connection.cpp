// The distance that a sliding binding holds: the nearest approach within its ranges, and its derivatives.
#include <algorithm>
#include <cmath>

#include "dynamics/bindings.hpp"

namespace loopwright {

ShortestConnection follow(const SplineModel& model, std::span<const Vec3> place, SlidingBinding& binding) {
  constexpr int most_steps = 30;
  constexpr double most_slide = 0.5, tolerance = 1e-12;
  const auto end_of = [&](int yarn) {
    return static_cast<double>(model.yarns[static_cast<std::size_t>(yarn)].segments());
  };
  const SlideRange &range_a = binding.range_a, &range_b = binding.range_b;
  const double low_s = std::max(0.0, range_a.low), high_s = std::min(range_a.high, end_of(binding.a.yarn)),
               low_t = std::max(0.0, range_b.low), high_t = std::min(range_b.high, end_of(binding.b.yarn));
  double &s = binding.a.t, &t = binding.b.t;
  s = std::clamp(s, low_s, high_s);
  t = std::clamp(t, low_t, high_t);
  ShortestConnection c;
  c.drag_a = range_a.drag;
  c.drag_b = range_b.drag;
  for (int step = 0;; ++step) {
    c.a = curve_point(model, place, binding.a.yarn, s);
    c.b = curve_point(model, place, binding.b.yarn, t);
    const Vec3 r = c.a.place - c.b.place;
    const double back_s = s - range_a.from, back_t = t - range_b.from;
    c.distance = std::sqrt(squared_norm(r) + c.drag_a * back_s * back_s + c.drag_b * back_t * back_t);
    c.normal = c.distance > 0 ? r / c.distance : Vec3{0, 0, 1};
    const double f_s = dot(r, c.a.slope) + c.drag_a * back_s, f_t = -dot(r, c.b.slope) + c.drag_b * back_t,
                 f_st = -dot(c.a.slope, c.b.slope);
    c.free_a = !(s <= low_s && f_s > 0) && !(s >= high_s && f_s < 0);
    c.free_b = !(t <= low_t && f_t > 0) && !(t >= high_t && f_t < 0);
    if (step == most_steps) break;
    const double first_s = squared_norm(c.a.slope), first_t = squared_norm(c.b.slope);
    double f_ss = first_s + dot(r, c.a.curve) + c.drag_a, f_tt = first_t - dot(r, c.b.curve) + c.drag_b;
    double det = f_ss * f_tt - f_st * f_st;
    // Not a valley in both directions: leave the curvature of the yarns out, then go downhill for sure.
    if (!(f_ss > 0.1 * first_s) || !(f_tt > 0.1 * first_t) || !(det > 1e-2 * f_ss * f_tt)) {
      f_ss = 1.1 * first_s + c.drag_a;
      f_tt = 1.1 * first_t + c.drag_b;
      det = f_ss * f_tt - f_st * f_st;
    }
    double ds = 0, dt = 0;
    if (c.free_a && c.free_b) {
      ds = (-f_s * f_tt + f_t * f_st) / det;
      dt = (-f_t * f_ss + f_s * f_st) / det;
    } else if (c.free_a) {
      ds = -f_s / f_ss;
    } else if (c.free_b) {
      dt = -f_t / f_tt;
    }
    const double largest = std::max(std::abs(ds), std::abs(dt));
    if (largest > most_slide) ds *= most_slide / largest, dt *= most_slide / largest;
    const double next_s = std::clamp(s + ds, low_s, high_s), next_t = std::clamp(t + dt, low_t, high_t);
    const double moved = std::max(std::abs(next_s - s), std::abs(next_t - t));
    s = next_s;
    t = next_t;
    if (moved < tolerance) break;
  }
  return c;
}

double off_by(const SlidingBinding& binding, const ShortestConnection& connection) {
  const double nearer = binding.distance - connection.distance;
  return binding.may_part() ? std::max(0.0, nearer) : std::abs(nearer);
}

std::array<std::array<double, 24>, 24> distance_hessian(const ShortestConnection& c) {
  // D = sqrt(2 F) with F = 1/2 |r|^2 + drags: D_qq = (F_qq - n n') / D, and F_qq less what s and t take.
  std::array<std::array<double, 24>, 24> h{};
  const Vec3 &n = c.normal, r = c.distance * n;
  std::array<double, 8> w{};
  for (std::size_t k = 0; k < 4; ++k) {
    w[k] = c.a.weights.value[k];
    w[4 + k] = -c.b.weights.value[k];
  }
  const double ss = squared_norm(c.a.slope) + dot(r, c.a.curve) + c.drag_a,
               tt = squared_norm(c.b.slope) - dot(r, c.b.curve) + c.drag_b, st = -dot(c.a.slope, c.b.slope);
  std::array<Vec3, 8> qs, qt;
  for (std::size_t k = 0; k < 8; ++k) {
    qs[k] = w[k] * c.a.slope + (k < 4 ? c.a.weights.slope[k] : 0) * r;
    qt[k] = -w[k] * c.b.slope + (k < 4 ? 0 : -c.b.weights.slope[k - 4]) * r;
  }
  // Inverse of the second derivative by what is free of s and t; where the connection is not a strict minimum
  // both are taken as fixed.
  double inverse_ss = 0, inverse_st = 0, inverse_tt = 0;
  const double det = ss * tt - st * st;
  if (c.free_a && c.free_b && ss > 0 && tt > 0 && det > 1e-6 * ss * tt) {
    inverse_ss = tt / det;
    inverse_st = -st / det;
    inverse_tt = ss / det;
  } else if (c.free_a && !c.free_b && ss > 0) {
    inverse_ss = 1 / ss;
  } else if (c.free_b && !c.free_a && tt > 0) {
    inverse_tt = 1 / tt;
  }
  for (std::size_t k = 0; k < 8; ++k)
    for (std::size_t l = 0; l < 8; ++l)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          h[3 * k + static_cast<std::size_t>(a)][3 * l + static_cast<std::size_t>(b)] =
              (w[k] * w[l] * ((a == b ? 1 : 0) - n[a] * n[b]) - inverse_ss * qs[k][a] * qs[l][b] -
               inverse_st * (qs[k][a] * qt[l][b] + qt[k][a] * qs[l][b]) - inverse_tt * qt[k][a] * qt[l][b]) /
              c.distance;
  return h;
}

}  // namespace loopwright
