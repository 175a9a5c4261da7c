#include "outputs/canvas.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace loopwright {

Canvas::Canvas(int width, int height) : width_(width), height_(height) {
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

Canvas::~Canvas() {
  glDeleteRenderbuffers(3, buffers_.data());
  glDeleteFramebuffers(2, framebuffers_.data());
}

void Canvas::bind() const { glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[0]); }

Image Canvas::pixels() const {
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

void Canvas::storage(std::size_t framebuffer, GLuint buffer, GLenum format, GLenum attachment,
                     GLsizei samples) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[framebuffer]);
  glBindRenderbuffer(GL_RENDERBUFFER, buffer);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width_, height_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
}

}  // namespace loopwright
