// Cloth at rest with one place of a yarn pulled by hand: each call comes to rest under a force and goes on
// from where the last one left it, with the friction of the way.
#pragma once
#include "mechanics/relax.hpp"

namespace loopwright {

class PullSession {
 public:
  // `rest` as relax() left it with `options`; the place: parameter t of a yarn. The frame or lattice stays as
  // it is. Where nothing is held the counterforce is spread evenly over all yarn, so that the cloth stays in
  // place.
  PullSession(const RelaxResult& rest, RelaxOptions options, int yarn, double t);

  // Force in B/d^2. False if it was stopped on the way.
  bool pull(const Vec3& force);

  const RelaxResult& reached() const { return at_; }
  RelaxOptions& options() { return options_; }
  double force_unit_N() const;                 // of B/d^2; 0 where the yarn does not state its bend stiffness
  static constexpr double largest_force = 12;  // B/d^2; a loop of plain pushes with about one

 private:
  RelaxOptions options_;
  RelaxResult at_;
  int yarn_ = 0;
  double t_ = 0;
};

}  // namespace loopwright
