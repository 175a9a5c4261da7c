// How the camera follows the mouse, and the floor that it stands on.
#pragma once
#include <array>
#include <cstdint>

#include "outputs/camera.hpp"
#include "outputs/structure_picture.hpp"

namespace loopwright {

// What the mouse does while a button is held: as in FreeCAD (middle turns with shift or left, pans alone) or
// Blender (middle turns, shift and middle pans). In both the left button alone chooses and pulls, or turns
// when it starts on nothing.
enum class MouseHabit { freecad, blender };
enum class MouseAct { none, choose, turn, pan, zoom };
struct MouseButtons {
  bool left = false, middle = false, right = false, shift = false, control = false;
};
MouseAct mouse_act(MouseHabit habit, const MouseButtons& buttons);

// `dx`, `dy`: in pixels, y downwards; `height`: of the picture.
Camera turned_by_mouse(const Camera& camera, double dx, double dy);
Camera panned_by_mouse(const Camera& camera, double dx, double dy, double height);
// The place under the mouse stays: x, y from -1 to 1. Steps: of a wheel, positive comes nearer.
Camera zoomed_by_mouse(const Camera& camera, double steps, double aspect, double x, double y);

// The same gaze with the whole box in the picture; perspective: 18 degrees, or none.
Camera fitted(const Camera& camera, const Bounds& bounds, double aspect, double margin = 1.1);
Camera with_projection(Camera camera, bool perspective);

// A grid of 1, 2 or 5 times a power of ten millimetres under the cloth, some 16 lines each way.
struct FloorGrid {
  StructureScene scene;
  double square_mm = 0;
};
FloorGrid floor_grid(const Bounds& bounds, double diameter_mm, std::array<std::uint8_t, 3> colour);

// A bar of a round length that takes about a fifth of the picture.
struct ScaleBar {
  double length_mm = 0, pixels = 0;
};
ScaleBar scale_bar(const Camera& camera, double diameter_mm, double width, double height);

}  // namespace loopwright
