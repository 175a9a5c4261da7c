#include "outputs/exchange/curve_pieces.hpp"

#include <algorithm>

#include "geometry/centreline.hpp"

namespace loopwright {
namespace {

Vec3 place_on(const BezierPiece& b, double u) {
  const double v = 1 - u;
  return b[0] * (v * v * v) + b[1] * (3 * v * v * u) + b[2] * (3 * v * u * u) + b[3] * (u * u * u);
}

// Calls add(p0, p1, p2, p3) for every four neighbouring points, round the seam of a closed curve; there the
// first four begin at point `first`.
template <class Add>
void each_four(const FileCurve& curve, std::size_t first, Add add) {
  const std::size_t n = curve.points.size();
  if (n < 4 && !(curve.closed && n == 3)) return;
  const std::size_t pieces = curve.closed ? n : n - 3;
  const std::size_t shift = curve.closed ? first : 0;
  const auto at = [&](std::size_t k) -> const Vec3& { return curve.points[(k + shift) % n]; };
  for (std::size_t k = 0; k < pieces; ++k) add(at(k), at(k + 1), at(k + 2), at(k + 3));
}

std::vector<BezierPiece> bezier_groups(const FileCurve& curve) {
  const std::size_t n = curve.points.size();
  std::vector<BezierPiece> pieces;
  for (std::size_t k = 0; curve.closed ? k + 3 <= n : k + 3 < n; k += 3)
    pieces.push_back({curve.points[k], curve.points[k + 1], curve.points[k + 2], curve.points[(k + 3) % n]});
  return pieces;
}

BezierPiece elevated(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {a, (a + b * 2) / 3, (b * 2 + c) / 3, c};
}

std::vector<BezierPiece> midpoint_pieces(const FileCurve& curve) {
  const std::vector<Vec3>& p = curve.points;
  const std::size_t n = p.size();
  std::vector<BezierPiece> pieces;
  if (n < 2 || (curve.closed && n < 3)) return pieces;
  const auto middle = [&](std::size_t k) { return (p[k % n] + p[(k + 1) % n]) / 2; };
  if (curve.closed) {
    for (std::size_t k = 0; k < n; ++k) pieces.push_back(elevated(middle(k), p[(k + 1) % n], middle(k + 1)));
    return pieces;
  }
  const auto straight = [&](const Vec3& a, const Vec3& b) { pieces.push_back(elevated(a, (a + b) / 2, b)); };
  straight(p[0], middle(0));
  for (std::size_t k = 1; k + 1 < n; ++k) pieces.push_back(elevated(middle(k - 1), p[k], middle(k)));
  straight(middle(n - 2), p[n - 1]);
  return pieces;
}

std::vector<BezierPiece> pieces_through(const FileCurve& curve) {
  // a point told twice would leave its knots without a distance
  std::vector<Vec3> points;
  for (const Vec3& p : curve.points)
    if (points.empty() || !(points.back() == p)) points.push_back(p);
  while (curve.closed && points.size() > 1 && points.back() == points.front()) points.pop_back();
  std::vector<BezierPiece> pieces;
  if (points.size() < (curve.closed ? 3U : 2U)) return pieces;
  const Centreline line = curve.closed ? Centreline::periodic(points, {}) : Centreline::open(points);
  for (std::size_t k = 0; k < line.pieces(); ++k) {
    const double step = (line.knots()[k + 1] - line.knots()[k]) / 3;
    const Vec3 a = line.position(k, 0), b = line.position(k, 1);
    pieces.push_back({a, a + line.derivative(k, 0) * step, b - line.derivative(k, 1) * step, b});
  }
  return pieces;
}

}  // namespace

std::vector<BezierPiece> bezier_pieces(CurveBasis basis, const FileCurve& curve) {
  std::vector<BezierPiece> pieces;
  switch (basis) {
    case CurveBasis::through_points:
      return pieces_through(curve);
    case CurveBasis::bezier:
      return bezier_groups(curve);
    case CurveBasis::midpoint_quadratic:
      return midpoint_pieces(curve);
    case CurveBasis::catmull_rom:
      // so that the curve begins at its first point
      each_four(curve, curve.points.size() - 1,
                [&](const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3) {
                  pieces.push_back({p1, p1 + (p2 - p0) / 6, p2 - (p3 - p1) / 6, p2});
                });
      return pieces;
    case CurveBasis::bspline:
      each_four(curve, 0, [&](const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3) {
        pieces.push_back(
            {(p0 + p1 * 4 + p2) / 6, (p1 * 2 + p2) / 3, (p1 + p2 * 2) / 3, (p1 + p2 * 4 + p3) / 6});
      });
      return pieces;
  }
  return pieces;
}

ArcLengthCurve::ArcLengthCurve(std::vector<BezierPiece> pieces) : pieces_(std::move(pieces)), arc_{0} {
  arc_.reserve(pieces_.size() * parts + 1);
  for (const BezierPiece& piece : pieces_) {
    Vec3 before = piece[0];
    for (std::size_t k = 1; k <= parts; ++k) {
      const Vec3 now = place_on(piece, static_cast<double>(k) / parts);
      arc_.push_back(arc_.back() + distance(before, now));
      before = now;
    }
  }
}

Vec3 ArcLengthCurve::at(double arc) const {
  const auto after = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, arc);
  const auto part = static_cast<std::size_t>(after - arc_.begin()) - 1;
  const double step = arc_[part + 1] - arc_[part];
  const double u = step > 0 ? std::clamp((arc - arc_[part]) / step, 0.0, 1.0) : 0;
  return place_on(pieces_[part / parts], (static_cast<double>(part % parts) + u) / parts);
}

}  // namespace loopwright
