// An OpenGL 3.3 core context without a screen, through EGL.
#pragma once
#include <stdexcept>
#include <string>

namespace loopwright {

// No OpenGL can be had here. The message says what to install.
class NoOpenGl : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Current on this thread from construction to destruction; then what was current before is so again. Tried in
// order: Mesa without a surface (software or GPU), the first EGL device that works (GPU drivers of their
// own), the default display.
class HeadlessGl {
 public:
  HeadlessGl();  // throws NoOpenGl
  ~HeadlessGl();
  HeadlessGl(const HeadlessGl&) = delete;
  HeadlessGl& operator=(const HeadlessGl&) = delete;

  std::string description() const;  // renderer and version, for messages

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  void* old_display_ = nullptr;
  void* old_context_ = nullptr;
  void* old_draw_ = nullptr;
  void* old_read_ = nullptr;
};

}  // namespace loopwright
