// STEP (ISO 10303-21): yarn centrelines as B-spline curves, exactly, for CAD.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"

namespace loopwright {

// A part of the AP214 schema: one B_SPLINE_CURVE_WITH_KNOTS of degree 3 a yarn (a yarn and cell of a periodic
// fabric), named yarn_0 and so on, with its colour, in millimetres. Knots are uniform and clamped at the
// ends, which for a yarn's spline is a change of the two outer control points at either end and not of the
// curve. Numbers have 17 digits. Throws FileError.
void write_step(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options = {});

}  // namespace loopwright
