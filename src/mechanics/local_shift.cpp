#include "mechanics/local_shift.hpp"

#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

constexpr double least_shift = 0.03;  // B/d^3: what soft yarn notices (a loop bends with some tenths)
constexpr double most_boost = 100;
constexpr double faded = 0.3;    // of it is left after a step
constexpr double counts = 1e-4;  // below which it is gone
constexpr double much_of_gain = 0.05, energy_boost = 16;
constexpr double least_bent_shift = 1e-3, bent_boost = 4;
constexpr int along_yarn = 3;  // control points beyond the segment that have it as well

}  // namespace

void LocalShift::make_room() {
  if (own_.empty()) own_.assign(static_cast<std::size_t>(model_.nodes), 0);
}

void LocalShift::raise_node(int node, double boost, double least, const std::vector<float>& before,
                            double shift) {
  const auto i = static_cast<std::size_t>(node);
  const double now = std::max({static_cast<double>(before[i]), shift, least});
  const auto raised = static_cast<float>(boost * now);
  if (!(raised > own_[i])) return;
  own_[i] = raised;
  raised_.push_back(node);
}

const std::vector<float>& LocalShift::weights(double shift) {
  weights_.clear();
  if (own_.empty()) return weights_;
  weights_.resize(own_.size());
  for (std::size_t i = 0; i < own_.size(); ++i)
    weights_[i] = static_cast<float>(std::max(1.0, own_[i] / shift));
  return weights_;
}

void LocalShift::raise_segment(int segment, double boost, const std::vector<float>& before, double shift) {
  const YarnModel::Yarn& yarn = model_.yarn_of(segment);
  const int at = segment - yarn.first_segment;
  for (int k = std::max(0, at - along_yarn); k <= std::min(yarn.nodes - 1, at + 3 + along_yarn); ++k)
    raise_node(yarn.first_node + k, boost, least_shift, before, shift);
}

void LocalShift::raise(const SafeStep& step, double shift, double share) {
  make_room();
  // From what is there now: what is named twice is not raised twice.
  const std::vector<float> before = own_;
  const auto boost = [](double ratio) { return std::clamp(2 * ratio, 2.0, most_boost); };
  for (const FarNode& far : step.far) raise_node(far.node, boost(far.ratio), least_shift, before, shift);
  for (const NearPair& pair : step.near)
    for (const int segment : {pair.a, pair.b})
      raise_segment(segment, boost(pair.ratio / share), before, shift);
}

bool LocalShift::raise(const std::vector<double>& before, const std::vector<double>& after, double gain,
                       double shift) {
  make_room();
  const std::vector<float> own_before = own_;
  bool any = false;
  for (std::size_t e = 0; e < before.size(); ++e) {
    if (after[e] - before[e] <= much_of_gain * gain) continue;  // also where it is infinite
    any = true;
    raise_segment(static_cast<int>(e), energy_boost, own_before, shift);
  }
  return any;
}

void LocalShift::raise(const std::vector<std::int32_t>& nodes, double shift) {
  make_room();
  const std::vector<float> before = own_;
  for (const std::int32_t node : nodes) raise_node(node, bent_boost, least_bent_shift, before, shift);
}

void LocalShift::fade() {
  raised_.clear();
  float most = 0;
  for (float& own : own_) most = std::max(most, own *= static_cast<float>(faded));
  if (most < counts) own_.clear();
}

}  // namespace loopwright
