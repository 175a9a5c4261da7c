#include "mechanics/linear/schwarz.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.hpp"

namespace loopwright {
namespace {

// Dense Cholesky in place (lower triangle, row-major); false if not positive definite.
bool dense_cholesky(std::vector<double>& a, int n) {
  const auto at = [&](int i, int j) -> double& {
    return a[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j)];
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = at(i, j);
      for (int k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
      if (i == j) {
        if (!(sum > 0)) return false;
        at(i, i) = std::sqrt(sum);
      } else {
        at(i, j) = sum / at(j, j);
      }
    }
  return true;
}

void dense_solve(const std::vector<double>& a, int n, std::vector<double>& x) {
  const auto at = [&](int i, int j) {
    return a[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j)];
  };
  for (int i = 0; i < n; ++i) {
    double sum = x[static_cast<std::size_t>(i)];
    for (int k = 0; k < i; ++k) sum -= at(i, k) * x[static_cast<std::size_t>(k)];
    x[static_cast<std::size_t>(i)] = sum / at(i, i);
  }
  for (int i = n; i-- > 0;) {
    double sum = x[static_cast<std::size_t>(i)];
    for (int k = i + 1; k < n; ++k) sum -= at(k, i) * x[static_cast<std::size_t>(k)];
    x[static_cast<std::size_t>(i)] = sum / at(i, i);
  }
}

}  // namespace

void Schwarz::set_patches(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held,
                          const BlockMatrix& matrix, int patch) {
  const auto n = places.size();
  double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
  for (const Vec3& p : places) {
    low_x = std::min(low_x, p.x);
    high_x = std::max(high_x, p.x);
    low_y = std::min(low_y, p.y);
    high_y = std::max(high_y, p.y);
  }
  const double side =
      std::sqrt(std::max(1e-12, (high_x - low_x) * (high_y - low_y) * patch / static_cast<double>(n)));
  const int nx = std::max(1, static_cast<int>(std::lround((high_x - low_x) / side)));
  const int ny = std::max(1, static_cast<int>(std::lround((high_y - low_y) / side)));
  const auto share = [](double v, double low, double high, int cells) {
    return std::clamp((v - low) / std::max(1e-12, high - low) * cells, 0.0, cells - 1e-9);
  };

  std::vector<std::vector<std::int32_t>> own(static_cast<std::size_t>(nx * ny));
  coarse_point_.assign(4 * n, 0);
  coarse_weight_.assign(4 * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = share(places[i].x, low_x, high_x, nx), y = share(places[i].y, low_y, high_y, ny);
    const int cx = static_cast<int>(x), cy = static_cast<int>(y);
    own[static_cast<std::size_t>(cy * nx + cx)].push_back(static_cast<std::int32_t>(i));
    if (held[i]) continue;
    const double fx = x - cx, fy = y - cy;
    for (int k = 0; k < 4; ++k) {
      const int dx = k & 1, dy = k >> 1;
      coarse_point_[4 * i + static_cast<std::size_t>(k)] = (cy + dy) * (nx + 1) + cx + dx;
      coarse_weight_[4 * i + static_cast<std::size_t>(k)] = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy);
    }
  }
  coarse_unknowns_ = 3 * (nx + 1) * (ny + 1) + 3;

  // Overlap: two rings of neighbours in the matrix (about half a loop along the yarn and the loops in
  // contact).
  patches_.clear();
  std::vector<std::uint8_t> in(n, 0);
  for (auto& nodes : own) {
    if (nodes.empty()) continue;
    for (const auto i : nodes) in[static_cast<std::size_t>(i)] = 1;
    for (int ring = 0; ring < 2; ++ring) {
      const std::size_t count = nodes.size();
      for (std::size_t k = 0; k < count; ++k) {
        const auto row = static_cast<std::size_t>(nodes[k]);
        for (auto e = matrix.row_start[row]; e < matrix.row_start[row + 1]; ++e) {
          const std::int32_t j = matrix.column[static_cast<std::size_t>(e)];
          if (!in[static_cast<std::size_t>(j)]) {
            in[static_cast<std::size_t>(j)] = 1;
            nodes.push_back(j);
          }
        }
      }
    }
    for (const auto i : nodes) in[static_cast<std::size_t>(i)] = 0;
    std::sort(nodes.begin(), nodes.end());
    patches_.push_back(std::make_unique<Patch>());
    patches_.back()->nodes = std::move(nodes);
  }
}

