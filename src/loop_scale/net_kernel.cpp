#include "loop_scale/net_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "base/parallel.hpp"

namespace loopwright {
namespace {

constexpr std::size_t chunk = 16384;  // masses a piece of work; fixed, so that sums do not depend on threads

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }
int chunks_of(std::size_t n) { return static_cast<int>((n + chunk - 1) / chunk); }

}  // namespace

NetKernel::NetKernel(const MassSpringNet& net)
    : law_(net.law),
      damping_(net.damping),
      gravity_(net.gravity),
      loads_(net.loads),
      clamps_(net.clamps),
      springs_(net.springs),
      couplings_(net.couplings) {
  require_sound(net);
  const std::size_t n = net.mass.size();

  // masses of one kind share a class
  std::vector<int> clamp_of(n, -1);
  std::vector<std::vector<int>> loads_of(net.loads.empty() ? 0 : n);
  for (std::size_t c = 0; c < clamps_.size(); ++c)
    for (const std::int32_t i : clamps_[c].masses) clamp_of[at(i)] = static_cast<int>(c);
  for (std::size_t k = 0; k < loads_.size(); ++k)
    for (const std::int32_t i : loads_[k].masses) loads_of[at(i)].push_back(static_cast<int>(k));
  std::map<std::tuple<double, int, std::vector<int>>, std::int32_t> known_classes;
  class_of_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const MassClass wanted{net.mass[i], clamp_of[i], loads_of.empty() ? std::vector<int>{} : loads_of[i]};
    const auto [place, is_new] = known_classes.try_emplace({wanted.mass, wanted.clamp, wanted.loads},
                                                           static_cast<std::int32_t>(classes_.size()));
    if (is_new) classes_.push_back(wanted);
    class_of_[i] = place->second;
  }
  passes_.resize(classes_.size());

  // every spring twice, once at each end, so that a mass gathers its forces without writing elsewhere
  first_half_.assign(n + 1, 0);
  for (const Spring& s : springs_) {
    ++first_half_[at(s.a) + 1];
    ++first_half_[at(s.b) + 1];
  }
  for (std::size_t i = 0; i < n; ++i) first_half_[i + 1] += first_half_[i];
  halves_.resize(2 * springs_.size());
  if (!couplings_.empty()) half_spring_.resize(halves_.size());
  tension_.assign(couplings_.empty() ? 0 : springs_.size(), 0);
  std::vector<std::int32_t> next(first_half_.begin(), first_half_.end() - 1);
  std::map<std::tuple<double, double, double, double>, std::int32_t> known_types;
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const Spring& s = springs_[k];
    for (const bool from_a : {true, false}) {
      const Vec3 rest = law_ == SpringLaw::vector ? (from_a ? s.rest : -s.rest) : Vec3{norm(s.rest), 0, 0};
      const auto [place, is_new] = known_types.try_emplace({s.stiffness, rest.x, rest.y, rest.z},
                                                           static_cast<std::int32_t>(types_.size()));
      if (is_new) {
        types_.push_back({s.stiffness, norm(s.rest)});
        rest_vectors_.push_back(rest);
      }
      const auto half = at(next[at(from_a ? s.a : s.b)]++);
      halves_[half] = {from_a ? s.b : s.a, place->second};
      if (!couplings_.empty()) half_spring_[half] = static_cast<std::int32_t>(k);
    }
  }
  bound_step(net);
}

void NetKernel::bound_step(const MassSpringNet& net) {
  // (a + r b)^2 <= (1 + r)(a^2 + r b^2): a coupling is never stiffer than so much more of its two springs
  std::vector<double> stiffness;
  for (const Spring& s : springs_) stiffness.push_back(s.stiffness);
  for (const YarnCoupling& c : couplings_) {
    stiffness[at(c.warp)] += c.stiffness * (1 + std::abs(c.ratio));
    stiffness[at(c.weft)] += c.stiffness * std::abs(c.ratio) * (1 + std::abs(c.ratio));
  }
  // rows of M^-1/2 K M^-1/2; clamped masses take no part
  std::vector<double> row(net.mass.size(), 0);
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const std::size_t a = at(springs_[k].a), b = at(springs_[k].b);
    const bool joins = !held(a) && !held(b);
    const double across = joins ? stiffness[k] / std::sqrt(net.mass[a] * net.mass[b]) : 0;
    if (!held(a)) row[a] += stiffness[k] / net.mass[a] + across;
    if (!held(b)) row[b] += stiffness[k] / net.mass[b] + across;
  }
  const double most = row.empty() ? 0 : *std::max_element(row.begin(), row.end());
  stable_step_ = most > 0 ? 2 / std::sqrt(most) : std::numeric_limits<double>::infinity();
}

