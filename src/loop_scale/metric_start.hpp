// A start for nets whose needles say little about their shape: places whose distances are near those along
// the springs at rest (classical scaling from a few pivots; Brandes and Pich, Eigensolver methods for
// progressive multidimensional scaling of large data, 2007).
#pragma once
#include <vector>

#include "base/vec3.hpp"
#include "loop_scale/mass_spring_net.hpp"

namespace loopwright {

// One place a mass, in the net's unit of length, about the origin, in an attitude of its own. Empty where the
// springs do not join all masses, or where they lie in a line. One pass over the springs for each of at most
// 80 pivots, O(pivots * springs * log masses).
std::vector<Vec3> metric_start(const MassSpringNet& net);

}  // namespace loopwright
