// How far curves are from each other where they are neighbours.
#pragma once
#include <optional>
#include <vector>

#include "base/vec3.hpp"

namespace loopwright {

// The distance from the nearest other curve that 95 % of places keep, as an estimate of how thick the yarn of
// touching curves is: where yarn touches yarn, in cloth nearly everywhere, it is a diameter, and a few places
// where a model is at fault do not count. Curves are given by points that lie closer than they are apart;
// some thousand of them are asked. Nothing for less than two curves and for curves that lie on each other.
std::optional<double> usual_distance(const std::vector<std::vector<Vec3>>& curves);

}  // namespace loopwright
