#include "outputs/headless_gl.hpp"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <vector>

namespace loopwright {
namespace {

constexpr const char* remedy =
    "install the Debian packages libopengl0, libegl-mesa0 and libgl1-mesa-dri (they draw in software "
    "where there is no graphics card)";

// libepoxy ends the program where a library is missing, so each is looked for first.
void require_libraries() {
  const auto there = [](const char* library) { return dlopen(library, RTLD_LAZY | RTLD_LOCAL) != nullptr; };
  const char* missing = nullptr;
  if (!there("libEGL.so.1")) missing = "libEGL.so.1";
  if (!there("libOpenGL.so.0") && !there("libGL.so.1")) missing = "libOpenGL.so.0";
  if (missing != nullptr)
    throw NoOpenGl(std::string("no picture can be drawn: the library ") + missing + " is missing; " + remedy);
}

// Displays in the order in which they are tried.
std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> found;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
      found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
      std::array<EGLDeviceEXT, 8> devices{};
      EGLint count = 0;
      if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE)
        for (EGLint i = 0; i < count; ++i)
          found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT,
                                                   devices[static_cast<std::size_t>(i)], nullptr));
    }
  }
  found.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return found;
}

// A context on a display without a surface, or EGL_NO_CONTEXT.
EGLContext context_on(EGLDisplay display) {
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || eglInitialize(display, &major, &minor) != EGL_TRUE) return EGL_NO_CONTEXT;
  if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context") ||
      eglBindAPI(EGL_OPENGL_API) != EGL_TRUE)
    return EGL_NO_CONTEXT;
  const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count < 1) config = nullptr;
  const std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                      3,
                                      EGL_CONTEXT_MINOR_VERSION,
                                      3,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                      EGL_NONE};
  return eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
}

}  // namespace

HeadlessGl::HeadlessGl() {
  require_libraries();
  old_display_ = eglGetCurrentDisplay();
  old_context_ = eglGetCurrentContext();
  old_draw_ = eglGetCurrentSurface(EGL_DRAW);
  old_read_ = eglGetCurrentSurface(EGL_READ);
  for (EGLDisplay display : displays()) {
    EGLContext context = context_on(display);
    if (context == EGL_NO_CONTEXT) continue;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
      display_ = display;
      context_ = context;
      return;
    }
    eglDestroyContext(display, context);
  }
  throw NoOpenGl(std::string("no picture can be drawn: EGL gives no OpenGL 3.3 context; ") + remedy);
}

// The display stays initialised: it may be shared with others, and starting it again costs time.
HeadlessGl::~HeadlessGl() {
  if (old_context_ != EGL_NO_CONTEXT)
    eglMakeCurrent(old_display_, old_draw_, old_read_, old_context_);
  else
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

std::string HeadlessGl::description() const {
  const auto text = [](GLenum name) {
    const GLubyte* s = glGetString(name);
    return s != nullptr ? std::string(reinterpret_cast<const char*>(s)) : std::string("?");
  };
  return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

}  // namespace loopwright
