#include "outputs/sky.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

constexpr double reach_in_diameters = 2.6;  // farther yarn adds an even shade, which shows nothing

// Copies of the cell's pieces at those lattice images that come within reach of the cell.
void add_images(const Fabric& fabric, double reach, std::vector<SkySample>& samples) {
  const Bounds box = fabric_bounds(fabric, {1, 1});
  const std::size_t own = samples.size();
  for (int n = -8; n <= 8; ++n)
    for (int m = -8; m <= 8; ++m) {
      const Vec3 shift = fabric.lattice(m, n);
      bool near = m != 0 || n != 0;
      for (int i = 0; i < 2; ++i)
        near = near && box.lower[i] + shift[i] < box.upper[i] + reach &&
               box.upper[i] + shift[i] > box.lower[i] - reach;
      if (!near) continue;
      for (std::size_t k = 0; k < own; ++k) {
        SkySample s = samples[k];
        s.centre += shift;
        bool in_reach = true;
        for (int i = 0; i < 2; ++i)
          in_reach = in_reach && s.centre[i] > box.lower[i] - reach && s.centre[i] < box.upper[i] + reach;
        if (in_reach) samples.push_back(s);
      }
    }
}

}  // namespace

Sky::Sky(const Fabric& fabric) {
  double thickest = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    thickest = std::max(thickest, yarn.diameter);
    const int steps =
        std::max(1, static_cast<int>(std::ceil(yarn.segment_rest_length / (0.5 * yarn.diameter))));
    const std::vector<Vec3> points = polyline(fabric, yarn, std::min(steps, 32));
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const Vec3 along = points[k + 1] - points[k];
      const double length = norm(along);
      if (length > 0)
        samples_.push_back({(points[k] + points[k + 1]) * 0.5, along / length, yarn.diameter / 2, length});
    }
  }
  reach_ = reach_in_diameters * thickest;
  if (fabric.periodic && fabric.width > 0 && fabric.height > 0) add_images(fabric, reach_, samples_);
  if (samples_.empty()) return;

  // counting sort into cells of the reach's size
  Vec3 upper = origin_ = samples_.front().centre;
  for (const SkySample& s : samples_)
    for (int i = 0; i < 3; ++i) {
      origin_[i] = std::min(origin_[i], s.centre[i]);
      upper[i] = std::max(upper[i], s.centre[i]);
    }
  for (int i = 0; i < 3; ++i)
    cells_[static_cast<std::size_t>(i)] =
        std::clamp(static_cast<int>((upper[i] - origin_[i]) / reach_) + 1, 1, 1024);
  starts_.assign(static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) *
                         static_cast<std::size_t>(cells_[2]) +
                     1,
                 0);
  for (const SkySample& s : samples_) ++starts_[cell(s.centre) + 1];
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  std::vector<SkySample> sorted(samples_.size());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (const SkySample& s : samples_) sorted[next[cell(s.centre)]++] = s;
  samples_ = std::move(sorted);
}

std::size_t Sky::cell(const Vec3& p) const {
  std::size_t index = 0;
  for (int i = 2; i >= 0; --i) {
    const auto n = static_cast<std::size_t>(cells_[static_cast<std::size_t>(i)]);
    const double place = std::clamp((p[i] - origin_[i]) / reach_, 0.0, static_cast<double>(n - 1));
    index = index * n + static_cast<std::size_t>(place);
  }
  return index;
}

void Sky::gather(const Vec3& centre, std::vector<SkySample>& near) const {
  near.clear();
  if (samples_.empty()) return;
  std::array<int, 3> low{}, high{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    const double place = (centre[axis] - origin_[axis]) / reach_;
    low[i] = std::clamp(static_cast<int>(std::floor(place)) - 1, 0, cells_[i] - 1);
    high[i] = std::clamp(static_cast<int>(std::floor(place)) + 1, 0, cells_[i] - 1);
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y) {
      const auto row = static_cast<std::size_t>((z * cells_[1] + y) * cells_[0]);
      const std::uint32_t begin = starts_[row + static_cast<std::size_t>(low[0])];
      const std::uint32_t end = starts_[row + static_cast<std::size_t>(high[0]) + 1];
      for (std::uint32_t k = begin; k < end; ++k) {
        const SkySample& s = samples_[k];
        const double d2 = squared_norm(s.centre - centre);
        if (d2 <= reach_ * reach_) near.push_back(s);
      }
    }
}

double Sky::open_share(const Vec3& point, const Vec3& normal, const std::vector<SkySample>& near) {
  double hidden = 0;
  for (const SkySample& s : near) {
    const Vec3 to = s.centre - point;
    const double above = dot(to, normal);
    if (above <= 0) continue;
    const double d2 = std::max(squared_norm(to), s.radius * s.radius), d = std::sqrt(d2);
    const double along = dot(to, s.tangent) / d;
    const double broadside = std::sqrt(std::max(0.0, 1 - along * along));
    hidden += above / d * 2 * s.radius * s.length * broadside / (std::numbers::pi * d2);
  }
  return std::exp(-hidden);
}

}  // namespace loopwright
