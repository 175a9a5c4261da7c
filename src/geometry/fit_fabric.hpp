// YarnCurves -> Fabric: uniform cubic B-splines with segments of equal rest length.
#pragma once
#include "geometry/fabric.hpp"
#include "geometry/geometry_options.hpp"

namespace loopwright {

struct FitOptions {
  double segments_per_loop = 12;  // for a loop of loop_length
};

// The C2 cubic through a yarn's type value points is sampled at equal steps of rest length and the samples
// are interpolated. A yarn has round(rest length / segment) segments, at least 4 (periodic: 6).
Fabric fit_fabric(const YarnCurves& curves, const YarnGraph& graph, const GeometryOptions& options,
                  const FitOptions& fit = {});

// Control points of the open uniform cubic B-spline through places (>= 2) at whole parameters, without
// curvature at its ends.
std::vector<Vec3> open_control_points(const std::vector<Vec3>& samples);
// Those of a periodic one (>= 3 places), whose next period starts at samples[0] + shift.
std::vector<Vec3> periodic_control_points(const std::vector<Vec3>& samples, const Vec3& shift);

}  // namespace loopwright
