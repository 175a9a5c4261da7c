// Yarn that resists twist and may turn about itself where it lies: a couple is the same all along it, so
// that of its twist only the sum over the yarn counts,
//   U = C / (2 L) (psi L + Theta)^2
// C: twist stiffness, L: the yarn's rest length, psi: its liveliness (rad per length), Theta: the angle by
// which its way through space twists it, ends not turning (Bergou et al., "Discrete Elastic Rods", ACM TOG
// 27, 63 (2008), section 4.2: uniform twist follows from quasi-static equilibrium). Theta is minus the area
// that the tangents enclose on the unit sphere (Fuller, PNAS 75, 3557 (1978)); when they move, it grows by
// the area that they sweep to their left. Unlike torsion it does not care for points of inflection.
//
// Here: the tangents of a segment as great arcs between those at u = 0, 1/4, 1/2, 3/4 and 1, and what these
// arcs add to the derivatives of Theta by the segment's control points. Theta belongs to the whole yarn: what
// one segment gives is a derivative only in the sum over the yarn, where the ends of arcs that meet cancel.
#pragma once
#include "base/vec3.hpp"
#include "mechanics/energies/energy.hpp"

namespace loopwright {

inline constexpr std::size_t twist_arcs = 4;
using ArcEnds = std::array<Vec3, twist_arcs + 1>;

// dp/du at the ends of the arcs of the segment with these control points.
ArcEnds arc_ends(const Vec3* control_points);
// The same, of unit length.
ArcEnds arc_tangents(const Vec3* control_points);

// Area of the spherical quadrilateral a b c d (unit vectors), positive if it runs counter-clockwise seen from
// outside; less than 2 pi.
double spherical_area(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The segment's part of dTheta by its control points.
std::array<Vec3, 4> turn_gradient(const ArcEnds& ends);
// Its part of the second derivatives, 3 x 3 blocks by row: those of control points k <= l, in the order 00 01
// 02 03 11 12 13 22 23 33, as SegmentBlocks has them.
std::array<std::array<double, 9>, 10> turn_hessian(const ArcEnds& ends);

}  // namespace loopwright
