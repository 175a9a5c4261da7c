// Cloth at rest that is pulled by hand: each call goes on from where the last one left it, so that a slider
// can be followed, forwards and back, with the friction of the way.
#pragma once
#include <functional>
#include <vector>

#include "experiments/stretch.hpp"

namespace loopwright {

class StretchSession {
 public:
  // `rest` as relax() left it with `options`. Throws std::invalid_argument where the cloth has no frame or
  // the yarn's bend stiffness is not known. Callbacks of `options` are used and may be changed before a call.
  StretchSession(const RelaxResult& rest, RelaxOptions options, StretchDirection direction);

  // Goes to a strain (a share of the size at rest) in steps of at most `largest_step`; the point that was
  // reached. `on_point` after each step; false stops.
  StretchPoint go_to(double strain, const std::function<bool(const StretchPoint&)>& on_point = {});

  StretchPoint point() const;  // where it is
  double strain() const { return strain_; }
  const RelaxResult& reached() const { return at_; }
  StretchDirection direction() const { return direction_; }
  RelaxOptions& options() { return options_; }
  static constexpr double largest_step = 0.02;

 private:
  RelaxOptions options_;
  StretchDirection direction_;
  Fabric rest_;
  RelaxResult at_;
  double strain_ = 0, energy_at_rest_ = 0;
};

}  // namespace loopwright