namespace {

// The sum of spring forces on mass i; three kinds, so that the common one carries nothing of the others.
template <class Half, class Type>
struct AlongSprings {
  const double *x, *y, *z;
  const std::int32_t* first;
  const Half* halves;
  const Type* types;

  Vec3 operator()(std::size_t i) const {
    const double xi = x[i], yi = y[i], zi = z[i];
    Vec3 force;
    for (std::int32_t k = first[i]; k < first[i + 1]; ++k) {
      const Half half = halves[k];
      const Type type = types[half.type];
      const double dx = x[half.neighbour] - xi, dy = y[half.neighbour] - yi, dz = z[half.neighbour] - zi;
      const double square = dx * dx + dy * dy + dz * dz;
      // two masses at one place: no direction, no force
      const double length = std::sqrt(std::max(square, std::numeric_limits<double>::min()));
      const double share = type.stiffness * (1 - type.rest / length);
      force.x += share * dx;
      force.y += share * dy;
      force.z += share * dz;
    }
    return force;
  }
};

template <class Half, class Type>
struct CoupledSprings {
  AlongSprings<Half, Type> plain;
  const std::int32_t* spring;
  const double* tension;

  Vec3 operator()(std::size_t i) const {
    Vec3 force = plain(i);
    for (std::int32_t k = plain.first[i]; k < plain.first[i + 1]; ++k) {
      const std::int32_t j = plain.halves[k].neighbour;
      const Vec3 d{plain.x[j] - plain.x[i], plain.y[j] - plain.y[i], plain.z[j] - plain.z[i]};
      force += d * (tension[spring[k]] / std::max(norm(d), std::numeric_limits<double>::min()));
    }
    return force;
  }
};

template <class Half, class Type>
struct VectorSprings {
  AlongSprings<Half, Type> plain;
  const Vec3* rest;

  Vec3 operator()(std::size_t i) const {
    Vec3 force;
    for (std::int32_t k = plain.first[i]; k < plain.first[i + 1]; ++k) {
      const Half half = plain.halves[k];
      const Vec3 d{plain.x[half.neighbour] - plain.x[i], plain.y[half.neighbour] - plain.y[i],
                   plain.z[half.neighbour] - plain.z[i]};
      force += (d - rest[half.type]) * plain.types[half.type].stiffness;
    }
    return force;
  }
};

}  // namespace

template <class Use>
void NetKernel::with_springs(const NetState& state, const Use& use) const {
  const AlongSprings<HalfSpring, SpringType> plain{state.x.data(),     state.y.data(), state.z.data(),
                                                   first_half_.data(), halves_.data(), types_.data()};
  if (law_ == SpringLaw::vector) {
    use(VectorSprings<HalfSpring, SpringType>{plain, rest_vectors_.data()});
  } else if (!couplings_.empty()) {
    couple(state);
    use(CoupledSprings<HalfSpring, SpringType>{plain, half_spring_.data(), tension_.data()});
  } else {
    use(plain);
  }
}

// Tension that couplings add to their springs, added up in their order.
void NetKernel::couple(const NetState& state) const {
  std::fill(tension_.begin(), tension_.end(), 0.0);
  for (const YarnCoupling& c : couplings_) {
    const double t = c.stiffness * (extension(springs_[at(c.warp)], state) +
                                    c.ratio * extension(springs_[at(c.weft)], state));
    tension_[at(c.warp)] += t;
    tension_[at(c.weft)] += c.ratio * t;
  }
}

void NetKernel::set_passes(double time, double h, Moment moment) {
  for (std::size_t k = 0; k < classes_.size(); ++k) {
    const MassClass& kind = classes_[k];
    Pass& pass = passes_[k];
    const double c = damping_ * h / (2 * kind.mass);
    pass.inverse_mass = 1 / kind.mass;
    pass.keep = moment == Moment::first ? 1 - c : moment == Moment::inner ? (1 - c) / (1 + c) : 1 / (1 + c);
    pass.gain = moment == Moment::first ? 1 : moment == Moment::inner ? 1 + pass.keep : pass.keep;
    pass.acceleration = gravity_;
    for (const int l : kind.loads)
      pass.acceleration += loads_[at(l)].force * (factor_at(loads_[at(l)].factor, time) / kind.mass);
    pass.clamped = kind.clamp >= 0;
    if (!pass.clamped) continue;
    const Clamp& clamp = clamps_[at(kind.clamp)];
    const double gone = factor_at(clamp.factor, time + h) - factor_at(clamp.factor, time);
    pass.velocity = clamp.factor.empty() ? Vec3{} : clamp.way * (gone / h);
  }
}

