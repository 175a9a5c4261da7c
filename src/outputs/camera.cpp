#include "outputs/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopwright {
namespace {

struct Gaze {
  Vec3 backward, up;
  double field_of_view_deg;
};

Gaze gaze_of(View view) {
  switch (view) {
    case View::front:
      return {{0, 0, 1}, {0, 1, 0}, 0};
    case View::back:
      return {{0, 0, -1}, {0, 1, 0}, 0};
    case View::left:
      return {{-1, 0, 0}, {0, 1, 0}, 0};
    case View::top:
      return {{0, 1, 0}, {0, 0, -1}, 0};
    case View::corner:
    case View::left_corner:
      break;
  }
  const Vec3 backward = normalized({view == View::corner ? 0.5 : -0.5, 0.42, 1});
  const Vec3 up{0, 1, 0};
  return {backward, normalized(up - backward * dot(up, backward)), 18};
}

Vec3 rotated(const Vec3& v, const Vec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

float f(double v) { return static_cast<float>(v); }

}  // namespace

Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
  Matrix4 product{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t k = 0; k < 4; ++k) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return product;
}

std::optional<View> view_named(std::string_view name) {
  if (name == "front") return View::front;
  if (name == "back") return View::back;
  if (name == "left") return View::left;
  if (name == "top") return View::top;
  if (name == "corner") return View::corner;
  if (name == "left-corner") return View::left_corner;
  return std::nullopt;
}

double Camera::eye_distance() const {
  return height / 2 / std::tan(field_of_view_deg / 2 * std::numbers::pi / 180);
}

Matrix4 Camera::view() const {
  const Vec3 r = right();
  return {f(r.x),
          f(up.x),
          f(backward.x),
          0,
          f(r.y),
          f(up.y),
          f(backward.y),
          0,
          f(r.z),
          f(up.z),
          f(backward.z),
          0,
          f(-dot(r, target)),
          f(-dot(up, target)),
          f(-dot(backward, target)),
          1};
}

Matrix4 Camera::projection(double aspect) const {
  const double half = height / 2;
  if (field_of_view_deg <= 0)
    return {f(1 / (half * aspect)), 0, 0, 0, 0, f(1 / half), 0, 0, 0, 0, f(-1 / reach), 0, 0, 0, 0, 1};
  // the eye stands eye_distance behind the target: shift, then project
  const double away = eye_distance(), near = std::max(away - reach, away * 0.02), far = away + reach;
  const double scale = away / half;
  const Matrix4 project{f(scale / aspect),
                        0,
                        0,
                        0,
                        0,
                        f(scale),
                        0,
                        0,
                        0,
                        0,
                        f((near + far) / (near - far)),
                        -1,
                        0,
                        0,
                        f(2 * near * far / (near - far)),
                        0};
  const Matrix4 shift{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, f(-away), 1};
  return project * shift;
}

Camera fitted_camera(View view, const Bounds& bounds, double aspect, double margin) {
  const Gaze gaze = gaze_of(view);
  Camera camera;
  camera.target = bounds.centre();
  camera.backward = gaze.backward;
  camera.up = gaze.up;
  camera.field_of_view_deg = gaze.field_of_view_deg;
  const Vec3 right = camera.right();
  const double slope = std::tan(gaze.field_of_view_deg / 2 * std::numbers::pi / 180);
  // each corner asks for a height; perspective: |y| <= slope * (distance - z) with distance = height / (2
  // slope)
  double height = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 c = bounds.corner(i) - camera.target;
    const double across = std::max(std::abs(dot(c, right)) / aspect, std::abs(dot(c, camera.up)));
    height = std::max(height, 2 * (across + slope * dot(c, camera.backward)));
  }
  camera.height = std::max(height * margin, 1e-3);
  camera.reach = std::max(distance(bounds.lower, bounds.upper), 1.0);
  return camera;
}

Camera turned(const Camera& camera, double yaw, double pitch) {
  Camera out = camera;
  out.backward = rotated(out.backward, camera.up, yaw);
  const Vec3 right = cross(camera.up, out.backward);
  out.backward = normalized(rotated(out.backward, right, pitch));
  const Vec3 up = rotated(camera.up, right, pitch);
  out.up = normalized(up - out.backward * dot(up, out.backward));
  return out;
}

}  // namespace loopwright
