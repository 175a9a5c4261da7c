#include "mechanics/linear/dense_cholesky.hpp"

#include <algorithm>
#include <stdexcept>

#ifdef LOOPWRIGHT_HAS_CHOLMOD
// LAPACK, by the names of its Fortran; OpenBLAS, if it is that, is held to the calling thread.
extern "C" void dpotrf_(const char* triangle, const int* order, double* entry, const int* leading, int* info);
extern "C" void dpotrs_(const char* triangle, const int* order, const int* sides, const double* entry,
                        const int* leading, double* right, const int* leading_right, int* info);
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
#else
#include <Eigen/Cholesky>
#endif

namespace loopwright {

namespace {

void to_unknowns(const std::vector<double>& numbers, Unknowns& x) {
  x.u.resize((numbers.size() - 3) / 3);
  for (std::size_t i = 0; i < x.u.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d) x.u[i][static_cast<int>(d)] = numbers[3 * i + d];
  std::copy(numbers.end() - 3, numbers.end(), x.g.begin());
}

}  // namespace

DenseCholesky::DenseCholesky() {
#ifdef LOOPWRIGHT_HAS_CHOLMOD
  if (openblas_set_num_threads) openblas_set_num_threads(1);
#endif
}

bool DenseCholesky::factor(const BlockMatrix& m, double shift, Unknowns& against) {
  against.u.clear();
  order_ = 3 * m.rows() + 3;
  const auto order = static_cast<std::size_t>(order_), rows = static_cast<std::size_t>(m.rows());
  entry_.resize(order * order);
  const auto column = [&](std::size_t k) { return entry_.data() + k * order; };
  // Lower triangle in columns = upper triangle of the symmetric matrix in rows.
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t r = 0; r < 3; ++r) {
      double* to = column(3 * i + r);
      std::fill(to + 3 * i, to + order, 0.0);
      for (auto k = static_cast<std::size_t>(m.row_start[i]);
           k < static_cast<std::size_t>(m.row_start[i + 1]); ++k) {
        const auto j = static_cast<std::size_t>(m.column[k]);
        if (j < i) continue;
        for (std::size_t c = 0; c < 3; ++c) to[3 * j + c] = m.block[k][3 * r + c];
        to[3 * j + r] += shift * m.metric[k];
      }
      for (std::size_t c = 0; c < 3; ++c) to[3 * rows + c] = m.border[i][3 * r + c];
    }
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = k; l < 3; ++l)
      column(3 * rows + k)[3 * rows + l] = m.corner[3 * k + l] + (k == l ? shift * m.measure_metric[k] : 0);
  for (const Dyad& dyad : m.dyads) {
    // Where it is not zero: its control points, then the measures.
    const std::size_t begin = 3 * static_cast<std::size_t>(dyad.first), count = 3 * dyad.u.size();
    const auto entry = [&](std::size_t k) {
      return k < count ? dyad.u[k / 3][static_cast<int>(k % 3)] : dyad.g[k - count];
    };
    const auto place = [&](std::size_t k) { return k < count ? begin + k : 3 * rows + k - count; };
    for (std::size_t k = 0; k < count + 3; ++k) {
      const double by = dyad.factor * entry(k);
      double* const to = column(place(k));
      for (std::size_t l = k; l < count + 3; ++l) to[place(l)] += by * entry(l);
    }
  }
#ifdef LOOPWRIGHT_HAS_CHOLMOD
  int info = 0;
  dpotrf_("L", &order_, entry_.data(), &order_, &info);
  if (info > 0) direction_against(static_cast<std::size_t>(info) - 1, against);
  return info == 0;
#else
  Eigen::Map<Eigen::MatrixXd> entries(entry_.data(), order_, order_);
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> in_place(entries);
  return in_place.info() == Eigen::Success;
#endif
}

// Before the pivot that was not positive lies a whole factor L, and in the pivot's row l: x = (-L'^-1 l', 1,
// 0) has that pivot for x'(A + shift D)x.
void DenseCholesky::direction_against(std::size_t pivot, Unknowns& against) const {
  const auto order = static_cast<std::size_t>(order_);
  std::vector<double> x(order, 0.0);
  x[pivot] = 1;
  for (std::size_t k = pivot; k-- > 0;) {
    const double* const column = entry_.data() + k * order;
    double sum = 0;
    for (std::size_t r = k + 1; r <= pivot; ++r) sum += column[r] * x[r];
    x[k] = -sum / column[k];
  }
  to_unknowns(x, against);
}

void DenseCholesky::solve(const Unknowns& b, Unknowns& x) {
  const std::size_t rows = b.u.size();
  if (order_ != static_cast<int>(3 * rows + 3)) throw std::logic_error("solving without a factor");
  right_.resize(3 * rows + 3);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t d = 0; d < 3; ++d) right_[3 * i + d] = b.u[i][static_cast<int>(d)];
  std::copy(b.g.begin(), b.g.end(), right_.end() - 3);
#ifdef LOOPWRIGHT_HAS_CHOLMOD
  int info = 0;
  const int one = 1;
  dpotrs_("L", &order_, &one, entry_.data(), &order_, right_.data(), &order_, &info);
#else
  const Eigen::Map<const Eigen::MatrixXd> entries(entry_.data(), order_, order_);
  Eigen::Map<Eigen::VectorXd> solution(right_.data(), order_);
  entries.triangularView<Eigen::Lower>().solveInPlace(solution);
  entries.triangularView<Eigen::Lower>().transpose().solveInPlace(solution);
#endif
  to_unknowns(right_, x);
}

}  // namespace loopwright
