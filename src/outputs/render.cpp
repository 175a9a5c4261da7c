#include "outputs/render.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace loopwright {
namespace {

// A framebuffer with several samples a pixel, and a plain one that it is resolved into.
class Canvas {
 public:
  Canvas(int width, int height) : width_(width), height_(height) {
    GLint most_samples = 1, most_pixels = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most_pixels);
    if (std::max(width, height) > most_pixels)
      throw std::invalid_argument("this graphics driver draws at most " + std::to_string(most_pixels) +
                                  " pixels a side");
    glGenFramebuffers(2, framebuffers_.data());
    glGenRenderbuffers(3, buffers_.data());
    storage(0, buffers_[0], GL_RGBA8, GL_COLOR_ATTACHMENT0, std::min(4, most_samples));
    storage(0, buffers_[1], GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, std::min(4, most_samples));
    storage(1, buffers_[2], GL_RGBA8, GL_COLOR_ATTACHMENT0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[0]);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("the OpenGL driver gives no framebuffer of " + std::to_string(width) + " x " +
                               std::to_string(height));
  }
  ~Canvas() {
    glDeleteRenderbuffers(3, buffers_.data());
    glDeleteFramebuffers(2, framebuffers_.data());
  }
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  Image pixels() const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[0]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[1]);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[1]);
    const auto row = 4 * static_cast<std::size_t>(width_), rows = static_cast<std::size_t>(height_);
    Image image{width_, height_, std::vector<std::uint8_t>(row * rows)};
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
    if (glGetError() != GL_NO_ERROR) throw std::runtime_error("the OpenGL driver failed while drawing");
    // OpenGL's first row is the lowest
    for (std::size_t y = 0; y < rows / 2; ++y)
      std::swap_ranges(image.pixels.begin() + static_cast<std::ptrdiff_t>(y * row),
                       image.pixels.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                       image.pixels.begin() + static_cast<std::ptrdiff_t>((rows - 1 - y) * row));
    return image;
  }

 private:
  void storage(std::size_t framebuffer, GLuint buffer, GLenum format, GLenum attachment,
               GLsizei samples) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[framebuffer]);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width_, height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
  }

  int width_, height_;
  std::array<GLuint, 2> framebuffers_{};
  std::array<GLuint, 3> buffers_{};
};

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
