#include "orbit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace loopwright {
namespace {

constexpr double perspective_deg = 18;  // as the named corner view

// The largest 1, 2 or 5 times a power of ten that is not above `most`.
double round_length(double most) {
  const double power = std::pow(10, std::floor(std::log10(std::max(most, 1e-9))));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= most) return factor * power;
  return power;
}

}  // namespace

MouseAct mouse_act(MouseHabit habit, const MouseButtons& b) {
  if (b.middle) {
    if (habit == MouseHabit::blender)
      return b.shift ? MouseAct::pan : b.control ? MouseAct::zoom : MouseAct::turn;
    return b.left || b.shift ? MouseAct::turn : b.control ? MouseAct::zoom : MouseAct::pan;
  }
  if (b.right) return b.shift ? MouseAct::pan : MouseAct::turn;
  return b.left ? MouseAct::choose : MouseAct::none;
}

Camera turned_by_mouse(const Camera& camera, double dx, double dy) {
  constexpr double radians_a_pixel = 0.008;
  return turned(camera, -dx * radians_a_pixel, -dy * radians_a_pixel);
}

Camera panned_by_mouse(const Camera& camera, double dx, double dy, double height) {
  Camera out = camera;
  const double scale = camera.height / std::max(height, 1.0);
  out.target += camera.up * (dy * scale) - camera.right() * (dx * scale);
  return out;
}

Camera zoomed_by_mouse(const Camera& camera, double steps, double aspect, double x, double y) {
  Camera out = camera;
  out.height = std::clamp(camera.height * std::pow(0.87, steps), 0.2, 1e6);
  const double moved = (camera.height - out.height) / 2;
  out.target += camera.right() * (x * moved * aspect) + camera.up * (y * moved);
  return out;
}

Camera fitted(const Camera& camera, const Bounds& bounds, double aspect, double margin) {
  Camera out = camera;
  out.target = bounds.centre();
  const double slope = std::tan(camera.field_of_view_deg / 2 * std::numbers::pi / 180);
  double height = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 c = bounds.corner(i) - out.target;
    const double across = std::max(std::abs(dot(c, out.right())) / aspect, std::abs(dot(c, out.up)));
    height = std::max(height, 2 * (across + slope * dot(c, out.backward)));
  }
  out.height = std::max(height * margin, 1e-3);
  // enough for the floor, which is wider than the cloth
  out.reach = 4 * std::max(distance(bounds.lower, bounds.upper), 1.0);
  return out;
}

Camera with_projection(Camera camera, bool perspective) {
  camera.field_of_view_deg = perspective ? perspective_deg : 0;
  return camera;
}

FloorGrid floor_grid(const Bounds& bounds, double diameter_mm, std::array<std::uint8_t, 3> colour) {
  FloorGrid grid;
  const Vec3 size = bounds.upper - bounds.lower, centre = bounds.centre();
  const double wide = std::max(std::max(size.x, size.z), 1.0) * 1.3;
  grid.square_mm = round_length(wide * diameter_mm / 12);
  const double square = grid.square_mm / diameter_mm;
  const double y = bounds.lower.y - 0.04 * std::max(size.y, 1.0);
  // lines lie on whole millimetres of the fabric's own axes
  const auto lines = [&](double middle, double reach) {
    return std::pair{static_cast<int>(std::floor((middle - reach) / square)),
                     static_cast<int>(std::ceil((middle + reach) / square))};
  };
  const auto [x0, x1] = lines(centre.x, wide / 2);
  const auto [z0, z1] = lines(centre.z, std::max(wide / 4, size.z));
  for (int i = x0; i <= x1; ++i)
    grid.scene.add_line(std::array{Vec3{i * square, y, z0 * square}, Vec3{i * square, y, z1 * square}},
                        colour, 0, i % 10 == 0 ? 1.4 : 0.8);
  for (int k = z0; k <= z1; ++k)
    grid.scene.add_line(std::array{Vec3{x0 * square, y, k * square}, Vec3{x1 * square, y, k * square}},
                        colour, 0, k % 10 == 0 ? 1.4 : 0.8);
  return grid;
}

ScaleBar scale_bar(const Camera& camera, double diameter_mm, double width, double height) {
  const double mm_a_pixel = camera.height * diameter_mm / std::max(height, 1.0);
  ScaleBar bar;
  bar.length_mm = round_length(width / 4 * mm_a_pixel);
  bar.pixels = bar.length_mm / mm_a_pixel;
  return bar;
}

}  // namespace loopwright
