#include "dynamics/spline_model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mechanics/energies/energy.hpp"

namespace loopwright {
namespace {

struct LocalCurve {
  Vec3 slope, curve;
};

LocalCurve local_curve(const SplineYarn& yarn, std::span<const Vec3> points, std::size_t segment, double u) {
  const BlendingWeights w = yarn.blending.weights(u);
  LocalCurve c;
  for (std::size_t i = 0; i < 4; ++i) {
    c.slope += w.slope[i] * points[segment + i];
    c.curve += w.curve[i] * points[segment + i];
  }
  return c;
}

void require(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument("spline model: " + what);
}

}  // namespace

void set_mass_per_parameter(SplineYarn& yarn, double mass) {
  yarn.density.assign(static_cast<std::size_t>(yarn.segments()), {mass, mass, mass, mass});
}

void set_mass_per_length(SplineYarn& yarn, double density, std::span<const Vec3> points) {
  yarn.density.assign(static_cast<std::size_t>(yarn.segments()), {});
  for (std::size_t e = 0; e < yarn.density.size(); ++e)
    for (std::size_t g = 0; g < 4; ++g)
      yarn.density[e][g] = density * norm(local_curve(yarn, points, e, gauss_node[g]).slope);
}

void set_rest_shape(SplineYarn& yarn, std::span<const Vec3> points, double set, StretchLaw law) {
  const auto segments = static_cast<std::size_t>(yarn.segments());
  if (law == StretchLaw::springs) {
    yarn.rest_length.resize(points.size() - 1);
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
      yarn.rest_length[k] = distance(points[k], points[k + 1]);
  } else {
    yarn.rest_length.assign(segments, 0);
    yarn.rest_speed.assign(law == StretchLaw::green ? segments : 0, {});
    for (std::size_t e = 0; e < segments; ++e)
      for (std::size_t g = 0; g < 4; ++g) {
        const double speed = norm(local_curve(yarn, points, e, gauss_node[g]).slope);
        yarn.rest_length[e] += gauss_weight[g] * speed;
        if (law == StretchLaw::green) yarn.rest_speed[e][g] = speed;
      }
  }
  yarn.natural_curvature.clear();
  if (set == 0) return;
  yarn.natural_curvature.assign(segments, {});
  for (std::size_t e = 0; e < segments; ++e)
    for (std::size_t g = 0; g < 4; ++g) {
      const LocalCurve c = local_curve(yarn, points, e, gauss_node[g]);
      const double speed = norm(c.slope);
      yarn.natural_curvature[e][g] = set * norm(cross(c.slope, c.curve)) / (speed * speed * speed);
    }
}

BandMatrix mass_matrix(const SplineYarn& yarn) {
  BandMatrix m(static_cast<std::size_t>(yarn.points));
  for (std::size_t g = 0; g < 4; ++g) {
    const auto h = yarn.blending.weights(gauss_node[g]).value;
    for (std::size_t e = 0; e < yarn.density.size(); ++e)
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b <= a; ++b)
          m.at(e + a, e + b) += gauss_weight[g] * yarn.density[e][g] * h[a] * h[b];
  }
  return m;
}

CurvePoint curve_point(const SplineModel& model, std::span<const Vec3> place, int y, double t) {
  const SplineYarn& yarn = model.yarns[static_cast<std::size_t>(y)];
  const int segment = std::clamp(static_cast<int>(std::floor(t)), 0, yarn.segments() - 1);
  CurvePoint p;
  p.first = yarn.first + segment;
  p.weights = yarn.blending.weights(t - segment);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3& q = place[static_cast<std::size_t>(p.first) + i];
    p.place += p.weights.value[i] * q;
    p.slope += p.weights.slope[i] * q;
    p.curve += p.weights.curve[i] * q;
  }
  return p;
}

void require_sound(const SplineModel& model, const MotionState& state) {
  const auto points = static_cast<std::size_t>(model.points);
  require(!model.yarns.empty(), "there is no yarn");
  require(state.place.size() == points && state.velocity.size() == points && model.held.size() == points,
          "places, velocities and `held` must be one for each control point");
  require(model.force.empty() || model.force.size() == points, "forces must be one for each control point");
  require(std::all_of(state.place.begin(), state.place.end(), is_finite) &&
              std::all_of(state.velocity.begin(), state.velocity.end(), is_finite) &&
              std::all_of(model.force.begin(), model.force.end(), is_finite) && is_finite(model.gravity),
          "a place, velocity, force or the gravity is not a finite number");
  require(std::isfinite(model.drag) && model.drag >= 0, "the drag must not be negative");
  int next = 0;
  for (const SplineYarn& yarn : model.yarns) {
    require(yarn.points >= 4, "a yarn needs four control points");
    require(yarn.first == next, "yarns must lie one after the other among the control points");
    next += yarn.points;
    const auto segments = static_cast<std::size_t>(yarn.segments());
    const std::size_t lengths = model.law == StretchLaw::springs ? segments + 2 : segments;
    require(yarn.rest_length.size() == lengths, "rest lengths do not fit the stretch law");
    require(std::all_of(yarn.rest_length.begin(), yarn.rest_length.end(),
                        [](double h) { return std::isfinite(h) && h > 0; }),
            "rest lengths must be positive");
    require(model.law != StretchLaw::green || yarn.rest_speed.size() == segments,
            "the continuous strain needs the speed of the rest shape");
    require(yarn.density.size() == segments, "mass must be given for each segment");
    for (const auto& m : yarn.density)
      for (const double v : m) require(std::isfinite(v) && v > 0, "mass must be positive");
    require(yarn.natural_curvature.empty() || yarn.natural_curvature.size() == segments,
            "natural curvature must be given for each segment or for none");
    for (const double v : {yarn.stretch_stiffness, yarn.bend_stiffness, yarn.spring_hardening})
      require(std::isfinite(v) && v >= 0, "stiffness must not be negative");
  }
  require(next == model.points, "the yarns do not have all control points");
}

}  // namespace loopwright
