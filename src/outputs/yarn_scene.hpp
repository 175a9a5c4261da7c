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
  double twist = 0.34;  // turns of the plies per d; 2/d is hard, 0.2/d soft. Positive: Z twist
  double fuzz =
      1;  // loose fibres, as a share of the usual number; drawn where a yarn is 14 pixels thick or more
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

// A yarn's triangles in YarnScene::indices: those of segment k of its spline start at first + k *
// per_segment; after the last come its two ends.
struct YarnPart {
  std::uint32_t first = 0, per_segment = 0, count = 0;
};

struct YarnScene {
  std::vector<SceneVertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise from outside
  std::vector<YarnPart> parts;         // by yarn
  // pairs of vertices, a line each; along[0] runs from 0 at a hair's root to 1 at its tip
  std::vector<std::uint32_t> hair_indices;
  // the scene is drawn once at each of these: (0, 0, 0), or the periodic repeats
  std::vector<std::array<float, 3>> offsets;
  Vec3 centre;    // of the scene, in the fabric's coordinates
  Bounds bounds;  // of all that is drawn, in the fabric's coordinates
  YarnLook look;
};

struct SceneOptions {
  // periodic fabrics: cells along each lattice vector; 0: enough for 6 wales, 6 courses
  std::array<int, 2> repeats{0, 0};
  double pixels_per_diameter = 24;  // size on the screen for which the mesh is fine enough
  YarnLook look;
  // by yarn and segment of its spline, sRGB; empty: every yarn in its own colour
  std::vector<std::vector<std::array<std::uint8_t, 3>>> colours{};
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
