// From placed loops and sinkers to YarnCurves: joins runs of loops, gives every step its rest length, marks
// what is tied to the frame, and keeps the interlacings with both loops inside.
#pragma once
#include <vector>

#include "geometry/type_points.hpp"

namespace loopwright {

// Consecutive loops of one yarn.
struct YarnRun {
  int yarn = 0, first = 0, count = 0;
};

std::vector<YarnRun> whole_yarns(const YarnGraph& graph);

// Held: the ends of every run, heads that hold something outside or lie on a needle, feet of loops whose
// parents are all outside. Runs with fewer than four points are left out.
YarnCurves assemble_runs(const YarnGraph& graph, const GeometryOptions& options, const PlacedPiece& piece,
                         const std::vector<YarnRun>& runs);

// Points and rest lengths of one loop with the half sinkers on both sides, from the middle before to the
// middle after. `after` starts at its own place; `moved` is added to the loop and to the sinker after it.
void append_loop(const Loop& loop, LoopId id, const PlacedSinker& before, const PlacedLoop& placed,
                 const PlacedSinker& after, const GeometryOptions& options, const Vec3& moved,
                 CurveYarn& curve);

// Sets carrier, diameter and yarn of a curve.
CurveYarn empty_curve(const YarnGraph& graph, const GeometryOptions& options, int yarn);

// Number of wales: distinct slots of the loops, those nearer than a quarter slot counted once.
double wales_of(const YarnGraph& graph, const std::vector<LoopId>& loops);

// Courses: loops per wale, where two layers lie over each other per wale and layer.
double courses_of(const Layout& layout, const std::vector<LoopId>& loops, double wales);

}  // namespace loopwright
