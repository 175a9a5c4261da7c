// The sums of an Assembly over the elements of one chunk of control points; for assembly*.cpp alone.
#pragma once
#include "mechanics/assembly.hpp"
#include "mechanics/linear/upper_blocks.hpp"
#include "mechanics/segment_lanes.hpp"

namespace loopwright {

using Fraction = std::array<double, 2>;

// This chunk owns control points [low, high): it alone writes their rows, and evaluates every element that
// has one. What is summed over the whole fabric is added by the chunk that owns the element's first point.
struct Assembly::Chunk {
  std::int32_t low = 0, high = 0;
  const YarnState* state = nullptr;
  Unknowns* gradient = nullptr;
  BlockMatrix* matrix = nullptr;               // with a gradient alone; its upper triangle is added to
  std::vector<double>* of_segments = nullptr;  // without a gradient: wanted there
  EnergyParts energy;
  Measures measures{};
  Block corner{};

  bool owns(std::int32_t node) const { return node >= low && node < high; }
};

inline FourNodes Assembly::nodes_of(int segment) const {
  const auto f = static_cast<std::size_t>(model_.first[static_cast<std::size_t>(segment)]);
  return {model_.base[f], model_.base[f + 1], model_.base[f + 2], model_.base[f + 3]};
}

}  // namespace loopwright
