// The inverse problem: control points of the NURBS curve through given points.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "loop_scale/nurbs.hpp"

namespace loopwright {
namespace {

constexpr std::size_t room = NurbsCurve::most_degree + 1;

// Values of the degree + 1 basis functions that do not vanish on a span (Cox and de Boor; The NURBS Book,
// A2.2).
std::array<double, room> basis(const std::vector<double>& knots, std::size_t span, std::size_t p, double u) {
  std::array<double, room> n{}, left{}, right{};
  n[0] = 1;
  for (std::size_t j = 1; j <= p; ++j) {
    left[j] = u - knots[span + 1 - j];
    right[j] = knots[span + j] - u;
    double saved = 0;
    for (std::size_t r = 0; r < j; ++r) {
      const double part = n[r] / (right[r + 1] + left[j - r]);
      n[r] = saved + right[r + 1] * part;
      saved = left[j - r] * part;
    }
    n[j] = saved;
  }
  return n;
}

// Rows of a banded system, solved without exchanging rows: collocation matrices of B-splines are totally
// positive, for which that is stable (de Boor and Pinkus, 1977).
class BandedSystem {
 public:
  BandedSystem(std::size_t rows, std::size_t half_width)
      : rows_(rows), half_(half_width), band_((2 * half_width + 1) * rows) {}

  void set(std::size_t row, std::size_t column, double value) {
    band_[row * (2 * half_ + 1) + column + half_ - row] = value;
  }
  std::vector<Vec3> solve(std::vector<Vec3> right) {
    for (std::size_t k = 0; k < rows_; ++k)
      for (std::size_t i = k + 1; i <= std::min(k + half_, rows_ - 1); ++i) {
        const double factor = at(i, k) / at(k, k);
        if (factor == 0) continue;
        for (std::size_t j = k; j <= std::min(k + half_, rows_ - 1); ++j) at(i, j) -= factor * at(k, j);
        right[i] -= right[k] * factor;
      }
    for (std::size_t k = rows_; k-- > 0;) {
      for (std::size_t j = k + 1; j <= std::min(k + half_, rows_ - 1); ++j) right[k] -= right[j] * at(k, j);
      right[k] = right[k] / at(k, k);
    }
    return right;
  }

