// STEP (ISO 10303-21): yarns as solids, for CAD.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"

namespace loopwright {

// A part of the AP214 schema: one MANIFOLD_SOLID_BREP a yarn (a yarn and cell of a periodic fabric), named
// yarn_0 and so on, in its colour, in millimetres. Each is a NURBS tube between two flat caps; a yarn that
// closes onto itself is a ring without. (The side is cut into faces of two segments of the yarn: one face
// that winds through a course is more than OpenCASCADE's mesher can do.) With u round the yarn and v along
// it,
//   S(u, v) = C(v) + r [a(u) N(v) + b(u) B(v)]
// (a, b): the unit circle as a rational quadratic (exact); C: the yarn's own cubic B-spline with knots
// inserted (exact); N, B: cubic B-splines through the tube's frames at `per_segment` places of a segment, so
// that a cross-section departs from its circle between them only (at 4 by some 1e-4 of the radius). Throws
// FileError.
void write_step_tubes(const std::filesystem::path& path, const Fabric& fabric,
                      const ExportOptions& options = {});

}  // namespace loopwright
