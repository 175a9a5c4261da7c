// min_clearance: a uniform grid over short chords of all centrelines and, in periodic cells, of their images.
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "geometry/interlacing.hpp"

namespace loopwright {
namespace {

constexpr int samples_per_segment = 4;
constexpr double pi = 3.14159265358979323846;
constexpr double same_yarn_reach = 1.25 * pi / 2;  // in d: nearer along the yarn is bending, not contact

struct Chord {
  Vec3 a, b;
  int yarn = 0;
  double t = 0;      // parameter of a
  double along = 0;  // rest length from the yarn's start, unwrapped over periods for images of the same yarn
  bool image = false;  // of the cell, not in it
};

struct Nearest {
  double distance;
  double u, v;
};

// Closest points of two segments: the unconstrained minimum clamped, then each end projected onto the other.
Nearest segment_distance(const Chord& p, const Chord& q) {
  const Vec3 d1 = p.b - p.a, d2 = q.b - q.a, r = p.a - q.a;
  const double a = squared_norm(d1), e = squared_norm(d2), f = dot(d2, r), c = dot(d1, r), b = dot(d1, d2);
  const double denominator = a * e - b * b;
  double u = denominator > 1e-14 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0;
  double v = e > 0 ? (b * u + f) / e : 0;
  if (v < 0 || v > 1) {
    v = std::clamp(v, 0.0, 1.0);
    u = a > 0 ? std::clamp((b * v - c) / a, 0.0, 1.0) : 0;
  }
  return {distance(p.a + d1 * u, q.a + d2 * v), u, v};
}

struct Box {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high = -low;
  void add(const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
};

std::vector<Chord> chords_of(const Fabric& fabric) {
  std::vector<Chord> chords;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& yarn = fabric.yarns[y];
    const std::vector<Vec3> line = polyline(fabric, yarn, samples_per_segment);
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      Chord chord;
      chord.a = line[k];
      chord.b = line[k + 1];
      chord.yarn = static_cast<int>(y);
      chord.t = static_cast<double>(k) / samples_per_segment;
      chord.along = chord.t * yarn.segment_rest_length;
      chords.push_back(chord);
    }
  }
  return chords;
}

// Rest length between two chords of one yarn; round a ring the shorter way.
double distance_along(const Fabric& fabric, const Chord& p, const Chord& q) {
  const double apart = std::abs(p.along - q.along);
  const FabricYarn& yarn = fabric.yarns[static_cast<std::size_t>(p.yarn)];
  const bool ring = yarn.periodic && yarn.shift == std::array<int, 2>{0, 0} && !p.image && !q.image;
  return ring ? std::min(apart, yarn.segments() * yarn.segment_rest_length - apart) : apart;
}

// Images that come within `reach` of the cell's own yarns.
void add_images(const Fabric& fabric, double reach, std::vector<Chord>& chords) {
  Box box;
  for (const Chord& chord : chords) {
    box.add(chord.a);
    box.add(chord.b);
  }
  const Vec3 size = box.high - box.low;
  const int most_n = static_cast<int>(std::ceil((size.y + reach) / fabric.height));
  const int most_m =
      static_cast<int>(std::ceil((size.x + reach + most_n * std::abs(fabric.skew)) / fabric.width));
  const std::size_t own = chords.size();
  for (int n = -most_n; n <= most_n; ++n)
    for (int m = -most_m; m <= most_m; ++m) {
      if (m == 0 && n == 0) continue;
      const Vec3 moved = fabric.lattice(m, n);
      for (std::size_t k = 0; k < own; ++k) {
        Chord chord = chords[k];
        chord.a += moved;
        chord.b += moved;
        const Vec3 middle = (chord.a + chord.b) / 2;
        if (middle.x < box.low.x - reach || middle.x > box.high.x + reach || middle.y < box.low.y - reach ||
            middle.y > box.high.y + reach)
          continue;
        chord.image = true;
        const FabricYarn& yarn = fabric.yarns[static_cast<std::size_t>(chord.yarn)];
        // The same yarn one or more periods on?
        const int turns = yarn.shift[0] != 0 ? m / yarn.shift[0] : yarn.shift[1] != 0 ? n / yarn.shift[1] : 0;
        const bool same = turns * yarn.shift[0] == m && turns * yarn.shift[1] == n;
        chord.along = same ? chord.along + turns * yarn.segments() * yarn.segment_rest_length
                           : std::numeric_limits<double>::infinity();
        chords.push_back(chord);
      }
    }
}

class Grid {
 public:
  Grid(const std::vector<Chord>& chords, double cell) : cell_(cell) {
    for (std::size_t k = 0; k < chords.size(); ++k) cells_[key(place(chords[k], 0, 0, 0))].push_back(k);
  }
  template <class Visit>
  void visit_near(const Chord& chord, Visit visit) const {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k)
          if (const auto found = cells_.find(key(place(chord, i, j, k))); found != cells_.end())
            for (const std::size_t other : found->second) visit(other);
  }

 private:
  struct Place {
    std::int64_t x, y, z;
  };
  Place place(const Chord& chord, int i, int j, int k) const {
    const Vec3 middle = (chord.a + chord.b) / 2;
    return {std::llround(std::floor(middle.x / cell_)) + i, std::llround(std::floor(middle.y / cell_)) + j,
            std::llround(std::floor(middle.z / cell_)) + k};
  }
  static std::int64_t key(const Place& p) {
    constexpr std::int64_t half = 1 << 20;
    return ((p.x + half) << 42) | ((p.y + half) << 21) | (p.z + half);
  }
  double cell_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

}  // namespace

Clearance min_clearance(const Fabric& fabric) {
  Clearance best;
  best.distance = std::numeric_limits<double>::infinity();
  const std::vector<Chord> own = chords_of(fabric);
  if (own.empty()) return best;
  double longest = 0;
  for (const Chord& chord : own) longest = std::max(longest, distance(chord.a, chord.b));
  Box box;
  for (const Chord& chord : own) box.add(chord.a);
  const double largest = norm(box.high - box.low) + 4;
  for (double reach = 1.2; !std::isfinite(best.distance) && reach < 2 * largest; reach *= 4) {
    std::vector<Chord> chords = own;
    if (fabric.periodic) add_images(fabric, reach, chords);
    const Grid grid(chords,
                    reach + longest);  // middles of chords nearer than reach lie in neighbouring cells
    for (std::size_t k = 0; k < own.size(); ++k)
      grid.visit_near(own[k], [&](std::size_t other) {
        const Chord& p = own[k];
        const Chord& q = chords[other];
        if (!q.image && other <= k) return;
        if (p.yarn == q.yarn && distance_along(fabric, p, q) < same_yarn_reach) return;
        const Nearest nearest = segment_distance(p, q);
        if (nearest.distance >= best.distance || nearest.distance > reach) return;
        best.distance = nearest.distance;
        best.yarn_a = p.yarn;
        best.yarn_b = q.yarn;
        best.t_a = p.t + nearest.u / samples_per_segment;
        best.t_b = q.t + nearest.v / samples_per_segment;
      });
  }
  return best;
}

}  // namespace loopwright
