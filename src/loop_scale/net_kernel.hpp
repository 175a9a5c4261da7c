// A net laid out for speed: forces, energy and the velocity Verlet step (9) in one pass over the masses.
//
//   X(t + h) = X + h V + h^2/2 a,   V(t + h) = V + h/2 (a(t) + a(t + h))                                 (9)
//
// Damping makes a(t + h) depend on V(t + h); solved for it, with c = K_d h / 2m and A the acceleration
// without damping:
//   V(t + h) = [ (1 - c) V(t) + h/2 (A(t) + A(t + h)) ] / (1 + c)
// Written with W = (1 - c) V(t) + h/2 A(t) it is X += h W, then W = (1 - c)/(1 + c) (W + h/2 A) + h/2 A: one
// evaluation of the springs and one sweep a step. Stable for h < 2 / omega_max whatever the damping.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "loop_scale/mass_spring_net.hpp"

namespace loopwright {

struct NetEnergy {
  double kinetic = 0, springs = 0;
  double weight = 0;  // potential of gravity
};

class NetKernel {
 public:
  explicit NetKernel(const MassSpringNet& net);  // throws what require_sound throws

  std::size_t masses() const { return class_of_.size(); }

  // Largest step that is stable for certain: 2 / sqrt(bound of omega^2), the bound by Gershgorin's circles.
  // For a plain net of equal masses it is 1 / sqrt((K_weft + K_warp) / m), which a large net attains.
  double stable_step() const { return stable_step_; }

  // `steps` Verlet steps of length h; steps + 1 evaluations of the springs, nothing allocated after the first
  // call. Throws std::invalid_argument if h is not below stable_step(). Bitwise the same for any number of
  // threads.
  void advance(NetState& state, double h, int steps);

  // Acceleration by springs, gravity and loads, without damping; of clamped masses: what they would have.
  void accelerations(const NetState& state, std::vector<Vec3>& out) const;
  // Forces of springs (and couplings) on every mass, clamped ones included.
  void spring_forces(const NetState& state, std::vector<Vec3>& out) const;
  NetEnergy energy(const NetState& state) const;
  double damping() const { return damping_; }
  bool held(std::size_t mass) const { return classes_[class_index(mass)].clamp >= 0; }
  double mass(std::size_t mass) const { return classes_[class_index(mass)].mass; }
  Vec3 gravity_force(std::size_t mass_index) const { return gravity_ * mass(mass_index); }
  // External force on a mass at a time: its weight and the loads.
  Vec3 external_force(std::size_t mass, double time) const;

  // Bytes that a step must move for a mass at least, if neighbours come from the cache: positions read and
  // written, velocities read and written, index lists read.
  double bytes_per_mass() const;

 private:
  // Masses of one kind: the same mass, clamp and loads.
  struct MassClass {
    double mass = 1;
    int clamp = -1;
    std::vector<int> loads;
  };
  // What a pass needs of a class: W = keep W + gain (A h/2), X += move W.
  struct Pass {
    double inverse_mass = 0, keep = 0, gain = 0;
    Vec3 acceleration, velocity;  // of loads and gravity; of a clamp
    bool clamped = false;
  };
  // A spring as a piece of work sees it: F on `a`, and -F on `b` if that is of the same piece.
  struct Bond {
    std::int32_t a, b, type;
  };
  // Springs of one type from a + i to b + i (or b - i), i < count: a course of loops, and all its warp
  // springs. Needs no list to be read, and the compiler turns it into vectors.
  struct Run {
    std::int32_t a, b, count, type;
    bool backward;  // b - i
  };
  struct SpringType {
    double stiffness, rest;
  };
  // Masses [first, last): bonds [inner, border) have both ends there, [border, end) the first alone. Springs
  // between two pieces are worked out by both, so that no piece writes to another.
  struct Piece {
    std::size_t first = 0, last = 0;
    std::size_t inner = 0, border = 0, end = 0;
    // The same as runs, if they are long enough; else none.
    std::size_t inner_runs = 0, border_runs = 0, end_runs = 0;
    std::int32_t only_class = -1;  // of all its masses, if they have one
  };
  enum class Moment : std::uint8_t { first, inner, last };
  struct Forces;

  std::size_t class_index(std::size_t mass) const { return static_cast<std::size_t>(class_of_[mass]); }
  void make_classes(const MassSpringNet& net);
  void make_bonds();
  void set_passes(double time, double h, Moment moment);
  void sweep(NetState& state, double half, double h);
  void couple(const NetState& state) const;
  void add_forces(const Piece& piece, const NetState& state, Forces& forces) const;
  std::size_t append_runs(std::size_t begin, std::size_t end);
  void add_run(const Piece& piece, const Run& run, bool both, const NetState& state, Forces& forces) const;
  void add_bonds(const Piece& piece, std::size_t begin, std::size_t end, bool both, const NetState& state,
                 Forces& forces) const;
  void move(const Piece& piece, const Forces& forces, NetState& state, double half, double h);
  void bound_step(const MassSpringNet& net);

  SpringLaw law_;
  double damping_ = 0, stable_step_ = 0;
  Vec3 gravity_;
  std::vector<Load> loads_;
  std::vector<Clamp> clamps_;
  std::vector<Spring> springs_;
  std::vector<YarnCoupling> couplings_;
  std::vector<MassClass> classes_;
  std::vector<std::int32_t> class_of_;  // [mass]
  std::vector<Piece> pieces_;
  std::vector<Bond> bonds_;  // by piece
  std::vector<Run> runs_;    // by piece
  std::vector<SpringType> types_;
  std::vector<Vec3> rest_vectors_;         // [type], law vector, from a to b
  std::vector<std::int32_t> bond_spring_;  // [bond] its spring, only with couplings
  mutable std::vector<double> tension_;    // [spring] by couplings
  std::vector<Pass> passes_;               // [class]
  std::vector<double> nx_, ny_, nz_;       // positions after the step
};

}  // namespace loopwright
