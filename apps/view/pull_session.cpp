#include "pull_session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace loopwright {
namespace {

// A force at a place of a yarn, on the control points of its segment (weights of a uniform cubic B-spline,
// geometry/fabric.hpp), and what holds against it.
std::vector<Vec3> loads_of(const Fabric& fabric, int yarn, double t, const Vec3& force) {
  std::size_t first = 0, all = 0;
  bool held = false;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& of = fabric.yarns[y];
    if (static_cast<int>(y) < yarn) first += of.control_points.size();
    all += of.control_points.size();
    held = held || std::find(of.held.begin(), of.held.end(), 1) != of.held.end();
  }
  std::vector<Vec3> loads(all);
  const FabricYarn& pulled = fabric.yarns[static_cast<std::size_t>(yarn)];
  const int e = std::clamp(static_cast<int>(std::floor(t)), 0, pulled.segments() - 1);
  const double u = std::clamp(t - e, 0.0, 1.0), v = 1 - u;
  const std::array<double, 4> weights{v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
                                      (-3 * u * u * u + 3 * u * u + 3 * u + 1) / 6, u * u * u / 6};
  const std::size_t points = pulled.control_points.size();
  for (std::size_t k = 0; k < weights.size(); ++k)
    loads[first + (static_cast<std::size_t>(e) + k) % points] += force * weights[k];
  if (!held)
    for (Vec3& load : loads) load -= force / static_cast<double>(all);
  return loads;
}

}  // namespace

PullSession::PullSession(const RelaxResult& rest, RelaxOptions options, int yarn, double t)
    : options_(std::move(options)), at_(rest), yarn_(yarn), t_(t) {
  options_.grow_in = false;
  options_.model.free = {false, false, false};
  options_.model.plates = rest.plates;
}

bool PullSession::pull(const Vec3& force) {
  const double size = norm(force);
  options_.model.point_loads =
      loads_of(at_.fabric, yarn_, t_, size > largest_force ? force * (largest_force / size) : force);
  options_.history = at_.history;
  at_ = relax(at_.fabric, options_);
  return !at_.stopped;
}

double PullSession::force_unit_N() const {
  return loopwright::force_unit_N(options_.model.material, at_.fabric.diameter_mm);
}

}  // namespace loopwright
