#ifdef LOOPWRIGHT_HAS_CHOLMOD
#include "mechanics/linear/supernodal_single.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/wide.hpp"

namespace loopwright {
namespace {

// Four columns of a supernode, one behind the other, are gone through at once: what is solved for is then
// read and written once for all four.
constexpr std::size_t group = 4;

// From the diagonals of `group` columns on; each begins one row below the one before.
using Columns = std::array<const float*, group>;

Columns columns_from(const float* first, std::size_t length) {
  Columns c;
  for (std::size_t k = 0; k < group; ++k) c[k] = first, first += length - k;
  return c;
}

using Lanes8 = float __attribute__((vector_size(32)));
constexpr std::size_t lanes8 = sizeof(Lanes8) / sizeof(float);

LOOPWRIGHT_INLINE void load(const float* from, Lanes8& to) { std::memcpy(&to, from, sizeof to); }

// x[i] -= c0[i] v0 + c1[i] v1 + c2[i] v2 + c3[i] v3
LOOPWRIGHT_INLINE void take_out(const Columns& c, const std::array<float, group>& v, float* x,
                                std::size_t n) {
  std::size_t i = 0;
  for (; i + lanes8 <= n; i += lanes8) {
    Lanes8 to, c0, c1, c2, c3;
    load(x + i, to);
    load(c[0] + i, c0);
    load(c[1] + i, c1);
    load(c[2] + i, c2);
    load(c[3] + i, c3);
    to -= (c0 * v[0] + c1 * v[1]) + (c2 * v[2] + c3 * v[3]);
    std::memcpy(x + i, &to, sizeof to);
  }
  for (; i < n; ++i) x[i] -= (c[0][i] * v[0] + c[1][i] * v[1]) + (c[2][i] * v[2] + c[3][i] * v[3]);
}

LOOPWRIGHT_INLINE float sum_of(const Lanes8& s) {
  return ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]));
}

// ck . x for each of the four
LOOPWRIGHT_INLINE std::array<float, group> products(const Columns& c, const float* x, std::size_t n) {
  std::array<Lanes8, group> sums{};
  std::size_t i = 0;
  for (; i + lanes8 <= n; i += lanes8) {
    Lanes8 v;
    load(x + i, v);
    for (std::size_t k = 0; k < group; ++k) {
      Lanes8 column;
      load(c[k] + i, column);
      sums[k] += column * v;
    }
  }
  std::array<float, group> total;
  for (std::size_t k = 0; k < group; ++k) {
    total[k] = sum_of(sums[k]);
    for (std::size_t j = i; j < n; ++j) total[k] += c[k][j] * x[j];
  }
  return total;
}

// x = L^-1 x for the columns of one supernode; x has its rows.
LOOPWRIGHT_WIDE void solve_down(const float* column, std::size_t rows, std::size_t columns, float* x) {
  std::size_t j = 0;
  for (; j + group <= columns; j += group) {
    Columns c = columns_from(column, rows - j);
    float* at = x + j;
    std::array<float, group> v;
    v[0] = at[0] * c[0][0];
    v[1] = (at[1] - c[0][1] * v[0]) * c[1][0];
    v[2] = (at[2] - c[0][2] * v[0] - c[1][1] * v[1]) * c[2][0];
    v[3] = (at[3] - c[0][3] * v[0] - c[1][2] * v[1] - c[2][1] * v[2]) * c[3][0];
    for (std::size_t k = 0; k < group; ++k) at[k] = v[k];
    column = c[group - 1] + rows - j - (group - 1);
    for (std::size_t k = 0; k < group; ++k) c[k] += group - k;
    take_out(c, v, at + group, rows - j - group);
  }
  for (; j < columns; ++j) {
    const float v = x[j] * *column;
    x[j] = v;
    for (std::size_t i = 1; i < rows - j; ++i) x[j + i] -= column[i] * v;
    column += rows - j;
  }
}

