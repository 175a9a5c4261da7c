#include "dynamics/bindings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace loopwright {
namespace {

// Weights of `count` control points of one yarn from `first` on, corrected by as little as possible so that
// they add up to 1 and give `place`: the barycentric coordinates nearest to the spline's own.
std::vector<double> barycentric_coordinates(std::span<const Vec3> points, std::vector<double> weights,
                                            const Vec3& place) {
  // Minimal |dw| with A dw = r, rows of A: ones and the coordinates about `place`; dw = A' (A A')^-1 r.
  std::array<std::array<double, 5>, 4> system{};
  const auto row = [&](std::size_t r, std::size_t i) {
    return r == 3 ? 1.0 : (points[i] - place)[static_cast<int>(r)];
  };
  double size = 0;
  for (std::size_t i = 0; i < points.size(); ++i) size += squared_norm(points[i] - place) + 1;
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t i = 0; i < points.size(); ++i) system[r][c] += row(r, i) * row(c, i);
    system[r][r] += 1e-12 * size;  // a straight or flat stretch of yarn reaches only its own line or plane
    system[r][4] = r == 3 ? 1 : 0;
    for (std::size_t i = 0; i < points.size(); ++i) system[r][4] -= row(r, i) * weights[i];
  }
  for (std::size_t k = 0; k < 4; ++k)  // positive definite: no pivoting
    for (std::size_t r = k + 1; r < 4; ++r) {
      const double f = system[r][k] / system[k][k];
      for (std::size_t c = k; c < 5; ++c) system[r][c] -= f * system[k][c];
    }
  std::array<double, 4> y{};
  for (std::size_t k = 4; k-- > 0;) {
    y[k] = system[k][4];
    for (std::size_t c = k + 1; c < 4; ++c) y[k] -= system[k][c] * y[c];
    y[k] /= system[k][k];
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t r = 0; r < 4; ++r) weights[i] += row(r, i) * y[r];
  return weights;
}

struct Side {
  int first = 0;
  std::vector<double> weights;
};

// The mean of the places' spline weights, over the control points of all of them and `more` on either side.
Side mean_weights(const SplineModel& model, std::span<const Vec3> place, const std::vector<YarnPlace>& places,
                  int more) {
  const SplineYarn& yarn = model.yarns[static_cast<std::size_t>(places.front().yarn)];
  int low = yarn.first + yarn.points, high = yarn.first;
  for (const YarnPlace& p : places) {
    const int first = curve_point(model, place, p.yarn, p.t).first;
    low = std::min(low, first - more);
    high = std::max(high, first + 3 + more);
  }
  low = std::max(low, yarn.first);
  high = std::min(high, yarn.first + yarn.points - 1);
  Side side{low, std::vector<double>(static_cast<std::size_t>(high - low + 1), 0.0)};
  for (const YarnPlace& p : places) {
    const CurvePoint c = curve_point(model, place, p.yarn, p.t);
    for (std::size_t i = 0; i < 4; ++i)
      side.weights[static_cast<std::size_t>(c.first - low) + i] +=
          c.weights.value[i] / static_cast<double>(places.size());
  }
  return side;
}

bool is_free(const SplineModel& model, int point) { return model.held[static_cast<std::size_t>(point)] == 0; }

bool moves(const SplineModel& model, std::span<const Vec3> place, const YarnPlace& at) {
  const int first = curve_point(model, place, at.yarn, at.t).first;
  for (int i = 0; i < 4; ++i)
    if (is_free(model, first + i)) return true;
  return false;
}

BarycentricBinding foot_binding(const SplineModel& model, std::span<const Vec3> place,
                                const FootContacts& foot) {
  std::vector<YarnPlace> child, parent;
  for (const auto& [a, b] : foot.touch) {
    child.push_back(a);
    parent.push_back(b);
  }
  // Enough of each yarn that it is bent out of a plane there.
  constexpr int more = 2;
  std::array<Side, 2> side{mean_weights(model, place, child, more), mean_weights(model, place, parent, more)};
  Vec3 middle;
  for (const Side& s : side)
    for (std::size_t i = 0; i < s.weights.size(); ++i)
      middle += 0.5 * s.weights[i] * place[static_cast<std::size_t>(s.first) + i];
  std::map<int, double> sum;
  for (std::size_t k = 0; k < 2; ++k) {
    const Side& s = side[k];
    const std::vector<double> w = barycentric_coordinates(
        place.subspan(static_cast<std::size_t>(s.first), s.weights.size()), s.weights, middle);
    for (std::size_t i = 0; i < w.size(); ++i) sum[s.first + static_cast<int>(i)] += k == 0 ? w[i] : -w[i];
  }
  return {{sum.begin(), sum.end()}};
}

}  // namespace

Vec3 BarycentricBinding::error(std::span<const Vec3> place) const {
  Vec3 sum;
  for (const auto& [point, w] : weights) sum += w * place[static_cast<std::size_t>(point)];
  return sum;
}

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
    const std::vector<double>& rest = model.yarns[y].rest_length;
    for (std::size_t k = 1; k < ends.size(); ++k) {
      const End &p = ends[k - 1], &q = ends[k];
      const double length = rest[std::min(static_cast<std::size_t>(p.t), rest.size() - 1)];
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

Bindings barycentric_bindings(const SplineModel& model, std::span<const Vec3> place,
                              std::span<const Foot> feet, double spring_stiffness) {
  Bindings bindings;
  for (const Foot& foot : feet) {
    const FootContacts contacts = foot_contacts(model, place, foot);
    if (contacts.touch.empty()) continue;
    BarycentricBinding binding = foot_binding(model, place, contacts);
    const bool any_free = std::any_of(binding.weights.begin(), binding.weights.end(), [&](const auto& w) {
      return is_free(model, w.first) && std::abs(w.second) > 1e-3;
    });
    if (!any_free) continue;
    bindings.barycentric.push_back(std::move(binding));
    for (std::size_t k = 0; k < contacts.touch.size(); ++k)
      bindings.springs.push_back(
          {contacts.touch[k].first, contacts.touch[k].second, contacts.distance[k], spring_stiffness});
  }
  return bindings;
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
