// A plain-knit piece from a closed formula, for the tests of this stage.
#pragma once
#include <cmath>
#include <numbers>

#include "geometry/fabric.hpp"

namespace loopwright::test {

// Control points whose uniform cubic B-spline follows the given points to fourth order: q = p - p''/6.
template <class Curve>
Vec3 control_point_on(const Curve& curve, double t, double step) {
  return (curve(t) * 8.0 - curve(t - step) - curve(t + step)) / 6.0;
}

// gamma(t) = (t + 1.5 sin 2t, 4 cos t, -cos 2t), one loop a turn of t, rows 4.5 apart, tube radius 0.8;
// everything is divided by 1.6, so that the diameter is 1. Legs lie in front: the front view shows face
// stitches.
inline Vec3 plain_curve(double t) {
  return Vec3{t + 1.5 * std::sin(2 * t), 4 * std::cos(t), -std::cos(2 * t)} / 1.6;
}
inline constexpr double plain_wale_spacing = 2 * std::numbers::pi / 1.6, plain_course_spacing = 4.5 / 1.6;

// `wales` x `courses` loops, a yarn per course; `per_loop` segments a loop.
inline Fabric plain_piece(int wales, int courses, int per_loop = 16) {
  Fabric fabric;
  fabric.name = "plain";
  fabric.diameter_mm = 0.5;
  fabric.wales = wales;
  fabric.courses = courses;
  fabric.width = wales * plain_wale_spacing;
  fabric.height = courses * plain_course_spacing;
  const double step = 2 * std::numbers::pi / per_loop;
  for (int row = 0; row < courses; ++row) {
    FabricYarn yarn;
    yarn.yarn = YarnId(row);
    yarn.carrier = CarrierId(0);
    for (int i = -1; i <= wales * per_loop + 1; ++i)
      yarn.control_points.push_back(control_point_on(plain_curve, std::numbers::pi + i * step, step) +
                                    Vec3{0, row * plain_course_spacing, 0});
    yarn.held.assign(yarn.control_points.size(), 0);
    yarn.held.front() = yarn.held.back() = 1;
    fabric.yarns.push_back(yarn);
    fabric.yarns.back().segment_rest_length = arc_length(fabric, fabric.yarns.back()) / yarn.segments();
    for (int wale = 0; wale < wales; ++wale)
      fabric.loops.push_back({LoopId(row * wales + wale),
                              row,
                              1.0 * wale * per_loop,
                              (wale + 0.5) * per_loop,
                              (wale + 1.0) * per_loop,
                              {row + 1, wale + 1},
                              LoopKind::knit,
                              StitchSide::front});
    if (row > 0)
      for (int wale = 0; wale < wales; ++wale)
        fabric.interlacings.push_back(
            {LoopId((row - 1) * wales + wale), LoopId(row * wales + wale), 1, {0, 0}});
  }
  return fabric;
}

// One loop that repeats in both directions.
inline Fabric plain_cell(int per_loop = 16) {
  Fabric fabric;
  fabric.name = "plain cell";
  fabric.diameter_mm = 0.5;
  fabric.periodic = true;
  fabric.wales = fabric.courses = 1;
  fabric.width = plain_wale_spacing;
  fabric.height = plain_course_spacing;
  FabricYarn yarn;
  yarn.yarn = YarnId(0);
  yarn.carrier = CarrierId(0);
  yarn.periodic = true;
  yarn.shift = {1, 0};
  const double step = 2 * std::numbers::pi / per_loop;
  for (int i = 0; i < per_loop; ++i)
    yarn.control_points.push_back(control_point_on(plain_curve, std::numbers::pi + (i - 1) * step, step));
  yarn.held.assign(yarn.control_points.size(), 0);
  fabric.yarns.push_back(yarn);
  fabric.yarns.back().segment_rest_length = arc_length(fabric, fabric.yarns.back()) / per_loop;
  fabric.loops.push_back(
      {LoopId(0), 0, 0, per_loop / 2.0, 1.0 * per_loop, {1, 1}, LoopKind::knit, StitchSide::front});
  fabric.interlacings.push_back({LoopId(0), LoopId(0), 1, {0, 1}});
  return fabric;
}

// A straight open yarn of the given length along x.
inline Fabric straight_yarn(double length, int segments = 20, double diameter = 1) {
  Fabric fabric;
  fabric.name = "straight";
  FabricYarn yarn;
  yarn.yarn = YarnId(0);
  yarn.carrier = CarrierId(0);
  yarn.diameter = diameter;
  for (int i = -1; i <= segments + 1; ++i) yarn.control_points.push_back({length * i / segments, 0, 0});
  yarn.held.assign(yarn.control_points.size(), 0);
  yarn.segment_rest_length = length / segments;
  fabric.yarns.push_back(yarn);
  fabric.width = length;
  return fabric;
}

}  // namespace loopwright::test
