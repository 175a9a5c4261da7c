// What OpenGL draws into without a screen.
#pragma once
#include <array>

#include "outputs/image.hpp"

namespace loopwright {

// A framebuffer with four samples a pixel (or as many as the driver has) and a plain one that it is resolved
// into. Bound for drawing after construction. An OpenGL context must be current from construction to
// destruction. Throws std::invalid_argument for more pixels than the driver draws.
class Canvas {
 public:
  Canvas(int width, int height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void bind() const;     // draw here (again, after pixels())
  Image pixels() const;  // what was drawn, rows from top to bottom

 private:
  void storage(std::size_t framebuffer, unsigned buffer, unsigned format, unsigned attachment,
               int samples) const;

  int width_, height_;
  std::array<unsigned, 2> framebuffers_{};
  std::array<unsigned, 3> buffers_{};
};

}  // namespace loopwright
