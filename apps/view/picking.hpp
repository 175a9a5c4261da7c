// What lies under the mouse.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "geometry/fabric.hpp"
#include "outputs/camera.hpp"

namespace loopwright {

// A line of sight through a place of the picture: x and y from -1 (left, bottom) to 1.
struct Sight {
  Vec3 from, direction;  // unit vector away from the eye
};
Sight line_of_sight(const Camera& camera, double aspect, double x, double y);

struct PickedYarn {
  int yarn = 0;
  double t = 0;  // parameter of the yarn
  std::array<int, 2> cell{0, 0};
  int loop = -1;  // index into Fabric::loops of the span that holds it; -1: none does
  Vec3 place;
};

// The foremost yarn on a line of sight, among the drawn repeats. `fed`: how far each yarn is there, in its
// parameter; empty: whole.
std::optional<PickedYarn> yarn_at(const Fabric& fabric, std::array<int, 2> repeats, const Sight& sight,
                                  const std::vector<double>& fed = {});

// The span of a fabric's loops that holds a place of a yarn; -1 if none does.
int loop_span_at(const Fabric& fabric, int yarn, double t);

}  // namespace loopwright
