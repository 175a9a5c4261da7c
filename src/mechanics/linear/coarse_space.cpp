#include "mechanics/linear/coarse_space.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "mechanics/linear/plate_projection.hpp"

namespace loopwright {
namespace {

constexpr int rows_per_chunk = 256;
constexpr std::size_t nodes_per_chunk = 4096;

// Coarse points and the control points that they carry: P by columns.
struct Columns {
  std::vector<std::int32_t> start, node;
  std::vector<double> weight;
};

Columns columns_of(const CoarseSpace& space) {
  Columns columns;
  columns.start.assign(static_cast<std::size_t>(space.points) + 1, 0);
  for (const CoarseSpace::Row& row : space.rows)
    for (std::size_t k = 0; k < 4; ++k)
      if (row.weight[k] != 0) ++columns.start[static_cast<std::size_t>(row.point[k]) + 1];
  for (std::size_t c = 0; c + 1 < columns.start.size(); ++c) columns.start[c + 1] += columns.start[c];
  columns.node.resize(static_cast<std::size_t>(columns.start.back()));
  columns.weight.resize(columns.node.size());
  std::vector<std::int32_t> fill(columns.start.begin(), columns.start.end() - 1);
  for (std::size_t i = 0; i < space.rows.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      if (space.rows[i].weight[k] == 0) continue;
      const auto at = static_cast<std::size_t>(fill[static_cast<std::size_t>(space.rows[i].point[k])]++);
      columns.node[at] = static_cast<std::int32_t>(i);
      columns.weight[at] = space.rows[i].weight[k];
    }
  return columns;
}

// Some rows of the coarse matrix: their columns and blocks one after another.
struct Part {
  std::vector<std::int32_t> length, column;
  std::vector<Block> block;
};

// Sums up rows of P' (A + shift D) P, one after another.
class RowSums {
 public:
  RowSums(const CoarseSpace& space, const Columns& columns, const BlockMatrix& matrix, double shift)
      : space_(space), columns_(columns), matrix_(matrix), shift_(shift) {
    slot_.assign(static_cast<std::size_t>(space.points), -1);
  }
  void add_row(std::size_t row, Part& part) {
    found_.clear();
    sum_.clear();
    for (auto at = static_cast<std::size_t>(columns_.start[row]);
         at < static_cast<std::size_t>(columns_.start[row + 1]); ++at)
      add_fine_row(static_cast<std::size_t>(columns_.node[at]), columns_.weight[at]);
    order_.resize(found_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) order_[k] = k;
    std::sort(order_.begin(), order_.end(),
              [this](std::size_t a, std::size_t b) { return found_[a] < found_[b]; });
    for (const std::size_t k : order_) {
      part.column.push_back(found_[k]);
      part.block.push_back(sum_[k]);
      slot_[static_cast<std::size_t>(found_[k])] = -1;
    }
    part.length.push_back(static_cast<std::int32_t>(found_.size()));
  }

 private:
  void add_fine_row(std::size_t i, double weight) {
    for (auto e = static_cast<std::size_t>(matrix_.row_start[i]);
         e < static_cast<std::size_t>(matrix_.row_start[i + 1]); ++e) {
      const CoarseSpace::Row& other = space_.rows[static_cast<std::size_t>(matrix_.column[e])];
      for (std::size_t k = 0; k < 4; ++k) {
        if (other.weight[k] == 0) continue;
        std::int32_t& slot = slot_[static_cast<std::size_t>(other.point[k])];
        if (slot < 0) {
          slot = static_cast<std::int32_t>(found_.size());
          found_.push_back(other.point[k]);
          sum_.push_back({});
        }
        Block& to = sum_[static_cast<std::size_t>(slot)];
        const double w = weight * other.weight[k];
        for (std::size_t d = 0; d < 9; ++d) to[d] += w * matrix_.block[e][d];
        if (shift_ != 0)
          for (const std::size_t d : {0, 4, 8}) to[d] += w * shift_ * matrix_.metric[e];
      }
    }
  }

