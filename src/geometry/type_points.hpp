// Type value points: the points in space that every yarn's centreline goes through, for any structure.
//
// What makes a stitch is which yarn is in front at its crossings, so z is given there. For a loop of sign s
// (front stitch +1, rear stitch -1) whose children have sign c, in yarn radii from the binding points O and
// P:
//   T0 sinker (-4, -3, -1.5 mean s)   A  foot (-2.556, -1.556, -s)   T1 (-1, 0, 0)        B  lower leg
//   (-1.444, 1.556, +s) T2 mid-leg (O + P)/2 + (-2, 0, 0.75 (s + c)) A' upper leg P + (-2.556, -1.556, +c) T3
//   P + (-3, 0, 0)   B' head P + (-1.444, 1.556, -c)   T4 P + (0, 3, -1.5 c)
// and their mirror images. The child's A meets the parent's A', its B the parent's B'. Stacked heads, plated
// loops, tucks, floats and crossing legs are layered in z on top of that; see docs/geometry.md.
#pragma once
#include <vector>

#include "geometry/layout.hpp"
#include "geometry/yarn_curves.hpp"

namespace loopwright {

// A loop's own points in yarn order, from its first foot to its last; `apex` is the top of the head.
struct PlacedLoop {
  std::vector<TypePoint> points;
  std::size_t apex = 0;
};

// The yarn between two loops, or before the first and after the last. The point `middle` has part sinker.
struct PlacedSinker {
  std::vector<TypePoint> points;
  std::size_t middle = 0;
  double extra_length =
      0;  // rest length beyond the two half sinkers of its loops: missed needles, bed change, in d
};

struct PlacedPiece {
  Layout layout;
  std::vector<PlacedLoop> loops;                   // by LoopId
  std::vector<std::vector<PlacedSinker>> sinkers;  // per yarn: before loop 0, between loops, after the last
};

PlacedPiece place_type_points(const YarnGraph& graph, const GeometryOptions& options);
// The same with binding points elsewhere in space (moved_layout). What the order of yarns at a crossing
// depends on is read from the flat layout; places and directions are those of `moved`.
PlacedPiece place_type_points(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                              Layout moved);

// The whole piece as curves. Held: yarn ends and the heads left on needles.
YarnCurves build_yarn_curves(const YarnGraph& graph, const GeometryOptions& options);
YarnCurves build_yarn_curves(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                             Layout moved);

// Rest length of a loop from the middle of the sinker before it to that of the one after it, in d.
double rest_length_of(const Loop& loop, const PlacedSinker& before, const PlacedSinker& after,
                      const GeometryOptions& options);

}  // namespace loopwright
