// Shader programs, for whatever draws with OpenGL.
#pragma once
#include <epoxy/gl.h>

namespace loopwright {

// Compiles and links two shaders, for the context that is current. Throws std::runtime_error with the
// driver's log.
GLuint linked_program(const char* vertex_shader, const char* fragment_shader);

}  // namespace loopwright
