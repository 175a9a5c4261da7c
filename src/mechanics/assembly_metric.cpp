// In what steps are measured.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "mechanics/assembly_sums.hpp"

namespace loopwright {
namespace {

constexpr double own_reach = 10;     // d
constexpr double own_motion = 1e-3;  // keeps rigid motion and the sliding of whole yarns finite
// Of a segment's control points at its middle.
constexpr std::array<double, 4> middle{1 / 48.0, 23 / 48.0, 23 / 48.0, 1 / 48.0};

}  // namespace

void Assembly::metric(BlockMatrix& matrix, const std::vector<float>& weights) const {
  matrix.metric.assign(matrix.column.size(), 0);
  const auto weight = [&](std::int32_t i) {
    return weights.empty() ? 1.0 : static_cast<double>(weights[static_cast<std::size_t>(i)]);
  };
  const auto held = [&](std::int32_t i) { return model_.held[static_cast<std::size_t>(i)] != 0; };
  const auto add_own = [&](std::int32_t i, double w) {
    if (!held(i)) matrix.metric[static_cast<std::size_t>(diagonal_[static_cast<std::size_t>(i)])] += w;
  };
  const UpperBlocks upper(matrix, diagonal_, 0, model_.nodes);
  const auto metric_of = [&](const Block& block) -> double& {
    return matrix.metric[static_cast<std::size_t>(&block - matrix.block.data())];
  };

  for (std::int32_t i = 0; i < model_.nodes; ++i) add_own(i, own_motion * weight(i));
  for (const YarnModel::Yarn& yarn : model_.yarns) {
    const int links = yarn.periodic ? yarn.nodes : yarn.nodes - 1;
    for (int k = 0; k < links; ++k) {
      const auto i = model_.base[static_cast<std::size_t>(yarn.first_extended + k)],
                 j = model_.base[static_cast<std::size_t>(yarn.first_extended + k + 1)];
      if (i == j) continue;
      const double w = std::max(weight(i), weight(j));
      add_own(i, w);
      add_own(j, w);
      if (!held(i) && !held(j)) matrix.metric[matrix.place(std::min(i, j), std::max(i, j))] -= w;
    }
  }

  // Segments in contact: relative motion of their middles. What a segment has of its own is added once for
  // all of its partners.
  std::vector<double> touched(static_cast<std::size_t>(model_.segments), 0);
  const auto counts = [&](const SegmentPair& pair) {  // the yarn's own links tell what lies near along it
    return !(pair.same_yarn && (model_.periodic || std::abs(pair.arc_offset) < own_reach));
  };
  const auto weight_of = [&](const SegmentPair& pair) {
    return std::max(weight(nodes_of(pair.a)[1]), weight(nodes_of(pair.b)[1]));
  };
  const auto add_between = [&](const SegmentPair& pair, const UpperBlocks& to) {
    const FourNodes a = nodes_of(pair.a), b = nodes_of(pair.b);
    const double more = weight_of(pair);
    to.each_between(a, b, [&](std::size_t k, std::size_t l, const Block& block) {
      if (!held(a[k]) && !held(b[l])) metric_of(block) -= more * middle[k] * middle[l];
    });
  };
  // Nearly all pairs add to rows of their first segment alone, and the list is sorted by these.
  const auto is_plain = [&](const SegmentPair& pair) {
    const FourNodes a = nodes_of(pair.a), b = nodes_of(pair.b);
    return UpperBlocks::is_run(a) && UpperBlocks::is_run(b) && a[3] < b[0];
  };
  std::vector<std::int32_t> others;
  for (const std::int32_t at : active_) {
    const SegmentPair& pair = pairs_[static_cast<std::size_t>(at)];
    if (!counts(pair)) continue;
    const double more = weight_of(pair);
    touched[static_cast<std::size_t>(pair.a)] += more;
    touched[static_cast<std::size_t>(pair.b)] += more;
    if (!is_plain(pair)) others.push_back(at);
  }
  for (int e = 0; e < model_.segments; ++e) {
    const double more = touched[static_cast<std::size_t>(e)];
    if (more == 0) continue;
    const FourNodes n = nodes_of(e);
    upper.each_own(n, [&](std::size_t k, std::size_t l, const Block& block, bool) {
      if (!held(n[k]) && !held(n[l]))
        metric_of(block) += (n[k] == n[l] && k != l ? 2 : 1) * more * middle[k] * middle[l];
    });
  }
  for (const std::int32_t at : others) add_between(pairs_[static_cast<std::size_t>(at)], upper);
  parallel_chunks(chunk_count(), [&](int c) {
    const UpperBlocks own(matrix, diagonal_, first_of_chunk(c), first_of_chunk(c + 1));
    const auto first = [&](std::int32_t at) { return nodes_of(pairs_[static_cast<std::size_t>(at)].a)[0]; };
    const auto begin = std::partition_point(active_.begin(), active_.end(), [&](std::int32_t at) {
      return !model_.periodic && first(at) + 3 < first_of_chunk(c);
    });
    for (auto at = begin; at != active_.end(); ++at) {
      const SegmentPair& pair = pairs_[static_cast<std::size_t>(*at)];
      if (!model_.periodic && first(*at) >= first_of_chunk(c + 1)) break;
      if (counts(pair) && is_plain(pair)) add_between(pair, own);
    }
  });
  mirror_upper_metric(matrix, diagonal_);
}

}  // namespace loopwright
