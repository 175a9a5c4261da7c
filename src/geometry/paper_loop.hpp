// The first paper's own nine-point loop (plain stitch), equations (1) to (5) and table 2.
#pragma once
#include <array>

#include "base/vec3.hpp"

namespace loopwright {

// Lower binding point of course `course`, wale `wale` for yarn radius r, and the upper one above it; eq. (1),
// (2).
Vec3 paper_lower(int course, int wale, double r);
Vec3 paper_upper(const Vec3& lower, double r);

// T0 .. T8 from the binding points of the loop and the lower ones of its neighbours in the course; eq. (3) to
// (5) and their mirror images.
std::array<Vec3, 9> paper_loop(const Vec3& lower, const Vec3& upper, const Vec3& lower_left,
                               const Vec3& lower_right, double r);

}  // namespace loopwright
