// Centreline: a C2 cubic through given points, the inverse problem of the first paper (global interpolation).
// With all weights 1 its NURBS curve is this cubic spline; natural ends or periodic with a shift.
#pragma once
#include <vector>

#include "base/vec3.hpp"

namespace loopwright {

enum class Parametrisation : std::uint8_t { chord_length, centripetal, uniform };

class Centreline {
 public:
  // Open curve through >= 2 points with zero second derivative at its ends.
  static Centreline open(const std::vector<Vec3>& points,
                         Parametrisation parametrisation = Parametrisation::chord_length);
  // Closed up to a shift: the point after the last is points[0] + shift. >= 2 points.
  static Centreline periodic(const std::vector<Vec3>& points, const Vec3& shift,
                             Parametrisation parametrisation = Parametrisation::chord_length);

  // Parameters of the points; periodic curves have one more, where the next period starts.
  const std::vector<double>& knots() const { return knots_; }
  std::size_t pieces() const { return knots_.size() - 1; }
  // On piece k at u in [0, 1].
  Vec3 position(std::size_t piece, double u) const;
  Vec3 derivative(std::size_t piece, double u) const;  // with respect to the parameter, not u
  Vec3 second_derivative(std::size_t piece, double u) const;
  double arc_length(std::size_t piece) const;  // 8-point Gauss
  double arc_length() const;

 private:
  std::vector<double> knots_;
  std::vector<Vec3> points_, curvature_;  // values and second derivatives at the knots
};

// Solves a tridiagonal system, lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i].
std::vector<Vec3> solve_tridiagonal(std::vector<double> lower, std::vector<double> diagonal,
                                    std::vector<double> upper, std::vector<Vec3> right);
// The same with the corners lower[0] (column n - 1) and upper[n - 1] (column 0); n >= 3.
std::vector<Vec3> solve_cyclic_tridiagonal(std::vector<double> lower, std::vector<double> diagonal,
                                           std::vector<double> upper, std::vector<Vec3> right);

}  // namespace loopwright
