// What friction remembers of a fabric's contacts from one run to the next.
#pragma once
#include <cstdint>
#include <vector>

#include "base/vec3.hpp"

namespace loopwright {

// The elastic slip of segment a against segment b at lattice image (m, n), in d. Segments are counted through
// all yarns of the fabric in turn.
struct ContactSlip {
  std::int32_t a = 0, b = 0;
  std::int8_t m = 0, n = 0;
  Vec3 slip;
};
using ContactHistory = std::vector<ContactSlip>;  // ascending by (a, b, m, n)

}  // namespace loopwright
