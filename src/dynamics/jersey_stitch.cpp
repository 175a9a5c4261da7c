#include "dynamics/jersey_stitch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace loopwright {
namespace {

// How far the head of a row reaches over the sinker of the next, and how far the foot bends outward and up:
// as in the template of the first paper (its T0 to T4), in yarn diameters; outward a
// fifth more, which Catmull-Rom curves need to pass each other.
constexpr double overlap = 3, foot_out = 0.6, foot_up = 1.5;

std::array<Vec3, 11> points_with(const JerseyStitch& stitch, double a) {
  const double d = stitch.thickness, w = stitch.wale_spacing, height = stitch.course_spacing + overlap * d;
  std::array<Vec3, 11> p;
  p[1] = {0, 0, -a};
  p[2] = {w / 4 + foot_out * d, foot_up * d, 0};
  p[3] = {w / 4, height / 2, a};
  for (const std::size_t k : {1, 2}) {  // half a turn about point 3
    const Vec3 turned = 2 * p[3] - p[k];
    p[6 - k] = {turned.x, turned.y, p[k].z};
  }
  for (const std::size_t k : {1, 2, 3, 4}) p[10 - k] = {w - p[k].x, p[k].y, p[k].z};  // mirror at x = w / 2
  p[0] = p[8] - Vec3{w, 0, 0};
  p[10] = p[2] + Vec3{w, 0, 0};
  return p;
}

std::vector<Vec3> row_of(const std::array<Vec3, 11>& p, double width, int n) {
  std::vector<Vec3> row(p.begin(), p.end());
  for (int k = 1; k < n; ++k)
    for (std::size_t i = 3; i < 11; ++i) row.push_back(p[i] + Vec3{k * width, 0, 0});
  return row;
}

std::vector<Vec3> line_of(const std::vector<Vec3>& row) {
  constexpr int per_segment = 12;
  const Blending blending = catmull_rom();
  std::vector<Vec3> line;
  for (std::size_t e = 0; e + 3 < row.size(); ++e)
    for (int k = 0; k < per_segment; ++k) {
      const auto w = blending.weights(static_cast<double>(k) / per_segment).value;
      line.push_back(w[0] * row[e] + w[1] * row[e + 1] + w[2] * row[e + 2] + w[3] * row[e + 3]);
    }
  return line;
}

// Smallest distance of the centrelines of a row and the next two.
double room(const JerseyStitch& stitch, double a) {
  const std::vector<Vec3> line = line_of(row_of(points_with(stitch, a), stitch.wale_spacing, 3));
  double least = std::numeric_limits<double>::infinity();
  for (const double rows : {1, 2})
    for (const Vec3& p : line)
      for (const Vec3& q : line)
        least = std::min(least, squared_norm(p - q - Vec3{0, rows * stitch.course_spacing, 0}));
  return std::sqrt(least);
}

}  // namespace

std::array<Vec3, 11> jersey_points(const JerseyStitch& stitch) {
  const double d = stitch.thickness;
  for (const double v : {d, stitch.wale_spacing, stitch.course_spacing})
    if (!std::isfinite(v) || !(v > 0))
      throw std::invalid_argument("a jersey stitch needs a positive thickness, wale and course spacing");
  // Heads side by side: each is half a wale and 1.2 diameters wide.
  constexpr double least_width = 4.4, highest = 3;
  if (stitch.wale_spacing < least_width * d || room(stitch, highest * d) < d)
    throw std::invalid_argument(
        "the stitches are too dense for the yarn: at least 4.4 diameters wide, and high enough for two rows "
        "to "
        "pass each other");
  double low = 0, high = highest * d;
  constexpr int halvings = 40;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (low + high);
    (room(stitch, middle) < d ? low : high) = middle;
  }
  return points_with(stitch, high);
}

std::vector<Vec3> jersey_row(const JerseyStitch& stitch, int n) {
  if (n < 1) throw std::invalid_argument("a row needs a stitch");
  return row_of(jersey_points(stitch), stitch.wale_spacing, n);
}

JerseyPiece jersey_piece(const JerseyStitch& stitch, int n, int rows, StretchLaw law, double tension) {
  if (rows < 1) throw std::invalid_argument("a piece needs a row");
  const std::vector<Vec3> row = jersey_row(stitch, n);
  JerseyPiece piece;
  piece.model.law = law;
  for (int r = 0; r < rows; ++r) {
    SplineYarn yarn;
    yarn.blending = catmull_rom(tension);
    yarn.first = piece.model.points;
    yarn.points = static_cast<int>(row.size());
    yarn.diameter = stitch.thickness;
    std::vector<Vec3> placed = row;
    for (Vec3& p : placed) p.y += r * stitch.course_spacing;
    set_rest_shape(yarn, placed, 1, law);
    set_mass_per_length(yarn, 1, placed);
    piece.model.points += yarn.points;
    piece.state.place.insert(piece.state.place.end(), placed.begin(), placed.end());
    piece.model.yarns.push_back(std::move(yarn));
    if (r == 0) continue;
    // Segment e runs from point e + 1 to e + 2 of the row: feet from sinker to mid-leg, heads between
    // mid-legs.
    for (int k = 0; k < n; ++k) {
      const double at = 8.0 * k;
      piece.feet.push_back({r, r - 1, at, at + 2, at + 2, at + 6});
      piece.feet.push_back({r, r - 1, at + 6, at + 8, at + 2, at + 6});
    }
  }
  piece.model.held.assign(static_cast<std::size_t>(piece.model.points), 0);
  piece.state.velocity.assign(piece.state.place.size(), Vec3{});
  return piece;
}

}  // namespace loopwright
