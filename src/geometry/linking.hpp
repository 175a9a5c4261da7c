// Linking numbers of yarns that close onto themselves: whether rings hang in each other, and how often.
#pragma once
#include <vector>

#include "geometry/fabric.hpp"

namespace loopwright {

// Two closed yarns (indices into Fabric::yarns, a < b) whose linking number is not 0.
struct LinkedPair {
  int a = 0, b = 0, number = 0;
  friend bool operator==(const LinkedPair&, const LinkedPair&) = default;
};

bool is_closed(const FabricYarn& yarn);  // periodic without a shift

// All of them, in order. The linking number is half the sum of the signs of the crossings of two rings in a
// projection (Gauss); it is the same for every projection, so an odd sum, which only a crossing through a
// corner to the last bit can give, makes it look from another side. Rings are polylines of 4 chords a
// segment.
std::vector<LinkedPair> linking_numbers(const Fabric& fabric);

}  // namespace loopwright
