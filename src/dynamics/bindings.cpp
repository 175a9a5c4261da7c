#include "dynamics/bindings.hpp"

#include <algorithm>
#include <cmath>
#include <map>

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
  const double end_a = model.yarns[static_cast<std::size_t>(binding.a.yarn)].segments(),
               end_b = model.yarns[static_cast<std::size_t>(binding.b.yarn)].segments();
  ShortestConnection c;
  for (int step = 0;; ++step) {
    c.a = curve_point(model, place, binding.a.yarn, binding.a.t);
    c.b = curve_point(model, place, binding.b.yarn, binding.b.t);
    const Vec3 r = c.a.place - c.b.place;
    c.distance = norm(r);
    c.normal = c.distance > 0 ? r / c.distance : Vec3{0, 0, 1};
    if (step == most_steps) break;
    const double f_s = dot(r, c.a.slope), f_t = -dot(r, c.b.slope), f_st = -dot(c.a.slope, c.b.slope);
    const double first_s = squared_norm(c.a.slope), first_t = squared_norm(c.b.slope);
    double f_ss = first_s + dot(r, c.a.curve), f_tt = first_t - dot(r, c.b.curve);
    double det = f_ss * f_tt - f_st * f_st;
    // Not a valley in both directions: leave the curvature of the yarns out, then go downhill for sure.
    if (!(f_ss > 0.1 * first_s) || !(f_tt > 0.1 * first_t) || !(det > 1e-2 * f_ss * f_tt)) {
      f_ss = 1.1 * first_s;
      f_tt = 1.1 * first_t;
      det = f_ss * f_tt - f_st * f_st;
    }
    double ds = (-f_s * f_tt + f_t * f_st) / det, dt = (-f_t * f_ss + f_s * f_st) / det;
    const double largest = std::max(std::abs(ds), std::abs(dt));
    if (largest > most_slide) ds *= most_slide / largest, dt *= most_slide / largest;
    const double s = std::clamp(binding.a.t + ds, 0.0, end_a), t = std::clamp(binding.b.t + dt, 0.0, end_b);
    const double moved = std::max(std::abs(s - binding.a.t), std::abs(t - binding.b.t));
    binding.a.t = s;
    binding.b.t = t;
    if (moved < tolerance) break;
  }
  return c;
}

std::array<std::array<double, 24>, 24> distance_hessian(const ShortestConnection& c) {
  std::array<std::array<double, 24>, 24> h{};
  const Vec3& n = c.normal;
  const auto across = [&](const Vec3& v) { return (v - dot(v, n) * n) / c.distance; };  // (I - n n') v / D
  std::array<double, 8> w{};
  for (std::size_t k = 0; k < 4; ++k) {
    w[k] = c.a.weights.value[k];
    w[4 + k] = -c.b.weights.value[k];
  }
  const Vec3 pa = across(c.a.slope), pb = -across(c.b.slope);
  const double ss = dot(c.a.slope, pa) + dot(n, c.a.curve), tt = -dot(c.b.slope, pb) - dot(n, c.b.curve),
               st = dot(c.a.slope, pb), det = ss * tt - st * st;
  std::array<Vec3, 8> qs, qt;
  for (std::size_t k = 0; k < 8; ++k) {
    qs[k] = w[k] * pa + (k < 4 ? c.a.weights.slope[k] : 0) * n;
    qt[k] = w[k] * pb + (k < 4 ? 0 : -c.b.weights.slope[k - 4]) * n;
  }
  // Where the connection is not a strict minimum the free variables are taken as fixed.
  const bool follows = ss > 0 && tt > 0 && det > 1e-6 * ss * tt;
  for (std::size_t k = 0; k < 8; ++k)
    for (std::size_t l = 0; l < 8; ++l)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          double v = w[k] * w[l] * ((a == b ? 1 : 0) - n[a] * n[b]) / c.distance;
          if (follows)
            v -= (tt * qs[k][a] * qs[l][b] - st * (qs[k][a] * qt[l][b] + qt[k][a] * qs[l][b]) +
                  ss * qt[k][a] * qt[l][b]) /
                 det;
          h[3 * k + static_cast<std::size_t>(a)][3 * l + static_cast<std::size_t>(b)] = v;
        }
  return h;
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
  Bindings bindings;
  for (const Foot& foot : feet) {
    const FootContacts contacts = foot_contacts(model, place, foot);
    std::vector<SlidingBinding> own;
    for (const auto& [a, b] : contacts.touch) {
      if (!moves(model, place, a) && !moves(model, place, b)) continue;
      SlidingBinding binding;
      binding.a = a;
      binding.b = b;
      binding.friction = friction;
      binding.distance = follow(model, place, binding).distance;
      // Along one yarn the way downhill may lead both to one point: that is no touch.
      if (a.yarn == b.yarn && std::abs(binding.a.t - binding.b.t) < 2) continue;
      // Both may have slid to one nearest approach.
      constexpr double same = 0.75;  // segments
      const bool known = std::any_of(own.begin(), own.end(), [&](const SlidingBinding& other) {
        return std::abs(other.a.t - binding.a.t) < same && std::abs(other.b.t - binding.b.t) < same;
      });
      if (!known) own.push_back(binding);
    }
    bindings.sliding.insert(bindings.sliding.end(), own.begin(), own.end());
  }
  return bindings;
}

}  // namespace loopwright
