#include "outputs/yarn_renderer.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "outputs/gl_program.hpp"
#include "outputs/yarn_shaders.hpp"

namespace loopwright {
namespace {

GLint place(GLuint program, const char* name) { return glGetUniformLocation(program, name); }
void set(GLuint program, const char* name, float v) { glUniform1f(place(program, name), v); }
void set(GLuint program, const char* name, const Matrix4& m) {
  glUniformMatrix4fv(place(program, name), 1, GL_FALSE, m.data());
}
void set(GLuint program, const char* name, const Vec3& v) {
  glUniform3f(place(program, name), static_cast<float>(v.x), static_cast<float>(v.y),
              static_cast<float>(v.z));
}

const void* at_offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

void attribute(GLuint index, GLint size, GLenum type, GLboolean normalised, std::size_t offset) {
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, size, type, normalised, sizeof(SceneVertex), at_offset(offset));
}

}  // namespace

// An orthographic camera of the sun: `matrix` carries the scene's box into the unit cube.
struct YarnRenderer::Light {
  Vec3 direction;  // unit vector to the light
  Matrix4 matrix;
  double texels_per_diameter;
  int size;
};

YarnRenderer::YarnRenderer() {
  if (epoxy_gl_version() < 33)
    throw std::runtime_error("OpenGL 3.3 is needed, the driver offers " +
                             std::to_string(epoxy_gl_version() / 10) + "." +
                             std::to_string(epoxy_gl_version() % 10));
  yarn_program_ = linked_program(shaders::yarn_vertex, shaders::yarn_fragment);
  hair_program_ = linked_program(shaders::yarn_vertex, shaders::hair_fragment);
  depth_program_ = linked_program(shaders::depth_vertex, shaders::depth_fragment);
  table_program_ = linked_program(shaders::table_vertex, shaders::table_fragment);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest_texture_);
  glGenVertexArrays(1, &vertex_array_);
  glGenVertexArrays(1, &empty_vertex_array_);
  glGenBuffers(1, &vertices_);
  glGenBuffers(1, &indices_);
  glGenBuffers(1, &hair_indices_);
  glGenBuffers(1, &offsets_);
  glGenFramebuffers(1, &shadow_framebuffer_);
  glGenTextures(1, &shadow_texture_);

  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(SceneVertex, position));
  attribute(1, 3, GL_FLOAT, GL_FALSE, offsetof(SceneVertex, along));
  attribute(2, 3, GL_BYTE, GL_TRUE, offsetof(SceneVertex, normal));
  attribute(3, 3, GL_BYTE, GL_TRUE, offsetof(SceneVertex, tangent));
  attribute(4, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(SceneVertex, colour));
  glBindBuffer(GL_ARRAY_BUFFER, offsets_);
  glEnableVertexAttribArray(5);
  glVertexAttribPointer(5, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glVertexAttribDivisor(5, 1);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBindVertexArray(0);
}

YarnRenderer::~YarnRenderer() {
  glDeleteTextures(1, &shadow_texture_);
  glDeleteFramebuffers(1, &shadow_framebuffer_);
  glDeleteBuffers(1, &offsets_);
  glDeleteBuffers(1, &hair_indices_);
  glDeleteBuffers(1, &indices_);
  glDeleteBuffers(1, &vertices_);
  glDeleteVertexArrays(1, &empty_vertex_array_);
  glDeleteVertexArrays(1, &vertex_array_);
  glDeleteProgram(table_program_);
  glDeleteProgram(depth_program_);
  glDeleteProgram(hair_program_);
  glDeleteProgram(yarn_program_);
}

