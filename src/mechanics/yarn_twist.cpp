#include "mechanics/yarn_twist.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"

namespace loopwright {
namespace {

constexpr int segments_per_chunk = 4096;

double length_of(const YarnModel::Yarn& yarn) { return yarn.segments * yarn.rest_length; }

}  // namespace

YarnTwist::YarnTwist(const YarnModel& model)
    : model_(model),
      counts_(std::any_of(model.yarns.begin(), model.yarns.end(),
                          [](const YarnModel::Yarn& yarn) { return yarn.twist_stiffness > 0; })) {}

// The direction in which a yarn runs from loop to loop, at an end of an arc: for open yarn the chord over two
// loops, without loops the tangent.
Vec3 YarnTwist::running(const YarnModel::Yarn& yarn, const YarnState& state,
                        const std::vector<Vec3>& extended, int segment, std::size_t end) const {
  const auto at = [&](int s) { return static_cast<std::size_t>(yarn.first_extended + s); };
  const Vec3 tangent = tangents_[static_cast<std::size_t>(yarn.first_segment + segment)][end];
  Vec3 chord = tangent;
  if (yarn.periodic) {
    if (yarn.shift != std::array<int, 2>{0, 0}) chord = state.lattice(yarn.shift[0], yarn.shift[1]);
  } else if (yarn.segments_per_loop > 0) {
    const SplineWeights w = spline_weights(static_cast<double>(end) / twist_arcs);
    const std::size_t ahead = at(std::min(segment + yarn.segments_per_loop, yarn.segments - 1)),
                      behind = at(std::max(segment - yarn.segments_per_loop, 0));
    chord = {};
    for (std::size_t i = 0; i < 4; ++i) chord += w.value[i] * (extended[ahead + i] - extended[behind + i]);
  }
  const double length = norm(chord);
  return length > 1e-9 ? chord / length : tangent;
}

double YarnTwist::first_turn(const YarnModel::Yarn& yarn, const YarnState& state,
                             const std::vector<Vec3>& extended) const {
  double turn = 0;
  for (int e = 0; e < yarn.segments; ++e) {
    const ArcEnds& t = tangents_[static_cast<std::size_t>(yarn.first_segment + e)];
    for (std::size_t k = 0; k < twist_arcs; ++k) {
      const Vec3 from = running(yarn, state, extended, e, k), to = running(yarn, state, extended, e, k + 1);
      turn += spherical_area(from, to, t[k + 1], t[k]);
      // Where it runs is taken to have been reached by turning about the normal of the cloth.
      const double way = std::atan2(to.y, to.x) - std::atan2(from.y, from.x);
      turn += std::remainder(way, 2 * std::numbers::pi) - spherical_area({0, 0, 1}, from, to, to);
    }
  }
  return turn;
}

void YarnTwist::measure(const YarnState& state, const std::vector<Vec3>& extended) {
  const auto segments = static_cast<std::size_t>(model_.segments);
  tangents_.resize(segments);
  swept_.assign(segments, 0);
  angle_.assign(model_.yarns.size(), 0);
  const bool follows = !settled_.empty();
  parallel_chunks((model_.segments + segments_per_chunk - 1) / segments_per_chunk, [&](int c) {
    const int end = std::min(model_.segments, (c + 1) * segments_per_chunk);
    for (int segment = c * segments_per_chunk; segment < end; ++segment) {
      if (!(model_.yarn_of(segment).twist_stiffness > 0)) continue;
      const auto e = static_cast<std::size_t>(segment);
      tangents_[e] = arc_tangents(&extended[static_cast<std::size_t>(model_.first[e])]);
      if (!follows) continue;
      const ArcEnds &old = settled_[e], &now = tangents_[e];
      for (std::size_t k = 0; k < twist_arcs; ++k)
        swept_[e] += spherical_area(old[k], old[k + 1], now[k + 1], now[k]);
    }
  });
  for (std::size_t y = 0; y < model_.yarns.size(); ++y) {
    const YarnModel::Yarn& yarn = model_.yarns[y];
    if (!(yarn.twist_stiffness > 0)) continue;
    if (!follows) {
      angle_[y] = yarn.liveliness * length_of(yarn) + first_turn(yarn, state, extended);
      continue;
    }
    angle_[y] = settled_angle_[y];
    for (int e = 0; e < yarn.segments; ++e)
      angle_[y] += swept_[static_cast<std::size_t>(yarn.first_segment + e)];
  }
}

void YarnTwist::settle() {
  settled_ = tangents_;
  settled_angle_ = angle_;
}

double YarnTwist::couple(std::size_t y) const {
  const YarnModel::Yarn& yarn = model_.yarns[y];
  return yarn.twist_stiffness * angle_[y] / length_of(yarn);
}

double YarnTwist::energy() const {
  double sum = 0;
  for (std::size_t y = 0; y < model_.yarns.size(); ++y) sum += 0.5 * couple(y) * angle_[y];
  return sum;
}

std::vector<Dyad> YarnTwist::dyads(const std::vector<Vec3>& extended,
                                   const std::vector<std::array<double, 2>>& fractions) const {
  std::vector<Dyad> dyads;
  for (const YarnModel::Yarn& yarn : model_.yarns) {
    if (!(yarn.twist_stiffness > 0)) continue;
    Dyad& dyad = dyads.emplace_back();
    dyad.factor = yarn.twist_stiffness / length_of(yarn);
    dyad.first = yarn.first_node;
    dyad.u.resize(static_cast<std::size_t>(yarn.nodes));
    for (int e = 0; e < yarn.segments; ++e) {
      const auto f = static_cast<std::size_t>(yarn.first_extended + e);
      const std::array<Vec3, 4> turn = turn_gradient(arc_ends(&extended[f]));
      for (std::size_t k = 0; k < 4; ++k) {
        dyad.u[static_cast<std::size_t>(model_.base[f + k] - yarn.first_node)] += turn[k];
        dyad.g[0] += fractions[f + k][0] * turn[k].x;
        dyad.g[1] += fractions[f + k][1] * turn[k].y;
        dyad.g[2] += fractions[f + k][1] * turn[k].x;
      }
    }
  }
  return dyads;
}

}  // namespace loopwright
