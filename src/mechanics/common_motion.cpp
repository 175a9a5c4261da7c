#include "mechanics/common_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace loopwright {
namespace {

constexpr double cell_side = 10;  // of the smooth field, d: some loops
constexpr int sweeps = 3;         // of the fit of its values

double greatest(const std::vector<Vec3>& motions) {
  double most2 = 0;
  for (const Vec3& m : motions) most2 = std::max(most2, squared_norm(m));
  return std::sqrt(most2);
}

// An affine map x -> x + T x + t taken out of the motions. Pieces: least squares over control points; their
// 4 x 4 moment matrix is solved by Gaussian elimination with a small ridge (flat pieces have no z extent).
// Periodic cells: the lattice's own map, so that what is left is the same in every image, and least squares
// for z alone.
CommonMotion take_out_affine(const YarnState& state, const YarnState& target, bool periodic,
                             std::vector<Vec3>& motions) {
  const std::size_t n = state.nodes.size();
  Vec3 centre;
  for (const Vec3& p : state.nodes) centre += p;
  centre *= 1.0 / static_cast<double>(n);
  std::array<Vec3, 3> lattice{};  // its columns of T
  if (periodic) {
    lattice[0].x = target.width / state.width - 1;
    lattice[1] = {(target.skew - state.skew - lattice[0].x * state.skew) / state.height,
                  target.height / state.height - 1, 0};
  }
  const auto left = [&](std::size_t i) {
    const Vec3 p = state.nodes[i] - centre;
    return target.nodes[i] - state.nodes[i] - p.x * lattice[0] - p.y * lattice[1];
  };
  std::array<std::array<double, 7>, 4> m{};  // moments of (x, y, z, 1), then three right-hand sides
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = state.nodes[i] - centre, s = left(i);
    const std::array<double, 4> x{periodic ? 0 : p.x, periodic ? 0 : p.y, p.z, 1};
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t c = 0; c < 4; ++c) m[r][c] += x[r] * x[c];
      m[r][4] += x[r] * s.x;
      m[r][5] += x[r] * s.y;
      m[r][6] += x[r] * s.z;
    }
  }
  for (std::size_t r = 0; r < 3; ++r) m[r][r] += 1e-9 * (m[0][0] + m[1][1] + m[2][2]) + 1e-12;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t r = 0; r < 4; ++r) {
      if (r == k) continue;
      const double f = m[r][k] / m[k][k];
      for (std::size_t c = k; c < 7; ++c) m[r][c] -= f * m[k][c];
    }
  std::array<Vec3, 4> column;  // of T, then t
  for (std::size_t k = 0; k < 4; ++k) column[k] = Vec3{m[k][4], m[k][5], m[k][6]} / m[k][k];

  CommonMotion common;
  double low = 0, high = 0;
  motions.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = state.nodes[i] - centre;
    low = std::min(low, p.z);
    high = std::max(high, p.z);
    motions[i] = left(i) - p.x * column[0] - p.y * column[1] - p.z * column[2] - column[3];
  }
  common.loose = greatest(motions);
  common.thickness = high - low;
  common.in_plane = std::sqrt(squared_norm(column[0] + lattice[0]) + squared_norm(column[1] + lattice[1]));
  common.across = norm(column[2]);
  return common;
}

