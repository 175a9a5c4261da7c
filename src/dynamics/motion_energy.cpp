// What does not depend on how time is stepped: energies, forces, momenta, friction of sliding bindings.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/motion_solver.hpp"
#include "dynamics/yarn_motion.hpp"

namespace loopwright {

YarnMotion::YarnMotion(SplineModel model, MotionState state, Bindings bindings, const MotionOptions& options,
                       std::optional<FabricContact> contact)
    : model_(std::move(model)),
      state_(std::move(state)),
      bindings_(std::move(bindings)),
      options_(options),
      contact_(std::move(contact)),
      solver_(std::make_unique<Solver>()) {
  require_sound(model_, state_);
  if (contact_ && options_.stepper == MotionStepper::explicit_euler)
    throw std::invalid_argument(
        "contact needs the implicit step: its shell is too stiff for an explicit one");
  if (contact_ && !(bindings_.barycentric.empty() && bindings_.springs.empty() && bindings_.sliding.empty()))
    throw std::invalid_argument("contact keeps yarns apart by itself: it goes with no other binding");
  if (contact_ && contact_->model.nodes != model_.points)
    throw std::invalid_argument("the contact model is of another fabric than the yarns");
  lumped_.assign(static_cast<std::size_t>(model_.points), 0);
  for (const SplineYarn& yarn : model_.yarns) {
    mass_.push_back(mass_matrix(yarn));
    const BandMatrix& m = mass_.back();
    for (std::size_t i = 0; i < m.size(); ++i)
      for (std::size_t j = i - std::min<std::size_t>(i, 3); j <= std::min(i + 3, m.size() - 1); ++j)
        lumped_[static_cast<std::size_t>(yarn.first) + i] += m(i, j);
  }
  multiplier_.assign(bindings_.barycentric.size(), Vec3{});
  for (SlidingBinding& binding : bindings_.sliding) follow(model_, state_.place, binding);
  for (SlidingBinding& binding : bindings_.sliding)
    binding.full_distance = std::max(binding.full_distance, binding.distance);
  prepare_friction(1);
  if (contact_) {
    solver_->assembly = std::make_unique<Assembly>(contact_->model);
    solver_->assembly->set_history(contact_->history);
  }
}

YarnMotion::~YarnMotion() = default;
YarnMotion::YarnMotion(YarnMotion&&) noexcept = default;

void YarnMotion::set_force(std::vector<Vec3> force) {
  model_.force = std::move(force);
  require_sound(model_, state_);
}

void YarnMotion::weigh(std::span<const Vec3> x, std::vector<Vec3>& y) const {
  y.resize(x.size());
  for (std::size_t k = 0; k < mass_.size(); ++k) {
    const auto first = static_cast<std::size_t>(model_.yarns[k].first), n = mass_[k].size();
    multiply(mass_[k], x.subspan(first, n), std::span<Vec3>(y).subspan(first, n));
  }
}

// Takes down load, normal and place of every sliding contact, as friction keeps them through a step.
void YarnMotion::prepare_friction(double dt) {
  if (!bindings_.guarded.empty()) update_guards(model_, state_.place, bindings_.guarded, bindings_.sliding);
  set_ranges(model_, state_.place, slide_stops(model_, bindings_.sliding), bindings_.sliding);
  friction_.resize(bindings_.sliding.size());
  start_.resize(bindings_.sliding.size());
  pressing_.assign(bindings_.sliding.size(), 1);
  for (std::size_t k = 0; k < friction_.size(); ++k) {
    SlidingBinding& binding = bindings_.sliding[k];
    if (binding.multiplier > binding.most_pull) {
      binding.parted = true;
      binding.multiplier = 0;
    } else if (binding.multiplier < 0) {
      binding.parted = false;
    }
    start_[k] = follow(model_, state_.place, binding);
    // Where a nearest approach has ended its place goes on downhill, and finds yarn that is nearer already:
    // an explicit step leads it apart from there, it would else be shot.
    if (options_.stepper == MotionStepper::explicit_euler) {
      constexpr double elsewhere = 0.02, apart = 0.004;
      if (start_[k].distance < (1 - elsewhere) * binding.distance)
        binding.distance = start_[k].distance;
      else
        binding.distance = std::min(binding.full_distance, (1 + apart) * binding.distance);
    }
    if (binding.may_part() && start_[k].distance >= binding.distance) pressing_[k] = 0;
    Friction& law = friction_[k];
    law = {};
    // Yarn that a binding holds back from leaving is not pressed on the other.
    law.load = binding.friction * std::max(0.0, -binding.multiplier);
    // An explicit step holds only springs that are soft against the mass on them.
    if (options_.stepper == MotionStepper::explicit_euler)
      law.softness = std::max(law.softness, 8 * law.load * dt * dt * mobility(start_[k]));
    law.normal = start_[k].normal / norm(start_[k].normal);
    law.slip = law.tangential(binding.slip);
    law.weight_a = start_[k].a.weights.value;
    law.weight_b = start_[k].b.weights.value;
    law.start = start_[k].a.place - start_[k].b.place;
  }
}

// Whether a sliding binding has anything to move: where it has slid between held points it stands for
// nothing.
bool YarnMotion::can_move(const ShortestConnection& connection) const {
  constexpr double least = 1e-2;
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto a = static_cast<std::size_t>(connection.a.first) + i,
               b = static_cast<std::size_t>(connection.b.first) + i;
    if (model_.held[a] == 0) sum += connection.a.weights.value[i] * connection.a.weights.value[i];
    if (model_.held[b] == 0) sum += connection.b.weights.value[i] * connection.b.weights.value[i];
  }
  return sum > least;
}

