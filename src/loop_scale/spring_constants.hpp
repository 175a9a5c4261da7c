// Spring constants and rest lengths from yarn data.
//
// The paper gives neither. Here they come from the yarn-scale model: relaxed frictionless cells of plain, 1x1
// rib and garter at l/d = 17, measured by studies/spring_constants. Without dimension they are: lengths over
// the loop length l, stiffness K l^3 / B with the yarn's bend stiffness B (a loop resists by bending its
// yarn). A connection is even between stitches that show the same face and odd between a front and a rear
// stitch; which of its springs a net has follows from the yarn graph alone.
#pragma once
#include "base/vec3.hpp"
#include "geometry/geometry_options.hpp"
#include "notation/program.hpp"

namespace loopwright {

// A connection at rest: from one binding point to the next, odd ones with z from the rear to the front
// stitch.
struct Connection {
  Vec3 rest;             // over l
  double stiffness = 1;  // K l^3 / B, pulled by 10 %
  double coupling = 0;   // share of the greatest coupling that stiffness allows, 0 to 1: Poisson's ratio
};

struct ConnectionTable {
  Connection weft_even, weft_odd, warp_even, warp_odd;
};
ConnectionTable measured_connections();

// The yarn of a net, in the units of mass_spring_net.hpp.
struct LoopYarn {
  double diameter_mm = 1;        // d, the unit of length
  double loop_length = 17;       // in d
  double bend_stiffness = 1e-8;  // B, N m^2
  double linear_density_tex = 1;
  bool estimated = false;  // whether B or the linear density is not the program's
};
// From the program's thickest yarn. Unstated: B = 10 mN mm^2 (wool 2/28 Nm); 0.5 g per cm^3 of the yarn's
// circle. They set forces and times, not the shape at rest.
LoopYarn loop_yarn(const Program& program, const GeometryOptions& options);

// N/m for a stiffness in B/l^3.
double stiffness_unit(const LoopYarn& yarn);
// Mass of one loop's yarn, kg.
double loop_mass(const LoopYarn& yarn);

// From a fabric's measured tangent stiffness Y (N/m along the course and the wale) and spacings (any unit):
// K_weft = Y_course c / w, K_warp = Y_wale w / c.
struct GridStiffness {
  double weft = 0, warp = 0;
};
GridStiffness stiffness_of_fabric(double course_stiffness, double wale_stiffness, double wale_spacing,
                                  double course_spacing);

}  // namespace loopwright
