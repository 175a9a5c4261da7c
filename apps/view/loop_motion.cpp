#include "loop_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loop_scale/net_kernel.hpp"

namespace loopwright {
namespace {

LoopModelOptions model_options(const std::vector<PiecePlace>& held) {
  LoopModelOptions options;
  options.fold = 0.25;  // keeps the fold of rib and purl, as the command's loop model does
  // without these courses slide along each other where a hand pulls, and crease
  options.shear = options.bend = 0.1;
  // a rib comes from twice its width: faster, it overshoots, and its courses come to rest in zigzag
  options.damping = 5;
  options.clamps = held;
  return options;
}

// Nothing pulls and nothing moves any more, in shares as settle() compares them.
constexpr double rest = 1e-4;

}  // namespace

LoopMotion::LoopMotion(const Knitting& knitting, const std::vector<PiecePlace>& held)
    : graph_(knitting.graph),
      model_(build_loop_model(knitting.graph, knitting.program, model_options(held))),
      held_(model_.net.clamps),
      state_(state_at_rest(model_.start)) {
  rebuild();
}

// The hand is a clamp without a way: the kernel leaves its masses where move_grabbed() puts them.
void LoopMotion::rebuild() {
  MassSpringNet net = model_.net;
  net.clamps.clear();
  const auto in_hand = [this](std::int32_t mass) {
    return std::find(grabbed_.begin(), grabbed_.end(), mass) != grabbed_.end();
  };
  for (Clamp clamp : held_) {
    std::erase_if(clamp.masses, in_hand);
    if (!clamp.masses.empty()) net.clamps.push_back(std::move(clamp));
  }
  if (!grabbed_.empty()) net.clamps.push_back({grabbed_, {}, {}});
  kernel_ = std::make_unique<NetKernel>(net);
  force_ = speed_ = 1;
}

void LoopMotion::measure() {
  std::vector<Vec3> acceleration;
  kernel_->accelerations(state_, acceleration);
  double pull = 0, length = 0;
  for (const Spring& s : model_.net.springs) pull += s.stiffness * norm(s.rest), length += norm(s.rest);
  const auto springs = static_cast<double>(std::max<std::size_t>(model_.net.springs.size(), 1));
  pull /= springs, length /= springs;
  force_ = speed_ = 0;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    if (kernel_->held(i)) continue;
    force_ = std::max(force_, norm(acceleration[i]) * kernel_->mass(i) / pull);
    speed_ = std::max(speed_, norm(state_.velocity(i)) * kernel_->stable_step() / length);
  }
}

bool LoopMotion::advance(int steps) {
  if (force_ < rest && speed_ < rest) return false;
  kernel_->advance(state_, 0.5 * kernel_->stable_step(), steps);
  measure();
  return force_ >= rest || speed_ >= rest;
}

void LoopMotion::reset() {
  grabbed_.clear();
  state_ = state_at_rest(model_.start);
  rebuild();
}

std::optional<std::size_t> LoopMotion::mass_at(const Vec3& from, const Vec3& direction, double reach) const {
  std::optional<std::size_t> best;
  double foremost = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const Vec3 to = state_.position(i) - from;
    const double along = dot(to, direction), aside = norm(to - direction * along);
    // the foremost of those that the line meets; a miss costs more than depth
    if (aside > reach || along + 4 * aside > foremost) continue;
    foremost = along + 4 * aside;
    best = i;
  }
  return best;
}

SourceLocation LoopMotion::letter_at(std::size_t mass) const {
  const BindingPoint& point = model_.points.points[mass];
  const std::vector<LoopId>& loops = point.lower_of.empty() ? point.upper_of : point.lower_of;
  return loops.empty() ? SourceLocation() : graph_.loop(loops.front()).at;
}

void LoopMotion::grab(std::size_t mass) {
  grabbed_ = {static_cast<std::int32_t>(mass)};
  rebuild();
}

void LoopMotion::grab_edge(PiecePlace edge) {
  grabbed_ = masses_at(graph_, model_.points, model_.start, edge);
  rebuild();
}

void LoopMotion::move_grabbed(const Vec3& by) {
  for (const std::int32_t mass : grabbed_) {
    const auto i = static_cast<std::size_t>(mass);
    state_.x[i] += by.x, state_.y[i] += by.y, state_.z[i] += by.z;
    state_.vx[i] = state_.vy[i] = state_.vz[i] = 0;
  }
  force_ = speed_ = 1;
}

void LoopMotion::let_go() {
  grabbed_.clear();
  rebuild();
}

}  // namespace loopwright
