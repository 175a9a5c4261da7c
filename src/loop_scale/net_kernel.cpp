#include "loop_scale/net_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

#include "base/parallel.hpp"
#include "base/wide.hpp"

namespace loopwright {
namespace {

// Masses a piece of work; fixed, so that sums do not depend on the number of threads. Its forces fit into a
// core's second cache.
constexpr std::size_t piece_size = 8192;
constexpr std::size_t shortest_run = 6;  // on average, for which runs are worth their overhead
constexpr std::size_t batch = 128;       // springs whose roots are drawn together

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace

// Forces on the masses of one piece, from its first on. One for each thread, made once.
struct NetKernel::Forces {
  std::array<double, piece_size> x, y, z;

  static Forces& of_this_thread() {
    thread_local const std::unique_ptr<Forces> forces = std::make_unique<Forces>();
    return *forces;
  }
};

NetKernel::NetKernel(const MassSpringNet& net)
    : law_(net.law),
      damping_(net.damping),
      gravity_(net.gravity),
      loads_(net.loads),
      clamps_(net.clamps),
      springs_(net.springs),
      couplings_(net.couplings) {
  require_sound(net);
  make_classes(net);
  make_bonds();
  bound_step(net);
}

// Masses of one kind share a class.
void NetKernel::make_classes(const MassSpringNet& net) {
  const std::size_t n = net.mass.size();
  std::vector<int> clamp_of(n, -1);
  std::vector<std::vector<int>> loads_of(net.loads.empty() ? 0 : n);
  for (std::size_t c = 0; c < clamps_.size(); ++c)
    for (const std::int32_t i : clamps_[c].masses) clamp_of[at(i)] = static_cast<int>(c);
  for (std::size_t k = 0; k < loads_.size(); ++k)
    for (const std::int32_t i : loads_[k].masses) loads_of[at(i)].push_back(static_cast<int>(k));
  std::map<std::tuple<double, int, std::vector<int>>, std::int32_t> known;
  class_of_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    MassClass wanted;
    wanted.mass = net.mass[i];
    wanted.clamp = clamp_of[i];
    if (!loads_of.empty()) wanted.loads = loads_of[i];
    const auto [place, is_new] = known.try_emplace({wanted.mass, wanted.clamp, wanted.loads},
                                                   static_cast<std::int32_t>(classes_.size()));
    if (is_new) classes_.push_back(std::move(wanted));
    class_of_[i] = place->second;
  }
  passes_.resize(classes_.size());
  for (std::size_t first = 0; first < n; first += piece_size) {
    Piece piece;
    piece.first = first;
    piece.last = std::min(first + piece_size, n);
    piece.only_class = class_of_[first];
    for (std::size_t i = piece.first; i < piece.last; ++i)
      if (class_of_[i] != piece.only_class) piece.only_class = -1;
    pieces_.push_back(piece);
  }
}

void NetKernel::make_bonds() {
  tension_.assign(couplings_.empty() ? 0 : springs_.size(), 0);
  std::map<std::tuple<double, double, double, double>, std::int32_t> known;
  const auto type_of = [&](const Spring& s, bool from_a) {
    const Vec3 rest = law_ == SpringLaw::vector ? (from_a ? s.rest : -s.rest) : Vec3{norm(s.rest), 0, 0};
    const auto [place, is_new] =
        known.try_emplace({s.stiffness, rest.x, rest.y, rest.z}, static_cast<std::int32_t>(types_.size()));
    if (is_new) {
      types_.push_back({s.stiffness, norm(s.rest)});
      rest_vectors_.push_back(rest);
    }
    return place->second;
  };
  // springs in the order of their first masses, so that neighbours are found in the cache
  std::vector<std::int32_t> order(springs_.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t l, std::int32_t r) {
    const Spring &a = springs_[at(l)], &b = springs_[at(r)];
    return std::min(a.a, a.b) < std::min(b.a, b.b);
  });
  struct Work {
    Bond bond;
    std::int32_t spring;
  };
  std::vector<std::vector<Work>> inner(pieces_.size()), border(pieces_.size());
  for (const std::int32_t k : order) {
    const Spring& s = springs_[at(k)];
    const std::size_t of_a = at(s.a) / piece_size, of_b = at(s.b) / piece_size;
    if (of_a == of_b) {
      inner[of_a].push_back({{s.a, s.b, type_of(s, true)}, k});
    } else {
      border[of_a].push_back({{s.a, s.b, type_of(s, true)}, k});
      border[of_b].push_back({{s.b, s.a, type_of(s, false)}, k});
    }
  }
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    pieces_[p].inner = bonds_.size();
    pieces_[p].border = bonds_.size() + inner[p].size();
    for (const std::vector<Work>* list : {&inner[p], &border[p]})
      for (const Work& work : *list) {
        bonds_.push_back(work.bond);
        if (!couplings_.empty()) bond_spring_.push_back(work.spring);
      }
    pieces_[p].end = bonds_.size();
  }
  // couplings and rest vectors are looked up by bond
  if (!couplings_.empty() || law_ == SpringLaw::vector) return;
  for (Piece& piece : pieces_) {
    piece.inner_runs = runs_.size();
    piece.border_runs = append_runs(piece.inner, piece.border);
    piece.end_runs = append_runs(piece.border, piece.end);
    const std::size_t count = piece.end_runs - piece.inner_runs;
    if (count * shortest_run > piece.end - piece.inner) {
      runs_.resize(piece.inner_runs);
      piece.border_runs = piece.end_runs = piece.inner_runs;
    }
  }
}