// Acceleration of the two yarns at a binding by a unit of force, about.
double YarnMotion::mobility(const ShortestConnection& connection) const {
  double sum = 0;
  for (const CurvePoint* c : {&connection.a, &connection.b})
    for (std::size_t i = 0; i < 4; ++i) {
      const auto point = static_cast<std::size_t>(c->first) + i;
      if (model_.held[point] == 0) sum += c->weights.value[i] * c->weights.value[i] / lumped_[point];
    }
  return sum;
}

namespace {

// Relative place of the material points that touched at the step's start.
Vec3 material_gap(const Friction& law, const ShortestConnection& start, const std::vector<Vec3>& place) {
  Vec3 r;
  for (std::size_t i = 0; i < 4; ++i)
    r += law.weight_a[i] * place[static_cast<std::size_t>(start.a.first) + i] -
         law.weight_b[i] * place[static_cast<std::size_t>(start.b.first) + i];
  return r;
}

}  // namespace

void YarnMotion::accept_friction() {
  for (std::size_t k = 0; k < friction_.size(); ++k)
    bindings_.sliding[k].slip =
        friction_[k].load > 0 ? friction_[k].slip_after(material_gap(friction_[k], start_[k], state_.place))
                              : Vec3{};
}

// Potential energy of yarn and bindings (contact and loads not in it), with its gradient; the band gets the
// yarns' part of the Hessian.
double YarnMotion::gradient(const std::vector<Vec3>& place, std::vector<Vec3>& g, BandHessian* band) const {
  g.assign(place.size(), Vec3{});
  double energy = elastic_energy(model_, place, g, band).total();
  for (const OrientationSpring& spring : bindings_.springs) {
    const CurvePoint a = curve_point(model_, place, spring.a.yarn, spring.a.t),
                     b = curve_point(model_, place, spring.b.yarn, spring.b.t);
    const Vec3 r = a.place - b.place;
    const double length = norm(r), beyond = length - spring.rest;
    energy += 0.5 * spring.stiffness * beyond * beyond;
    const Vec3 f = length > 0 ? (spring.stiffness * beyond / length) * r : Vec3{};
    for (std::size_t i = 0; i < 4; ++i) {
      g[static_cast<std::size_t>(a.first) + i] += a.weights.value[i] * f;
      g[static_cast<std::size_t>(b.first) + i] -= b.weights.value[i] * f;
    }
  }
  for (std::size_t k = 0; k < friction_.size(); ++k) {
    const Friction& law = friction_[k];
    if (law.load == 0) continue;
    const Vec3 r = material_gap(law, start_[k], place), f = law.force(r);
    energy += law.energy(r);
    for (std::size_t i = 0; i < 4; ++i) {
      g[static_cast<std::size_t>(start_[k].a.first) + i] += law.weight_a[i] * f;
      g[static_cast<std::size_t>(start_[k].b.first) + i] -= law.weight_b[i] * f;
    }
  }
  return energy;
}

double YarnMotion::potential(const std::vector<Vec3>& place) const {
  std::vector<Vec3> g;
  double energy = gradient(place, g, nullptr);
  for (std::size_t i = 0; i < place.size(); ++i) {
    energy -= lumped_[i] * dot(model_.gravity, place[i]);
    if (!model_.force.empty()) energy -= dot(model_.force[i], place[i]);
  }
  return energy;
}

