// The eye that looks at a fabric, and the small float matrices that OpenGL wants.
#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "base/vec3.hpp"

namespace loopwright {

// Column-major, as OpenGL takes it; multiplies column vectors.
using Matrix4 = std::array<float, 16>;
Matrix4 operator*(const Matrix4& a, const Matrix4& b);

struct Bounds {
  Vec3 lower, upper;
  Vec3 centre() const { return (lower + upper) * 0.5; }
  Vec3 corner(int i) const {
    return {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y,
            (i & 4) != 0 ? upper.z : lower.z};
  }
};

// front: from +z, wales upward; back: from -z, so left and right are swapped; left: from -x; top: from +y, +z
// down; corner: from the right, above and in front; left_corner: the same from the left.
enum class View { front, back, left, top, corner, left_corner };
std::optional<View> view_named(std::string_view name);

// `height` is what the picture's height shows at the target, in d, for both kinds of projection, so that
// zooming is one number. Orthographic where field_of_view_deg is 0.
struct Camera {
  Vec3 target;
  Vec3 backward{0, 0, 1};  // unit vector from the target to the eye
  Vec3 up{0, 1, 0};        // unit vector across `backward`
  double height = 10;
  double field_of_view_deg = 0;
  double reach = 100;  // everything within this distance of the target is between the near and far planes

  Vec3 right() const { return cross(up, backward); }
  double eye_distance() const;              // of a perspective camera
  Matrix4 view() const;                     // world to eye, about the target
  Matrix4 projection(double aspect) const;  // aspect: width over height
};

// The camera of a named view with the whole box in the picture and `margin` times the room that it needs.
Camera fitted_camera(View view, const Bounds& bounds, double aspect, double margin = 1.06);

// Turns the camera about its target: `yaw` about the camera's up axis, `pitch` about its right axis, in
// radians.
Camera turned(const Camera& camera, double yaw, double pitch);

}  // namespace loopwright
