// Coulomb friction at a contact of two segments, with history, lagged over one Newton step.
//
//   U = mu N e [ F(|u|/e) - F(|s|/e) ],   u = P (s + r - r0),   P = I - n n'
//   F(y) = y^2 - y^3/3 for y < 1,  y - 1/3 beyond;   force mu N F'(y): 2y - y^2 for y < 1, then mu N
//
// r: place of the contact point of yarn a minus that of yarn b; r0: the same where the step starts; s:
// elastic slip there (history); n: contact normal; N: contact force; mu: friction coefficient; e: elastic
// slip at which the contact slides. Below e the contact sticks on a short spring, so a loaded cloth does not
// creep. N, n and the contact's places on the yarns are those of the step's start; after the step s becomes
// u, cut to e where the contact has slid: its anchor is dragged along and the force stays at mu N exactly. At
// rest all forces are inside the friction cone. Source: anchored springs as in Cirio et al. 2014; the curve
// F' as in Li et al. 2020 (incremental potential contact).
#pragma once
#include <array>
#include <cmath>

#include "base/vec3.hpp"
#include "mechanics/energies/energy.hpp"

namespace loopwright {

struct Friction {
  static constexpr const char* name = "friction";
  static constexpr std::size_t dofs = 24;

  double load = 0;                               // mu N
  double softness = 0.02;                        // e, in d
  Vec3 normal{0, 0, 1}, slip, start;             // n, s, r0
  std::array<double, 4> weight_a{}, weight_b{};  // spline weights of the contact's places

  Vec3 tangential(const Vec3& v) const { return v - dot(v, normal) * normal; }
  Vec3 slip_at(const Vec3& r) const { return tangential(slip + r - start); }
  static double potential(double y) { return y < 1 ? y * y * (1 - y / 3) : y - 1.0 / 3; }
  double energy(const Vec3& r) const {
    return load * softness * (potential(norm(slip_at(r)) / softness) - potential(norm(slip) / softness));
  }
  // dU/dr and d2U/dr2 (xx, xy, xz, yy, yz, zz).
  Vec3 force(const Vec3& r) const {
    const Vec3 u = slip_at(r);
    const double y = norm(u) / softness;
    return u * (y < 1 ? load / softness * (2 - y) : load / (y * softness));
  }
  std::array<double, 6> stiffness(const Vec3& r) const {
    // Across u: force / |u|; along u: its slope; their difference acts on u u' / |u|^2.
    const Vec3 u = slip_at(r), n = normal;
    const double y = norm(u) / softness, k = y < 1 ? load / softness * (2 - y) : load / (y * softness);
    const double along = y < 1 ? load / softness * (2 - 2 * y) : 0;
    const double c = y > 0 ? (k - along) / squared_norm(u) : 0;
    return {k * (1 - n.x * n.x) - c * u.x * u.x, -k * n.x * n.y - c * u.x * u.y,
            -k * n.x * n.z - c * u.x * u.z,      k * (1 - n.y * n.y) - c * u.y * u.y,
            -k * n.y * n.z - c * u.y * u.z,      k * (1 - n.z * n.z) - c * u.z * u.z};
  }
  // History after the contact has moved to r.
  Vec3 slip_after(const Vec3& r) const {
    const Vec3 u = slip_at(r);
    const double length = norm(u);
    return length > softness ? u * (softness / length) : u;
  }

  // As an element of both segments' control points, for the derivative check.
  LocalTerm<24> evaluate(const std::array<double, 24>& q) const {
    LocalTerm<24> term;
    std::array<double, 8> w;
    Vec3 r;
    for (std::size_t k = 0; k < 8; ++k) {
      w[k] = k < 4 ? weight_a[k] : -weight_b[k - 4];
      r += w[k] * Vec3{q[3 * k], q[3 * k + 1], q[3 * k + 2]};
    }
    const Vec3 f = force(r);
    const std::array<double, 6> s = stiffness(r);
    constexpr std::array<std::array<std::size_t, 3>, 3> at{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
    term.energy = energy(r);
    for (std::size_t k = 0; k < 8; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        term.gradient[3 * k + c] = w[k] * f[static_cast<int>(c)];
        for (std::size_t l = 0; l < 8; ++l)
          for (std::size_t d = 0; d < 3; ++d) term.hessian[3 * k + c][3 * l + d] = w[k] * w[l] * s[at[c][d]];
      }
    return term;
  }
};

}  // namespace loopwright
