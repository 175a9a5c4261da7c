// PLY: yarns as tubes with normals, texture coordinates, colours, and what each vertex belongs to.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"

namespace loopwright {

// Binary, little-endian, in mm. Vertex: x y z, nx ny nz, s t (yarn_skin's u and v), red green blue, and the
// integers `yarn`, `loop` (number in the fabric, -1: none) and `line` of the source (0: none). Face:
// vertex_indices. Throws FileError, and std::invalid_argument for options that make no tube.
void write_ply(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options = {});

}  // namespace loopwright
