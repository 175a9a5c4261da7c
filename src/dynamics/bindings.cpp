// Barycentric bindings with their orientation springs.
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

}  // namespace loopwright
