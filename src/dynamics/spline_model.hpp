// Yarns as dynamic material splines: the control points are the degrees of freedom of a continuous yarn, mass
// stays spread along the curve (Remion, Nourrit, Gillard 1999; the second paper, "Yarn modelling").
//
//   K = 1/2 sum_ab M_ab qdot_a . qdot_b,   M_ab = sum_j int_0^1 m_j(u) h_a(u) h_b(u) du,   M qddot = Q
//
// Units are any consistent ones; for cloth: lengths in d, energies in B/d, masses in rho d (rho: mass per
// length of the reference yarn), so that the unit of time is d^2 sqrt(rho / B) (MotionUnits).
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "dynamics/banded_cholesky.hpp"
#include "dynamics/blending.hpp"

namespace loopwright {

// What keeps a yarn's length.
enum class StretchLaw : std::uint8_t {
  springs,  // the paper's first version: non-linear springs between consecutive control points
  green,    // its second: continuous energy of finite displacements, eps = (|p'|^2 - |p0'|^2) / (2 |p0'|^2)
  mean      // of a segment's length over its rest length, as src/mechanics; stiff yarn stays free to bend
};

struct SplineYarn {
  Blending blending = uniform_b_spline();
  int first = 0, points = 0;  // its control points among those of the model; >= 4
  double stretch_stiffness = 1;
  // Springs only: tension = EA (e + hardening e^3) at elongation e, so that yarn grows stiffer as it is
  // stretched.
  double spring_hardening = 0;
  // Mean only: share of the stiffness against uneven speed of the parameter inside a segment. At rest it may
  // be 0, as in src/mechanics; in motion what costs nothing drifts until the yarn runs backward. 1 would be
  // the local strain, which makes bends too stiff (membrane locking).
  double evenness = 0.05;
  double bend_stiffness = 0;
  double diameter = 1;
  // What follows is one per segment; at Gauss points of mechanics/energies/energy.hpp where there are four.
  std::vector<double> rest_length;                // of the segment (springs: between points k and k + 1,
                                                  // points - 1 of them)
  std::vector<std::array<double, 4>> rest_speed;  // green only: |p0'(u)|
  std::vector<std::array<double, 4>> density;     // mass per parameter m(u)
  std::vector<std::array<double, 4>> natural_curvature;  // kappa_0; empty: straight when unloaded

  int segments() const { return points - 3; }
  double rest_length_at(double t) const {  // of the segment there, t a parameter of the spline
    return rest_length[std::min(static_cast<std::size_t>(t), rest_length.size() - 1)];
  }
};

struct SplineModel {
  std::vector<SplineYarn> yarns;
  int points = 0;
  std::vector<std::uint8_t> held;  // [points] 1: goes where it is told, whatever pulls
  StretchLaw law = StretchLaw::mean;
  Vec3 gravity;             // acceleration
  double drag = 0;          // viscosity of what the yarn moves in: force = -drag * mass * velocity
  std::vector<Vec3> force;  // external forces on control points; empty: none
};

struct MotionState {
  std::vector<Vec3> place, velocity;  // [points]
  double time = 0;
};

// m_j(u) everywhere the same.
void set_mass_per_parameter(SplineYarn& yarn, double mass);
// m_j(u) = rho |p0'(u)| with the yarn's mass per length rho, for the rest shape that `points` (the yarn's
// own) have.
void set_mass_per_length(SplineYarn& yarn, double density, std::span<const Vec3> points);
// Rest lengths, and natural curvature times `set` (0: straight, 1: this shape unloaded), of the shape that
// `points` (the yarn's own) have. `law`: springs have their lengths between control points.
void set_rest_shape(SplineYarn& yarn, std::span<const Vec3> points, double set, StretchLaw law);

// M of one yarn, over its own control points.
BandMatrix mass_matrix(const SplineYarn& yarn);
// The point of yarn `y` at parameter t in [0, segments], and its derivatives with respect to t.
struct CurvePoint {
  Vec3 place, slope, curve;
  int first = 0;  // of the four control points, among those of the model
  BlendingWeights weights;
};
CurvePoint curve_point(const SplineModel& model, std::span<const Vec3> place, int y, double t);

// Throws std::invalid_argument for counts that do not fit, numbers that are not finite and data out of range,
// saying which.
void require_sound(const SplineModel& model, const MotionState& state);

}  // namespace loopwright