void YarnRenderer::upload(const YarnScene& scene) {
  const auto fill = [](GLenum target, GLuint buffer, const auto& list) {
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(list.size() * sizeof(*list.data())), list.data(),
                 GL_STATIC_DRAW);
  };
  glBindVertexArray(vertex_array_);
  fill(GL_ARRAY_BUFFER, vertices_, scene.vertices);
  fill(GL_ARRAY_BUFFER, offsets_, scene.offsets);
  fill(GL_ELEMENT_ARRAY_BUFFER, hair_indices_, scene.hair_indices);
  fill(GL_ELEMENT_ARRAY_BUFFER, indices_, scene.indices);
  glBindVertexArray(0);
  if (glGetError() == GL_OUT_OF_MEMORY)
    throw std::runtime_error("the scene does not fit into graphics memory");
  shown_.reset();
  index_count_ = static_cast<int>(scene.indices.size());
  hair_index_count_ = static_cast<int>(scene.hair_indices.size());
  copies_ = static_cast<int>(scene.offsets.size());
  centre_ = scene.centre;
  bounds_ = {scene.bounds.lower - scene.centre, scene.bounds.upper - scene.centre};
  look_ = scene.look;
}

YarnRenderer::Light YarnRenderer::key_light(const Camera& camera, double pixels_per_diameter) const {
  Light light{};
  // over the viewer's left shoulder, high enough that legs throw their shadow on what lies beside them
  light.direction = normalized(camera.right() * -0.55 + camera.up * 0.75 + camera.backward * 1.0);
  Camera sun;
  sun.backward = light.direction;
  sun.up = normalized(camera.up - light.direction * dot(camera.up, light.direction));
  sun.target = (bounds_.lower + bounds_.upper) * 0.5;
  Vec3 half{1e-3, 1e-3, 1e-3};
  for (int i = 0; i < 8; ++i) {
    const Vec3 c = bounds_.corner(i) - sun.target;
    half = {std::max(half.x, std::abs(dot(c, sun.right()))), std::max(half.y, std::abs(dot(c, sun.up))),
            std::max(half.z, std::abs(dot(c, sun.backward)))};
  }
  const double extent = std::max(half.x, half.y) * 1.02;
  sun.height = 2 * extent;
  sun.reach = half.z * 1.1 + 2;
  light.matrix = sun.projection(1) * sun.view();
  const double wanted = std::exp2(std::ceil(std::log2(2 * extent * pixels_per_diameter)));
  light.size = std::clamp(static_cast<int>(std::min(wanted, 8192.0)), 512, std::min(largest_texture_, 4096));
  light.texels_per_diameter = light.size / (2 * extent);
  return light;
}

void YarnRenderer::draw_shadow_map(const Light& light) {
  GLint bound = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  glBindTexture(GL_TEXTURE_2D, shadow_texture_);
  if (shadow_size_ != light.size) {
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, light.size, light.size, 0, GL_DEPTH_COMPONENT,
                 GL_FLOAT, nullptr);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    shadow_size_ = light.size;
  }
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, shadow_framebuffer_);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_texture_, 0);
  const GLenum none = GL_NONE;
  glDrawBuffers(1, &none);
  glViewport(0, 0, light.size, light.size);
  glClear(GL_DEPTH_BUFFER_BIT);
  glUseProgram(depth_program_);
  set(depth_program_, "view_projection", light.matrix);
  draw_yarns();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(bound));
}

void YarnRenderer::draw_yarns() {
  glBindVertexArray(vertex_array_);
  if (!shown_)
    glDrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr, copies_);
  else
    for (const Run& run : *shown_)
      glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(run.count), GL_UNSIGNED_INT,
                              at_offset(run.first * sizeof(std::uint32_t)), copies_);
  glBindVertexArray(0);
}

