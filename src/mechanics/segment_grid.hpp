// Finds segments of yarn near a segment, each known by a ball round its middle.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "mechanics/yarn_model.hpp"

namespace loopwright {

// Segments by the place of their middle, in cubes.
class SegmentGrid {
 public:
  SegmentGrid(const YarnModel& model, const YarnState& state) {
    const auto count = static_cast<std::size_t>(model.segments);
    middle_.resize(count);
    reach_.resize(count);
    for (std::size_t e = 0; e < count; ++e) {
      const auto f = static_cast<std::size_t>(model.first[e]);
      const auto at = [&](std::size_t k) { return state.nodes[static_cast<std::size_t>(model.base[f + k])]; };
      middle_[e] = (at(0) + 23 * at(1) + 23 * at(2) + at(3)) / 48;
      // The curve lies in the hull of its control points, within those of its middle span's.
      for (std::size_t k = 0; k < 4; ++k) reach_[e] = std::max(reach_[e], distance(at(k), middle_[e]));
      largest_ = std::max(largest_, reach_[e]);
      cubes_[key(middle_[e])].push_back(static_cast<std::int32_t>(e));
    }
  }
  // Segments of which some point may lie within `distance` of some point of `segment`.
  template <class Visit>
  void each_near(std::int32_t segment, double within, const Visit& visit) const {
    const Vec3& from = middle_[static_cast<std::size_t>(segment)];
    const double own = reach_[static_cast<std::size_t>(segment)], far = within + own + largest_;
    const auto [x0, y0, z0] = key(from - Vec3{far, far, far});
    const auto [x1, y1, z1] = key(from + Vec3{far, far, far});
    for (int x = x0; x <= x1; ++x)
      for (int y = y0; y <= y1; ++y)
        for (int z = z0; z <= z1; ++z) {
          const auto cube = cubes_.find({x, y, z});
          if (cube == cubes_.end()) continue;
          for (const std::int32_t e : cube->second)
            if (distance(from, middle_[static_cast<std::size_t>(e)]) <
                within + own + reach_[static_cast<std::size_t>(e)])
              visit(e);
        }
  }

 private:
  using Key = std::tuple<int, int, int>;
  static Key key(const Vec3& p) {
    constexpr double side = 4;
    return {static_cast<int>(std::floor(p.x / side)), static_cast<int>(std::floor(p.y / side)),
            static_cast<int>(std::floor(p.z / side))};
  }
  std::vector<Vec3> middle_;
  std::vector<double> reach_;
  double largest_ = 0;
  std::map<Key, std::vector<std::int32_t>> cubes_;
};

}  // namespace loopwright