template <class Springs>
void NetKernel::sweep_chunk(const Springs& springs, NetState& state, double half, double h, std::size_t first,
                            std::size_t last) {
  // the state's velocities are W here; they are written where they were read
  double* const vx = state.vx.data();
  double* const vy = state.vy.data();
  double* const vz = state.vz.data();
  for (std::size_t i = first; i < last; ++i) {
    const Pass& pass = passes_[at(class_of_[i])];
    Vec3 w;
    if (pass.clamped) {
      w = pass.velocity;
    } else {
      const Vec3 a = springs(i) * pass.inverse_mass + pass.acceleration;
      w = Vec3{vx[i], vy[i], vz[i]} * pass.keep + a * (pass.gain * half);
    }
    vx[i] = w.x;
    vy[i] = w.y;
    vz[i] = w.z;
    nx_[i] = state.x[i] + h * w.x;
    ny_[i] = state.y[i] + h * w.y;
    nz_[i] = state.z[i] + h * w.z;
  }
}

void NetKernel::sweep(NetState& state, double half, double h) {
  with_springs(state, [&]<class Springs>(const Springs& springs) {
    struct Work {
      NetKernel* kernel;
      const Springs* sums;
      NetState* state;
      double half, h;
    } work{this, &springs, &state, half, h};
    const Work* w = &work;  // one pointer: handing out the work does not allocate
    parallel_chunks(chunks_of(masses()), [w](int c) {
      const std::size_t first = static_cast<std::size_t>(c) * chunk;
      w->kernel->sweep_chunk(*w->sums, *w->state, w->half, w->h, first,
                             std::min(first + chunk, w->kernel->masses()));
    });
  });
}

void NetKernel::advance(NetState& state, double h, int steps) {
  if (state.size() != masses()) throw std::invalid_argument("mass-spring net: the state has another size");
  if (!(h > 0) || !(h < stable_step_))
    throw std::invalid_argument("mass-spring net: a time step of " + std::to_string(h) +
                                " is not stable; it must be below " + std::to_string(stable_step_));
  if (steps <= 0) return;
  for (std::vector<double>* each : {&nx_, &ny_, &nz_}) each->resize(masses());
  for (int step = 0; step < steps; ++step) {
    set_passes(state.time, h, step == 0 ? Moment::first : Moment::inner);
    sweep(state, h / 2, h);
    state.x.swap(nx_);
    state.y.swap(ny_);
    state.z.swap(nz_);
    state.time += h;
  }
  set_passes(state.time, h, Moment::last);
  sweep(state, h / 2, 0);
}

void NetKernel::spring_forces(const NetState& state, std::vector<Vec3>& out) const {
  out.resize(masses());
  with_springs(state, [&](const auto& springs) {
    parallel_chunks(chunks_of(masses()), [&](int c) {
      const std::size_t first = static_cast<std::size_t>(c) * chunk;
      for (std::size_t i = first; i < std::min(first + chunk, masses()); ++i) out[i] = springs(i);
    });
  });
}

Vec3 NetKernel::external_force(std::size_t mass, double time) const {
  const MassClass& kind = classes_[class_index(mass)];
  Vec3 force = gravity_ * kind.mass;
  for (const int l : kind.loads) force += loads_[at(l)].force * factor_at(loads_[at(l)].factor, time);
  return force;
}

void NetKernel::accelerations(const NetState& state, std::vector<Vec3>& out) const {
  spring_forces(state, out);
  for (std::size_t i = 0; i < masses(); ++i)
    out[i] = (out[i] + external_force(i, state.time)) / classes_[class_index(i)].mass;
}

NetEnergy NetKernel::energy(const NetState& state) const {
  NetEnergy energy;
  for (std::size_t i = 0; i < masses(); ++i) {
    const double m = classes_[class_index(i)].mass;
    if (!held(i))
      energy.kinetic += 0.5 * m * squared_norm(state.velocity(i));  // a clamp gives and takes its own
    energy.weight -= m * dot(gravity_, state.position(i));
  }
  for (const Spring& s : springs_) {
    const Vec3 d = state.position(at(s.b)) - state.position(at(s.a));
    const double square =
        law_ == SpringLaw::vector ? squared_norm(d - s.rest) : std::pow(norm(d) - norm(s.rest), 2);
    energy.springs += 0.5 * s.stiffness * square;
  }
  for (const YarnCoupling& c : couplings_) {
    const double e =
        extension(springs_[at(c.warp)], state) + c.ratio * extension(springs_[at(c.weft)], state);
    energy.springs += 0.5 * c.stiffness * e * e;
  }
  return energy;
}

double NetKernel::bytes_per_mass() const {
  const double halves =
      static_cast<double>(halves_.size()) / static_cast<double>(std::max<std::size_t>(masses(), 1));
  // x read, x written, v read, v written; a class, a first index, and the list of neighbours
  return 4 * 3 * sizeof(double) + 2 * sizeof(std::int32_t) + halves * sizeof(HalfSpring);
}

}  // namespace loopwright
