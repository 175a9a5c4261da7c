// Layout: where the binding points of every loop lie. x comes from the needles, z from the beds, and y from a
// linear least-squares problem on the graph, so that increases, short rows, tucks and tubes find their
// levels.
#pragma once
#include <cstdint>
#include <vector>

#include "base/rotation.hpp"
#include "base/vec3.hpp"
#include "geometry/geometry_options.hpp"
#include "topology/yarn_graph.hpp"

namespace loopwright {

// How steeply legs rise out of the cloth at a binding point: the angles, in radians, by which a crossing is
// turned about the course there, below the point (as the heads' legs come) and above it (as the feet's go).
struct CrossingTilt {
  double below = 0, above = 0;
};

struct Layout {
  std::vector<Vec3> lower, upper;  // per loop: O and P, in d. P of a parent equals O of its children
  std::vector<double> y_scale_lower,
      y_scale_upper;  // per loop: share of the template's height that there is room for
  std::vector<double> x_scale_lower, x_scale_upper;  // and of its width
  std::vector<std::uint8_t> faced;     // per loop: 1 if a loop lay on the facing needle of the other bed
  std::vector<std::uint8_t> overlaid;  // and at the same slot, so that the two wales lie over each other
  double slot_pitch = 1;               // x of one slot, in d
  bool two_beds = false;               // loops were formed on both beds
  // How the cloth is turned at O and P: from x along the course, y along the wale, z toward the front bed to
  // where these point. Empty: nothing is turned, as in the first geometry.
  std::vector<Rotation> turn_lower, turn_upper;
  std::vector<CrossingTilt> tilt_lower, tilt_upper;  // per loop, at O and P; empty: nothing is tilted
  std::vector<std::int8_t> wall;  // per loop: of a tube's front (1) or rear (-1) wall; empty: not known

  bool is_flat() const { return turn_lower.empty(); }
  Rotation lower_turn(LoopId id) const { return is_flat() ? Rotation{} : turn_lower[id.position()]; }
  Rotation upper_turn(LoopId id) const { return is_flat() ? Rotation{} : turn_upper[id.position()]; }
  Rotation turn(LoopId id) const;  // of the loop as a whole
  // An offset from O or P, given in the directions of the cloth there, as it is in space: tilted and turned.
  // `reach`: how far above and below the point the tilt is whole, in the offset's unit.
  Vec3 from_lower(LoopId id, const Vec3& offset, double reach) const;
  Vec3 from_upper(LoopId id, const Vec3& offset, double reach) const;
  // The way from O to P as the loop sees it: along its course, along its wale, to the front.
  Vec3 step(LoopId id) const { return turn(id).transposed(upper[id.position()] - lower[id.position()]); }
  bool in_one_wall(LoopId a, LoopId b) const {
    return wall.empty() || wall[a.position()] * wall[b.position()] >= 0;
  }
};

// O(loops) nodes; one sparse factorisation.
Layout lay_out(const YarnGraph& graph, const GeometryOptions& options);

// Where the binding points of a layout lie and how the cloth is turned there after it was moved. Places and
// turns are per loop; those of a parent's P are those of its children's O.
struct MovedPlaces {
  std::vector<Vec3> lower, upper;
  std::vector<Rotation> turn_lower, turn_upper;
  std::vector<std::int8_t> wall;
};
// The same layout at other places: tucks below each other and templates as large as there is room for now.
Layout moved_layout(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                    MovedPlaces places);

// Typical distance of wales, in slots: 1 where every needle knits, 2 on half gauge, 1/2 for a full rib.
double slots_per_wale(const YarnGraph& graph);

}  // namespace loopwright
