// Tubes round centrelines: rings with frames that do not twist, and closed triangle meshes made of them.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/fabric.hpp"

namespace loopwright {

// One cross-section of a tube. `normal` and `binormal` = tangent x normal are unit vectors across the
// centreline.
struct TubeRing {
  Vec3 centre, tangent, normal, binormal;
  double arc = 0;  // length of the polyline up to here, in d
};

// Rings at the points of `polyline(fabric, yarn, per_segment)`. Frames are carried along by the double
// reflection method (Wang et al., ACM TOG 27(1), 2008), which has no twist and needs no curvature. On a
// periodic yarn the angle by which the last frame misses the first is spread evenly over the length, so that
// repeats join.
std::vector<TubeRing> tube_rings(const Fabric& fabric, const FabricYarn& yarn, int per_segment);

// A closed triangle mesh; lengths are in d. Triangles are counter-clockwise seen from outside. Corners index
// positions and normals apart, as in OBJ, so that a cap's rim has two normals and yet one position.
struct TubeMesh {
  struct Triangle {
    std::array<std::uint32_t, 3> position, normal;
  };
  std::vector<Vec3> positions, normals;
  std::vector<Triangle> triangles;
};

// The tube round a yarn with `sides` >= 3 corners on a circle round the centreline, closed by flat caps (a
// yarn that closes onto itself without a shift joins end to end instead). The radius is such that the
// cross-section has the area of the yarn's circle, so that the volume is pi/4 d^2 L to second order in the
// curvature.
TubeMesh tube_mesh(const Fabric& fabric, const FabricYarn& yarn, int per_segment, int sides);

}  // namespace loopwright
