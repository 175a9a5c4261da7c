// The deformation model of the first paper: masses at binding points, springs between them, damping, loads.
//
//   F_s = -K_s dX  (6),   F_d = -K_d V  (7),   m a = F_s + F_d + external forces  (8)
//
// The paper gives no units. Any consistent set will do; nets built from yarn data (loop_scale/build_net.hpp)
// have lengths in d, stiffness in N/m, mass in kg, time in s, so that a force is in N d/m and an energy in
// N d^2/m.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "base/vec3.hpp"

namespace loopwright {

// weft: lower binding points of neighbours in a course; warp: lower and upper binding point of a loop; shear
// and bend: diagonals and second neighbours, of the traditional net (figure 5) and as options.
enum class SpringKind : std::uint8_t { weft, warp, shear, bend, passing };

// What "spring deformation vector" of (6) is taken to be.
//   along   (length - rest length) along the spring: free to turn, as springs are
//   vector  difference of the two end-to-end vectors: resists turning as well, and is linear
enum class SpringLaw : std::uint8_t { along, vector };

struct Spring {
  std::int32_t a = 0, b = 0;  // masses
  double stiffness = 1;       // K_s
  Vec3 rest;                  // from a to b at no load; its length is the rest length
  SpringKind kind = SpringKind::weft;
};

// The yarn of a loop serves its height and its width: energy 1/2 k (e_warp + ratio e_weft)^2, e: extension of
// a spring. With law `along` only.
struct YarnCoupling {
  std::int32_t warp = 0, weft = 0;  // springs
  double stiffness = 0, ratio = 0;
};

// Factor of a load over time: straight lines between (time, factor), constant outside; empty: always 1.
using TimeCourse = std::vector<std::pair<double, double>>;
double factor_at(const TimeCourse& course, double time);

struct Load {
  std::vector<std::int32_t> masses;
  Vec3 force;  // on each of them
  TimeCourse factor;
};

// Masses that are moved by hand: they have gone way * factor(t) at time t. Without a way: held.
struct Clamp {
  std::vector<std::int32_t> masses;
  Vec3 way;
  TimeCourse factor;
};

// What never changes during a simulation.
struct MassSpringNet {
  std::vector<double> mass;  // > 0
  std::vector<Spring> springs;
  std::vector<YarnCoupling> couplings;
  SpringLaw law = SpringLaw::along;
  double damping = 0;  // K_d of every mass
  Vec3 gravity;        // acceleration
  std::vector<Load> loads;
  std::vector<Clamp> clamps;  // a mass is in one of them at most
};

// What does. One array a coordinate.
struct NetState {
  std::vector<double> x, y, z, vx, vy, vz;
  double time = 0;

  std::size_t size() const { return x.size(); }
  Vec3 position(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 velocity(std::size_t i) const { return {vx[i], vy[i], vz[i]}; }
};

NetState state_at_rest(const std::vector<Vec3>& positions);
std::vector<Vec3> positions_of(const NetState& state);

// Extension of a spring along itself.
double extension(const Spring& spring, const NetState& state);

// Throws std::invalid_argument that names the fault: masses and stiffnesses not positive, indices out of
// range, a mass in two clamps, couplings of a net with law `vector`.
void require_sound(const MassSpringNet& net);

}  // namespace loopwright