std::vector<Vec3> YarnMotion::inertial_place(double dt) const {
  std::vector<Vec3> x = state_.place;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += dt * state_.velocity[i];
  return x;
}

double YarnMotion::incremental(const std::vector<Vec3>& place, const std::vector<Vec3>& inertial,
                               double dt) const {
  std::vector<Vec3> apart(place.size()), heavy;
  double energy = potential(place);
  for (std::size_t i = 0; i < place.size(); ++i) apart[i] = place[i] - inertial[i];
  weigh(apart, heavy);
  for (std::size_t i = 0; i < place.size(); ++i) energy += 0.5 / (dt * dt) * dot(apart[i], heavy[i]);
  if (model_.drag == 0) return energy;
  for (std::size_t i = 0; i < place.size(); ++i) apart[i] = place[i] - state_.place[i];
  weigh(apart, heavy);
  for (std::size_t i = 0; i < place.size(); ++i) energy += 0.5 * model_.drag / dt * dot(apart[i], heavy[i]);
  return energy;
}

MotionEnergy YarnMotion::energy() const {
  MotionEnergy e;
  std::vector<Vec3> g(state_.place.size()), heavy;
  const ElasticEnergy elastic = elastic_energy(model_, state_.place, g);
  e.stretch = elastic.stretch;
  e.bend = elastic.bend;
  for (const OrientationSpring& spring : bindings_.springs) {
    const double beyond = norm(curve_point(model_, state_.place, spring.a.yarn, spring.a.t).place -
                               curve_point(model_, state_.place, spring.b.yarn, spring.b.t).place) -
                          spring.rest;
    e.bindings += 0.5 * spring.stiffness * beyond * beyond;
  }
  weigh(state_.velocity, heavy);
  for (std::size_t i = 0; i < heavy.size(); ++i) {
    e.kinetic += 0.5 * dot(state_.velocity[i], heavy[i]);
    e.load -= lumped_[i] * dot(model_.gravity, state_.place[i]);
    if (!model_.force.empty()) e.load -= dot(model_.force[i], state_.place[i]);
  }
  e.contact = solver_->contact_energy;
  return e;
}

Vec3 YarnMotion::momentum() const {
  Vec3 sum;
  for (std::size_t i = 0; i < lumped_.size(); ++i) sum += lumped_[i] * state_.velocity[i];
  return sum;
}

Vec3 YarnMotion::angular_momentum() const {
  std::vector<Vec3> heavy;
  weigh(state_.velocity, heavy);
  Vec3 sum;
  for (std::size_t i = 0; i < heavy.size(); ++i) sum += cross(state_.place[i], heavy[i]);
  return sum;
}

double YarnMotion::constraint_error() const {
  double largest = 0;
  for (const BarycentricBinding& binding : bindings_.barycentric)
    largest = std::max(largest, norm(binding.error(state_.place)));
  for (SlidingBinding binding : bindings_.sliding) {
    const ShortestConnection c = follow(model_, state_.place, binding);
    if (can_move(c)) largest = std::max(largest, off_by(binding, c));
  }
  return largest;
}

std::vector<Vec3> YarnMotion::forces() const {
  std::vector<Vec3> g;
  gradient(state_.place, g, nullptr);
  for (std::size_t k = 0; k < bindings_.barycentric.size(); ++k)
    for (const auto& [point, w] : bindings_.barycentric[k].weights)
      g[static_cast<std::size_t>(point)] += w * multiplier_[k];
  for (SlidingBinding binding : bindings_.sliding) {
    const ShortestConnection c = follow(model_, state_.place, binding);
    for (std::size_t i = 0; i < 4; ++i) {
      g[static_cast<std::size_t>(c.a.first) + i] += (binding.multiplier * c.a.weights.value[i]) * c.normal;
      g[static_cast<std::size_t>(c.b.first) + i] -= (binding.multiplier * c.b.weights.value[i]) * c.normal;
    }
  }
  for (Vec3& f : g) f = -f;
  return g;
}

double YarnMotion::course_force(double width) const {
  const std::vector<Vec3> f = forces();
  // contact's measure is the frame's width at the start, and its slope goes with that
  double sum = contact_ ? solver_->contact_measures[0] * contact_->width / width : 0;
  for (std::size_t i = 0; i < f.size(); ++i) sum -= f[i].x * state_.place[i].x / width;
  return sum;
}

double YarnMotion::contact_core() const { return contact_ ? contact_->model.contact.core : 0; }

}  // namespace loopwright
