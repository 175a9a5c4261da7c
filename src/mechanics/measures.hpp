// The outer measures of a fabric, or what belongs to each of them (forces, steps).
#pragma once
#include <array>

namespace loopwright {

using Measures = std::array<double, 3>;  // width, height, skew

}  // namespace loopwright
