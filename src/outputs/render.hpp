// Pictures of a fabric, drawn without a screen.
#pragma once
#include <array>

#include "geometry/fabric.hpp"
#include "outputs/camera.hpp"
#include "outputs/headless_gl.hpp"
#include "outputs/image.hpp"
#include "outputs/yarn_renderer.hpp"

namespace loopwright {

struct RenderOptions {
  View view = View::front;
  int width = 1600, height = 1200;   // pixels, 16 to 16384
  std::array<int, 2> repeats{0, 0};  // periodic fabrics: cells to draw; 0: enough for 6 wales and 6 courses
  double margin = 1.06;              // the picture's size over the size that the fabric needs
  YarnLook look;
  DrawStyle style;
};

// Draws the whole fabric, fitted to the picture, four samples a pixel. Throws NoOpenGl where no OpenGL can be
// had, std::invalid_argument for a fabric without yarn, with numbers that are not finite, or for a size out
// of range.
Image render(const Fabric& fabric, const RenderOptions& options = {});

// The same with a camera of one's own.
Image render(const Fabric& fabric, const Camera& camera, const RenderOptions& options);

}  // namespace loopwright
