// Yarn that comes back along itself turns in a round hairpin, not in a point.
#pragma once
#include <vector>

#include "base/vec3.hpp"

namespace loopwright {

// `way` (at least 2 places) is yarn that comes from `before` and goes on to `after`. Where it folds back on
// itself at its first or last place, that place becomes the two corners of a hairpin of this radius, in the
// plane of the fold's legs and without crossing them; other ways stay as they are. Unit: that of the places.
//
// Why: where a loop's foot points away from where its yarn goes on (a bind-off that begins at the edge where
// the last course ended, its first loop drawn through the next wale) the yarn comes back along its own foot.
// A spline through such a corner has a cusp, and bending and stretch, summed at points beside it, do not see
// it: it would never open.
void open_hairpins(std::vector<Vec3>& way, const Vec3& before, const Vec3& after, double radius);

}  // namespace loopwright