// Bonds are ordered by their first masses, so runs of different types lie in turns: as many open runs as
// types.
std::size_t NetKernel::append_runs(std::size_t begin, std::size_t end) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> open;  // by type and a's next value
  for (std::size_t k = begin; k < end; ++k) {
    const Bond& bond = bonds_[k];
    const auto found = open.find({bond.type, bond.a});
    bool joined = false;
    if (found != open.end()) {
      Run& run = runs_[found->second];
      const std::int32_t forward = run.b + run.count, backward = run.b - run.count;
      if (run.count == 1) run.backward = bond.b == backward;
      if (bond.b == (run.backward ? backward : forward)) {
        const std::size_t which = found->second;
        ++run.count;
        open.erase(found);
        open[{bond.type, bond.a + 1}] = which;
        joined = true;
      }
    }
    if (joined) continue;
    open[{bond.type, bond.a + 1}] = runs_.size();
    runs_.push_back({bond.a, bond.b, 1, bond.type, false});
  }
  return runs_.size();
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

// Forces of bonds [begin, end), on both ends or on the first alone.
void NetKernel::add_bonds(const Piece& piece, std::size_t begin, std::size_t end, bool both,
                          const NetState& state, Forces& forces) const {
  const double *const x = state.x.data(), *const y = state.y.data(), *const z = state.z.data();
  std::array<double, batch> dx, dy, dz, stiffness, rest, share;
  for (std::size_t k = begin; k < end; k += batch) {
    const std::size_t count = std::min(batch, end - k);
    for (std::size_t i = 0; i < count; ++i) {
      const Bond bond = bonds_[k + i];
      dx[i] = x[bond.b] - x[bond.a];
      dy[i] = y[bond.b] - y[bond.a];
      dz[i] = z[bond.b] - z[bond.a];
      stiffness[i] = types_[at(bond.type)].stiffness;
      rest[i] = types_[at(bond.type)].rest;
    }
    if (law_ == SpringLaw::vector) {
      for (std::size_t i = 0; i < count; ++i) {
        const Vec3& unloaded = rest_vectors_[at(bonds_[k + i].type)];
        dx[i] -= unloaded.x;
        dy[i] -= unloaded.y;
        dz[i] -= unloaded.z;
        share[i] = stiffness[i];
      }
    } else {
      // two masses at one place: no direction, no force
      constexpr double least = std::numeric_limits<double>::min();
      for (std::size_t i = 0; i < count; ++i) {
        const double square = dx[i] * dx[i] + dy[i] * dy[i] + dz[i] * dz[i];
        share[i] = stiffness[i] - stiffness[i] * rest[i] / std::sqrt(square > least ? square : least);
      }
      if (!couplings_.empty())
        for (std::size_t i = 0; i < count; ++i) {
          const double length = norm({dx[i], dy[i], dz[i]});
          share[i] += tension_[at(bond_spring_[k + i])] / std::max(length, least);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double fx = share[i] * dx[i], fy = share[i] * dy[i], fz = share[i] * dz[i];
      const std::size_t a = at(bonds_[k + i].a) - piece.first;
      forces.x[a] += fx;
      forces.y[a] += fy;
      forces.z[a] += fz;
      if (!both) continue;
      const std::size_t b = at(bonds_[k + i].b) - piece.first;
      forces.x[b] -= fx;
      forces.y[b] -= fy;
      forces.z[b] -= fz;
    }
  }
}

namespace {

// Differences, and later forces, of springs a + i to b + i or b - i.
template <bool backward>
void differences(const double* a, const double* b, std::size_t count, double* d) {
  for (std::size_t i = 0; i < count; ++i)
    d[i] = *(backward ? b - static_cast<std::ptrdiff_t>(i) : b + static_cast<std::ptrdiff_t>(i)) - a[i];
}
template <bool backward>
void take_away(const double* share, const double* d, std::size_t count, double* b) {
  for (std::size_t i = 0; i < count; ++i)
    *(backward ? b - static_cast<std::ptrdiff_t>(i) : b + static_cast<std::ptrdiff_t>(i)) -= share[i] * d[i];
}

}  // namespace

LOOPWRIGHT_WIDE void NetKernel::add_run(const Piece& piece, const Run& run, bool both, const NetState& state,
                                        Forces& forces) const {
  const double stiffness = types_[at(run.type)].stiffness, pull = stiffness * types_[at(run.type)].rest;
  std::array<std::array<double, batch>, 3> d;
  std::array<double, batch> share;
  const std::array<const double*, 3> place{state.x.data(), state.y.data(), state.z.data()};
  const std::array<double*, 3> force{forces.x.data(), forces.y.data(), forces.z.data()};
  for (std::size_t k = 0; k < at(run.count); k += batch) {
    const std::size_t count = std::min(batch, at(run.count) - k), a = at(run.a) + k;
    const std::size_t b = run.backward ? at(run.b) - k : at(run.b) + k;
    for (std::size_t c = 0; c < 3; ++c)
      run.backward ? differences<true>(place[c] + a, place[c] + b, count, d[c].data())
                   : differences<false>(place[c] + a, place[c] + b, count, d[c].data());
    constexpr double least = std::numeric_limits<double>::min();
    for (std::size_t i = 0; i < count; ++i) {
      const double square = d[0][i] * d[0][i] + d[1][i] * d[1][i] + d[2][i] * d[2][i];
      share[i] = stiffness - pull / std::sqrt(square > least ? square : least);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      double* const fa = force[c] + (a - piece.first);
      for (std::size_t i = 0; i < count; ++i) fa[i] += share[i] * d[c][i];
      if (!both) continue;
      double* const fb = force[c] + (b - piece.first);
      run.backward ? take_away<true>(share.data(), d[c].data(), count, fb)
                   : take_away<false>(share.data(), d[c].data(), count, fb);
    }
  }
}

void NetKernel::add_forces(const Piece& piece, const NetState& state, Forces& forces) const {
  const std::size_t count = piece.last - piece.first;
  for (auto* each : {&forces.x, &forces.y, &forces.z}) std::fill_n(each->begin(), count, 0.0);
  if (piece.inner_runs < piece.end_runs) {
    for (std::size_t r = piece.inner_runs; r < piece.end_runs; ++r)
      add_run(piece, runs_[r], r < piece.border_runs, state, forces);
    return;
  }
  add_bonds(piece, piece.inner, piece.border, true, state, forces);
  add_bonds(piece, piece.border, piece.end, false, state, forces);
}

// The state's velocities are W here; they are written where they were read.
LOOPWRIGHT_WIDE void NetKernel::move(const Piece& piece, const Forces& forces, NetState& state, double half,
                                     double h) {
  const auto along = [&](const Pass& pass, double force, double load, double x, double& v, double& next) {
    v = v * pass.keep + (force * pass.inverse_mass + load) * (pass.gain * half);
    next = x + h * v;
  };
  if (piece.only_class >= 0 && !passes_[at(piece.only_class)].clamped) {
    // a loop for each axis, which the compiler turns into vectors
    const Pass pass = passes_[at(piece.only_class)];
    const std::size_t count = piece.last - piece.first;
    const auto axis = [&](const std::array<double, piece_size>& force, double load, const double* x,
                          double* v, double* next) {
      for (std::size_t i = 0; i < count; ++i) along(pass, force[i], load, x[i], v[i], next[i]);
    };
    const std::size_t f = piece.first;
    axis(forces.x, pass.acceleration.x, state.x.data() + f, state.vx.data() + f, nx_.data() + f);
    axis(forces.y, pass.acceleration.y, state.y.data() + f, state.vy.data() + f, ny_.data() + f);
    axis(forces.z, pass.acceleration.z, state.z.data() + f, state.vz.data() + f, nz_.data() + f);
    return;
  }
  for (std::size_t i = piece.first; i < piece.last; ++i) {
    const Pass& pass = passes_[at(class_of_[i])];
    const std::size_t f = i - piece.first;
    if (pass.clamped) {
      state.vx[i] = pass.velocity.x;
      state.vy[i] = pass.velocity.y;
      state.vz[i] = pass.velocity.z;
      nx_[i] = state.x[i] + h * pass.velocity.x;
      ny_[i] = state.y[i] + h * pass.velocity.y;
      nz_[i] = state.z[i] + h * pass.velocity.z;
      continue;
    }
    along(pass, forces.x[f], pass.acceleration.x, state.x[i], state.vx[i], nx_[i]);
    along(pass, forces.y[f], pass.acceleration.y, state.y[i], state.vy[i], ny_[i]);
    along(pass, forces.z[f], pass.acceleration.z, state.z[i], state.vz[i], nz_[i]);
  }
}

void NetKernel::sweep(NetState& state, double half, double h) {
  couple(state);
  struct Work {
    NetKernel* kernel;
    NetState* state;
    double half, h;
  } work{this, &state, half, h};
  const Work* w = &work;  // one pointer: handing out the work does not allocate
  parallel_chunks(static_cast<int>(pieces_.size()), [w](int p) {
    const Piece& piece = w->kernel->pieces_[static_cast<std::size_t>(p)];
    Forces& forces = Forces::of_this_thread();
    w->kernel->add_forces(piece, *w->state, forces);
    w->kernel->move(piece, forces, *w->state, w->half, w->h);
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
  couple(state);
  parallel_chunks(static_cast<int>(pieces_.size()), [&](int p) {
    const Piece& piece = pieces_[static_cast<std::size_t>(p)];
    Forces& forces = Forces::of_this_thread();
    add_forces(piece, state, forces);
    for (std::size_t i = piece.first; i < piece.last; ++i) {
      const std::size_t f = i - piece.first;
      out[i] = {forces.x[f], forces.y[f], forces.z[f]};
    }
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
  double list = static_cast<double>(runs_.size() * sizeof(Run));
  for (const Piece& p : pieces_)
    if (p.inner_runs == p.end_runs) list += static_cast<double>((p.end - p.inner) * sizeof(Bond));
  const bool classes =
      std::any_of(pieces_.begin(), pieces_.end(), [](const Piece& p) { return p.only_class < 0; });
  // x read, x written, v read, v written; the list of springs; the classes where they differ
  return 4 * 3 * sizeof(double) + list / static_cast<double>(std::max<std::size_t>(masses(), 1)) +
         (classes ? sizeof(std::int32_t) : 0);
}

}  // namespace loopwright
