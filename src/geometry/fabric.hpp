// Fabric: the yarns of a piece or cell as uniform cubic B-splines. This is what mechanics moves, what a saved
// state holds and what every output draws; the first geometry and the relaxed cloth have the same form.
//
// Lengths are in d, the diameter of the reference yarn; `diameter_mm` turns them into millimetres.
// Yarn y has control points q_0 .. q_(n-1). Open: n - 3 segments. Periodic: n segments, with
// q_(n+k) = q_k + shift[0] * a1 + shift[1] * a2. On segment e, at u in [0, 1]:
//   p(u) = 1/6 [ (1-u)^3 q_e + (3u^3 - 6u^2 + 4) q_(e+1) + (-3u^3 + 3u^2 + 3u + 1) q_(e+2) + u^3 q_(e+3) ]
// A place on a yarn is a parameter t in [0, segments]: segment floor(t), u = t - floor(t).
#pragma once
#include <array>
#include <string>
#include <vector>

#include "geometry/yarn_curves.hpp"

namespace loopwright {

// The stretch of yarn that belongs to a loop: from the middle of the sinker before it to that of the one
// after it.
struct LoopSpan {
  LoopId loop;
  int yarn = 0;                         // index into Fabric::yarns
  double begin = 0, apex = 0, end = 0;  // yarn parameters; apex: the top of the head
  SourceLocation at;
  LoopKind kind = LoopKind::knit;
  StitchSide side = StitchSide::front;
  Direction direction = Direction::right;  // of its yarn when it was formed
  int course = -1;                         // course_numbers(); -1: not known
  double slot = 0;                         // where it was formed, in needles on the common axis
  Bed bed = Bed::front;                    // formed on
};

struct FabricYarn {
  YarnId yarn;  // in the graph
  CarrierId carrier;
  std::string colour;              // "#rrggbb"
  double diameter = 1;             // in d
  double linear_density_tex = 0;   // 0: unknown
  double segment_rest_length = 1;  // in d, the same for every segment of the yarn
  // Twist that it would lose if its ends were let go, rad/d; positive: right-handed (Z). Counts where the
  // yarn resists twist (YarnMaterial::twist_stiffness).
  double liveliness = 0;
  // Of set yarn: its curvature when unloaded, 1/d, at the 4 Gauss points of every segment
  // (0.0694, 0.3300, 0.6700, 0.9306 of its parameter); empty: straight.
  std::vector<std::array<double, 4>> natural_curvature{};
  bool periodic = false;
  std::array<int, 2> shift{0, 0};
  std::vector<Vec3> control_points;
  std::vector<std::uint8_t> held;  // per control point: 1 if tied to the frame

  int segments() const {
    const int n = static_cast<int>(control_points.size());
    return periodic ? n : n - 3;
  }
};

struct Fabric {
  std::string name;
  std::vector<FabricYarn> yarns;
  std::vector<LoopSpan> loops;
  std::vector<PlacedInterlacing> interlacings;  // what must be interlaced
  double diameter_mm = 1;
  bool periodic = false;
  double width = 0, height = 0, skew = 0;  // in d; periodic: a1 = (width, 0, 0), a2 = (skew, height, 0)
  double wales = 0, courses = 0;

  Vec3 lattice(int m, int n) const { return {m * width + n * skew, n * height, 0}; }
};

// Is any of its yarn set, with a natural curvature of its own?
bool is_set(const Fabric& fabric);
// Control point i of a yarn, with the periodic continuation for i outside [0, n).
Vec3 control_point(const Fabric& fabric, const FabricYarn& yarn, int i);
// Place on the centreline at parameter t in [0, segments] (periodic yarns: any t).
Vec3 position(const Fabric& fabric, const FabricYarn& yarn, double t);
// Centreline as a polyline with `per_segment` equal parameter steps a segment; both ends included.
std::vector<Vec3> polyline(const Fabric& fabric, const FabricYarn& yarn, int per_segment);
// Arc length of the centreline, in d (4-point Gauss a segment).
double arc_length(const Fabric& fabric, const FabricYarn& yarn);
// The same between two parameters, begin <= end; open yarns: both in [0, segments].
double arc_length(const Fabric& fabric, const FabricYarn& yarn, double begin, double end);

}  // namespace loopwright
