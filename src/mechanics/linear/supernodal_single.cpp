#ifdef LOOPWRIGHT_HAS_CHOLMOD
#include "mechanics/linear/supernodal_single.hpp"

#include <algorithm>
#include <array>

namespace loopwright {
namespace {

// a[0] b[0] + .. + a[n - 1] b[n - 1], in eight sums that the compiler can keep in one vector.
float dot(const float* a, const float* b, std::size_t n) {
  constexpr std::size_t lanes = 8;
  std::array<float, lanes> sums{};
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes)
    for (std::size_t k = 0; k < lanes; ++k) sums[k] += a[i + k] * b[i + k];
  float sum = 0;
  for (; i < n; ++i) sum += a[i] * b[i];
  for (const float s : sums) sum += s;
  return sum;
}

std::size_t size(int i) { return static_cast<std::size_t>(i); }

std::vector<int> integers(const void* from, std::size_t count) {
  const int* begin = static_cast<const int*>(from);
  return {begin, begin + count};
}

}  // namespace

SupernodalSingle::SupernodalSingle(const cholmod_factor& factor)
    : order_(integers(factor.Perm, factor.n)),
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
        value_.push_back(static_cast<float>(x[size(from[k]) + j * rows + i]));
}

void SupernodalSingle::solve(const double* b, double* x) const {
  std::vector<float> y(order_.size()), part(most_rows_);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = static_cast<float>(b[size(order_[i])]);
  const std::size_t supernodes = first_.size() - 1;
  for (std::size_t k = 0; k < supernodes; ++k) {  // L y = b
    const int* row = row_.data() + row_start_[k];
    const std::size_t rows = size(row_start_[k + 1] - row_start_[k]),
                      columns = size(first_[k + 1] - first_[k]);
    for (std::size_t i = 0; i < rows; ++i) part[i] = y[size(row[i])];
    const float* column = value_.data() + value_start_[k];
    for (std::size_t j = 0; j < columns; ++j) {
      const std::size_t length = rows - j;
      float* below = part.data() + j;
      const float v = *below / *column;
      *below = v;
      for (std::size_t i = 1; i < length; ++i) below[i] -= column[i] * v;
      column += length;
    }
    for (std::size_t i = 0; i < rows; ++i) y[size(row[i])] = part[i];
  }
  for (std::size_t k = supernodes; k-- > 0;) {  // L' x = y
    const int* row = row_.data() + row_start_[k];
    const std::size_t rows = size(row_start_[k + 1] - row_start_[k]),
                      columns = size(first_[k + 1] - first_[k]);
    for (std::size_t i = 0; i < rows; ++i) part[i] = y[size(row[i])];
    const float* column = value_.data() + value_start_[k + 1];
    for (std::size_t j = columns; j-- > 0;) {
      column -= rows - j;
      part[j] = (part[j] - dot(column + 1, part.data() + j + 1, rows - j - 1)) / *column;
    }
    for (std::size_t j = 0; j < columns; ++j) y[size(row[j])] = part[j];
  }
  for (std::size_t i = 0; i < y.size(); ++i) x[size(order_[i])] = static_cast<double>(y[i]);
}

}  // namespace loopwright
#endif
