// Wavefront OBJ: centrelines as polylines, yarns as closed tubes. Coordinates are in millimetres.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"

namespace loopwright {

// One `o` and one `l` element a yarn (a yarn and cell of a periodic fabric). Throws FileError.
void write_obj_lines(const std::filesystem::path& path, const Fabric& fabric,
                     const ExportOptions& options = {});

// One `o` a yarn with triangles and normals; see tube_mesh(). Throws FileError.
void write_obj_tubes(const std::filesystem::path& path, const Fabric& fabric,
                     const ExportOptions& options = {});

}  // namespace loopwright
