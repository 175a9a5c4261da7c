// How cloth that nothing holds flat curls: curvature along its courses and its wales, from where its loops
// are.
#pragma once
#include <vector>

#include "mechanics/yarn_model.hpp"

namespace loopwright {

// Curvature of the cloth at a loop, 1/d: positive where it bends toward the side that front stitches show as
// their face (+z of the flat cloth). Along the course: the sides roll up; along the wale: top and bottom do.
struct LoopCurvature {
  LoopId loop;
  double course = 0, wale = 0;
};

// Of every loop with `apart` neighbours on all four sides (finite pieces, knitted loops). The loop's place is
// the middle of its span; a curvature is the second difference of places so many loops apart across the
// cloth's normal, over the squared mean distance. 2, so that stitches of both beds in turn do not count as
// waves; 1 goes nearer to the edges of plain.
std::vector<LoopCurvature> loop_curvatures(const Fabric& fabric, int apart = 2);

struct Curl {
  double course = 0, wale = 0;              // mean curvature, 1/d
  double course_error = 0, wale_error = 0;  // standard deviation over loops by the root of their number
  int loops = 0;
};
// Throws std::invalid_argument if no loop has so many neighbours on all sides (for 2: fewer than 5 x 5).
Curl curl(const Fabric& fabric, int apart = 2);

// What makes a flat cloth curl: the moments that a periodic cell would need to stay flat, as the slope of its
// energy when the plane is bent to a cylinder, dW/dkappa at kappa = 0 (W: energy per area; kappa as above).
// Below zero: the cloth wants to bend toward the face. Unit B/d^2, times B/d^2 in N a moment per length of
// cloth.
struct CurlMoment {
  double course = 0, wale = 0;
};
// Exact at the cell's flat state: every piece of yarn and every contact is bent with u = kappa (-x z, 0,
// x^2/2), in patches of several repeats; a second difference over the patches' sizes takes their edges away.
// Friction and plates are left out. Throws std::invalid_argument for a fabric that is not periodic or whose
// yarns do not close after one repeat along their course.
CurlMoment curl_moment(const Fabric& cell, const ModelOptions& options);

}  // namespace loopwright
