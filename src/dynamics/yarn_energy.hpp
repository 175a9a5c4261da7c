// Elastic energy of yarns in any blending functions, with gradient and Hessian. (The elements of
// src/mechanics are for uniform B-splines, straight yarn and always with their Hessian; on that case they and
// these agree, which is a test.)
//
//   springs: h (1/2 e^2 + hardening/4 e^4) EA,  e = |q_(k+1) - q_k| / h - 1
//
//   green: 1/2 EA int eps^2 |p0'| du,  eps = (|p'|^2 - |p0'|^2) / (2 |p0'|^2),  |p0'|: speed of the rest
//   shape
//
//   mean: 1/2 EA/h [ (L - h)^2 + evenness (int |p'|^2 du - L^2) ],  L = int |p'| du
//
//   bend: 1/2 B h int (kappa - kappa_0)^2 du,  kappa = |p' x p''| / |p'|^3; with natural
// curvature both kappas are rounded off, sqrt(kappa^2 + (0.1/h)^2), so that straight yarn has no corner
// 4-point Gauss a segment; h: rest length. Finite displacements after Nocent and Remion, Eurographics
// workshop on computer animation and simulation 2001, in the form of Green and Lagrange.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "dynamics/spline_model.hpp"
#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

struct ElasticEnergy {
  double stretch = 0, bend = 0;
  double total() const { return stretch + bend; }
};

// Block (i, i - 3 + k) of the Hessian at [i][k]; lower triangle, all control points of the model in a row.
using BandHessian = std::vector<std::array<Block, 4>>;

// Adds to `gradient` and, if given, to `hessian` (both of the size of the model).
ElasticEnergy elastic_energy(const SplineModel& model, std::span<const Vec3> place, std::span<Vec3> gradient,
                             BandHessian* hessian = nullptr);

// The linear bend energy of nearly inextensible straight yarn, 1/2 B/h^3 sum q_a . q_b int h_a'' h_b'': its
// Hessian is constant, so that explicit steps may keep it in the factored matrix. Not for curved natural
// states.
BandMatrix linear_bend_matrix(const SplineYarn& yarn);

}  // namespace loopwright