 private:
  double& at(std::size_t row, std::size_t column) {
    return band_[row * (2 * half_ + 1) + column + half_ - row];
  }
  std::size_t rows_, half_;
  std::vector<double> band_;
};

void set_weights(const InterpolationOptions& options, std::size_t count, std::vector<double>& weights) {
  weights = options.weights.empty() ? std::vector<double>(count, 1.0) : options.weights;
  if (weights.size() != count)
    throw std::invalid_argument("NURBS: " + std::to_string(count) +
                                " weights are needed, one a control point");
}

NurbsCurve interpolate_natural(const std::vector<Vec3>& points, const InterpolationOptions& options) {
  if (options.degree != 3 || !options.weights.empty())
    throw std::invalid_argument("NURBS: natural ends are for a cubic without weights");
  const std::vector<double> u = parameters_of(points, options.parametrisation);
  const std::size_t last = points.size() - 1;
  NurbsCurve curve;
  curve.knots.assign(3, u.front());
  curve.knots.insert(curve.knots.end(), u.begin(), u.end());
  curve.knots.insert(curve.knots.end(), 3, u.back());
  // Unknowns in order; the first and last two rows are a point and no second derivative there.
  const std::size_t n = points.size() + 2;
  BandedSystem system(n, 3);
  std::vector<Vec3> right = points;
  right.insert(right.begin() + 1, Vec3{});
  right.insert(right.end() - 1, Vec3{});
  system.set(0, 0, 1);
  if (last == 1) {  // a straight line: the four control points are evenly spaced
    const Vec3 step = (points[1] - points[0]) / 3;
    curve.control_points = {points[0], points[0] + step, points[1] - step, points[1]};
    curve.weights.assign(4, 1);
    return curve;
  }
  // C'' = 0 at an end: (P1 - P0) / near = (P2 - P1) / (near + far), near and far the two knot spans there
  const double first = u[1] - u[0], second = u[2] - u[0];
  system.set(1, 0, 1 / first);
  system.set(1, 1, -(1 / first + 1 / second));
  system.set(1, 2, 1 / second);
  for (std::size_t k = 1; k < last; ++k) {
    const std::array<double, room> value = basis(curve.knots, 3 + k, 3, u[k]);
    for (std::size_t j = 0; j < 3; ++j) system.set(k + 1, k + j, value[j]);
  }
  const double near = u[last] - u[last - 1], both = u[last] - u[last - 2];
  system.set(n - 2, n - 1, 1 / near);
  system.set(n - 2, n - 2, -(1 / near + 1 / both));
  system.set(n - 2, n - 3, 1 / both);
  system.set(n - 1, n - 1, 1);
  curve.control_points = system.solve(std::move(right));
  curve.weights.assign(n, 1);
  return curve;
}

}  // namespace

std::vector<double> parameters_of(const std::vector<Vec3>& points, Parametrisation parametrisation,
                                  const Vec3* shift) {
  std::vector<double> u{0};
  const std::size_t steps = shift ? points.size() : points.size() - 1;
  for (std::size_t k = 0; k < steps; ++k) {
    const Vec3 next = k + 1 < points.size() ? points[k + 1] : points[0] + *shift;
    const double chord = distance(points[k], next);
    if (!(chord > 0) || !std::isfinite(chord))
      throw std::invalid_argument("NURBS: points " + std::to_string(k) + " and " + std::to_string(k + 1) +
                                  " are at one place or not finite");
    const double step = parametrisation == Parametrisation::chord_length  ? chord
                        : parametrisation == Parametrisation::centripetal ? std::sqrt(chord)
                                                                          : 1;
    u.push_back(u.back() + step);
  }
  return u;
}

NurbsCurve interpolate(const std::vector<Vec3>& points, const InterpolationOptions& options) {
  if (options.degree < 1 || options.degree > NurbsCurve::most_degree)
    throw std::invalid_argument("NURBS: the degree must be 1 to " + std::to_string(NurbsCurve::most_degree));
  const std::size_t p = static_cast<std::size_t>(options.degree), n = points.size();
  const bool natural = options.ends == NurbsEnds::natural;
  if (n < (natural ? 2 : p + 1))
    throw std::invalid_argument("NURBS: " + std::to_string(n) + " points are too few for an interpolation");
  if (natural) return interpolate_natural(points, options);
  const std::vector<double> u = parameters_of(points, options.parametrisation);
  NurbsCurve curve;
  curve.degree = options.degree;
  curve.knots.assign(p + 1, u.front());
  for (std::size_t j = 1; j + p < n; ++j) {
    double sum = 0;
    for (std::size_t i = j; i < j + p; ++i) sum += u[i];
    curve.knots.push_back(sum / static_cast<double>(p));
  }
  curve.knots.insert(curve.knots.end(), p + 1, u.back());
  set_weights(options, n, curve.weights);
  // sum_i N_i(u_k) w_i P_i = Q_k sum_i N_i(u_k) w_i: linear in w_i P_i
  BandedSystem system(n, p);
  std::vector<Vec3> right(n);
  for (std::size_t k = 0; k < n; ++k) {
    const auto first = curve.knots.begin() + static_cast<std::ptrdiff_t>(p);
    const auto past = curve.knots.begin() + static_cast<std::ptrdiff_t>(n);
    const std::size_t span =
        p +
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(std::upper_bound(first, past, u[k]) - first, 1)) -
        1;
    const std::array<double, room> value = basis(curve.knots, span, p, u[k]);
    double whole = 0;
    for (std::size_t j = 0; j <= p; ++j) {
      if (value[j] != 0) system.set(k, span - p + j, value[j]);
      whole += value[j] * curve.weights[span - p + j];
    }
    right[k] = points[k] * whole;
  }
  curve.control_points = system.solve(std::move(right));
  for (std::size_t i = 0; i < n; ++i) curve.control_points[i] = curve.control_points[i] / curve.weights[i];
  return curve;
}

NurbsCurve interpolate_periodic(const std::vector<Vec3>& points, const Vec3& shift,
                                const InterpolationOptions& options) {
  if (options.degree != 3) throw std::invalid_argument("NURBS: periodic interpolation is cubic");
  const std::size_t n = points.size();
  if (n < 3) throw std::invalid_argument("NURBS: a periodic curve needs at least three points");
  const std::vector<double> u = parameters_of(points, options.parametrisation, &shift);
  const double period = u.back();
  std::vector<double> weights;
  set_weights(options, n, weights);
  NurbsCurve curve;
  for (std::size_t i = 0; i < n + 7; ++i) {
    // knots u[-3] .. u[n + 3], continued with the period
    const std::size_t k = i + 3 * n - 3;
    curve.knots.push_back(u[k % n] + period * (static_cast<double>(k / n) - 3));
  }
  // At u[k] three functions do not vanish: those of control points k, k + 1, k + 2 (the unknown k + 1 in the
  // middle).
  std::vector<double> lower(n), diagonal(n), upper(n);
  std::vector<Vec3> right(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::array<double, room> value = basis(curve.knots, 3 + k, 3, u[k]);
    lower[k] = value[0];
    diagonal[k] = value[1];
    upper[k] = value[2];
    const double before = weights[(k + n - 1) % n], here = weights[k], after = weights[(k + 1) % n];
    right[k] = points[k] * (value[0] * before + value[1] * here + value[2] * after);
  }
  // the unknowns before the first and after the last are images
  right[0] += shift * (lower[0] * weights[n - 1]);
  right[n - 1] -= shift * (upper[n - 1] * weights[0]);
  const std::vector<Vec3> x = solve_cyclic_tridiagonal(lower, diagonal, upper, std::move(right));
  for (std::size_t i = 0; i < n + 3; ++i) {
    const std::size_t k = i + n - 1;
    curve.control_points.push_back(x[k % n] / weights[k % n] + shift * (static_cast<double>(k / n) - 1));
    curve.weights.push_back(weights[k % n]);
  }
  return curve;
}

}  // namespace loopwright
