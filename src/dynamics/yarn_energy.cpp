#include "dynamics/yarn_energy.hpp"

#include <cmath>

#include "mechanics/energies/energy.hpp"

namespace loopwright {
namespace {

using GaussWeights = std::array<BlendingWeights, 4>;

GaussWeights at_gauss_points(const Blending& blending) {
  GaussWeights w;
  for (std::size_t g = 0; g < 4; ++g) w[g] = blending.weights(gauss_node[g]);
  return w;
}

// s (1 - or + ) outer products, on row-major blocks.
void add_identity(Block& h, double s) {
  h[0] += s;
  h[4] += s;
  h[8] += s;
}
void add_outer(Block& h, double s, const Vec3& a, const Vec3& b) {
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) h[3 * r + c] += s * a[static_cast<int>(r)] * b[static_cast<int>(c)];
}
void add_scaled(Block& h, double s, const Block& b) {
  for (std::size_t k = 0; k < 9; ++k) h[k] += s * b[k];
}
Block transposed(const Block& b) { return {b[0], b[3], b[6], b[1], b[4], b[7], b[2], b[5], b[8]}; }

// One segment's four control points: where its terms are summed.
struct Element {
  std::array<Vec3, 4> q, gradient{};
  std::array<std::array<Block, 4>, 4> hessian{};  // lower triangle only
};

Vec3 combined(const std::array<double, 4>& w, const std::array<Vec3, 4>& q) {
  return w[0] * q[0] + w[1] * q[1] + w[2] * q[2] + w[3] * q[3];
}

double add_green(Element& e, const GaussWeights& w, double stiffness, const std::array<double, 4>& speed,
                 bool with_hessian) {
  double energy = 0;
  for (std::size_t g = 0; g < 4; ++g) {
    const auto& h1 = w[g].slope;
    const Vec3 a = combined(h1, e.q);
    const double rest = speed[g];
    const double eps = 0.5 * (squared_norm(a) / (rest * rest) - 1), f = gauss_weight[g] * stiffness / rest;
    energy += 0.5 * gauss_weight[g] * stiffness * rest * eps * eps;
    for (std::size_t i = 0; i < 4; ++i) e.gradient[i] += (f * eps * h1[i]) * a;
    if (!with_hessian) continue;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        add_identity(e.hessian[i][j], f * eps * h1[i] * h1[j]);
        add_outer(e.hessian[i][j], f * h1[i] * h1[j] / (rest * rest), a, a);
      }
  }
  return energy;
}

double add_mean(Element& e, const GaussWeights& w, double stiffness, double evenness, double rest,
                bool with_hessian) {
  std::array<Vec3, 4> tangent, arc_slope{};
  std::array<double, 4> speed{};
  double arc = 0, square = 0;
  for (std::size_t g = 0; g < 4; ++g) {
    tangent[g] = combined(w[g].slope, e.q);
    speed[g] = norm(tangent[g]);
    arc += gauss_weight[g] * speed[g];
    square += gauss_weight[g] * speed[g] * speed[g];
    tangent[g] *= 1 / speed[g];
    for (std::size_t i = 0; i < 4; ++i) arc_slope[i] += (gauss_weight[g] * w[g].slope[i]) * tangent[g];
  }
  const double k = stiffness / rest, tension = k * ((1 - evenness) * arc - rest), even = k * evenness;
  for (std::size_t i = 0; i < 4; ++i) {
    e.gradient[i] += tension * arc_slope[i];
    for (std::size_t g = 0; g < 4; ++g)
      e.gradient[i] += (even * gauss_weight[g] * w[g].slope[i] * speed[g]) * tangent[g];
  }
  if (with_hessian)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        add_outer(e.hessian[i][j], k * (1 - evenness), arc_slope[i], arc_slope[j]);
        for (std::size_t g = 0; g < 4; ++g) {
          const double both = gauss_weight[g] * w[g].slope[i] * w[g].slope[j], f = tension * both / speed[g];
          add_identity(e.hessian[i][j], f + even * both);
          add_outer(e.hessian[i][j], -f, tangent[g], tangent[g]);
        }
      }
  return 0.5 * k * ((arc - rest) * (arc - rest) + evenness * (square - arc * arc));
}

