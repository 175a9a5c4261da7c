// The coarse spaces of the two-level solver: few points that carry many control points along.
//
//   u_i = sum_p  w_ip c_p + (a_ip, b_ip, 0) c_p.z,   u = P c
//
// and the Hessian as these points see it, P' (A + shift D) P.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

// Quadratic B-splines over a grid of squares; see plate_space.
struct PlateGrid {
  struct Place {
    std::int32_t cell = -1;     // -1: held
    float x = 0, y = 0, z = 0;  // inside the cell, 0 to 1; above the middle plane, in d
  };
  int nx = 0, ny = 0;                // cells; (nx + 2) (ny + 2) splines
  double width = 1, height = 1;      // of a cell, in d
  std::vector<Place> places;         // [control point]
  std::vector<std::int32_t> number;  // [spline] coarse point, -1: carries nothing

  // What the nine splines of a place's cell carry it along by: spline k is the (k % 3)rd along x and the
  // (k / 3)rd along y that begin at its cell.
  struct Carried {
    std::array<double, 9> w, a, b;
  };
  Carried carried(const Place& place) const;
};

struct CoarseSpace {
  struct Row {
    std::array<std::int32_t, 4> point{};
    std::array<double, 4> weight{};  // 0: no entry
  };
  // One of the two, the other is empty.
  std::vector<Row> rows;  // [control point]; held ones have no weight
  PlateGrid plate;
  int points = 0;

  std::size_t control_points() const { return rows.empty() ? plate.places.size() : rows.size(); }
  // visit(point, w, a, b) for every coarse point that carries control point i.
  template <class Visit>
  void each_entry(std::size_t i, const Visit& visit) const;

  // Every column with an entry, or P' A P has empty rows: takes out the others and counts anew.
  void drop_empty_columns();
  // c = P' r and u += P c.
  void restricted(const std::vector<Vec3>& r, std::vector<Vec3>& c) const;
  void add_prolonged(const std::vector<Vec3>& c, std::vector<Vec3>& u) const;
  // P' (A + shift D) P; the metric is in the blocks. The coarse matrix has no border.
  void project(const BlockMatrix& matrix, double shift, BlockMatrix& coarse) const;
};

// Smooth displacements of the piece as a plate on nx x ny cells over the places' bounding box: quadratic
// B-splines for all three coordinates, and where the plate tilts its yarn turns along (Kirchhoff):
// a = -z dw/dx, b = -z dw/dy. Hat functions without the turning shear the loops of a wave out of the plane:
// they see it stiffer by the square of its length over the cloth's thickness.
CoarseSpace plate_space(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held, int nx,
                        int ny);

inline PlateGrid::Carried PlateGrid::carried(const Place& place) const {
  const auto splines = [](double t) {
    return std::array{0.5 * (1 - t) * (1 - t), 0.5 + t - t * t, 0.5 * t * t};
  };
  const auto slopes = [](double t, double h) { return std::array{(t - 1) / h, (1 - 2 * t) / h, t / h}; };
  const double x = place.x, y = place.y, z = place.z;
  const auto wx = splines(x), wy = splines(y), sx = slopes(x, width), sy = slopes(y, height);
  Carried c;
  for (std::size_t k = 0; k < 9; ++k) {
    c.w[k] = wx[k % 3] * wy[k / 3];
    c.a[k] = -z * sx[k % 3] * wy[k / 3];
    c.b[k] = -z * wx[k % 3] * sy[k / 3];
  }
  return c;
}

template <class Visit>
void CoarseSpace::each_entry(std::size_t i, const Visit& visit) const {
  if (!rows.empty()) {
    const Row& row = rows[i];
    for (std::size_t k = 0; k < 4; ++k)
      if (row.weight[k] != 0) visit(row.point[k], row.weight[k], 0.0, 0.0);
    return;
  }
  const PlateGrid::Place& place = plate.places[i];
  if (place.cell < 0) return;
  const PlateGrid::Carried carried = plate.carried(place);
  const int first = place.cell / plate.nx * (plate.nx + 2) + place.cell % plate.nx;
  for (std::size_t k = 0; k < 9; ++k) {
    const auto spline = first + static_cast<int>(k / 3) * (plate.nx + 2) + static_cast<int>(k % 3);
    const std::int32_t point = plate.number[static_cast<std::size_t>(spline)];
    if (point >= 0) visit(point, carried.w[k], carried.a[k], carried.b[k]);
  }
}

}  // namespace loopwright
