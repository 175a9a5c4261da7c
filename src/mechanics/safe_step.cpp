#include "mechanics/safe_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"

namespace loopwright {
namespace {

// Least-squares affine map of the displacement s_i ~ T x_i + t over control points; returns the largest |s_i - T x_i - t|.
// The points' own 4 x 4 moment matrix is solved by Gaussian elimination with a small ridge (flat pieces have no z extent).
double motion_beyond_affine(const YarnState& state, const YarnState& target) {
  const std::size_t n = state.nodes.size();
  Vec3 centre;
  for (const Vec3& p : state.nodes) centre += p;
  centre *= 1.0 / static_cast<double>(n);
  std::array<std::array<double, 7>, 4> m{};  // moments of (x, y, z, 1), then three right-hand sides
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = state.nodes[i] - centre, s = target.nodes[i] - state.nodes[i];
    const std::array<double, 4> x{p.x, p.y, p.z, 1};
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
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = state.nodes[i] - centre;
    Vec3 s = target.nodes[i] - state.nodes[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const double affine = m[0][4 + c] / m[0][0] * p.x + m[1][4 + c] / m[1][1] * p.y + m[2][4 + c] / m[2][2] * p.z +
                            m[3][4 + c] / m[3][3];
      s[static_cast<int>(c)] -= affine;
    }
    largest = std::max(largest, squared_norm(s));
  }
  return std::sqrt(largest);
}

}  // namespace

SafeStep safe_step(const YarnModel& model, const Assembly& assembly, const YarnState& state, const YarnState& target,
                   double range, double outer_diameter, double share) {
  std::vector<Vec3> extended;
  SamplePlaces from, to;
  expand(model, state, extended);
  place_samples(model, extended, from);
  expand(model, target, extended);
  place_samples(model, extended, to);

  const auto& pairs = assembly.pairs();
  constexpr int pairs_per_chunk = 4096;
  const int chunks = static_cast<int>((pairs.size() + pairs_per_chunk - 1) / pairs_per_chunk);
  struct Worst {
    double ratio2 = 0;
    int a = -1, b = -1;
  };
  std::vector<Worst> worst(static_cast<std::size_t>(chunks));
  parallel_chunks(chunks, [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * pairs_per_chunk, end = std::min(pairs.size(), begin + pairs_per_chunk);
    Worst& w = worst[static_cast<std::size_t>(c)];
    for (std::size_t k = begin; k < end; ++k) {
      const SegmentPair& pair = pairs[k];
      const Vec3 image = state.lattice(pair.m, pair.n), moved_image = target.lattice(pair.m, pair.n) - image;
      const YarnModel::Yarn& yarn = model.yarns[static_cast<std::size_t>(model.yarn_of_segment[static_cast<std::size_t>(pair.a)])];
      const double spacing = yarn.rest_length / model.samples;
      const double missed = spacing * spacing;  // nearest samples lie up to half a spacing off on either yarn
      const auto i0 = static_cast<std::size_t>(pair.a * model.samples), j0 = static_cast<std::size_t>(pair.b * model.samples);
      const auto count = static_cast<std::size_t>(model.samples);
      for (std::size_t i = 0; i < count; ++i) {
        const double x = from.x[i0 + i] - image.x, y = from.y[i0 + i] - image.y, z = from.z[i0 + i] - image.z;
        const double sx = to.x[i0 + i] - from.x[i0 + i] - moved_image.x, sy = to.y[i0 + i] - from.y[i0 + i] - moved_image.y,
                     sz = to.z[i0 + i] - from.z[i0 + i] - moved_image.z;
        for (std::size_t j = 0; j < count; ++j) {
          if (pair.same_yarn && std::abs(pair.arc_offset + (static_cast<double>(j) - static_cast<double>(i)) * spacing) < model.excluded)
            continue;
          const double dx = x - from.x[j0 + j], dy = y - from.y[j0 + j], dz = z - from.z[j0 + j];
          const double d2 = dx * dx + dy * dy + dz * dz;
          const double rx = sx - (to.x[j0 + j] - from.x[j0 + j]), ry = sy - (to.y[j0 + j] - from.y[j0 + j]),
                       rz = sz - (to.z[j0 + j] - from.z[j0 + j]);
          const double r2 = rx * rx + ry * ry + rz * rz;
          const double room2 = std::max(d2 - missed, 0.1 * d2);
          if (r2 > w.ratio2 * room2) {
            w.ratio2 = r2 / room2;
            w.a = pair.a;
            w.b = pair.b;
          }
        }
      }
    }
  });

  SafeStep result;
  double ratio2 = 0;
  for (const Worst& w : worst)
    if (w.ratio2 > ratio2) {
      ratio2 = w.ratio2;
      result.worst_a = w.a;
      result.worst_b = w.b;
    }
  result.pair_ratio = std::sqrt(ratio2);
  result.loose_motion = motion_beyond_affine(state, target);
  // Pairs outside the list stay outside contact: each of the two may move by less than half of what parts them from it.
  const double loose_limit = 0.45 * (range - outer_diameter);
  if (result.pair_ratio > share) result.scale = share / result.pair_ratio;
  if (result.loose_motion * result.scale > loose_limit) result.scale = loose_limit / result.loose_motion;
  return result;
}

}  // namespace loopwright
