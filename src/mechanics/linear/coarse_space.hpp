// The coarse space of the two-level solver: few points that carry many control points along.
//
//   u = P c,   P: [control points] x [coarse points], at most four entries a row
//
// and the Hessian as these points see it, P' (A + shift D) P, bordered by the fabric's measures like the
// whole matrix.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

struct CoarseSpace {
  struct Row {
    std::array<std::int32_t, 4> point{};
    std::array<double, 4> weight{};  // 0: no entry
  };
  std::vector<Row> rows;  // [control point]; held ones have no weight
  int points = 0;

  // Every column with an entry, or P' A P has empty rows: takes out the others and counts anew.
  void drop_empty_columns();
  // c = P' r and u += P c.
  void restricted(const std::vector<Vec3>& r, std::vector<Vec3>& c) const;
  void add_prolonged(const std::vector<Vec3>& c, std::vector<Vec3>& u) const;
  // P' (A + shift D) P with border and corner; the metric is in the blocks, the coarse matrix has none.
  void project(const BlockMatrix& matrix, double shift, BlockMatrix& coarse) const;
};

// Hat functions on a grid of nx x ny cells over the places' bounding box.
CoarseSpace hat_space(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held, int nx, int ny);

}  // namespace loopwright
