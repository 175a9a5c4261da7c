#include "geometry/centreline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace loopwright {
namespace {

std::vector<double> knots_for(const std::vector<Vec3>& points, Parametrisation parametrisation) {
  std::vector<double> knots{0};
  for (std::size_t k = 1; k < points.size(); ++k) {
    double step = 1;
    if (parametrisation == Parametrisation::chord_length) step = distance(points[k - 1], points[k]);
    if (parametrisation == Parametrisation::centripetal) step = std::sqrt(distance(points[k - 1], points[k]));
    if (!(step > 0) || !std::isfinite(step))
      throw std::invalid_argument("centreline: two points in a row coincide");
    knots.push_back(knots.back() + step);
  }
  return knots;
}

}  // namespace

std::vector<Vec3> solve_tridiagonal(std::vector<double> lower, std::vector<double> diagonal,
                                    std::vector<double> upper, std::vector<Vec3> right) {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    right[i] -= right[i - 1] * factor;
  }
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) right[i] -= right[i + 1] * upper[i];
    right[i] = right[i] / diagonal[i];
  }
  return right;
}

std::vector<Vec3> solve_cyclic_tridiagonal(std::vector<double> lower, std::vector<double> diagonal,
                                           std::vector<double> upper, std::vector<Vec3> right) {
  // Sherman-Morrison: the corners as a rank-one change of a tridiagonal matrix.
  const std::size_t n = diagonal.size();
  if (n < 3 || right.size() != n)
    throw std::invalid_argument("cyclic tridiagonal system: needs three rows or more");
  const double corner_low = lower[0], corner_high = upper[n - 1], gamma = -diagonal[0];
  diagonal[0] -= gamma;
  diagonal[n - 1] -= corner_low * corner_high / gamma;
  std::vector<Vec3> spike = right;
  std::fill(spike.begin(), spike.end(), Vec3{});
  spike[0].x = gamma;
  spike[n - 1].x = corner_high;
  std::vector<Vec3> x = solve_tridiagonal(lower, diagonal, upper, std::move(right));
  const std::vector<Vec3> z =
      solve_tridiagonal(std::move(lower), std::move(diagonal), std::move(upper), std::move(spike));
  if (x.size() != n || z.size() != n) return x;
  const Vec3 factor =
      (x[0] + x[n - 1] * (corner_low / gamma)) / (1 + z[0].x + z[n - 1].x * corner_low / gamma);
  for (std::size_t i = 0; i < n; ++i) x[i] -= factor * z[i].x;
  return x;
}

Centreline Centreline::open(const std::vector<Vec3>& points, Parametrisation parametrisation) {
  if (points.size() < 2) throw std::invalid_argument("centreline: needs at least two points");
  Centreline line;
  line.points_ = points;
  line.knots_ = knots_for(points, parametrisation);
  const std::size_t n = points.size();
  std::vector<double> lower(n, 0), diagonal(n, 1), upper(n, 0);
  std::vector<Vec3> right(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = line.knots_[i] - line.knots_[i - 1], after = line.knots_[i + 1] - line.knots_[i];
    lower[i] = before;
    diagonal[i] = 2 * (before + after);
    upper[i] = after;
    right[i] = ((points[i + 1] - points[i]) / after - (points[i] - points[i - 1]) / before) * 6;
  }
  line.curvature_ =
      solve_tridiagonal(std::move(lower), std::move(diagonal), std::move(upper), std::move(right));
  return line;
}

Centreline Centreline::periodic(const std::vector<Vec3>& points, const Vec3& shift,
                                Parametrisation parametrisation) {
  if (points.size() < 3)
    throw std::invalid_argument("centreline: a periodic curve needs at least three points");
  Centreline line;
  line.points_ = points;
  line.points_.push_back(points.front() + shift);
  line.knots_ = knots_for(line.points_, parametrisation);
  const std::size_t n = points.size();
  std::vector<double> lower(n), diagonal(n), upper(n);
  std::vector<Vec3> right(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t last = n - 1;
    const double before = i > 0 ? line.knots_[i] - line.knots_[i - 1] : line.knots_[n] - line.knots_[last];
    const double after = line.knots_[i + 1] - line.knots_[i];
    const Vec3 previous = i > 0 ? points[i - 1] : points[last] - shift;
    lower[i] = before;
    diagonal[i] = 2 * (before + after);
    upper[i] = after;
    right[i] = ((line.points_[i + 1] - points[i]) / after - (points[i] - previous) / before) * 6;
  }
  line.curvature_ =
      solve_cyclic_tridiagonal(std::move(lower), std::move(diagonal), std::move(upper), std::move(right));
  line.curvature_.push_back(line.curvature_.front());
  return line;
}

Vec3 Centreline::position(std::size_t piece, double u) const {
  const double h = knots_[piece + 1] - knots_[piece], v = 1 - u;
  return points_[piece] * v + points_[piece + 1] * u +
         (curvature_[piece] * (v * v * v - v) + curvature_[piece + 1] * (u * u * u - u)) * (h * h / 6);
}

Vec3 Centreline::derivative(std::size_t piece, double u) const {
  const double h = knots_[piece + 1] - knots_[piece], v = 1 - u;
  return (points_[piece + 1] - points_[piece]) / h +
         (curvature_[piece] * (1 - 3 * v * v) + curvature_[piece + 1] * (3 * u * u - 1)) * (h / 6);
}

Vec3 Centreline::second_derivative(std::size_t piece, double u) const {
  return curvature_[piece] * (1 - u) + curvature_[piece + 1] * u;
}

double Centreline::arc_length(std::size_t piece) const {
  // Gauss-Legendre nodes and weights of order 8 on [-1, 1], Abramowitz and Stegun table 25.4
  constexpr std::array<double, 4> node{0.183434642495650, 0.525532409916329, 0.796666477413627,
                                       0.960289856497536};
  constexpr std::array<double, 4> weight{0.362683783378362, 0.313706645877887, 0.222381034453374,
                                         0.101228536290376};
  double length = 0;
  for (std::size_t g = 0; g < node.size(); ++g)
    for (const double sign : {-1.0, 1.0})
      length += weight[g] / 2 * norm(derivative(piece, (1 + sign * node[g]) / 2));
  return length * (knots_[piece + 1] - knots_[piece]);
}

double Centreline::arc_length() const {
  double length = 0;
  for (std::size_t k = 0; k < pieces(); ++k) length += arc_length(k);
  return length;
}

}  // namespace loopwright
