#include "mechanics/linear/block_matrix.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/parallel.hpp"

namespace loopwright {
namespace {

constexpr int rows_per_chunk = 2048;

int chunk_count(std::size_t rows) { return static_cast<int>((rows + rows_per_chunk - 1) / rows_per_chunk); }

}  // namespace

std::size_t BlockMatrix::place(std::int32_t row, std::int32_t col) const {
  if (!places.empty()) {
    const std::int32_t at =
        places[static_cast<std::size_t>(row) * (row_start.size() - 1) + static_cast<std::size_t>(col)];
    if (at < 0) throw std::logic_error("block outside the matrix pattern");
    return static_cast<std::size_t>(at);
  }
  const auto begin = column.begin() + row_start[static_cast<std::size_t>(row)];
  const auto end = column.begin() + row_start[static_cast<std::size_t>(row) + 1];
  const auto at = std::lower_bound(begin, end, col);
  if (at == end || *at != col) throw std::logic_error("block outside the matrix pattern");
  return static_cast<std::size_t>(at - column.begin());
}

double dot(const Unknowns& a, const Unknowns& b) {
  // Summed by fixed chunks: the same result for any number of threads.
  const int chunks = chunk_count(a.u.size());
  std::vector<double> sums(static_cast<std::size_t>(chunks), 0);
  parallel_chunks(chunks, [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * rows_per_chunk;
    const std::size_t end = std::min(a.u.size(), begin + rows_per_chunk);
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += dot(a.u[i], b.u[i]);
    sums[static_cast<std::size_t>(c)] = sum;
  });
  double total = 0;
  for (const double sum : sums) total += sum;
  for (std::size_t k = 0; k < 3; ++k) total += a.g[k] * b.g[k];
  return total;
}

void axpy(double s, const Unknowns& x, Unknowns& y) {
  parallel_chunks(chunk_count(x.u.size()), [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * rows_per_chunk;
    const std::size_t end = std::min(x.u.size(), begin + rows_per_chunk);
    for (std::size_t i = begin; i < end; ++i) y.u[i] += s * x.u[i];
  });
  for (std::size_t k = 0; k < 3; ++k) y.g[k] += s * x.g[k];
}

double Dyad::dot(const Unknowns& x) const {
  double sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    sum += loopwright::dot(u[i], x.u[static_cast<std::size_t>(first) + i]);
  for (std::size_t k = 0; k < 3; ++k) sum += g[k] * x.g[k];
  return sum;
}

void Dyad::add_to(double times, Unknowns& x) const {
  for (std::size_t i = 0; i < u.size(); ++i) x.u[static_cast<std::size_t>(first) + i] += times * u[i];
  for (std::size_t k = 0; k < 3; ++k) x.g[k] += times * g[k];
}

void multiply(const BlockMatrix& matrix, double shift, const Unknowns& x, Unknowns& y) {
  const auto rows = static_cast<std::size_t>(matrix.rows());
  y.u.resize(rows);
  const int chunks = chunk_count(rows);
  std::vector<Measures> partial(static_cast<std::size_t>(chunks));
  parallel_chunks(chunks, [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * rows_per_chunk;
    const std::size_t end = std::min(rows, begin + rows_per_chunk);
    Measures& g = partial[static_cast<std::size_t>(c)];
    g = {};
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 sum;
      for (auto k = static_cast<std::size_t>(matrix.row_start[i]);
           k < static_cast<std::size_t>(matrix.row_start[i + 1]); ++k) {
        const Block& b = matrix.block[k];
        const Vec3& v = x.u[static_cast<std::size_t>(matrix.column[k])];
        sum.x += b[0] * v.x + b[1] * v.y + b[2] * v.z;
        sum.y += b[3] * v.x + b[4] * v.y + b[5] * v.z;
        sum.z += b[6] * v.x + b[7] * v.y + b[8] * v.z;
        if (shift != 0) sum += (shift * matrix.metric[k]) * v;
      }
      const Block& e = matrix.border[i];
      sum.x += e[0] * x.g[0] + e[1] * x.g[1] + e[2] * x.g[2];
      sum.y += e[3] * x.g[0] + e[4] * x.g[1] + e[5] * x.g[2];
      sum.z += e[6] * x.g[0] + e[7] * x.g[1] + e[8] * x.g[2];
      y.u[i] = sum;
      const Vec3& v = x.u[i];
      for (std::size_t k = 0; k < 3; ++k) g[k] += e[k] * v.x + e[3 + k] * v.y + e[6 + k] * v.z;
    }
  });
  y.g = {};
  for (const Measures& g : partial)
    for (std::size_t k = 0; k < 3; ++k) y.g[k] += g[k];
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l) y.g[k] += matrix.corner[3 * k + l] * x.g[l];
  if (shift != 0)
    for (std::size_t k = 0; k < 3; ++k) y.g[k] += shift * matrix.measure_metric[k] * x.g[k];
  for (const Dyad& dyad : matrix.dyads) dyad.add_to(dyad.factor * dyad.dot(x), y);
}

double shift_against(const BlockMatrix& matrix, const Unknowns& x) {
  Unknowns y;
  multiply(matrix, x, y);
  double metric = 0;
  for (std::size_t i = 0; i < x.u.size(); ++i)
    for (auto k = static_cast<std::size_t>(matrix.row_start[i]);
         k < static_cast<std::size_t>(matrix.row_start[i + 1]); ++k)
      metric += matrix.metric[k] * dot(x.u[i], x.u[static_cast<std::size_t>(matrix.column[k])]);
  for (std::size_t k = 0; k < 3; ++k) metric += matrix.measure_metric[k] * x.g[k] * x.g[k];
  return metric > 0 ? -dot(x, y) / metric : 0;
}

}  // namespace loopwright
