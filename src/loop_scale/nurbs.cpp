#include "loop_scale/nurbs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace loopwright {
namespace {

constexpr std::size_t room = NurbsCurve::most_degree + 1;

std::size_t count_of(int n) { return static_cast<std::size_t>(n); }

// Point in homogeneous coordinates (w x, w y, w z, w).
struct Weighted {
  Vec3 p;
  double w = 0;
};

Weighted weighted(const NurbsCurve& curve, std::size_t i) {
  return {curve.control_points[i] * curve.weights[i], curve.weights[i]};
}

// Span k with knots[k] <= u < knots[k + 1], the last one that is not empty for u = end.
std::size_t span_of(const NurbsCurve& curve, double u) {
  const std::size_t p = count_of(curve.degree), n = curve.control_points.size();
  const auto first = curve.knots.begin() + static_cast<std::ptrdiff_t>(p),
             last = curve.knots.begin() + static_cast<std::ptrdiff_t>(n) + 1;
  auto above = std::upper_bound(first, last, u);
  if (above == last) above = std::lower_bound(first, last, curve.knots[n]);
  const auto span = above - curve.knots.begin() - 1;
  return std::max(static_cast<std::size_t>(std::max<std::ptrdiff_t>(span, 0)), p);
}

// Polar form of the piece over `span`: de Boor's recurrence with an argument of its own in every step. All
// arguments equal give the point, knots give control points of any other B-spline form of the piece.
Weighted blossom(const NurbsCurve& curve, std::size_t span, const double* arguments) {
  const std::size_t p = count_of(curve.degree);
  std::array<Weighted, room> d;
  for (std::size_t j = 0; j <= p; ++j) d[j] = weighted(curve, span - p + j);
  for (std::size_t level = 1; level <= p; ++level)
    for (std::size_t j = p; j >= level; --j) {
      const double low = curve.knots[span - p + j], high = curve.knots[span + 1 + j - level];
      const double share = (arguments[level - 1] - low) / (high - low);
      d[j] = {d[j - 1].p * (1 - share) + d[j].p * share, d[j - 1].w * (1 - share) + d[j].w * share};
    }
  return d[p];
}

// Derivatives of the homogeneous curve: differences of control points lower the degree (The NURBS Book, eq.
// 3.7).
void homogeneous_derivatives(const NurbsCurve& curve, std::size_t span, double u, int order,
                             std::array<Weighted, room>& out) {
  const std::size_t p = count_of(curve.degree);
  std::array<Weighted, room> c;
  for (std::size_t j = 0; j <= p; ++j) c[j] = weighted(curve, span - p + j);
  for (std::size_t k = 0; k <= count_of(order); ++k) {
    if (k > p) {
      out[k] = {};
      continue;
    }
    const std::size_t q = p - k;  // degree of the k-th derivative; its control points are c[k .. p]
    std::array<Weighted, room> d = c;
    for (std::size_t level = 1; level <= q; ++level)
      for (std::size_t j = p; j >= k + level; --j) {
        const double low = curve.knots[span - p + j], high = curve.knots[span + 1 + j - k - level];
        const double share = (u - low) / (high - low);
        d[j] = {d[j - 1].p * (1 - share) + d[j].p * share, d[j - 1].w * (1 - share) + d[j].w * share};
      }
    out[k] = d[p];
    for (std::size_t j = p; j > k; --j) {
      const double step =
          static_cast<double>(q) / (curve.knots[span - p + j + q] - curve.knots[span - p + j]);
      c[j] = {(c[j].p - c[j - 1].p) * step, (c[j].w - c[j - 1].w) * step};
    }
  }
}

// Gauss-Legendre nodes and weights of order 8 on [-1, 1], Abramowitz and Stegun table 25.4
constexpr std::array<double, 4> gauss_node{0.183434642495650, 0.525532409916329, 0.796666477413627,
                                           0.960289856497536};
constexpr std::array<double, 4> gauss_weight{0.362683783378362, 0.313706645877887, 0.222381034453374,
                                             0.101228536290376};

double gauss_length(const NurbsCurve& curve, double from, double to) {
  double length = 0;
  const double middle = (from + to) / 2, half = (to - from) / 2;
  for (std::size_t g = 0; g < gauss_node.size(); ++g)
    for (const double sign : {-1.0, 1.0})
      length += gauss_weight[g] * norm(derivatives(curve, middle + sign * half * gauss_node[g], 1)[1]);
  return length * half;
}

double refined_length(const NurbsCurve& curve, double from, double to, double whole, double tolerance,
                      int depth) {
  const double middle = (from + to) / 2;
  const double left = gauss_length(curve, from, middle), right = gauss_length(curve, middle, to);
  if (depth == 0 || std::abs(left + right - whole) <= tolerance * (left + right)) return left + right;
  return refined_length(curve, from, middle, left, tolerance, depth - 1) +
         refined_length(curve, middle, to, right, tolerance, depth - 1);
}

}  // namespace

