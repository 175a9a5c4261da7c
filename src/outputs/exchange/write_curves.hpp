// Centrelines in the curve formats of other programs; their readers are in curve_file.hpp. Coordinates in mm,
// y along a wale, z toward the front bed.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"

namespace loopwright {

// BCC (Binary Curve Collection) of kind C0: uniform Catmull-Rom curves through points of the centrelines.
// Open curves have one more point at either end, for their direction. Yarns that close onto themselves are
// closed.
void write_bcc(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options = {});

// BCC of kind BS: the yarns' own control points, exact to the 24 bits of its numbers.
void write_bcc_bspline(const std::filesystem::path& path, const Fabric& fabric,
                       const ExportOptions& options = {});

// .yarns: polygons whose quadratic curves (from midpoint to midpoint) follow the centrelines; source line of
// every point, radius and colour of every yarn, and checkpoints with the unloaded length of every loop.
void write_yarns(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options = {});

}  // namespace loopwright
