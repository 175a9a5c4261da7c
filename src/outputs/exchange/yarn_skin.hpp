// Tubes as graphics programs want them: one list of vertices, each with place, normal and texture
// coordinates.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "outputs/export_options.hpp"

namespace loopwright {

// The tube of tube_mesh(), with its own vertices where one place has two normals (caps) or two texture
// coordinates (the seam along the yarn). Lengths in mm.
//   u: round the yarn, from 0 to 1;   v: along it, in turns of the yarn's circumference, so that a texture is
//   as long as it is wide.
struct YarnSkin {
  struct Vertex {
    Vec3 place_mm, normal;
    double u = 0, v = 0;
    std::uint32_t ring = 0;  // which cross-section: point of polyline(fabric, yarn, per_segment)
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

YarnSkin yarn_skin(const Fabric& fabric, const FabricYarn& yarn, const ExportOptions& options);

// What yarn_skin() will hold.
std::size_t skin_vertices(const FabricYarn& yarn, const ExportOptions& options);
std::size_t skin_triangles(const FabricYarn& yarn, const ExportOptions& options);

// Throws std::invalid_argument unless tubes can be made with these options.
void check_tube_options(const ExportOptions& options);

}  // namespace loopwright
