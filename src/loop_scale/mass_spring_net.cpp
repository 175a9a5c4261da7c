#include "loop_scale/mass_spring_net.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace loopwright {

double factor_at(const TimeCourse& course, double time) {
  if (course.empty()) return 1;
  if (time <= course.front().first) return course.front().second;
  for (std::size_t k = 1; k < course.size(); ++k) {
    const auto& [t0, f0] = course[k - 1];
    const auto& [t1, f1] = course[k];
    if (time < t1) return f0 + (f1 - f0) * (time - t0) / (t1 - t0);
  }
  return course.back().second;
}

NetState state_at_rest(const std::vector<Vec3>& positions) {
  NetState state;
  const std::size_t n = positions.size();
  for (std::vector<double>* each : {&state.x, &state.y, &state.z, &state.vx, &state.vy, &state.vz})
    each->assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    state.x[i] = positions[i].x;
    state.y[i] = positions[i].y;
    state.z[i] = positions[i].z;
  }
  return state;
}

std::vector<Vec3> positions_of(const NetState& state) {
  std::vector<Vec3> positions(state.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = state.position(i);
  return positions;
}

double extension(const Spring& spring, const NetState& state) {
  return distance(state.position(static_cast<std::size_t>(spring.a)),
                  state.position(static_cast<std::size_t>(spring.b))) -
         norm(spring.rest);
}

void require_sound(const MassSpringNet& net) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument("mass-spring net: " + what); };
  const auto masses = static_cast<std::int32_t>(net.mass.size());
  const auto springs = static_cast<std::int32_t>(net.springs.size());
  const auto known = [&](std::int32_t i) { return i >= 0 && i < masses; };
  for (const double m : net.mass)
    if (!(m > 0) || !std::isfinite(m)) fail("every mass must be positive");
  for (const Spring& s : net.springs) {
    if (!known(s.a) || !known(s.b) || s.a == s.b) fail("a spring must join two masses of the net");
    if (!(s.stiffness > 0) || !std::isfinite(s.stiffness)) fail("a spring's stiffness must be positive");
    if (!is_finite(s.rest)) fail("a spring's rest length must be finite");
  }
  if (!net.couplings.empty() && net.law != SpringLaw::along)
    fail("yarn couplings need springs that act along themselves");
  for (const YarnCoupling& c : net.couplings)
    if (c.warp < 0 || c.warp >= springs || c.weft < 0 || c.weft >= springs || !(c.stiffness >= 0))
      fail("a coupling must join two springs of the net");
  if (!(net.damping >= 0)) fail("damping must not be negative");
  std::vector<char> clamped(net.mass.size());
  for (const Clamp& clamp : net.clamps)
    for (const std::int32_t i : clamp.masses) {
      if (!known(i)) fail("a clamp holds a mass that is not there");
      if (clamped[static_cast<std::size_t>(i)]++) fail("a mass is held by two clamps");
    }
  const auto in_order = [&](const TimeCourse& course) {
    for (std::size_t k = 1; k < course.size(); ++k)
      if (!(course[k].first > course[k - 1].first)) fail("the times of a load must ascend");
  };
  for (const Clamp& clamp : net.clamps) in_order(clamp.factor);
  for (const Load& load : net.loads) {
    in_order(load.factor);
    for (const std::int32_t i : load.masses)
      if (!known(i)) fail("a load pulls at a mass that is not there");
  }
}

}  // namespace loopwright
