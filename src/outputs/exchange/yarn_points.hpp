// A yarn's centreline as points, with all that is known at each: what tables and data files hold.
#pragma once
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/fabric.hpp"
#include "mechanics/yarn_forces.hpp"
#include "outputs/state.hpp"

namespace loopwright {

// Forces of a state in the units in which they are told.
struct ToldForces {
  YarnForces forces;
  double tension_scale = 1, contact_scale = 1;
  std::string tension_name = "tension_B_per_d2", contact_name = "contact_B_per_d3";
};

// Nothing for a first geometry (its yarn is not grown in) and for a state that does not hold its material.
// cN and cN/mm where the yarn's bend stiffness is known.
std::optional<ToldForces> told_forces(const State& state);

// All columns have one entry a point.
struct YarnPoints {
  std::vector<Vec3> place_mm;
  std::vector<double> arc_mm;            // from the yarn's first point
  std::vector<double> curvature_per_mm;  // of the spline itself
  std::vector<int> loop;                 // number of its loop in Fabric::loops; -1: a float or a tail
  std::vector<double> tension, contact;  // empty: not known
};

// For every yarn the numbers of its loops, in the order of their stretches.
std::vector<std::vector<int>> loops_of_yarns(const Fabric& fabric);

// Which loop has the place at parameter t, among those of one yarn (loops_of_yarns); -1: none.
int loop_at(const Fabric& fabric, const std::vector<int>& loops, double t);

// The same for every point of polyline(fabric, fabric.yarns[yarn], per_segment).
std::vector<int> loops_at_points(const Fabric& fabric, std::size_t yarn, const std::vector<int>& loops,
                                 int per_segment);

// What a point tells of its loop, as numbers. `none`: what a point without a loop has.
struct LoopColumn {
  const char* name;
  double none;
  double (*value)(const LoopSpan&);
};
inline constexpr std::array<LoopColumn, 6> loop_columns{{
    {"kind", -1, [](const LoopSpan& loop) { return static_cast<double>(loop.kind); }},
    {"side", 0, [](const LoopSpan& loop) { return static_cast<double>(loop.side); }},
    {"course", -1, [](const LoopSpan& loop) { return static_cast<double>(loop.course); }},
    {"needle", std::numeric_limits<double>::quiet_NaN(), [](const LoopSpan& loop) { return loop.slot; }},
    {"bed", -1, [](const LoopSpan& loop) { return static_cast<double>(loop.bed); }},
    {"line", 0, [](const LoopSpan& loop) { return static_cast<double>(loop.at.line); }},
}};
// The column's value at a point of loop `loop` (YarnPoints::loop).
inline double loop_value(const Fabric& fabric, const LoopColumn& column, int loop) {
  return loop < 0 ? column.none : column.value(fabric.loops[static_cast<std::size_t>(loop)]);
}

// Gives the points of one yarn after the other, so that a large fabric need not be held as points at once.
class PointSource {
 public:
  PointSource(const State& state, int per_segment);  // keeps a reference to the state's fabric
  YarnPoints of(std::size_t yarn) const;  // those of polyline(fabric, fabric.yarns[yarn], per_segment)
  std::size_t count() const;              // of all yarns
  const std::optional<ToldForces>& forces() const { return forces_; }

 private:
  const Fabric& fabric_;
  int per_segment_;
  std::optional<ToldForces> forces_;
  std::vector<std::vector<int>> loops_;
  std::vector<std::size_t> first_segment_;
};

}  // namespace loopwright
