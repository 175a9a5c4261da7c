#include "outputs/exchange/yarn_points.hpp"

#include <algorithm>
#include <cmath>

#include "outputs/state_material.hpp"

namespace loopwright {
namespace {

// First and second derivative of the spline by its parameter.
struct Slopes {
  Vec3 first, second;
};

Slopes slopes(const Fabric& fabric, const FabricYarn& yarn, int segment, double u) {
  const double v = 1 - u;
  const std::array<double, 4> first{-v * v / 2, (3 * u * u - 4 * u) / 2, (-3 * u * u + 2 * u + 1) / 2,
                                    u * u / 2},
      second{v, 3 * u - 2, 1 - 3 * u, u};
  Slopes s;
  for (int k = 0; k < 4; ++k) {
    const Vec3 q = control_point(fabric, yarn, segment + k);
    s.first += q * first[static_cast<std::size_t>(k)];
    s.second += q * second[static_cast<std::size_t>(k)];
  }
  return s;
}

double curvature(const Slopes& s) {
  const double speed = norm(s.first);
  return speed > 0 ? norm(cross(s.first, s.second)) / (speed * speed * speed) : 0;
}

// Contact at parameter t, between the two samples that are nearest; `first`: the yarn's first segment.
double contact_at(const YarnForces& forces, std::size_t first, const FabricYarn& yarn, double t) {
  const int count = yarn.segments() * forces.samples;
  const double along = t * forces.samples - 0.5;
  const int before = static_cast<int>(std::floor(along));
  const auto sample = [&](int k) {
    k = yarn.periodic ? (k % count + count) % count : std::clamp(k, 0, count - 1);
    return forces.contact[first * static_cast<std::size_t>(forces.samples) + static_cast<std::size_t>(k)];
  };
  const double share = along - before;
  return (1 - share) * sample(before) + share * sample(before + 1);
}

}  // namespace

std::optional<ToldForces> told_forces(const State& state) {
  const std::optional<YarnMaterial> material = state_material(state);
  const auto radius = state.numbers.find("radius");
  if (!material || radius == state.numbers.end() || radius->second < 1) return std::nullopt;
  ToldForces told;
  ModelOptions options;
  options.material = *material;
  told.forces = yarn_forces(state.fabric, options);
  if (const double unit_N = force_unit_N(*material, state.fabric.diameter_mm); unit_N > 0) {
    told.tension_scale = 100 * unit_N;                                   // cN
    told.contact_scale = told.tension_scale / state.fabric.diameter_mm;  // cN/mm
    told.tension_name = "tension_cN", told.contact_name = "contact_cN_per_mm";
  }
  return told;
}

std::vector<std::vector<int>> loops_of_yarns(const Fabric& fabric) {
  std::vector<std::vector<int>> loops(fabric.yarns.size());
  for (std::size_t k = 0; k < fabric.loops.size(); ++k)
    loops[static_cast<std::size_t>(fabric.loops[k].yarn)].push_back(static_cast<int>(k));
  for (std::vector<int>& each : loops)
    std::stable_sort(each.begin(), each.end(), [&fabric](int a, int b) {
      return fabric.loops[static_cast<std::size_t>(a)].begin <
             fabric.loops[static_cast<std::size_t>(b)].begin;
    });
  return loops;
}

int loop_at(const Fabric& fabric, const std::vector<int>& loops, double t) {
  if (loops.empty()) return -1;
  const FabricYarn& yarn =
      fabric.yarns[static_cast<std::size_t>(fabric.loops[static_cast<std::size_t>(loops.front())].yarn)];
  const auto span = [&fabric](int k) -> const LoopSpan& { return fabric.loops[static_cast<std::size_t>(k)]; };
  // a stretch of a periodic yarn may reach over the seam
  for (const double turn : {0.0, 1.0, -1.0}) {
    if (turn != 0 && !yarn.periodic) break;
    const double at = t + turn * yarn.segments();
    const auto after = std::upper_bound(loops.begin(), loops.end(), at,
                                        [&span](double value, int k) { return value < span(k).begin; });
    if (after == loops.begin()) continue;
    const int found = *std::prev(after);
    // the very end of an open yarn still is of its last loop
    if (at < span(found).end || (at == span(found).end && at >= yarn.segments() && !yarn.periodic))
      return found;
  }
  return -1;
}

std::vector<int> loops_at_points(const Fabric& fabric, std::size_t yarn, const std::vector<int>& loops,
                                 int per_segment) {
  std::vector<int> of_point;
  for (int k = 0; k <= fabric.yarns[yarn].segments() * per_segment; ++k)
    of_point.push_back(loop_at(fabric, loops, static_cast<double>(k) / per_segment));
  return of_point;
}

PointSource::PointSource(const State& state, int per_segment)
    : fabric_(state.fabric),
      per_segment_(per_segment),
      forces_(told_forces(state)),
      loops_(loops_of_yarns(state.fabric)) {
  std::size_t first = 0;
  for (const FabricYarn& yarn : fabric_.yarns) {
    first_segment_.push_back(first);
    first += static_cast<std::size_t>(yarn.segments());
  }
}

std::size_t PointSource::count() const {
  std::size_t points = 0;
  for (const FabricYarn& yarn : fabric_.yarns)
    points += static_cast<std::size_t>(yarn.segments()) * static_cast<std::size_t>(per_segment_) + 1;
  return points;
}

YarnPoints PointSource::of(std::size_t yarn) const {
  const FabricYarn& of = fabric_.yarns[yarn];
  const double mm = fabric_.diameter_mm;
  YarnPoints points;
  const int last = of.segments() * per_segment_;
  double arc = 0;
  for (int k = 0; k <= last; ++k) {
    const int segment = std::min(k / per_segment_, of.segments() - 1);
    const double u = static_cast<double>(k - segment * per_segment_) / per_segment_, t = segment + u;
    if (k > 0) arc += arc_length(fabric_, of, static_cast<double>(k - 1) / per_segment_, t);
    points.place_mm.push_back(position(fabric_, of, t) * mm);
    points.arc_mm.push_back(arc * mm);
    points.curvature_per_mm.push_back(curvature(slopes(fabric_, of, segment, u)) / mm);
    points.loop.push_back(loop_at(fabric_, loops_[yarn], t));
    if (!forces_) continue;
    const std::size_t at = first_segment_[yarn] + static_cast<std::size_t>(segment);
    points.tension.push_back(forces_->forces.tension[at] * forces_->tension_scale);
    points.contact.push_back(contact_at(forces_->forces, first_segment_[yarn], of, t) *
                             forces_->contact_scale);
  }
  return points;
}

}  // namespace loopwright
