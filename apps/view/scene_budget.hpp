// How fine the cloth can be drawn: pieces of many thousand loops are drawn coarser, and coarser still while
// they move.
#pragma once
#include <cstddef>

#include "geometry/fabric.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {

std::size_t segments_of(const Fabric& fabric);

// Vertices that a scene of so many segments takes, about.
double vertices_of(const Fabric& fabric, double pixels_per_diameter);

// `wanted`, or as much of it as memory can bear, and a processor that draws by itself (`without_gpu`).
double affordable_detail(const Fabric& fabric, double wanted, bool without_gpu);

// Whether the still picture has shadows: they draw all of it twice.
bool affords_shadows(const YarnScene& scene, bool without_gpu);

// Whether light that crevices keep out is ready within a few seconds.
bool affords_occlusion(const Fabric& fabric, double pixels_per_diameter);

// The fabric for a picture that moves: of large pieces only every k-th control point, at most four. For
// drawing alone.
struct SparseFabric {
  Fabric fabric;
  int every = 1;
};
SparseFabric sparse_fabric(const Fabric& fabric);

}  // namespace loopwright