// x = L'^-1 x for the columns of one supernode; what its rows below them are is known. `end`: behind its last
// column.
LOOPWRIGHT_WIDE void solve_up(const float* end, std::size_t rows, std::size_t columns, float* x) {
  std::size_t j = columns;
  for (; j % group != 0;) {
    --j;
    end -= rows - j;
    float sum = 0;
    for (std::size_t i = 1; i < rows - j; ++i) sum += end[i] * x[j + i];
    x[j] = (x[j] - sum) * *end;
  }
  while (j > 0) {
    j -= group;
    const std::size_t length = rows - j;
    end -= group * length - group * (group - 1) / 2;
    const Columns c = columns_from(end, length);
    Columns below = c;
    for (std::size_t k = 0; k < group; ++k) below[k] += group - k;
    float* at = x + j;
    const std::array<float, group> sum = products(below, at + group, length - group);
    at[3] = (at[3] - sum[3]) * c[3][0];
    at[2] = (at[2] - sum[2] - c[2][1] * at[3]) * c[2][0];
    at[1] = (at[1] - sum[1] - c[1][1] * at[2] - c[1][2] * at[3]) * c[1][0];
    at[0] = (at[0] - sum[0] - c[0][1] * at[1] - c[0][2] * at[2] - c[0][3] * at[3]) * c[0][0];
  }
}

std::size_t size(int i) { return static_cast<std::size_t>(i); }

std::vector<int> integers(const void* from, std::size_t count) {
  const int* begin = static_cast<const int*>(from);
  return {begin, begin + count};
}

}  // namespace

SupernodalSingle::SupernodalSingle(const cholmod_factor& factor, const std::vector<int>& order)
    : order_(order),
      first_(integers(factor.super, factor.nsuper + 1)),
      row_start_(integers(factor.pi, factor.nsuper + 1)),
      row_(integers(factor.s, factor.ssize)) {
  const double* x = static_cast<const double*>(factor.x);
  const int* from = static_cast<const int*>(factor.px);
  const std::size_t supernodes = factor.nsuper;
  const auto rows_of = [this](std::size_t k) { return size(row_start_[k + 1] - row_start_[k]); };
  const auto columns_of = [this](std::size_t k) { return size(first_[k + 1] - first_[k]); };
  value_start_.assign(1, 0);
  for (std::size_t k = 0; k < supernodes; ++k) {
    const std::size_t rows = rows_of(k), columns = columns_of(k);
    value_start_.push_back(value_start_.back() + rows * columns - columns * (columns - 1) / 2);
    most_rows_ = std::max(most_rows_, rows);
  }
  // CHOLMOD's columns are whole; what lies above the diagonal, a fifth of all, is left behind.
  value_.reserve(value_start_.back());
  for (std::size_t k = 0; k < supernodes; ++k)
    for (std::size_t j = 0, rows = rows_of(k); j < columns_of(k); ++j)
      for (std::size_t i = j; i < rows; ++i)
        value_.push_back(static_cast<float>(i == j ? 1 / x[size(from[k]) + j * rows + i]
                                                   : x[size(from[k]) + j * rows + i]));
}

void SupernodalSingle::solve(const double* b, double* x) const {
  thread_local std::vector<float> y, part;
  y.resize(3 * order_.size());
  part.resize(most_rows_);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = static_cast<float>(b[3 * size(order_[i / 3]) + i % 3]);
  const std::size_t supernodes = first_.size() - 1;
  const auto gather = [&](std::size_t k) {
    const int* row = row_.data() + row_start_[k];
    const std::size_t rows = size(row_start_[k + 1] - row_start_[k]);
    for (std::size_t i = 0; i < rows; ++i) part[i] = y[size(row[i])];
    return rows;
  };
  const auto put_back = [&](std::size_t k, std::size_t rows) {
    const int* row = row_.data() + row_start_[k];
    for (std::size_t i = 0; i < rows; ++i) y[size(row[i])] = part[i];
  };
  for (std::size_t k = 0; k < supernodes; ++k) {  // L y = b
    const std::size_t rows = gather(k);
    solve_down(value_.data() + value_start_[k], rows, size(first_[k + 1] - first_[k]), part.data());
    put_back(k, rows);
  }
  for (std::size_t k = supernodes; k-- > 0;) {  // L' x = y
    const std::size_t rows = gather(k), columns = size(first_[k + 1] - first_[k]);
    solve_up(value_.data() + value_start_[k + 1], rows, columns, part.data());
    put_back(k, columns);
  }
  for (std::size_t i = 0; i < y.size(); ++i) x[3 * size(order_[i / 3]) + i % 3] = static_cast<double>(y[i]);
}

}  // namespace loopwright
#endif
