// The second paper's own jersey stitch: 8 Catmull-Rom segments over 11 control points (its figures 12 and
// 13).
//
// In the plane of the cloth the yarn from point 3 to 5 is the yarn from 1 to 3 turned half round point 3, and
// the stitch is its own mirror image about the axis through point 5: points 1, 2 and 3 make the rest. Point 1
// is the middle of the sinker loop, 2 the bend of the foot, 3 the middle of the leg, 5 the top of the head.
// Elevations are the same at points that mirror each other: -a at sinker and head, +a at the legs' middles,
// 0 between; a is as large as it must be for the yarns of neighbouring rows just to touch.
#pragma once
#include <array>
#include <vector>

#include "dynamics/bindings.hpp"

namespace loopwright {

struct JerseyStitch {
  double thickness = 1;         // diameter of the yarn
  double wale_spacing = 4.6;    // width of a stitch: 1 / wales per length
  double course_spacing = 3.5;  // distance of rows: 1 / courses per length
};

// Points 0 to 10 of the stitch, point 1 at the origin, the next stitch at +x, the next row at +y. Throws
// std::invalid_argument if the stitch density leaves no room for the yarn.
std::array<Vec3, 11> jersey_points(const JerseyStitch& stitch);
// A row of n stitches: 8 n + 3 control points; neighbours share three.
std::vector<Vec3> jersey_row(const JerseyStitch& stitch, int n);

// `rows` rows of n stitches, each a yarn of its own, as the paper has it ("yarn warping from row to row is
// forgotten"); nothing is held. The model's mass and stiffness are 1 per length and to be set by the caller.
struct JerseyPiece {
  SplineModel model;
  MotionState state;
  std::vector<Foot> feet;
};
JerseyPiece jersey_piece(const JerseyStitch& stitch, int n, int rows, StretchLaw law, double tension = 0.5);

}  // namespace loopwright
