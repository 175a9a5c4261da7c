// YarnCurves: every yarn as an ordered list of type value points in space, with what each point belongs to.
// Lengths are in yarn diameters d of the reference yarn (the thickest); only the border turns them into
// millimetres. x along a course to higher needles, y along a wale to later courses, z toward the front bed
// (right-handed).
#pragma once
#include <array>
#include <vector>

#include "base/vec3.hpp"
#include "topology/yarn_graph.hpp"

namespace loopwright {

enum class LoopPart : std::uint8_t { sinker, foot, leg, head, span };  // span: a point on a float

struct TypePoint {
  Vec3 position;
  LoopId loop;  // the loop that it belongs to (a sinker point: the loop before it)
  LoopPart part = LoopPart::leg;
  bool held = false;  // tied to the frame
  SourceLocation at;
};

// A yarn, or the piece of one inside a window or cell.
struct CurveYarn {
  YarnId yarn;  // in the graph
  CarrierId carrier;
  std::vector<TypePoint> points;    // >= 4
  std::vector<double> rest_length;  // yarn between points k and k+1, in d; size = points.size() - 1 (open) or
                                    // size() (periodic)
  bool periodic = false;            // closes onto its first point, shifted by `shift` lattice vectors
  std::array<int, 2> shift{0, 0};
  double diameter = 1;  // relative to the reference diameter
};

// An interlacing inside a window or cell. In a periodic cell the child is taken at this lattice image.
struct PlacedInterlacing {
  LoopId parent, child;
  int sign = 1;  // as in Interlacing
  std::array<int, 2> shift{0, 0};
};

struct YarnCurves {
  std::vector<CurveYarn> yarns;
  double diameter_mm = 1;  // the unit of length
  bool periodic = false;
  // Periodic: lattice vectors a1 = (width, 0, 0) and a2 = (skew, height, 0). Finite: width and height of the
  // piece between its outermost binding points plus one pitch, so that spacings are width / wales and height
  // / courses.
  double width = 0, height = 0, skew = 0;
  double wales = 0, courses = 0;                // counted in that width and height
  std::vector<PlacedInterlacing> interlacings;  // those with both loops inside
};

}  // namespace loopwright
