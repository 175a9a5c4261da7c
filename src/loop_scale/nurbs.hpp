// NURBS curves: the paper's "NURBS curve application" (first paper, section 4.2). Inverse problem (type value
// points -> control points), evaluation, derivatives, arc length, and exact conversion to Bezier and to
// uniform B-spline pieces.
//
//   C(u) = sum_i N_i,p(u) w_i P_i / sum_i N_i,p(u) w_i          (Piegl and Tiller, The NURBS Book, eq. 4.1)
//
// A periodic curve is held as an unclamped one whose last `degree` control points repeat the first, moved by
// its shift, so that everything below treats both alike.
#pragma once
#include <vector>

#include "base/vec3.hpp"
#include "geometry/centreline.hpp"

namespace loopwright {

struct NurbsCurve {
  int degree = 3;                    // 1 to most_degree
  std::vector<double> knots;         // ascending; control_points.size() + degree + 1 of them
  std::vector<Vec3> control_points;  // in the unit of the points that they were found from
  std::vector<double> weights;       // > 0, one each
  static constexpr int most_degree = 9;

  double begin() const { return knots[static_cast<std::size_t>(degree)]; }
  double end() const { return knots[control_points.size()]; }
};

// Throws std::invalid_argument, saying what is wrong, where the lists disagree in length, a knot goes back,
// or a weight is not positive.
void require_sound(const NurbsCurve& curve);

// Point and derivatives with respect to u, u in [begin, end]; values[k] is the k-th derivative, k = 0 ..
// order.
Vec3 position(const NurbsCurve& curve, double u);
std::vector<Vec3> derivatives(const NurbsCurve& curve, double u, int order);

// Length between two parameters: 8-point Gauss on every span, halved until two estimates agree to
// `tolerance` of the span's length.
double arc_length(const NurbsCurve& curve, double from, double to, double tolerance = 1e-10);
double arc_length(const NurbsCurve& curve);

// How the inverse problem is closed at the two ends of an open curve.
//   averaged_knots  as many control points as points, inner knots are means of `degree` parameters (The NURBS
//                   Book, eq. 9.8)
//   natural         knots at the points, no second derivative at the ends (cubic only): geometry's Centreline
enum class NurbsEnds : std::uint8_t { averaged_knots, natural };

struct InterpolationOptions {
  int degree = 3;
  Parametrisation parametrisation = Parametrisation::chord_length;
  NurbsEnds ends = NurbsEnds::averaged_knots;
  std::vector<double> weights;  // of the control points; empty: all 1
};

// The clamped curve through all points, at increasing parameters that start at 0 and are not normalised.
// Throws std::invalid_argument for fewer than degree + 1 points (natural: 2), two points in a row at one
// place, or weights of another number than the control points.
NurbsCurve interpolate(const std::vector<Vec3>& points, const InterpolationOptions& options = {});

// The cubic with C2 joints through points[k] and their images points[k] + m shift; weights, if any, repeat
// too. At least 3 points.
NurbsCurve interpolate_periodic(const std::vector<Vec3>& points, const Vec3& shift,
                                const InterpolationOptions& options = {});

// Parameters that the points of an interpolation have, one more than points if `shift` is given.
std::vector<double> parameters_of(const std::vector<Vec3>& points, Parametrisation parametrisation,
                                  const Vec3* shift = nullptr);

// A polynomial or rational piece: degree + 1 points and weights, over [from, to] of the curve's parameter.
struct BezierPiece {
  double from = 0, to = 1;
  std::vector<Vec3> points;
  std::vector<double> weights;
};
std::vector<BezierPiece> bezier_pieces(const NurbsCurve& curve);  // one a span, exact

// Control points q_0 .. q_(m+2) of the uniform cubic B-spline that is the same curve, m spans: the form of
// FabricYarn::control_points. Throws std::invalid_argument unless the curve is cubic, its weights are all
// equal, and its joints equally far apart (use Parametrisation::uniform with natural ends or periodic).
std::vector<Vec3> uniform_control_points(const NurbsCurve& curve);

}  // namespace loopwright
