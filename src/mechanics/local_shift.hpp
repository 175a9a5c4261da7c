// Newton's shift, larger where it must be. In a large piece some yarn somewhere always comes too near to
// other yarn in a step, or stands where the energy is not convex; if all the piece waited for it, steps would
// grow in number with the piece. So the shift is a field: the common one, and more at the control points that
// held a step back, fading as steps go by.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "mechanics/safe_step.hpp"

namespace loopwright {

class LocalShift {
 public:
  explicit LocalShift(const YarnModel& model) : model_(model) {}

  // [control point] how many times the common shift each one has; empty: the common one everywhere.
  const std::vector<float>& weights(double shift);
  // More where yarn would move too much in a step, as much as it does.
  void raise(const SafeStep& step, double shift, double share);
  // More at the segments whose energy rises in the step by a good part of what the piece was to gain: there
  // the Hessian does not foretell it. `before`, `after`: [segment]. False if there are none.
  bool raise(const std::vector<double>& before, const std::vector<double>& after, double gain, double shift);
  // Four times more.
  void raise(const std::vector<std::int32_t>& nodes, double shift);
  // Control points that were raised since this was asked last or since the last step, some more than once.
  std::vector<std::int32_t> take_raised() { return std::exchange(raised_, {}); }
  void fade();
  bool empty() const { return own_.empty(); }

 private:
  // To `boost` times the largest of what it had `before`, the common shift and `least`.
  void raise_node(int node, double boost, double least, const std::vector<float>& before, double shift);
  void raise_segment(int segment, double boost, const std::vector<float>& before, double shift);
  void make_room();

  const YarnModel& model_;
  std::vector<float> own_;  // [control point] shift, counts where it is more than the common one; or empty
  std::vector<float> weights_;
  std::vector<std::int32_t> raised_;
};

}  // namespace loopwright
