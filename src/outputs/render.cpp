#include "outputs/render.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "outputs/canvas.hpp"

namespace loopwright {
namespace {

// The resolve mixed the background's colour, at alpha 0, into the edges; PNG wants the yarn's own colour
// there.
void take_out_background(Image& image, const std::array<std::uint8_t, 3>& background) {
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    const int alpha = image.pixels[i + 3];
    if (alpha == 0 || alpha == 255) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const int own = (image.pixels[i + c] * 255 - background[c] * (255 - alpha)) / alpha;
      image.pixels[i + c] = static_cast<std::uint8_t>(std::clamp(own, 0, 255));
    }
  }
}

void check(const RenderOptions& options) {
  if (options.width < 16 || options.height < 16 || options.width > 16384 || options.height > 16384)
    throw std::invalid_argument("a picture has 16 to 16384 pixels a side, not " +
                                std::to_string(options.width) + " x " + std::to_string(options.height));
}

}  // namespace

Image render(const Fabric& fabric, const RenderOptions& options) {
  check(options);
  const Bounds bounds = fabric_bounds(fabric, drawn_repeats(fabric, options.repeats));
  const double aspect = static_cast<double>(options.width) / options.height;
  return render(fabric, fitted_camera(options.view, bounds, aspect, options.margin), options);
}

Image render(const Fabric& fabric, const Camera& camera, const RenderOptions& options) {
  check(options);
  const YarnScene scene = yarn_scene(fabric, {options.repeats, options.height / camera.height, options.look});
  const HeadlessGl context;
  YarnRenderer renderer;
  const Canvas canvas(options.width, options.height);
  renderer.upload(scene);
  renderer.draw(camera, options.style, options.width, options.height);
  Image image = canvas.pixels();
  if (options.style.transparent) take_out_background(image, options.style.background);
  return image;
}

}  // namespace loopwright
