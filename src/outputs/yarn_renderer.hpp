// Draws yarn with OpenGL 3.3 core into whatever framebuffer is bound: a picture without a screen, or a
// window. Knows neither EGL nor a window system; a current context is all that it asks for.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "outputs/camera.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {

struct DrawStyle {
  std::array<std::uint8_t, 3> background{246, 245, 242};  // sRGB
  bool transparent = false;                               // background alpha 0 and no table; yarn has alpha 1
  bool shadows = true;  // real shadows of the key light; without them redrawing is about half the work
  bool table = true;    // the background takes the cloth's shadow in views across the cloth
};

// Every call needs the context that was current at construction. Throws std::runtime_error where the driver
// refuses.
class YarnRenderer {
 public:
  YarnRenderer();
  ~YarnRenderer();  // the context must be current
  YarnRenderer(const YarnRenderer&) = delete;
  YarnRenderer& operator=(const YarnRenderer&) = delete;

  // Copies a scene to the GPU in place of the one before.
  void upload(const YarnScene& scene);

  // Draws only these triangles of the uploaded scene: first index and count of indices of each run. Hairs are
  // left out then. Nothing: all of them again, as after upload().
  struct Run {
    std::uint32_t first = 0, count = 0;
  };
  void show_only(std::optional<std::vector<Run>> runs) { shown_ = std::move(runs); }

  // Clears and draws a viewport of `width` x `height` pixels in the bound framebuffer, which must have a
  // depth buffer. The camera is in the fabric's coordinates. Leaves depth test, face culling and blending
  // off.
  void draw(const Camera& camera, const DrawStyle& style, int width, int height);

 private:
  struct Light;
  Light key_light(const Camera& camera, double pixels_per_diameter) const;
  void draw_shadow_map(const Light& light);
  void draw_table(const Camera& camera, const DrawStyle& style, const Light& light,
                  const Matrix4& view_projection);
  void draw_yarns();
  void draw_hairs();
  void set_view(unsigned program, const Camera& camera, const Light& light, const Matrix4& view_projection,
                bool shadows) const;

  unsigned yarn_program_ = 0, hair_program_ = 0, depth_program_ = 0, table_program_ = 0;
  unsigned vertex_array_ = 0, empty_vertex_array_ = 0, vertices_ = 0, indices_ = 0, hair_indices_ = 0,
           offsets_ = 0;
  unsigned shadow_framebuffer_ = 0, shadow_texture_ = 0;
  int shadow_size_ = 0, largest_texture_ = 2048;
  std::optional<std::vector<Run>> shown_;
  int index_count_ = 0, hair_index_count_ = 0, copies_ = 0;
  Vec3 centre_;
  Bounds bounds_;
  YarnLook look_;
};

}  // namespace loopwright
