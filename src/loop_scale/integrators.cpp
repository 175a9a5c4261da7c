#include "loop_scale/integrators.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace loopwright {
namespace {

using Vectors = std::vector<Vec3>;

double dot_of(const Vectors& a, const Vectors& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

class Stepper {
 public:
  Stepper(const MassSpringNet& net, const NetKernel& kernel, double h, NetState& state)
      : net_(net), kernel_(kernel), h_(h), state_(state) {}

  void step(Integrator integrator) {
    // clamps go where their time course says, whatever the method
    for (const Clamp& clamp : net_.clamps) {
      const double gone = factor_at(clamp.factor, state_.time + h_) - factor_at(clamp.factor, state_.time);
      for (const std::int32_t i : clamp.masses)
        set_velocity(static_cast<std::size_t>(i), clamp.factor.empty() ? Vec3{} : clamp.way * (gone / h_));
    }
    switch (integrator) {
      case Integrator::verlet:
        verlet();
        break;
      case Integrator::explicit_euler:
        evaluate();
        move(h_);
        for_free([&](std::size_t i) {
          const Vec3 v = state_.velocity(i);
          set_velocity(i, v + (a_[i] - v * drag(i)) * h_);
        });
        break;
      case Integrator::semi_implicit_euler:
        evaluate();
        for_free([&](std::size_t i) {
          const Vec3 v = state_.velocity(i);
          set_velocity(i, v + (a_[i] - v * drag(i)) * h_);
        });
        move(h_);
        break;
      case Integrator::implicit_euler:
        implicit();
        break;
    }
  }
  long long evaluations = 0;

 private:
  double drag(std::size_t i) const { return kernel_.damping() / kernel_.mass(i); }
  void set_velocity(std::size_t i, const Vec3& v) {
    state_.vx[i] = v.x;
    state_.vy[i] = v.y;
    state_.vz[i] = v.z;
  }
  void evaluate() {
    kernel_.accelerations(state_, a_);
    ++evaluations;
  }
  template <class Use>
  void for_free(const Use& use) {
    for (std::size_t i = 0; i < state_.size(); ++i)
      if (!kernel_.held(i)) use(i);
  }
  void move(double h) {
    for (std::size_t i = 0; i < state_.size(); ++i) {
      state_.x[i] += h * state_.vx[i];
      state_.y[i] += h * state_.vy[i];
      state_.z[i] += h * state_.vz[i];
    }
    state_.time += h;
  }

  void verlet() {
    if (a_.empty()) evaluate();
    const Vectors before = a_;
    const NetState old = state_;
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const bool free = !kernel_.held(i);
      const Vec3 v = old.velocity(i), a = free ? before[i] - v * drag(i) : Vec3{};
      const Vec3 x = old.position(i) + v * h_ + a * (h_ * h_ / 2);
      state_.x[i] = x.x;
      state_.y[i] = x.y;
      state_.z[i] = x.z;
    }
    state_.time += h_;
    evaluate();
    for_free([&](std::size_t i) {
      const double c = drag(i) * h_ / 2;
      set_velocity(i, (old.velocity(i) * (1 - c) + (before[i] + a_[i]) * (h_ / 2)) / (1 + c));
    });
  }

  // out = (M + h Kd + h^2 K) p with K at the state's place; springs in compression lose their negative part,
  // so that the matrix stays positive.
  void apply(const Vectors& p, Vectors& out) {
    ++evaluations;
    for (std::size_t i = 0; i < p.size(); ++i) out[i] = p[i] * (kernel_.mass(i) + h_ * kernel_.damping());
    const auto join = [&](std::size_t a, std::size_t b, const Vec3& force) {
      out[a] -= force * (h_ * h_);
      out[b] += force * (h_ * h_);
    };
    for (const Spring& s : net_.springs) {
      const auto a = static_cast<std::size_t>(s.a), b = static_cast<std::size_t>(s.b);
      const Vec3 dp = p[b] - p[a];
      if (net_.law == SpringLaw::vector) {
        join(a, b, dp * s.stiffness);
        continue;
      }
      const Vec3 d = state_.position(b) - state_.position(a);
      const double length = std::max(norm(d), std::numeric_limits<double>::min());
      const Vec3 n = d / length, along = n * dot(n, dp);
      join(a, b, (along + (dp - along) * std::max(0.0, 1 - norm(s.rest) / length)) * s.stiffness);
    }
    for (const YarnCoupling& c : net_.couplings) {
      const std::array<const Spring*, 2> pair{&net_.springs[static_cast<std::size_t>(c.warp)],
                                              &net_.springs[static_cast<std::size_t>(c.weft)]};
      std::array<Vec3, 2> gradient;
      double change = 0;
      for (std::size_t k = 0; k < 2; ++k) {
        const auto a = static_cast<std::size_t>(pair[k]->a), b = static_cast<std::size_t>(pair[k]->b);
        gradient[k] = normalized(state_.position(b) - state_.position(a)) * (k == 0 ? 1 : c.ratio);
        change += dot(gradient[k], p[b] - p[a]);
      }
      for (std::size_t k = 0; k < 2; ++k)
        join(static_cast<std::size_t>(pair[k]->a), static_cast<std::size_t>(pair[k]->b),
             gradient[k] * (c.stiffness * change));
    }
    for (std::size_t i = 0; i < p.size(); ++i)
      if (kernel_.held(i)) out[i] = {};
  }

  void implicit() {
    const NetState old = state_;
    const std::size_t n = state_.size();
    Vectors residual(n), change(n), direction(n), image(n);
    double first = -1;
    state_.time += h_;
    for (int newton = 0; newton < 30; ++newton) {
      for (std::size_t i = 0; i < n; ++i) {
        state_.x[i] = old.x[i] + h_ * state_.vx[i];
        state_.y[i] = old.y[i] + h_ * state_.vy[i];
        state_.z[i] = old.z[i] + h_ * state_.vz[i];
      }
      evaluate();
      for (std::size_t i = 0; i < n; ++i) {
        const Vec3 v = state_.velocity(i);
        residual[i] =
            kernel_.held(i) ? Vec3{} : (old.velocity(i) - v + (a_[i] - v * drag(i)) * h_) * kernel_.mass(i);
      }
      double square = dot_of(residual, residual);
      if (first < 0) first = square;
      if (!(square > 1e-20 * first)) break;
      // conjugate gradients for the change of V
      std::fill(change.begin(), change.end(), Vec3{});
      direction = residual;
      const double goal = 1e-8 * square;
      for (std::size_t k = 0; k < 10 * n && square > goal; ++k) {
        apply(direction, image);
        const double step = square / dot_of(direction, image);
        for (std::size_t i = 0; i < n; ++i) {
          change[i] += direction[i] * step;
          residual[i] -= image[i] * step;
        }
        const double next = dot_of(residual, residual);
        for (std::size_t i = 0; i < n; ++i) direction[i] = residual[i] + direction[i] * (next / square);
        square = next;
      }
      for_free([&](std::size_t i) { set_velocity(i, state_.velocity(i) + change[i]); });
    }
    for (std::size_t i = 0; i < n; ++i) {
      state_.x[i] = old.x[i] + h_ * state_.vx[i];
      state_.y[i] = old.y[i] + h_ * state_.vy[i];
      state_.z[i] = old.z[i] + h_ * state_.vz[i];
    }
  }

  const MassSpringNet& net_;
  const NetKernel& kernel_;
  double h_;
  NetState& state_;
  Vectors a_;
};

}  // namespace

std::string_view name_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::verlet:
      return "velocity Verlet";
    case Integrator::explicit_euler:
      return "explicit Euler";
    case Integrator::semi_implicit_euler:
      return "semi-implicit Euler";
    case Integrator::implicit_euler:
      break;
  }
  return "implicit Euler";
}

void integrate(const MassSpringNet& net, const NetKernel& kernel, Integrator integrator, double h, int steps,
               NetState& state, long long* evaluations) {
  Stepper stepper(net, kernel, h, state);
  for (int k = 0; k < steps; ++k) stepper.step(integrator);
  if (evaluations) *evaluations += stepper.evaluations;
}

}  // namespace loopwright
