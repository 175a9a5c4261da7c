// The first paper's pictures of its model (figures 3, 4 and 12 to 14): binding points, masses, springs and
// centrelines over a floor grid.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "loop_scale/loop_model.hpp"
#include "outputs/camera.hpp"
#include "outputs/image.hpp"

namespace loopwright {

//   net    the paper's figures 12 to 14: masses red, lower binding points blue, upper ones green, springs
//   grey,
//          centrelines dashed black. A binding point has the place of its mass; so that it is seen, its cube
//          hangs below the mass (upper) or stands on it (lower).
//   sides  figures 3 and 4: centrelines of front loops green, of rear loops blue
enum class StructureStyle : std::uint8_t { net, sides };

// What is drawn of one state; lengths in d.
struct StructureScene {
  struct Cube {
    Vec3 centre;
    double side = 1;
    std::array<std::uint8_t, 3> colour{};
  };
  struct Line {
    std::size_t first = 0, count = 0;  // of `points`
    std::array<std::uint8_t, 3> colour{};
    double dash = 0;   // length of a dash and of a gap; 0: drawn through
    double width = 1;  // share of the picture's usual line
  };
  std::vector<Cube> cubes;
  std::vector<Line> lines;
  std::vector<Vec3> points;  // of all lines

  void add_line(std::span<const Vec3> way, std::array<std::uint8_t, 3> colour, double dash, double width);
};

// `aside` moves it, so that several moments stand side by side.
StructureScene structure_scene(const LoopModel& model, const NetState& state, StructureStyle style,
                               const Vec3& aside = {});
void append(StructureScene& scene, const StructureScene& other);
// The floor: a grid below everything, at the height of the lowest point less a little.
void add_floor(StructureScene& scene, const Bounds& bounds);
Bounds bounds_of(const StructureScene& scene);

// Draws with OpenGL 3.3 core into whatever framebuffer is bound, which must have a depth buffer; every call
// needs the context that was current at construction.
class StructurePainter {
 public:
  StructurePainter();   // throws std::runtime_error where the driver refuses
  ~StructurePainter();  // the context must be current
  StructurePainter(const StructurePainter&) = delete;
  StructurePainter& operator=(const StructurePainter&) = delete;

  // Adds the scene to what is drawn already, in a viewport of `width` x `height` pixels whose usual line is
  // `line_pixels` wide.
  void draw(const StructureScene& scene, const Camera& camera, int width, int height, double line_pixels);
  // Clears the viewport first.
  void clear(std::array<std::uint8_t, 3> background, int width, int height);

 private:
  struct Gl;
  std::unique_ptr<Gl> gl_;
};

// Draws without a screen, four samples a pixel; keeps its OpenGL context, so that a sequence is quick.
class StructureRenderer {
 public:
  StructureRenderer(int width, int height);  // throws NoOpenGl, std::invalid_argument
  ~StructureRenderer();
  StructureRenderer(const StructureRenderer&) = delete;
  StructureRenderer& operator=(const StructureRenderer&) = delete;

  Image draw(const StructureScene& scene, const Camera& camera);

 private:
  struct Gl;
  std::unique_ptr<Gl> gl_;
  int width_, height_;
};

}  // namespace loopwright