// Hairs are mixed over what is drawn. They do not hide each other, so their order hardly shows.
void YarnRenderer::draw_hairs() {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, hair_indices_);
  glDrawElementsInstanced(GL_LINES, hair_index_count_, GL_UNSIGNED_INT, nullptr, copies_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBindVertexArray(0);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

// A plane under the cloth, where the camera looks across it. It has the colour of the background, so only the
// shadow shows.
void YarnRenderer::draw_table(const Camera& camera, const DrawStyle& style, const Light& light,
                              const Matrix4& view_projection) {
  const double facing = camera.backward.z;
  if (std::abs(facing) < 0.3) return;
  const Vec3 middle = (bounds_.lower + bounds_.upper) * 0.5, size = bounds_.upper - bounds_.lower;
  glUseProgram(table_program_);
  set(table_program_, "view_projection", view_projection);
  set(table_program_, "shadow_matrix", light.matrix);
  set(table_program_, "centre",
      Vec3{middle.x, middle.y, facing > 0 ? bounds_.lower.z - 0.4 : bounds_.upper.z + 0.4});
  set(table_program_, "side", Vec3{(facing > 0 ? 1 : -1) * (size.x + 8), 0, 0});
  set(table_program_, "rise", Vec3{0, size.y + 8, 0});
  const double blur = 1.1 * light.texels_per_diameter / light.size;
  set(table_program_, "shadow_blur", static_cast<float>(blur));
  glUniform3f(place(table_program_, "background"), static_cast<float>(style.background[0]) / 255.0F,
              static_cast<float>(style.background[1]) / 255.0F,
              static_cast<float>(style.background[2]) / 255.0F);
  glUniform1i(place(table_program_, "shadow_map"), 0);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(empty_vertex_array_);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glBindVertexArray(0);
  glEnable(GL_CULL_FACE);
}

// Makes a program current and sets what yarn and hair have in common.
void YarnRenderer::set_view(unsigned program, const Camera& camera, const Light& light,
                            const Matrix4& view_projection, bool shadows) const {
  glUseProgram(program);
  set(program, "view_projection", view_projection);
  set(program, "shadow_matrix", light.matrix);
  set(program, "shadow_offset", static_cast<float>(0.03 + 1.2 / light.texels_per_diameter));
  set(program, "shadow_strength", shadows ? 1.0F : 0.0F);
  const double blur = std::max(0.11 * light.texels_per_diameter, 1.0) / light.size;
  set(program, "shadow_blur", static_cast<float>(blur));
  set(program, "to_light", light.direction);
  set(program, "to_sky", normalized(camera.up + camera.backward * 0.6));
  set(program, "to_eye", camera.backward);
  const bool perspective = camera.field_of_view_deg > 0;
  set(program, "perspective", perspective ? 1.0F : 0.0F);
  set(program, "eye", perspective ? camera.target + camera.backward * camera.eye_distance() : Vec3{});
  glUniform1i(place(program, "shadow_map"), 0);
}

void YarnRenderer::draw(const Camera& camera, const DrawStyle& style, int width, int height) {
  Camera local = camera;  // the scene's coordinates are about its centre
  local.target -= centre_;
  const Matrix4 view_projection = local.projection(static_cast<double>(width) / height) * local.view();
  const Light light = key_light(local, height / camera.height);

  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  glActiveTexture(GL_TEXTURE0);
  const bool shadows = style.shadows && index_count_ > 0;
  if (shadows) draw_shadow_map(light);

  glViewport(0, 0, width, height);
  glClearColor(static_cast<float>(style.background[0]) / 255.0F,
               static_cast<float>(style.background[1]) / 255.0F,
               static_cast<float>(style.background[2]) / 255.0F, style.transparent ? 0.0F : 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (index_count_ > 0) {
    glBindTexture(GL_TEXTURE_2D, shadow_texture_);
    set_view(yarn_program_, local, light, view_projection, shadows);
    set(yarn_program_, "plies", static_cast<float>(look_.plies));
    set(yarn_program_, "twist", static_cast<float>(look_.twist));
    draw_yarns();
    if (shadows && style.table && !style.transparent) draw_table(local, style, light, view_projection);
    if (hair_index_count_ > 0 && !shown_) {
      set_view(hair_program_, local, light, view_projection, shadows);
      draw_hairs();
    }
  }
  glBindTexture(GL_TEXTURE_2D, 0);
  glUseProgram(0);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace loopwright
