// Layout: where the binding points of every loop lie. x comes from the needles, z from the beds, and y from a
// linear least-squares problem on the graph, so that increases, short rows, tucks and tubes find their
// levels.
#pragma once
#include <cstdint>
#include <vector>

#include "base/vec3.hpp"
#include "geometry/geometry_options.hpp"
#include "topology/yarn_graph.hpp"

namespace loopwright {

struct Layout {
  std::vector<Vec3> lower, upper;  // per loop: O and P, in d. P of a parent equals O of its children
  std::vector<double> y_scale_lower,
      y_scale_upper;  // per loop: share of the template's height that there is room for
  std::vector<double> x_scale_lower, x_scale_upper;  // and of its width
  std::vector<std::uint8_t> faced;     // per loop: 1 if a loop lay on the facing needle of the other bed
  std::vector<std::uint8_t> overlaid;  // and at the same slot, so that the two wales lie over each other
  double slot_pitch = 1;               // x of one slot, in d
  bool two_beds = false;               // loops were formed on both beds
};

// O(loops) nodes; one sparse factorisation.
Layout lay_out(const YarnGraph& graph, const GeometryOptions& options);

// Typical distance of wales, in slots: 1 where every needle knits, 2 on half gauge, 1/2 for a full rib.
double slots_per_wale(const YarnGraph& graph);

}  // namespace loopwright