void require_sound(const NurbsCurve& curve) {
  const std::size_t n = curve.control_points.size();
  if (curve.degree < 1 || curve.degree > NurbsCurve::most_degree)
    throw std::invalid_argument("NURBS: the degree must be 1 to " + std::to_string(NurbsCurve::most_degree));
  if (n < count_of(curve.degree) + 1)
    throw std::invalid_argument("NURBS: needs at least degree + 1 control points");
  if (curve.weights.size() != n || curve.knots.size() != n + count_of(curve.degree) + 1)
    throw std::invalid_argument("NURBS: needs a weight for each control point and degree + 1 more knots");
  for (std::size_t i = 1; i < curve.knots.size(); ++i)
    if (!(curve.knots[i] >= curve.knots[i - 1])) throw std::invalid_argument("NURBS: knots must ascend");
  for (const double w : curve.weights)
    if (!(w > 0) || !std::isfinite(w)) throw std::invalid_argument("NURBS: weights must be positive");
  if (!(curve.begin() < curve.end())) throw std::invalid_argument("NURBS: the knots leave no room");
}

Vec3 position(const NurbsCurve& curve, double u) {
  std::array<double, room> arguments;
  arguments.fill(u);
  const Weighted c = blossom(curve, span_of(curve, u), arguments.data());
  return c.p / c.w;
}

std::vector<Vec3> derivatives(const NurbsCurve& curve, double u, int order) {
  if (order < 0 || order > NurbsCurve::most_degree)
    throw std::invalid_argument("NURBS: derivatives up to order " + std::to_string(NurbsCurve::most_degree));
  std::array<Weighted, room> a;
  homogeneous_derivatives(curve, span_of(curve, u), u, order, a);
  // quotient rule for C = A / w (The NURBS Book, eq. 4.8)
  std::vector<Vec3> c(count_of(order) + 1);
  for (std::size_t k = 0; k < c.size(); ++k) {
    Vec3 v = a[k].p;
    double binomial = 1;
    for (std::size_t i = 1; i <= k; ++i) {
      binomial *= static_cast<double>(k - i + 1) / static_cast<double>(i);
      v -= c[k - i] * (binomial * a[i].w);
    }
    c[k] = v / a[0].w;
  }
  return c;
}

double arc_length(const NurbsCurve& curve, double from, double to, double tolerance) {
  double length = 0;
  const std::size_t first = count_of(curve.degree), last = curve.control_points.size();
  for (std::size_t k = first; k < last; ++k) {
    const double a = std::max(from, curve.knots[k]), b = std::min(to, curve.knots[k + 1]);
    if (b > a) length += refined_length(curve, a, b, gauss_length(curve, a, b), tolerance, 20);
  }
  return length;
}

double arc_length(const NurbsCurve& curve) { return arc_length(curve, curve.begin(), curve.end()); }

std::vector<BezierPiece> bezier_pieces(const NurbsCurve& curve) {
  require_sound(curve);
  const std::size_t p = count_of(curve.degree);
  std::vector<BezierPiece> pieces;
  for (std::size_t k = p; k < curve.control_points.size(); ++k) {
    BezierPiece piece{curve.knots[k], curve.knots[k + 1], {}, {}};
    if (!(piece.from < piece.to)) continue;
    for (std::size_t j = 0; j <= p; ++j) {
      std::array<double, room> arguments;
      for (std::size_t i = 0; i < p; ++i) arguments[i] = i < j ? piece.to : piece.from;
      const Weighted b = blossom(curve, k, arguments.data());
      piece.points.push_back(b.p / b.w);
      piece.weights.push_back(b.w);
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

std::vector<Vec3> uniform_control_points(const NurbsCurve& curve) {
  require_sound(curve);
  if (curve.degree != 3) throw std::invalid_argument("NURBS: only a cubic is a uniform cubic B-spline");
  for (const double w : curve.weights)
    if (std::abs(w - curve.weights[0]) > 1e-12 * curve.weights[0])
      throw std::invalid_argument("NURBS: a rational curve is no B-spline; its weights must be equal");
  const std::size_t n = curve.control_points.size(), spans = n - 3;
  const double begin = curve.begin(), step = (curve.end() - begin) / static_cast<double>(spans);
  for (std::size_t e = 0; e <= spans; ++e)
    if (std::abs(curve.knots[3 + e] - (begin + step * static_cast<double>(e))) > 1e-9 * step)
      throw std::invalid_argument("NURBS: the joints are not equally far apart; use uniform parameters");
  std::vector<Vec3> control;
  for (std::size_t i = 0; i < n; ++i) {
    // q_i is the polar form at three uniform knots in a row, of any span that they touch
    const std::size_t span = std::min(i, spans - 1);
    std::array<double, room> arguments{};
    for (std::size_t j = 0; j < 3; ++j)
      arguments[j] = begin + step * (static_cast<double>(i) + static_cast<double>(j) - 2);
    const Weighted q = blossom(curve, 3 + span, arguments.data());
    control.push_back(q.p / q.w);
  }
  return control;
}

}  // namespace loopwright
