#include "outputs/exchange/curve_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>

namespace loopwright {
namespace {

struct CurvePoint {
  Vec3 place;
  std::size_t curve = 0;
};

// A tree over points, halved at the median of the longest side: nearest neighbours without a scale to choose.
class PointTree {
 public:
  explicit PointTree(std::vector<CurvePoint> points) : points_(std::move(points)) {
    build(0, points_.size());
  }

  // Squared distance to the nearest point of another curve.
  double nearest_other(const CurvePoint& from) const {
    double best = std::numeric_limits<double>::infinity();
    search(from, 0, points_.size(), best);
    return best;
  }

 private:
  static constexpr std::size_t leaf = 8;

  static int longest_side(std::span<const CurvePoint> points) {
    Vec3 low = points[0].place, high = low;
    for (const CurvePoint& p : points)
      for (int c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], p.place[c]);
        high[c] = std::max(high[c], p.place[c]);
      }
    const Vec3 size = high - low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  }

  // The middle point of a range parts it; its axis is kept beside it.
  void build(std::size_t begin, std::size_t end) {
    axis_.resize(points_.size());
    if (end - begin <= leaf) return;
    const int axis = longest_side(std::span(points_).subspan(begin, end - begin));
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t k) { return points_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end), [axis](const CurvePoint& a, const CurvePoint& b) {
      return a.place[axis] < b.place[axis];
    });
    axis_[middle] = static_cast<std::uint8_t>(axis);
    build(begin, middle);
    build(middle + 1, end);
  }

  void search(const CurvePoint& from, std::size_t begin, std::size_t end, double& best) const {
    const auto look = [&](const CurvePoint& p) {
      if (p.curve != from.curve) best = std::min(best, squared_norm(p.place - from.place));
    };
    if (end - begin <= leaf) {
      for (std::size_t k = begin; k < end; ++k) look(points_[k]);
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    look(points_[middle]);
    const int axis = axis_[middle];
    const double across = from.place[axis] - points_[middle].place[axis];
    const bool first_half = across < 0;
    if (first_half)
      search(from, begin, middle, best);
    else
      search(from, middle + 1, end, best);
    if (across * across >= best) return;
    if (first_half)
      search(from, middle + 1, end, best);
    else
      search(from, begin, middle, best);
  }

  std::vector<CurvePoint> points_;
  std::vector<std::uint8_t> axis_;
};

}  // namespace

std::optional<double> usual_distance(const std::vector<std::vector<Vec3>>& curves) {
  if (curves.size() < 2) return std::nullopt;
  std::vector<CurvePoint> points;
  for (std::size_t k = 0; k < curves.size(); ++k)
    for (const Vec3& p : curves[k]) points.push_back({p, k});
  constexpr std::size_t asked = 4000;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / asked);
  std::vector<CurvePoint> from;
  for (std::size_t k = 0; k < points.size(); k += stride) from.push_back(points[k]);
  const PointTree tree(std::move(points));
  std::vector<double> distances;
  for (const CurvePoint& p : from) distances.push_back(std::sqrt(tree.nearest_other(p)));
  const auto place = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 20);
  std::nth_element(distances.begin(), place, distances.end());
  if (!(*place > 0) || !std::isfinite(*place)) return std::nullopt;
  return *place;
}

}  // namespace loopwright
