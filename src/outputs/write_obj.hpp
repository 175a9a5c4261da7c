// Wavefront OBJ: centrelines as polylines, yarns as closed tubes. Coordinates are in millimetres.
#pragma once
#include <array>
#include <filesystem>

#include "geometry/fabric.hpp"

namespace loopwright {

struct ObjOptions {
  int per_segment = 4;               // polyline steps on a spline segment
  int sides = 8;                     // corners of a tube's cross-section
  std::array<int, 2> repeats{1, 1};  // periodic fabrics: cells along each lattice vector; 1 x 1 otherwise
};

// One `o` and one `l` element a yarn (a yarn and cell of a periodic fabric). Throws FileError.
void write_obj_lines(const std::filesystem::path& path, const Fabric& fabric, const ObjOptions& options = {});

// One `o` a yarn with triangles and normals; see tube_mesh(). Throws FileError.
void write_obj_tubes(const std::filesystem::path& path, const Fabric& fabric, const ObjOptions& options = {});

}  // namespace loopwright
