// Bending of one spline segment of rest length h, straight when unloaded:
//   U = 1/2 B int kappa^2 ds0 = 1/2 B h int kappa^2 du,   kappa^2 = |p' x p''|^2 / |p'|^6
// B: bend stiffness (1 in the model's units, energies in B/d). 4-point Gauss.
// With A = p'.p', C = p'.p'', D = p''.p'': kappa^2 = f = D A^-2 - C^2 A^-3; derivatives follow by the chain
// rule.
// Set yarn has a curvature kappa_0 when unloaded: U = 1/2 B int (r - r_0)^2 ds0 with r^2 = kappa^2 + e^2,
// r_0^2 = kappa_0^2 + e^2, e = kappa_0 / 16, which is (kappa - kappa_0)^2 but for yarn that is nearly
// straight where it was bent, whose cusp it rounds. The plane of the bend may turn: yarn without resistance
// to twist.
#pragma once
#include <cmath>

#include "mechanics/energies/energy.hpp"

namespace loopwright {

struct Bend {
  static constexpr const char* name = "bend";
  static constexpr std::size_t dofs = 12;
  double stiffness = 1;                            // B
  double rest_length = 1;                          // h
  const std::array<double, 4>* natural = nullptr;  // kappa_0 at the Gauss points, 1/d; none: straight

  // p', p'' and their products at a Gauss point, with what its energy density is multiplied by.
  struct Point {
    std::array<double, 3> a{}, b{};
    double A = 0, C = 0, D = 0, weight = 0;
  };
  Point point(const SegmentDofs& x, std::size_t g) const {
    Point p;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        p.a[c] += gauss_spline[g].slope[i] * x[3 * i + c];
        p.b[c] += gauss_spline[g].curve[i] * x[3 * i + c];
      }
    p.A = p.a[0] * p.a[0] + p.a[1] * p.a[1] + p.a[2] * p.a[2];
    p.C = p.a[0] * p.b[0] + p.a[1] * p.b[1] + p.a[2] * p.b[2];
    p.D = p.b[0] * p.b[0] + p.b[1] * p.b[1] + p.b[2] * p.b[2];
    p.weight = 0.5 * gauss_weight[g] * stiffness * rest_length;
    return p;
  }

  // (r - r_0)^2 as a function of f = kappa^2, and its first two derivatives.
  struct Law {
    double value, slope, curvature;
  };
  Law law(double f, std::size_t g) const {
    if (!natural || (*natural)[g] == 0) return {f, 1, 0};
    const double k0 = (*natural)[g], e2 = k0 * k0 / 256;
    const double r0 = std::sqrt(k0 * k0 + e2), r = std::sqrt(f + e2);
    return {(r - r0) * (r - r0), 1 - r0 / r, 0.5 * r0 / (r * r * r)};
  }

  double energy(const SegmentDofs& x) const {
    double sum = 0;
    for (std::size_t g = 0; g < 4; ++g) {
      const Point p = point(x, g);
      const double i1 = 1 / p.A, i2 = i1 * i1;
      sum += p.weight * law(p.D * i2 - p.C * p.C * (i2 * i1), g).value;
    }
    return sum;
  }

  LocalTerm<12> evaluate(const SegmentDofs& x) const {
    LocalTerm<12> term;
    for (std::size_t g = 0; g < 4; ++g) {
      const auto& h1 = gauss_spline[g].slope;
      const auto& h2 = gauss_spline[g].curve;
      const Point p = point(x, g);
      const auto& [a, b, A, C, D, weight] = p;
      const double i1 = 1 / A, i2 = i1 * i1, i3 = i2 * i1, i4 = i2 * i2;
      const Law set = law(D * i2 - C * C * i3, g);
      const double w = weight * set.slope;
      const double f_A = w * (-2 * D * i3 + 3 * C * C * i4), f_C = w * (-2 * C * i3), f_D = w * i2;
      const double f_AA = w * (6 * D * i4 - 12 * C * C * i4 * i1), f_AC = w * 6 * C * i4,
                   f_AD = w * (-2 * i3), f_CC = w * (-2 * i3);
      term.energy += weight * set.value;

      std::array<double, 3> da{}, db{};
      for (std::size_t c = 0; c < 3; ++c) {
        da[c] = 2 * f_A * a[c] + f_C * b[c];
        db[c] = 2 * f_D * b[c] + f_C * a[c];
      }
      std::array<std::array<double, 3>, 3> haa, hab, hbb;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t e = 0; e < 3; ++e) {
          haa[c][e] = 4 * f_AA * a[c] * a[e] + 2 * f_AC * (a[c] * b[e] + b[c] * a[e]) + f_CC * b[c] * b[e];
          hab[c][e] = 4 * f_AD * a[c] * b[e] + 2 * f_AC * a[c] * a[e] + f_CC * b[c] * a[e];
          hbb[c][e] = f_CC * a[c] * a[e];
          if (c == e) {
            haa[c][e] += 2 * f_A;
            hab[c][e] += f_C;
            hbb[c][e] += 2 * f_D;
          }
        }
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c) term.gradient[3 * i + c] += h1[i] * da[c] + h2[i] * db[c];
      if (set.curvature != 0) add_curvature(p, g, weight * set.curvature, term);
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i; j < 4; ++j)
          for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t e = 0; e < 3; ++e) {
              const double v = h1[i] * h1[j] * haa[c][e] + h1[i] * h2[j] * hab[c][e] +
                               h2[i] * h1[j] * hab[e][c] + h2[i] * h2[j] * hbb[c][e];
              term.hessian[3 * i + c][3 * j + e] += v;
              if (i != j) term.hessian[3 * j + e][3 * i + c] += v;
            }
    }
    return term;
  }

 private:
  // What the law's own curvature adds to the Hessian: by * (grad f)(grad f)^T.
  void add_curvature(const Point& p, std::size_t g, double by, LocalTerm<12>& term) const {
    const double i1 = 1 / p.A, i2 = i1 * i1, i3 = i2 * i1;
    const double f_A = -2 * p.D * i3 + 3 * p.C * p.C * i2 * i2, f_C = -2 * p.C * i3, f_D = i2;
    std::array<double, 12> f;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        f[3 * i + c] = gauss_spline[g].slope[i] * (2 * f_A * p.a[c] + f_C * p.b[c]) +
                       gauss_spline[g].curve[i] * (2 * f_D * p.b[c] + f_C * p.a[c]);
    for (std::size_t i = 0; i < 12; ++i)
      for (std::size_t j = 0; j < 12; ++j) term.hessian[i][j] += by * f[i] * f[j];
  }
};

}  // namespace loopwright