  const CoarseSpace& space_;
  const Columns& columns_;
  const BlockMatrix& matrix_;
  double shift_;
  std::vector<std::int32_t> slot_, found_;  // [coarse point] its place among the row's, -1: none yet
  std::vector<Block> sum_;
  std::vector<std::size_t> order_;
};

void project_rows(const CoarseSpace& space, const BlockMatrix& matrix, double shift, BlockMatrix& coarse) {
  const Columns columns = columns_of(space);
  const int chunks = (space.points + rows_per_chunk - 1) / rows_per_chunk;
  std::vector<Part> parts(static_cast<std::size_t>(chunks));
  parallel_chunks(chunks, [&](int chunk) {
    RowSums sums(space, columns, matrix, shift);
    const int end = std::min(space.points, (chunk + 1) * rows_per_chunk);
    for (int row = chunk * rows_per_chunk; row < end; ++row)
      sums.add_row(static_cast<std::size_t>(row), parts[static_cast<std::size_t>(chunk)]);
  });
  coarse.row_start.assign(1, 0);
  coarse.column.clear();
  coarse.block.clear();
  for (const Part& part : parts) {
    for (const std::int32_t length : part.length)
      coarse.row_start.push_back(coarse.row_start.back() + length);
    coarse.column.insert(coarse.column.end(), part.column.begin(), part.column.end());
    coarse.block.insert(coarse.block.end(), part.block.begin(), part.block.end());
  }
}

}  // namespace

void CoarseSpace::drop_empty_columns() {
  std::vector<std::int32_t> number(static_cast<std::size_t>(points), -1);
  for (const Row& row : rows)
    for (std::size_t k = 0; k < 4; ++k)
      if (row.weight[k] != 0) number[static_cast<std::size_t>(row.point[k])] = 0;
  points = 0;
  for (std::int32_t& n : number)
    if (n == 0) n = points++;
  for (Row& row : rows)
    for (std::size_t k = 0; k < 4; ++k)
      row.point[k] = row.weight[k] != 0 ? number[static_cast<std::size_t>(row.point[k])] : 0;
}

void CoarseSpace::restricted(const std::vector<Vec3>& r, std::vector<Vec3>& c) const {
  c.assign(static_cast<std::size_t>(points), Vec3{});
  for (std::size_t i = 0; i < r.size(); ++i)
    each_entry(i, [&](std::int32_t point, double w, double a, double b) {
      Vec3& sum = c[static_cast<std::size_t>(point)];
      sum += w * r[i];
      sum.z += a * r[i].x + b * r[i].y;
    });
}

void CoarseSpace::add_prolonged(const std::vector<Vec3>& c, std::vector<Vec3>& u) const {
  const int chunks = static_cast<int>((u.size() + nodes_per_chunk - 1) / nodes_per_chunk);
  parallel_chunks(chunks, [&](int chunk) {
    const std::size_t begin = static_cast<std::size_t>(chunk) * nodes_per_chunk;
    for (std::size_t i = begin; i < std::min(u.size(), begin + nodes_per_chunk); ++i)
      each_entry(i, [&](std::int32_t point, double w, double a, double b) {
        const Vec3& v = c[static_cast<std::size_t>(point)];
        u[i] += w * v + Vec3{a * v.z, b * v.z, 0};
      });
  });
}

void CoarseSpace::project(const BlockMatrix& matrix, double shift, BlockMatrix& coarse) const {
  if (rows.empty())
    project_plate(plate, points, matrix, shift, coarse);
  else
    project_rows(*this, matrix, shift, coarse);
  coarse.metric.assign(coarse.column.size(), 0);
  coarse.border.assign(static_cast<std::size_t>(points), Block{});
  coarse.corner = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  coarse.measure_metric = {};
}

CoarseSpace plate_space(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held, int nx,
                        int ny) {
  constexpr double least_carried = 0.01;  // sum of squared weights; columns below it would repeat others
  Vec3 low = places.front(), high = places.front();
  for (const Vec3& p : places)
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  CoarseSpace space;
  PlateGrid& plate = space.plate;
  plate.nx = nx;
  plate.ny = ny;
  plate.width = std::max(1e-9, (high.x - low.x) / nx);
  plate.height = std::max(1e-9, (high.y - low.y) / ny);
  plate.places.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (held[i] != 0) continue;
    const double x = std::clamp((places[i].x - low.x) / plate.width, 0.0, nx - 1e-9),
                 y = std::clamp((places[i].y - low.y) / plate.height, 0.0, ny - 1e-9);
    const int cx = static_cast<int>(x), cy = static_cast<int>(y);
    plate.places[i] = {cy * nx + cx, static_cast<float>(x - cx), static_cast<float>(y - cy),
                       static_cast<float>(places[i].z - 0.5 * (low.z + high.z))};
  }
  plate.number.resize(static_cast<std::size_t>((nx + 2) * (ny + 2)));
  for (std::size_t k = 0; k < plate.number.size(); ++k) plate.number[k] = static_cast<std::int32_t>(k);
  std::vector<double> carried(plate.number.size(), 0);
  for (std::size_t i = 0; i < places.size(); ++i)
    space.each_entry(i, [&](std::int32_t point, double w, double, double) {
      carried[static_cast<std::size_t>(point)] += w * w;
    });
  for (std::size_t k = 0; k < carried.size(); ++k)
    plate.number[k] = carried[k] > least_carried ? space.points++ : -1;
  return space;
}

}  // namespace loopwright
