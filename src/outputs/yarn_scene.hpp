// What the renderer draws: the yarns of a fabric as one vertex and index list, with light that crevices keep
// out.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "geometry/fabric.hpp"
#include "outputs/camera.hpp"

namespace loopwright {

// How a yarn is made up, for drawing only.
struct YarnLook {
  int plies = 2;
  double twist = 0.34;    // turns of the plies per d; 2/d is hard, 0.2/d soft. Positive: Z twist
  bool occlusion = true;  // darken where other yarn hides the sky; off, for speed, while the picture moves
};

// 36 bytes a vertex, as the GPU reads it.
struct SceneVertex {
  std::array<float, 3> position;  // about the scene's centre, in d
  std::array<float, 3> along;  // angle round the yarn (in turns), arc length, and the length after which the
                               // pattern of plies and fibres repeats (both in d)
  std::array<std::int8_t, 4> normal;  // times 127; the fourth is unused
  std::array<std::int8_t, 4> tangent;
  std::array<std::uint8_t, 4> colour;  // sRGB, and the open share of the sky, times 255
};

struct YarnScene {
  std::vector<SceneVertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise from outside
  std::vector<std::array<float, 3>>
      offsets;    // the scene is drawn once at each: (0, 0, 0), or the periodic repeats
  Vec3 centre;    // of the scene, in the fabric's coordinates
  Bounds bounds;  // of all that is drawn, in the fabric's coordinates
  YarnLook look;
};

struct SceneOptions {
  std::array<int, 2> repeats{
      0, 0};  // periodic fabrics: cells along each lattice vector; 0: enough for 6 wales, 6 courses
  double pixels_per_diameter = 24;  // size on the screen for which the mesh is fine enough
  YarnLook look;
};

// The repeats that will be drawn: as asked, or enough cells for six wales and six courses. {1, 1} for a
// finite piece.
std::array<int, 2> drawn_repeats(const Fabric& fabric, std::array<int, 2> asked);

// Box round all yarns with their radii and repeats. Throws std::invalid_argument for a fabric without yarns
// or with coordinates that are not finite.
Bounds fabric_bounds(const Fabric& fabric, std::array<int, 2> repeats);

YarnScene yarn_scene(const Fabric& fabric, const SceneOptions& options = {});

// The colour of a yarn: its own "#rrggbb", or one of a palette by its carrier.
std::array<std::uint8_t, 3> drawn_colour(const Fabric& fabric, std::size_t yarn);
std::array<std::uint8_t, 3> parsed_colour(std::string_view text, std::array<std::uint8_t, 3> otherwise);

}  // namespace loopwright
