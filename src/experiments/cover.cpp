#include "experiments/cover.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace loopwright {
namespace {

constexpr double points_per_diameter = 16;
constexpr double most_points = 4e6;

// A grid over the cell or rectangle. Its points lie at x = x0 + (column + 1/2) step_x + (row + 1/2) / rows *
// skew, y = y0 + (row + 1/2) step_y. A cell goes on beyond its rim: columns and rows wrap round, a row beyond
// the rim being one inside, moved by the skew, which the unwrapped row number contains.
struct CoverGrid {
  bool wraps = false;
  double x0 = 0, y0 = 0, width = 0, height = 0, skew = 0;
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> covered;

  void divide() {
    const double wanted = width * points_per_diameter * height * points_per_diameter;
    const double density = points_per_diameter * std::min(1.0, std::sqrt(most_points / wanted));
    columns = std::max(1, static_cast<int>(std::lround(width * density)));
    rows = std::max(1, static_cast<int>(std::lround(height * density)));
    covered.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  }

  void cover(int column, int row) {
    if (wraps) {
      column = (column % columns + columns) % columns;
      row = (row % rows + rows) % rows;
    } else if (column < 0 || column >= columns || row < 0 || row >= rows) {
      return;
    }
    covered[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
            static_cast<std::size_t>(column)] = 1;
  }

  void cover_disc(const Vec3& centre, double radius) {
    const double step_x = width / columns, step_y = height / rows;
    const auto first_at = [](double place) { return static_cast<int>(std::ceil(place - 0.5)); };
    const auto last_at = [](double place) { return static_cast<int>(std::floor(place - 0.5)); };
    const int last_row = last_at((centre.y + radius - y0) / step_y);
    for (int row = first_at((centre.y - radius - y0) / step_y); row <= last_row; ++row) {
      const double dy = y0 + (row + 0.5) * step_y - centre.y;
      const double half = std::sqrt(std::max(0.0, radius * radius - dy * dy));
      const double middle = centre.x - x0 - skew * (row + 0.5) / rows;
      const int last_column = last_at((middle + half) / step_x);
      for (int column = first_at((middle - half) / step_x); column <= last_column; ++column)
        cover(column, row);
    }
  }
};

// The rectangle between the outermost heads of loops: of a finite piece, the part that is cloth all over.
CoverGrid rectangle_of_heads(const Fabric& fabric) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  double left = inf, right = -inf, low = inf, high = -inf;
  for (const LoopSpan& span : fabric.loops) {
    const Vec3 head = position(fabric, fabric.yarns[static_cast<std::size_t>(span.yarn)], span.apex);
    left = std::min(left, head.x), right = std::max(right, head.x);
    low = std::min(low, head.y), high = std::max(high, head.y);
  }
  return {false, left, low, right - left, high - low, 0, 0, 0, {}};
}

}  // namespace

double cover_factor(const Fabric& fabric) {
  CoverGrid grid = fabric.periodic ? CoverGrid{true, 0, 0, fabric.width, fabric.height, fabric.skew, 0, 0, {}}
                                   : rectangle_of_heads(fabric);
  if (!(grid.width > 0 && grid.height > 0)) return std::numeric_limits<double>::quiet_NaN();
  grid.divide();
  for (const FabricYarn& yarn : fabric.yarns) {
    // discs a tenth of a diameter apart leave scallops of 0.0025 d at the rim
    const double spacing = 0.1 * yarn.diameter;
    const double segment = arc_length(fabric, yarn) / std::max(1, yarn.segments());
    const int per_segment = std::max(1, static_cast<int>(std::ceil(segment / spacing)));
    for (const Vec3& point : polyline(fabric, yarn, per_segment)) grid.cover_disc(point, 0.5 * yarn.diameter);
  }
  const auto covered = std::count(grid.covered.begin(), grid.covered.end(), std::uint8_t{1});
  return static_cast<double>(covered) / static_cast<double>(grid.covered.size());
}

}  // namespace loopwright
