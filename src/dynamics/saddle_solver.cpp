#include "dynamics/saddle_solver.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace loopwright {

struct SaddleSolver::Data {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  int rows = 0;
  std::vector<Eigen::Triplet<double, int>> entries;
  Matrix matrix;
  std::vector<int> outer, inner;  // the pattern whose elimination order is at hand
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> factor;
};

SaddleSolver::SaddleSolver() : data_(std::make_unique<Data>()) {}
SaddleSolver::~SaddleSolver() = default;

void SaddleSolver::start(int rows) {
  data_->rows = rows;
  data_->entries.clear();
}

void SaddleSolver::add(int row, int column, double value) {
  data_->entries.emplace_back(std::max(row, column), std::min(row, column), value);
}

bool SaddleSolver::factor() {
  Data& d = *data_;
  d.matrix.resize(d.rows, d.rows);
  d.matrix.setFromTriplets(d.entries.begin(), d.entries.end());
  const auto columns = static_cast<std::size_t>(d.rows) + 1;
  const auto entries = static_cast<std::size_t>(d.matrix.nonZeros());
  const int *outer = d.matrix.outerIndexPtr(), *inner = d.matrix.innerIndexPtr();
  if (d.outer.size() != columns || d.inner.size() != entries ||
      !std::equal(d.outer.begin(), d.outer.end(), outer) ||
      !std::equal(d.inner.begin(), d.inner.end(), inner)) {
    d.outer.assign(outer, outer + columns);
    d.inner.assign(inner, inner + entries);
    d.factor.analyzePattern(d.matrix);
  }
  d.factor.factorize(d.matrix);
  return d.factor.info() == Eigen::Success && d.factor.vectorD().allFinite();
}

int SaddleSolver::negative_pivots() const {
  return static_cast<int>((data_->factor.vectorD().array() < 0).count());
}

void SaddleSolver::solve(std::span<double> b) const {
  Eigen::Map<Eigen::VectorXd> x(b.data(), static_cast<Eigen::Index>(b.size()));
  const Eigen::VectorXd solution = data_->factor.solve(x);
  x = solution;
}

double SaddleSolver::factor_entries() const {
  return static_cast<double>(data_->factor.matrixL().nestedExpression().nonZeros());
}

}  // namespace loopwright
