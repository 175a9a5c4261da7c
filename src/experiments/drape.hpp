// Cloth under its own weight: the weight as loads on the control points, what holds it, and how it hangs.
#pragma once
#include <vector>

#include "mechanics/relax.hpp"

namespace loopwright {

// Weight of every yarn, spread over its control points by the spline's weights (a uniform force per rest
// length), for ModelOptions::point_loads: B/d^2. `acceleration`: m/s^2, e.g. {0, -9.81, 0} for cloth that
// hangs along its wales. Throws std::invalid_argument if a yarn's linear density or the bend stiffness is not
// known.
std::vector<Vec3> weight_loads(const Fabric& fabric, const YarnMaterial& material, const Vec3& acceleration);

// Force that the held points exert on the cloth at rest, N: with the loads it must come to nothing. `options`
// and `history` as the cloth was relaxed with.
Vec3 support_force(const Fabric& fabric, const ModelOptions& options, const ContactHistory& history);
// Sum of the loads on all control points, N.
Vec3 total_load(const Fabric& fabric, const ModelOptions& options);

// A strip of endless width that hangs along its wales from its topmost course: `courses` courses of a cell,
// stacked, periodic along the courses at the width of the cell. The topmost heads are held, and the lattice's
// height is loaded so that no force goes from the lowest course to the next image of the rail: so the strip
// has no loose edge and does not curl.
struct HangingStrip {
  Fabric fabric;  // at rest
  RelaxResult result;
  int courses = 0;
  double areal_density_g_m2 = 0;  // unloaded
  double elongation = 0;          // share of the height without weight
  double weight_N_m = 0;          // of the strip, per width
  double support_N_m = 0;         // what the rail bears, per width
  std::vector<double> strain,
      force_N_m;  // per course, from the lowest: its strain, and the pull in its middle
};
// `cell`: at rest with `options` (periodic; its yarns close along the courses). `courses`: a multiple of the
// cell's. `gravity`: m/s^2, downward along the wales, which grows in equal `steps` (with friction the way
// counts). Throws std::invalid_argument as weight_loads and for
// counts and fabrics that are not such.
HangingStrip hang(const RelaxResult& cell, const RelaxOptions& options, int courses, double gravity,
                  int steps = 1);

}  // namespace loopwright