// With A = p'.p', C = p'.p'', D = p''.p'': kappa^2 = f = D A^-2 - C^2 A^-3, and the energy is a function F of
// f; derivatives follow by the chain rule.
double add_bend(Element& e, const GaussWeights& w, double stiffness, double rest,
                const std::array<double, 4>& natural, bool with_hessian) {
  // Where yarn is straight, kappa has a corner: rounded off over a tenth of a segment's turn, with the least
  // energy where it was.
  const double corner = 0.01 / (rest * rest);
  double energy = 0;
  for (std::size_t g = 0; g < 4; ++g) {
    const auto& h1 = w[g].slope;
    const auto& h2 = w[g].curve;
    const Vec3 a = combined(h1, e.q), b = combined(h2, e.q);
    const double A = squared_norm(a), C = dot(a, b), D = squared_norm(b);
    const double i1 = 1 / A, i2 = i1 * i1, i3 = i2 * i1, i4 = i2 * i2;
    const double f = D * i2 - C * C * i3, s = 0.5 * gauss_weight[g] * stiffness * rest;
    // F = s (sqrt(f) - kappa_0)^2
    double F1 = s, F2 = 0;
    if (natural[g] == 0) {
      energy += s * f;
    } else {
      const double k0 = std::sqrt(natural[g] * natural[g] + corner), k = std::sqrt(std::max(f, 0.0) + corner);
      energy += s * (k - k0) * (k - k0);
      F1 = s * (1 - k0 / k);
      F2 = 0.5 * s * k0 / (k * k * k);
    }
    const double f_A = -2 * D * i3 + 3 * C * C * i4, f_C = -2 * C * i3, f_D = i2;
    const Vec3 da = 2 * f_A * a + f_C * b, db = 2 * f_D * b + f_C * a;  // df/da, df/db
    for (std::size_t i = 0; i < 4; ++i) e.gradient[i] += F1 * (h1[i] * da + h2[i] * db);
    if (!with_hessian) continue;
    const double f_AA = 6 * D * i4 - 12 * C * C * i4 * i1, f_AC = 6 * C * i4, f_AD = -2 * i3, f_CC = -2 * i3;
    Block haa{}, hab{}, hbb{};
    add_outer(haa, 4 * f_AA * F1, a, a);
    add_outer(haa, 2 * f_AC * F1, a, b);
    add_outer(haa, 2 * f_AC * F1, b, a);
    add_outer(haa, f_CC * F1, b, b);
    add_identity(haa, 2 * f_A * F1);
    add_outer(hab, 4 * f_AD * F1, a, b);
    add_outer(hab, 2 * f_AC * F1, a, a);
    add_outer(hab, f_CC * F1, b, a);
    add_identity(hab, f_C * F1);
    add_outer(hbb, f_CC * F1, a, a);
    add_identity(hbb, 2 * f_D * F1);
    if (F2 != 0) {
      add_outer(haa, F2, da, da);
      add_outer(hab, F2, da, db);
      add_outer(hbb, F2, db, db);
    }
    const Block hba = transposed(hab);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        add_scaled(e.hessian[i][j], h1[i] * h1[j], haa);
        add_scaled(e.hessian[i][j], h1[i] * h2[j], hab);
        add_scaled(e.hessian[i][j], h2[i] * h1[j], hba);
        add_scaled(e.hessian[i][j], h2[i] * h2[j], hbb);
      }
  }
  return energy;
}

double add_spring(const SplineYarn& yarn, std::span<const Vec3> place, std::size_t k,
                  std::span<Vec3> gradient, BandHessian* hessian) {
  const std::size_t a = static_cast<std::size_t>(yarn.first) + k, b = a + 1;
  const double h = yarn.rest_length[k], EA = yarn.stretch_stiffness, hard = yarn.spring_hardening;
  const Vec3 along = place[b] - place[a];
  const double length = norm(along), e = length / h - 1;
  const double tension = EA * (e + hard * e * e * e), stiffness = EA * (1 + 3 * hard * e * e) / h;
  const Vec3 n = along / length;
  gradient[b] += tension * n;
  gradient[a] -= tension * n;
  if (hessian) {
    Block block{};
    add_identity(block, tension / length);
    add_outer(block, stiffness - tension / length, n, n);
    add_scaled((*hessian)[a][3], 1, block);
    add_scaled((*hessian)[b][3], 1, block);
    add_scaled((*hessian)[b][2], -1, block);
  }
  return EA * h * e * e * (0.5 + 0.25 * hard * e * e);
}

}  // namespace

ElasticEnergy elastic_energy(const SplineModel& model, std::span<const Vec3> place, std::span<Vec3> gradient,
                             BandHessian* hessian) {
  ElasticEnergy energy;
  const bool with_hessian = hessian != nullptr;
  for (const SplineYarn& yarn : model.yarns) {
    const GaussWeights w = at_gauss_points(yarn.blending);
    if (model.law == StretchLaw::springs)
      for (std::size_t k = 0; k < yarn.rest_length.size(); ++k)
        energy.stretch += add_spring(yarn, place, k, gradient, hessian);
    // Springs keep the length of the chain of control points; bending still wants a length to act on.
    for (std::size_t s = 0; s < static_cast<std::size_t>(yarn.segments()); ++s) {
      const std::size_t first = static_cast<std::size_t>(yarn.first) + s;
      Element e;
      for (std::size_t i = 0; i < 4; ++i) e.q[i] = place[first + i];
      const double rest = model.law == StretchLaw::springs ? yarn.rest_length[s + 1] : yarn.rest_length[s];
      if (model.law == StretchLaw::green)
        energy.stretch += add_green(e, w, yarn.stretch_stiffness, yarn.rest_speed[s], with_hessian);
      if (model.law == StretchLaw::mean)
        energy.stretch += add_mean(e, w, yarn.stretch_stiffness, yarn.evenness, rest, with_hessian);
      if (yarn.bend_stiffness > 0)
        energy.bend +=
            add_bend(e, w, yarn.bend_stiffness, rest,
                     yarn.natural_curvature.empty() ? std::array<double, 4>{} : yarn.natural_curvature[s],
                     with_hessian);
      for (std::size_t i = 0; i < 4; ++i) gradient[first + i] += e.gradient[i];
      if (hessian)
        for (std::size_t i = 0; i < 4; ++i)
          for (std::size_t j = 0; j <= i; ++j)
            add_scaled((*hessian)[first + i][3 - (i - j)], 1, e.hessian[i][j]);
    }
  }
  return energy;
}

BandMatrix linear_bend_matrix(const SplineYarn& yarn) {
  const BlendingMatrix K2 = product_integrals(yarn.blending, 2);
  BandMatrix m(static_cast<std::size_t>(yarn.points));
  for (std::size_t s = 0; s < static_cast<std::size_t>(yarn.segments()); ++s) {
    const double h = yarn.rest_length[s];
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b <= a; ++b) m.at(s + a, s + b) += yarn.bend_stiffness / (h * h * h) * K2[a][b];
  }
  return m;
}

}  // namespace loopwright
