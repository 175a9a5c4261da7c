// A symmetric sparse matrix of 3 x 3 blocks over control points, bordered by three columns for the fabric's
// measures (width, height, skew):   [ A  C ] [ u ]
//                          [ C' G ] [ g ]
// A is kept whole (both triangles) by rows, so that products and assembly can run by rows.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "mechanics/measures.hpp"

namespace loopwright {

using Block = std::array<double, 9>;            // row-major 3 x 3
using FourNodes = std::array<std::int32_t, 4>;  // control points of a segment

// A vector of unknowns: one displacement per control point and the measures.
struct Unknowns {
  std::vector<Vec3> u;
  Measures g{};
};
double dot(const Unknowns& a, const Unknowns& b);
void axpy(double s, const Unknowns& x, Unknowns& y);  // y += s x

// factor v v', v zero outside a run of control points: what couples all of a yarn at once.
struct Dyad {
  double factor = 0;
  int first = 0;        // control point of u[0]
  std::vector<Vec3> u;  // v there
  Measures g{};

  double dot(const Unknowns& x) const;           // v'x
  void add_to(double times, Unknowns& x) const;  // x += times v
};

struct BlockMatrix {
  std::vector<std::int32_t> row_start;  // [rows + 1]
  std::vector<std::int32_t> column;     // sorted in a row
  std::vector<Block> block;
  std::vector<Block> border;  // [rows] C: columns width, height, skew
  Block corner{};             // G
  // A second matrix on the same pattern, each entry a multiple of the 3 x 3 identity: the metric in which
  // steps are measured (Assembly::metric); measure_metric is its diagonal for the three measures.
  std::vector<double> metric;
  Measures measure_metric{};

  std::vector<Dyad> dyads;  // are added to all of it

  // [rows * rows] of small matrices: the place of a block, or -1; larger ones are searched.
  std::vector<std::int32_t> places;

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  // Place of block (row, col); the pattern must have it.
  std::size_t place(std::int32_t row, std::int32_t col) const;
};

// y = (A + shift D) x, with border, corner and dyads; D is the metric.
void multiply(const BlockMatrix& matrix, double shift, const Unknowns& x, Unknowns& y);
inline void multiply(const BlockMatrix& matrix, const Unknowns& x, Unknowns& y) { multiply(matrix, 0, x, y); }

// The shift up to which x'(A + shift D)x is not positive: no smaller one makes the matrix positive definite.
double shift_against(const BlockMatrix& matrix, const Unknowns& x);

}  // namespace loopwright
