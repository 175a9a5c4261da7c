#include "stretch_session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "experiments/deformed.hpp"

namespace loopwright {
namespace {

bool pulls_courses(StretchDirection d) {
  return d == StretchDirection::course || d == StretchDirection::both;
}
bool pulls_wales(StretchDirection d) { return d == StretchDirection::wale || d == StretchDirection::both; }

}  // namespace

StretchSession::StretchSession(const RelaxResult& rest, RelaxOptions options, StretchDirection direction)
    : options_(std::move(options)), direction_(direction), rest_(rest.fabric), at_(rest) {
  if (!(options_.model.material.reference_bend_N_m2 > 0))
    throw std::invalid_argument("forces need the yarn's bend stiffness: name a material in the notation");
  if (!rest_.periodic && !(options_.model.free.width || options_.model.free.height))
    throw std::invalid_argument("only a repeat or a piece with held edges can be stretched");
  options_.grow_in = false;
  options_.model.plates = rest.plates;
  if (direction == StretchDirection::shear && !rest_.periodic)
    throw std::invalid_argument("only a repeat that tiles the plane can be sheared");
  // the size that is not pulled follows, so that its force is zero
  const FreeMeasures usual = options_.model.free;
  options_.model.free = {!pulls_courses(direction) && usual.width, !pulls_wales(direction) && usual.height,
                         false};
  energy_at_rest_ = rest.energy.stored();
}

StretchPoint StretchSession::point() const {
  const double d = rest_.diameter_mm * 1e-3, bend = options_.model.material.reference_bend_N_m2;
  const double force_unit = force_unit_N(options_.model.material, rest_.diameter_mm), width = rest_.width * d,
               height = rest_.height * d;
  StretchPoint p;
  p.course_strain = at_.fabric.width / rest_.width - 1;
  p.wale_strain = at_.fabric.height / rest_.height - 1;
  p.shear = (at_.fabric.skew - rest_.skew) / rest_.height;
  p.shear_force = at_.measure_forces[2] * force_unit / width;
  p.course_force = at_.measure_forces[0] * force_unit / height;
  p.wale_force = at_.measure_forces[1] * force_unit / width;
  p.energy = (at_.energy.stored() - energy_at_rest_) * bend / d / (width * height);
  set_run(p, at_);
  return p;
}

StretchPoint StretchSession::go_to(double strain, const std::function<bool(const StretchPoint&)>& on_point) {
  const double from = strain_;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(strain - from) / largest_step - 1e-9)));
  StretchPoint reached;
  for (int k = 1; k <= steps; ++k) {
    const double to = from + (strain - from) * k / steps;
    const Fabric& now = at_.fabric;
    const Fabric moved =
        deformed(now, pulls_courses(direction_) ? rest_.width * (1 + to) : now.width,
                 pulls_wales(direction_) ? rest_.height * (1 + to) : now.height,
                 direction_ == StretchDirection::shear ? rest_.skew + to * rest_.height : now.skew);
    options_.history = at_.history;
    at_ = relax(moved, options_);
    strain_ = to;
    reached = point();
    if ((on_point && !on_point(reached)) || at_.stopped) break;
  }
  return reached;
}

}  // namespace loopwright