bool Schwarz::factor(const BlockMatrix& matrix, double shift) {
  std::atomic<bool> definite{true};
  parallel_chunks(static_cast<int>(patches_.size()), [&](int p) {
    Patch& patch = *patches_[static_cast<std::size_t>(p)];
    const auto rows = patch.nodes.size();
    BlockMatrix& m = patch.matrix;
    m.row_start.assign(1, 0);
    m.column.clear();
    m.block.clear();
    m.metric.clear();
    for (const auto i : patch.nodes) {
      const auto begin = static_cast<std::size_t>(matrix.row_start[static_cast<std::size_t>(i)]);
      const auto end = static_cast<std::size_t>(matrix.row_start[static_cast<std::size_t>(i) + 1]);
      for (std::size_t e = begin; e < end; ++e) {
        const auto at = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), matrix.column[e]);
        if (at == patch.nodes.end() || *at != matrix.column[e]) continue;
        m.column.push_back(static_cast<std::int32_t>(at - patch.nodes.begin()));
        m.block.push_back(matrix.block[e]);
        m.metric.push_back(matrix.metric[e]);
      }
      m.row_start.push_back(static_cast<std::int32_t>(m.column.size()));
    }
    m.border.assign(rows, Block{});
    m.corner = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    m.measure_metric = {};
    if (!patch.factor.factor(m, shift)) definite = false;
  });
  if (!definite) return false;
  coarse_matrix(matrix, shift);
  return dense_cholesky(coarse_factor_, coarse_unknowns_);
}

void Schwarz::coarse_matrix(const BlockMatrix& matrix, double shift) {
  const int n = coarse_unknowns_, measures = n - 3;
  coarse_factor_.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0);
  const auto add = [&](int i, int j, double v) {
    coarse_factor_[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j)] +=
        v;
  };
  const auto rows = static_cast<std::size_t>(matrix.rows());
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t a = 0; a < 4; ++a) {
      const double wa = coarse_weight_[4 * i + a];
      if (wa == 0) continue;
      const int ca = 3 * coarse_point_[4 * i + a];
      for (auto e = static_cast<std::size_t>(matrix.row_start[i]);
           e < static_cast<std::size_t>(matrix.row_start[i + 1]); ++e) {
        const auto j = static_cast<std::size_t>(matrix.column[e]);
        for (std::size_t b = 0; b < 4; ++b) {
          const double w = wa * coarse_weight_[4 * j + b];
          if (w == 0) continue;
          const int cb = 3 * coarse_point_[4 * j + b];
          if (cb > ca) continue;  // lower triangle
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
              add(ca + r, cb + c,
                  w * (matrix.block[e][static_cast<std::size_t>(3 * r + c)] +
                       (r == c ? shift * matrix.metric[e] : 0)));
        }
      }
      for (int r = 0; r < 3; ++r)
        for (int m = 0; m < 3; ++m)
          add(measures + m, ca + r, wa * matrix.border[i][static_cast<std::size_t>(3 * r + m)]);
    }
  for (int m = 0; m < 3; ++m)
    for (int l = 0; l < 3; ++l)
      add(measures + m, measures + l,
          matrix.corner[static_cast<std::size_t>(3 * m + l)] +
              (m == l ? shift * matrix.measure_metric[static_cast<std::size_t>(m)] : 0));
  // Coarse points in which no free control point takes part keep an identity row.
  for (int i = 0; i < n; ++i)
    if (coarse_factor_[static_cast<std::size_t>(i) * static_cast<std::size_t>(n) +
                       static_cast<std::size_t>(i)] == 0)
      add(i, i, 1);
}

void Schwarz::solve(const Unknowns& b, Unknowns& x) {
  parallel_chunks(static_cast<int>(patches_.size()), [&](int p) {
    Patch& patch = *patches_[static_cast<std::size_t>(p)];
    patch.right.u.resize(patch.nodes.size());
    for (std::size_t k = 0; k < patch.nodes.size(); ++k)
      patch.right.u[k] = b.u[static_cast<std::size_t>(patch.nodes[k])];
    patch.factor.solve(patch.right, patch.result);
  });
  x.u.assign(b.u.size(), Vec3{});
  for (const auto& patch : patches_)
    for (std::size_t k = 0; k < patch->nodes.size(); ++k)
      x.u[static_cast<std::size_t>(patch->nodes[k])] += patch->result.u[k];

  std::vector<double> c(static_cast<std::size_t>(coarse_unknowns_), 0);
  for (std::size_t i = 0; i < b.u.size(); ++i)
    for (std::size_t a = 0; a < 4; ++a) {
      const double w = coarse_weight_[4 * i + a];
      const auto at = static_cast<std::size_t>(3 * coarse_point_[4 * i + a]);
      c[at] += w * b.u[i].x;
      c[at + 1] += w * b.u[i].y;
      c[at + 2] += w * b.u[i].z;
    }
  const auto measures = static_cast<std::size_t>(coarse_unknowns_ - 3);
  for (std::size_t m = 0; m < 3; ++m) c[measures + m] = b.g[m];
  dense_solve(coarse_factor_, coarse_unknowns_, c);
  for (std::size_t i = 0; i < b.u.size(); ++i)
    for (std::size_t a = 0; a < 4; ++a) {
      const double w = coarse_weight_[4 * i + a];
      const auto at = static_cast<std::size_t>(3 * coarse_point_[4 * i + a]);
      x.u[i] += w * Vec3{c[at], c[at + 1], c[at + 2]};
    }
  for (std::size_t m = 0; m < 3; ++m) x.g[m] = c[measures + m];
}

}  // namespace loopwright
