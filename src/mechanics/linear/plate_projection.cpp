// The Hessian as a plate's splines see it. Control points of one cell share nine splines, so what they add is
// summed up cell by cell in a small dense array before it goes to the rows of the coarse matrix.
#include "mechanics/linear/plate_projection.hpp"

#include <algorithm>
#include <cstdlib>

#include "base/parallel.hpp"

namespace loopwright {
namespace {

constexpr int reach = 2;             // cells that a neighbour's splines may begin away from a cell's
constexpr int side = 3 + 2 * reach;  // so many splines are seen along each axis
constexpr int seen_splines = side * side;

std::size_t place(std::int64_t i) { return static_cast<std::size_t>(i); }

struct Addition {
  std::int32_t row, column;  // splines of the grid
  Block block;
};

// What the control points of one cell add: to its own nine splines (rows) from all splines round it.
struct CellSum {
  std::array<Block, 9 * static_cast<std::size_t>(seen_splines)> near;
  std::vector<Addition> far;  // of neighbours farther away than `reach`
};

// to += h P for the spline (w, a, b)
void add_right(const Block& h, double w, double a, double b, Block& to) {
  for (std::size_t d = 0; d < 9; ++d) to[d] += w * h[d];
  for (std::size_t r = 0; r < 9; r += 3) to[r + 2] += a * h[r] + b * h[r + 1];
}

// to += P' h
void add_left(const Block& h, double w, double a, double b, Block& to) {
  for (std::size_t d = 0; d < 9; ++d) to[d] += w * h[d];
  for (std::size_t c = 0; c < 3; ++c) to[6 + c] += a * h[c] + b * h[3 + c];
}

class CellSums {
 public:
  CellSums(const PlateGrid& plate, const BlockMatrix& matrix, double shift)
      : plate_(plate), matrix_(matrix), shift_(shift) {}

  void add(std::int32_t node, CellSum& sum) {
    const PlateGrid::Place& own = plate_.places[place(node)];
    const PlateGrid::Carried left = plate_.carried(own);
    const int cx = own.cell % plate_.nx, cy = own.cell / plate_.nx;
    // The row of A + shift D times P: blocks of the splines round the cell.
    std::array<Block, static_cast<std::size_t>(seen_splines)> row;
    std::array<bool, static_cast<std::size_t>(seen_splines)> used{};
    for (auto e = place(matrix_.row_start[place(node)]); e < place(matrix_.row_start[place(node) + 1]); ++e) {
      const PlateGrid::Place& other = plate_.places[place(matrix_.column[e])];
      if (other.cell < 0) continue;
      Block h = matrix_.block[e];
      for (const std::size_t d : {0, 4, 8}) h[d] += shift_ * matrix_.metric[e];
      const PlateGrid::Carried right = plate_.carried(other);
      const int ox = other.cell % plate_.nx, oy = other.cell / plate_.nx;
      const bool near = std::abs(ox - cx) <= reach && std::abs(oy - cy) <= reach;
      for (std::size_t k = 0; k < 9; ++k) {
        if (!near) {
          Block seen{};
          add_right(h, right.w[k], right.a[k], right.b[k], seen);
          add_far(left, spline(cx, cy, 0), spline(ox, oy, k), seen, sum);
          continue;
        }
        const std::size_t at = place((oy - cy + reach + static_cast<int>(k / 3)) * side + ox - cx + reach +
                                     static_cast<int>(k % 3));
        if (!used[at]) row[at] = {};
        used[at] = true;
        add_right(h, right.w[k], right.a[k], right.b[k], row[at]);
      }
    }
    for (std::size_t at = 0; at < row.size(); ++at)
      if (used[at])
        for (std::size_t k = 0; k < 9; ++k)
          add_left(row[at], left.w[k], left.a[k], left.b[k], sum.near[k * place(seen_splines) + at]);
  }

 private:
  std::int32_t spline(int cx, int cy, std::size_t k) const {
    return (cy + static_cast<int>(k / 3)) * (plate_.nx + 2) + cx + static_cast<int>(k % 3);
  }
  void add_far(const PlateGrid::Carried& left, std::int32_t first_row, std::int32_t column, const Block& seen,
               CellSum& sum) const {
    for (std::size_t k = 0; k < 9; ++k) {
      Block block{};
      add_left(seen, left.w[k], left.a[k], left.b[k], block);
      sum.far.push_back(
          {first_row + static_cast<int>(k / 3) * (plate_.nx + 2) + static_cast<int>(k % 3), column, block});
    }
  }

  const PlateGrid& plate_;
  const BlockMatrix& matrix_;
  double shift_;
};

struct RowEntry {
  std::int32_t column;
  Block block;
};
using Rows = std::vector<std::vector<RowEntry>>;

void add_to(Rows& rows, const PlateGrid& plate, std::int32_t row, std::int32_t column, const Block& block) {
  const std::int32_t r = plate.number[place(row)], c = plate.number[place(column)];
  if (r < 0 || c < 0) return;
  auto& entries = rows[place(r)];
  auto at = std::find_if(entries.begin(), entries.end(), [c](const RowEntry& e) { return e.column == c; });
  if (at == entries.end()) at = entries.insert(at, {c, Block{}});
  for (std::size_t d = 0; d < 9; ++d) at->block[d] += block[d];
}

void add_cell(Rows& rows, const PlateGrid& plate, int cx, int cy, const CellSum& sum) {
  for (int k = 0; k < 9; ++k)
    for (int at = 0; at < seen_splines; ++at) {
      const Block& block = sum.near[place(k * seen_splines + at)];
      const int x = cx - reach + at % side, y = cy - reach + at / side;
      if (block == Block{} || x < 0 || y < 0 || x >= plate.nx + 2 || y >= plate.ny + 2) continue;
      add_to(rows, plate, (cy + k / 3) * (plate.nx + 2) + cx + k % 3, y * (plate.nx + 2) + x, block);
    }
  for (const Addition& a : sum.far) add_to(rows, plate, a.row, a.column, a.block);
}

}  // namespace

void project_plate(const PlateGrid& plate, int points, const BlockMatrix& matrix, double shift,
                   BlockMatrix& coarse) {
  std::vector<std::vector<std::int32_t>> nodes(place(plate.nx) * place(plate.ny));
  for (std::size_t i = 0; i < plate.places.size(); ++i)
    if (plate.places[i].cell >= 0) nodes[place(plate.places[i].cell)].push_back(static_cast<std::int32_t>(i));
  Rows rows(place(points));
  std::vector<CellSum> sums(place(plate.nx));
  for (int cy = 0; cy < plate.ny; ++cy) {
    parallel_chunks(plate.nx, [&](int cx) {
      CellSum& sum = sums[place(cx)];
      sum.near.fill(Block{});
      sum.far.clear();
      CellSums cell(plate, matrix, shift);
      for (const std::int32_t node : nodes[place(cy) * place(plate.nx) + place(cx)]) cell.add(node, sum);
    });
    for (int cx = 0; cx < plate.nx; ++cx) add_cell(rows, plate, cx, cy, sums[place(cx)]);
  }
  coarse.row_start.assign(1, 0);
  coarse.column.clear();
  coarse.block.clear();
  for (auto& row : rows) {
    std::sort(row.begin(), row.end(),
              [](const RowEntry& a, const RowEntry& b) { return a.column < b.column; });
    for (const RowEntry& e : row) {
      coarse.column.push_back(e.column);
      coarse.block.push_back(e.block);
    }
    coarse.row_start.push_back(static_cast<std::int32_t>(coarse.column.size()));
  }
}

}  // namespace loopwright
