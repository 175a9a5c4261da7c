// Stitch bindings of the second paper: what ties crossing yarns to each other.
//
// Barycentric: at a foot that is drawn through a head, a point with fixed barycentric coordinates in the
// control points of one yarn coincides with one of the other yarn, C = sum_i w_i q_i = 0, linear in q: the
// Jacobian is constant. Orientation springs between the yarns on both sides of that point push and pull, so
// that each yarn keeps its side (figure 14 of the paper).
//
// Sliding ("free variables", Lenoir and others, GRAPHITE 2004): the places s, t of a contact on the two yarns
// are unknowns without mass,
//   C(q, s, t) = p_a(s) - p_b(t) - g n = 0,   p_a' . lambda = 0,   p_b' . lambda = 0
// The last two say that the multiplier does no work along the yarns. Between their stops, where the valley of
// the distance is not flat (docs/energies/bindings.md), they make lambda normal to both yarns and r = p_a -
// p_b the shortest connection there, so that s and t follow from q, and one equation is left:
//   D(q) = min_(s,t) |p_a(s) - p_b(t)| = g,   dD/dq = n (h_a(s) - h_b(t)),   n = r / D
// Friction along the yarns is Coulomb's law with a short sticking spring (mechanics/energies/friction.hpp),
// loaded by the multiplier of the step before.
#pragma once
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "dynamics/spline_model.hpp"
#include "geometry/fabric.hpp"
#include "mechanics/energies/friction.hpp"

namespace loopwright {

struct BarycentricBinding {
  std::vector<std::pair<int, double>> weights;  // control points of the model; sum of weights: 0

  Vec3 error(std::span<const Vec3> place) const;
};

// A place on a yarn.
struct YarnPlace {
  int yarn = 0;
  double t = 0;
};

// U = 1/2 k (|p_a - p_b| - rest)^2 between fixed parameters of two yarns.
struct OrientationSpring {
  YarnPlace a, b;
  double rest = 1, stiffness = 1;
};

// How far a free variable may go in a step, and what holds it back: 1/2 drag (t - from)^2 is added to
// 1/2 |p_a - p_b|^2.
struct SlideRange {
  double low = 0, high = std::numeric_limits<double>::infinity();
  double from = 0, drag = 0;
};

struct SlidingBinding {
  YarnPlace a, b;  // free variables: where the yarns touch now
  SlideRange range_a, range_b;
  double distance = 1;       // g
  double full_distance = 0;  // what an explicit step leads g back to where it found yarn nearer
  double multiplier = 0;     // force along n: negative where the yarns press on each other
  double friction = 0;       // coefficient
  Vec3 slip;                 // elastic slip of the friction, tangential
  // Yarns are held at g by up to this pull; beyond it they part, until they press on each other again.
  double most_pull = std::numeric_limits<double>::infinity();
  bool parted = false;
  bool guard = false;  // only presses, ever
  bool may_part() const { return guard || parted; }
};

// The shortest connection near a binding's last one.
struct ShortestConnection {
  CurvePoint a, b;
  Vec3 normal;                        // dD / dp_a: n, from b to a
  double distance = 0;                // D
  double drag_a = 0, drag_b = 0;      // as in SlideRange
  bool free_a = true, free_b = true;  // false: at an end of its range
};
// Moves the free variables s and t of `binding` to the places that are nearest to each other, downhill from
// where they are and within their ranges (yarns may slide from segment to segment, not past their ends).
ShortestConnection follow(const SplineModel& model, std::span<const Vec3> place, SlidingBinding& binding);
// |D - g|, or g - D where the yarns may part.
double off_by(const SlidingBinding& binding, const ShortestConnection& connection);
// The second derivative of D by the 8 control points (4 of a, 4 of b), s and t following where they are free:
//   D_qq - D_qs (D_ss)^-1 D_sq
std::array<std::array<double, 24>, 24> distance_hessian(const ShortestConnection& connection);

// Between two bindings that follow each other on a yarn there stays some room.
struct SlideStop {
  std::size_t first = 0, second = 0;           // bindings, in their order along the yarn
  bool first_is_a = true, second_is_a = true;  // which of their two places is on this yarn
  double room = 0;                             // parameters
};
// For all neighbours on every yarn: half the thickness of both yarns that cross there, or as much as there
// is.
std::vector<SlideStop> slide_stops(const SplineModel& model, std::span<const SlidingBinding> bindings);
// Ranges for a step from where the bindings are: up to the middle between neighbours, less half their room.
void set_ranges(const SplineModel& model, std::span<const Vec3> place, std::span<const SlideStop> stops,
                std::span<SlidingBinding> bindings);

// A foot of a loop and the head that it is drawn through, as stretches of yarn (parameters, begin < end).
struct Foot {
  int child = 0, parent = 0;  // yarns
  double begin = 0, end = 0, head_begin = 0, head_end = 0;
};
// Two feet for every interlacing of a fabric with both loops inside. Any structure: tucks and held loops have
// heads that the loops drawn through them pass.
std::vector<Foot> feet(const Fabric& fabric);

// Where a foot touches the head: the nearest approaches, at most two (behind the leg, in front of the head),
// at least one unless the two are one stretch of yarn.
struct FootContacts {
  std::vector<std::pair<YarnPlace, YarnPlace>> touch;  // (on the child, on the parent)
  std::vector<double> distance;                        // of each
};
FootContacts foot_contacts(const SplineModel& model, std::span<const Vec3> place, const Foot& foot);

struct Bindings {
  std::vector<BarycentricBinding> barycentric;
  std::vector<OrientationSpring> springs;
  std::vector<SlidingBinding> sliding;
  std::vector<Foot> guarded;  // feet that are looked at for approaches beside their bindings
};

// Guards, bindings that only press: set wherever a foot and its head have come near each other beside the
// bindings that are there, taken away where they have parted again.
void update_guards(const SplineModel& model, std::span<const Vec3> place, std::span<const Foot> feet,
                   std::vector<SlidingBinding>& bindings);

// One barycentric binding a foot, with orientation springs at its contacts that rest at the distances which
// `place` has. Bindings whose control points are all held are left out.
Bindings barycentric_bindings(const SplineModel& model, std::span<const Vec3> place,
                              std::span<const Foot> feet, double spring_stiffness);
// One sliding binding for every contact of a foot, at the distance which `place` has.
Bindings sliding_bindings(const SplineModel& model, std::span<const Vec3> place, std::span<const Foot> feet,
                          double friction);

}  // namespace loopwright
