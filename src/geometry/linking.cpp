#include "geometry/linking.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace loopwright {
namespace {

constexpr int chords_per_segment = 4;

struct Chord {
  Vec3 a, b;  // seen along z
  int yarn = 0;
};

// Axes of the picture plane and the direction of sight, none of them along anything that a fabric has.
struct Sight {
  Vec3 right, up, toward;
};

Sight sight(int attempt) {
  const double turn = 0.3217 + 0.7113 * attempt, tilt = 0.1729 + 0.2311 * attempt;
  const Vec3 toward{std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)};
  const Vec3 right = normalized(cross({0.1, 1, 0.05}, toward));
  return {right, cross(toward, right), toward};
}

std::vector<Chord> chords_of(const Fabric& fabric, const Sight& eye) {
  std::vector<Chord> chords;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    if (!is_closed(fabric.yarns[y])) continue;
    std::vector<Vec3> line = polyline(fabric, fabric.yarns[y], chords_per_segment);
    line.back() = line.front();  // to the bit
    for (Vec3& p : line) p = {dot(p, eye.right), dot(p, eye.up), dot(p, eye.toward)};
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      chords.push_back({line[k], line[k + 1], static_cast<int>(y)});
  }
  return chords;
}

double turn(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// +1 or -1 where the two chords cross in the picture, 0 where not. A corner on a line counts as to its left,
// so that of the chords that share the corner one crosses.
int crossing_sign(const Chord& p, const Chord& q) {
  const double qa = turn(p.a, p.b, q.a), qb = turn(p.a, p.b, q.b);
  if ((qa >= 0) == (qb >= 0)) return 0;
  const double pa = turn(q.a, q.b, p.a), pb = turn(q.a, q.b, p.b);
  if ((pa >= 0) == (pb >= 0)) return 0;
  const double s = pa / (pa - pb), t = qa / (qa - qb);
  const double p_height = p.a.z + (p.b.z - p.a.z) * s, q_height = q.a.z + (q.b.z - q.a.z) * t;
  const bool leftward = qb > qa;  // q goes to the left of p
  return (p_height > q_height) == leftward ? 1 : -1;
}

// Sums of signs for every pair of rings whose pictures meet.
std::map<std::pair<int, int>, int> crossing_sums(const std::vector<Chord>& chords) {
  double longest = 0;
  for (const Chord& chord : chords)
    longest = std::max({longest, std::abs(chord.b.x - chord.a.x), std::abs(chord.b.y - chord.a.y)});
  const double cell = longest > 0 ? longest : 1;
  const auto index = [cell](double x) { return static_cast<std::int64_t>(std::floor(x / cell)); };
  const auto key = [](std::int64_t i, std::int64_t j) { return i * 0x1f123bb5LL ^ j * 0x5bd1e995LL; };
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
  for (std::size_t k = 0; k < chords.size(); ++k)
    cells[key(index(0.5 * (chords[k].a.x + chords[k].b.x)), index(0.5 * (chords[k].a.y + chords[k].b.y)))]
        .push_back(k);
  std::map<std::pair<int, int>, int> sums;
  for (std::size_t k = 0; k < chords.size(); ++k) {
    const Chord& p = chords[k];
    const std::int64_t i0 = index(0.5 * (p.a.x + p.b.x)), j0 = index(0.5 * (p.a.y + p.b.y));
    // cells whose keys fall together would be visited twice
    std::vector<std::int64_t> keys;
    for (std::int64_t i = i0 - 1; i <= i0 + 1; ++i)
      for (std::int64_t j = j0 - 1; j <= j0 + 1; ++j) keys.push_back(key(i, j));
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    for (const std::int64_t each : keys) {
      const auto found = cells.find(each);
      if (found == cells.end()) continue;
      for (const std::size_t other : found->second)
        if (other > k && chords[other].yarn != p.yarn)
          if (const int sign = crossing_sign(p, chords[other]); sign != 0)
            sums[std::minmax(p.yarn, chords[other].yarn)] += sign;
    }
  }
  return sums;
}

}  // namespace

bool is_closed(const FabricYarn& yarn) { return yarn.periodic && yarn.shift == std::array<int, 2>{0, 0}; }

std::vector<LinkedPair> linking_numbers(const Fabric& fabric) {
  constexpr int most_attempts = 8;
  std::map<std::pair<int, int>, int> sums;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    sums = crossing_sums(chords_of(fabric, sight(attempt)));
    if (std::all_of(sums.begin(), sums.end(), [](const auto& each) { return each.second % 2 == 0; })) break;
  }
  std::vector<LinkedPair> linked;
  for (const auto& [pair, sum] : sums)
    if (sum / 2 != 0) linked.push_back({pair.first, pair.second, sum / 2});
  return linked;
}

}  // namespace loopwright
