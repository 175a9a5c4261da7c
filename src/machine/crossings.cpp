#include "machine/crossings.hpp"

#include <algorithm>
#include <tuple>

namespace loopwright {
namespace {

int sign(long long x) { return (x > 0) - (x < 0); }

}  // namespace

void CrossingTracker::rack(const Racking& racking) {
  rackings_.push_back(racking);
  lowest_ = std::min(lowest_, racking.whole());
  highest_ = std::max(highest_, racking.whole());
}

void CrossingTracker::arrive(LoopId loop) {
  if (arrived_.size() <= loop.position()) arrived_.resize(loop.position() + 1);
  arrived_[loop.position()] = static_cast<std::int32_t>(rackings_.size() - 1);
}

void CrossingTracker::leave(LoopId loop, Needle needle, int instruction) {
  const std::int32_t arrived = arrived_[loop.position()];
  if (arrived == static_cast<std::int32_t>(rackings_.size()) - 1) return;  // not racked since it came here

  // Needles of the opposite bed that face this one, or stand beside it, at some racking there has been.
  const bool in_front = is_front(needle.bed);
  const long long lowest = in_front ? needle.index - highest_ - 1 : needle.index + lowest_;
  const long long highest = in_front ? needle.index - lowest_ : needle.index + highest_ + 1;
  const Racking& now = rackings_.back();
  for (Bed bed : {in_front ? Bed::back : Bed::front, in_front ? Bed::back_slider : Bed::front_slider}) {
    const auto [first, last] = needles_.range(bed, lowest, highest);
    for (int position = first; position < last; ++position) {
      const Needle opposite = needles_.needle(position);
      for (LoopId other : stacks_[static_cast<std::size_t>(position)]) {
        const Racking& then =
            rackings_[static_cast<std::size_t>(std::max(arrived, arrived_[other.position()]))];
        const int before = sign(then.order(needle) - then.order(opposite));
        const int after = sign(now.order(needle) - now.order(opposite));
        if (before == after) continue;
        const bool loop_is_low = loop < other;
        Passing p;
        p.low = loop_is_low ? loop : other;
        p.high = loop_is_low ? other : loop;
        p.order = loop_is_low ? before : -before;
        p.half_turns = in_front ? after - before : before - after;
        p.low_in_front = loop_is_low == in_front;
        p.instruction = instruction;
        passings_.push_back(p);
      }
    }
  }
}

std::vector<LoopCrossing> CrossingTracker::net_crossings(int instruction) {
  // Loops that are still held: each pair once, from its front loop.
  for (int position = 0; position < needles_.size(); ++position) {
    if (!is_front(needles_.needle(position).bed)) continue;
    for (LoopId loop : stacks_[static_cast<std::size_t>(position)])
      leave(loop, needles_.needle(position), instruction);
  }

  // Add up each pair's passings; they are in time order, which a stable sort keeps.
  std::stable_sort(passings_.begin(), passings_.end(), [](const Passing& a, const Passing& b) {
    return std::tie(a.low, a.high) < std::tie(b.low, b.high);
  });
  std::vector<LoopCrossing> crossings;
  for (std::size_t begin = 0, end = 0; begin < passings_.size(); begin = end) {
    const Passing& first = passings_[begin];
    int half_turns = 0;
    for (end = begin;
         end < passings_.size() && passings_[end].low == first.low && passings_[end].high == first.high;
         ++end)
      half_turns += passings_[end].half_turns;
    const Passing& last = passings_[end - 1];
    // The loop that began at the left is in front if the front went right. Loops that began facing each other
    // have no left and right: then the last passing says who was in front.
    bool low_in_front = first.order == 0 ? last.low_in_front : (first.order < 0) == (half_turns > 0);
    for (int turns = std::abs(half_turns) / 2; turns > 0; --turns) {
      crossings.push_back({low_in_front ? first.low : first.high, low_in_front ? first.high : first.low,
                           half_turns > 0 ? 1 : -1, last.instruction});
      low_in_front = !low_in_front;  // a further half turn the same way brings the other one to the front
    }
  }
  passings_.clear();
  std::stable_sort(crossings.begin(), crossings.end(), [](const LoopCrossing& a, const LoopCrossing& b) {
    return a.instruction < b.instruction;
  });
  return crossings;
}

}  // namespace loopwright
