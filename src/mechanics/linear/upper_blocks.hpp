// Adds blocks to the upper triangle of a block matrix, of rows [low, high) only, and mirrors it at the end.
// A row's columns are sorted and hold all four control points of a segment, so that one place gives the
// others of a run.
#pragma once
#include <algorithm>
#include <array>

#include "base/wide.hpp"
#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

class UpperBlocks {
 public:
  // `diagonal`: places of the diagonal blocks.
  UpperBlocks(BlockMatrix& matrix, const std::vector<std::int32_t>& diagonal, std::int32_t low,
              std::int32_t high)
      : matrix_(matrix), diagonal_(diagonal), low_(low), high_(high) {}

  bool owns(std::int32_t row) const { return row >= low_ && row < high_; }
  // Control points of a segment, one behind the other in the fabric (not so where an endless yarn closes).
  static bool is_run(const FourNodes& n) { return n[3] == n[0] + 3 && n[1] == n[0] + 1 && n[2] == n[0] + 2; }

  // Fetches what each_own() and each_between() will add to: the matrix is larger than the caches, its rows
  // are far apart and come in no order, so that adding would wait for every one of them.
  void fetch(const FourNodes& n) const {
    for (const std::int32_t row : n)
      if (owns(row)) fetch_run(on_diagonal(row));
  }
  void fetch_between(const FourNodes& a, const FourNodes& b) const {
    const bool a_first = a[0] < b[0];
    for (const std::int32_t row : a_first ? a : b)
      if (owns(row)) fetch_run(place(row, a_first ? b[0] : a[0]));
  }

  // Calls add(k, l, block, transposed) for the places of the blocks (n[k], n[l]), k <= l, in rows that are
  // ours; transposed: the upper triangle has (n[l], n[k]).
  template <class Add>
  LOOPWRIGHT_INLINE void each_own(const FourNodes& n, const Add& add) const {
    const bool run = is_run(n);
    if (run && owns(n[0]) && owns(n[3])) {
      for (std::size_t k = 0; k < 4; ++k) {
        Block* const on = &matrix_.block[on_diagonal(n[k])];
        for (std::size_t l = k; l < 4; ++l) add(k, l, on[l - k], false);
      }
      return;
    }
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = k; l < 4; ++l) {
        const bool turned = n[k] > n[l];
        const std::int32_t row = turned ? n[l] : n[k], column = turned ? n[k] : n[l];
        if (!owns(row)) continue;
        add(k, l, matrix_.block[run ? on_diagonal(row) + (l - k) : place(row, column)], turned);
      }
  }
  // Calls add(k, l, block) for the places of the symmetric blocks (a[k], b[l]), twice for one on the
  // diagonal.
  template <class Add>
  LOOPWRIGHT_INLINE void each_between(const FourNodes& a, const FourNodes& b, const Add& add) const {
    const bool runs = is_run(a) && is_run(b);
    if (runs && a[3] < b[0]) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (!owns(a[k])) continue;
        const std::size_t at = place(a[k], b[0]);
        for (std::size_t l = 0; l < 4; ++l) add(k, l, matrix_.block[at + l]);
      }
    } else if (runs && b[3] < a[0]) {
      for (std::size_t l = 0; l < 4; ++l) {
        if (!owns(b[l])) continue;
        const std::size_t at = place(b[l], a[0]);
        for (std::size_t k = 0; k < 4; ++k) add(k, l, matrix_.block[at + k]);
      }
    } else {
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < 4; ++l) {
          const std::int32_t row = std::min(a[k], b[l]), column = std::max(a[k], b[l]);
          if (!owns(row)) continue;
          Block& block = matrix_.block[place(row, column)];
          add(k, l, block);
          if (row == column) add(k, l, block);
        }
    }
  }

 private:
  // Four blocks one behind the other.
  void fetch_run(std::size_t first) const {
    constexpr std::ptrdiff_t line = 64;
    const char* const from = reinterpret_cast<const char*>(matrix_.block.data() + first);
    for (std::ptrdiff_t at = 0; at < static_cast<std::ptrdiff_t>(4 * sizeof(Block)); at += line)
      __builtin_prefetch(from + at, 1);
  }
  std::size_t on_diagonal(std::int32_t row) const {
    return static_cast<std::size_t>(diagonal_[static_cast<std::size_t>(row)]);
  }
  std::size_t place(std::int32_t row, std::int32_t column) const {
    if (!matrix_.places.empty()) return matrix_.place(row, column);
    const std::int32_t* const columns = matrix_.column.data();
    const std::int32_t* first = columns + on_diagonal(row);
    const std::int32_t* const last = columns + matrix_.row_start[static_cast<std::size_t>(row) + 1];
    // No branches that depend on the columns but the last: a row is short.
    std::ptrdiff_t count = last - first;
    while (count > 1) {
      const std::ptrdiff_t half = count / 2;
      first = first[half] <= column ? first + half : first;
      count -= half;
    }
    return static_cast<std::size_t>(first - columns);
  }

  BlockMatrix& matrix_;
  const std::vector<std::int32_t>& diagonal_;
  std::int32_t low_, high_;
};

// Copies the upper triangle's blocks, transposed, to the lower.
void mirror_upper(BlockMatrix& matrix, const std::vector<std::int32_t>& diagonal);
// The same for the metric.
void mirror_upper_metric(BlockMatrix& matrix, const std::vector<std::int32_t>& diagonal);

}  // namespace loopwright