// Bilinear over a grid on the places' bounding box.
class SmoothField {
 public:
  explicit SmoothField(const std::vector<Vec3>& places) : low_(places.front()) {
    Vec3 high = low_;
    for (const Vec3& p : places) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), 0};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
    }
    nx_ = std::max(1, static_cast<int>((high.x - low_.x) / cell_side));
    ny_ = std::max(1, static_cast<int>((high.y - low_.y) / cell_side));
    width_ = std::max(1e-9, (high.x - low_.x) / nx_), height_ = std::max(1e-9, (high.y - low_.y) / ny_);
    value_.resize(static_cast<std::size_t>((nx_ + 1) * (ny_ + 1)));
  }
  // Takes the mean round every point of the grid out of the motions.
  void take_out(const std::vector<Vec3>& places, std::vector<Vec3>& motions) {
    std::vector<Vec3> sum(value_.size());
    std::vector<double> weight(value_.size(), 0);
    for (std::size_t i = 0; i < places.size(); ++i)
      each_corner(places[i], [&](std::size_t corner, double w) {
        sum[corner] += w * motions[i];
        weight[corner] += w;
      });
    for (std::size_t k = 0; k < sum.size(); ++k) {
      sum[k] *= weight[k] > 0 ? 1 / weight[k] : 0;
      value_[k] += sum[k];
    }
    for (std::size_t i = 0; i < places.size(); ++i)
      each_corner(places[i], [&](std::size_t corner, double w) { motions[i] -= w * sum[corner]; });
  }
  // By how much it moves two points apart at most, for their distance in the plane.
  double slope() const {
    double most2 = 0;
    for (int y = 0; y < ny_; ++y)
      for (int x = 0; x < nx_; ++x) {
        const auto at = [&](int i, int j) {
          return value_[static_cast<std::size_t>((y + j) * (nx_ + 1) + x + i)];
        };
        const double along_x = std::max(distance(at(0, 0), at(1, 0)), distance(at(0, 1), at(1, 1))) / width_,
                     along_y = std::max(distance(at(0, 0), at(0, 1)), distance(at(1, 0), at(1, 1))) / height_;
        most2 = std::max(most2, along_x * along_x + along_y * along_y);
      }
    return std::sqrt(most2);
  }

 private:
  template <class Visit>
  void each_corner(const Vec3& p, const Visit& visit) const {
    const double x = std::clamp((p.x - low_.x) / width_, 0.0, nx_ - 1e-9),
                 y = std::clamp((p.y - low_.y) / height_, 0.0, ny_ - 1e-9);
    const int cx = static_cast<int>(x), cy = static_cast<int>(y);
    const double fx = x - cx, fy = y - cy;
    const auto corner = static_cast<std::size_t>(cy * (nx_ + 1) + cx);
    const auto above = corner + static_cast<std::size_t>(nx_) + 1;
    visit(corner, (1 - fx) * (1 - fy)), visit(corner + 1, fx * (1 - fy));
    visit(above, (1 - fx) * fy), visit(above + 1, fx * fy);
  }

  Vec3 low_;
  int nx_ = 1, ny_ = 1;
  double width_ = 1, height_ = 1;
  std::vector<Vec3> value_;  // [point of the grid]
};

// The greatest distance of two control points that follow each other.
double greatest_spacing(const YarnModel& model, const YarnState& state) {
  double most2 = 0;
  for (const YarnModel::Yarn& yarn : model.yarns)
    for (int k = yarn.periodic ? 0 : 1; k < yarn.nodes; ++k) {
      const auto i = static_cast<std::size_t>(yarn.first_node + k),
                 before = static_cast<std::size_t>(yarn.first_node + (k + yarn.nodes - 1) % yarn.nodes);
      most2 = std::max(most2, squared_norm(state.nodes[i] - state.nodes[before]));
    }
  return std::sqrt(most2);
}

}  // namespace

double CommonMotion::far_ratio(double range) const {
  return in_plane + across * std::min(1.0, thickness / range) + 2 * loose / range;
}

CommonMotion common_motion(const YarnModel& model, const YarnState& state, const YarnState& target,
                           double range, double enough) {
  std::vector<Vec3> motions;
  CommonMotion common = take_out_affine(state, target, model.periodic, motions);
  if (!model.periodic && common.loose > enough) {
    std::vector<Vec3> rest = motions;
    SmoothField field(state.nodes);
    for (int k = 0; k < sweeps; ++k) field.take_out(state.nodes, rest);
    CommonMotion finer = common;
    const double slope = field.slope();
    finer.in_plane += slope;
    // The field moves control points; a point of a cubic B-spline has these round it at a mean distance of
    // 0.54 of their spacing at most, and moves otherwise than the field says at its place by that.
    finer.loose = greatest(rest) + 0.6 * greatest_spacing(model, state) * slope;
    if (finer.loose < common.loose && finer.far_ratio(range) < common.far_ratio(range)) {
      common = finer;
      motions = std::move(rest);
    }
  }
  common.left.resize(motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) common.left[i] = norm(motions[i]);
  return common;
}

}  // namespace loopwright
