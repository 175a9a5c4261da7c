// Laws with few constants, fitted to membrane forces. The law of a pull is that of Singal and others, Nature
// Communications 15, 2622 (2024):
//
//   sigma = Y e + beta g(alpha e),   g(x) = (1 - x)^-2 - 1 - 2 x for x > 0, else 0
//
// Y: stiffness at small strain, 1/alpha: strain at which the loops lock, beta: how strongly. g begins with
// 3 x^2. Two ways at once, with a common coupling:
//
//   sigma_course = Cxx e_course + Cxy e_wale + beta_x g(alpha_x e_course)
//   sigma_wale   = Cxy e_course + Cyy e_wale + beta_y g(alpha_y e_wale),   sigma_shear = G gamma
//
// In a knit width and height are made of the same yarn, so that it locks when both together have used it up.
// With one locking for both directions, e = e_course + r e_wale:
//
//   sigma_course = Cxx e_course + Cxy e_wale + beta g(alpha e)
//   sigma_wale   = Cxy e_course + Cyy e_wale + r beta g(alpha e)
//
// r: how much width a loop gives up for a share of its height (that the mean of width and height is kept is
// how Poincloux, Adda-Bedia and Lechenault describe stockinette, Physical Review X 8, 021075, 2018).
#pragma once
#include <span>

#include "experiments/stretch.hpp"

namespace loopwright {

struct FitError {
  double rms = 0;    // N/m
  double share = 0;  // rms over the root mean square of the forces
  double worst = 0;  // the largest difference, N/m
};

struct PullLaw {
  double Y = 0, beta = 0, alpha = 0;  // N/m, N/m, 1
  FitError error;
  double operator()(double strain) const;
};

// Least squares over all points, Y and beta not below 0 (at beta = 0 alpha means nothing). Strains and forces
// of one pull, strains not below 0. Throws std::invalid_argument for fewer than four points, lists of unequal
// length or values that are not finite.
PullLaw fit_pull(std::span<const double> strain, std::span<const double> force);

struct MembraneLaw {
  double Cxx = 0, Cyy = 0, Cxy = 0, G = 0;  // N/m
  double beta_x = 0, alpha_x = 0, beta_y = 0, alpha_y = 0;
  FitError course, wale, shear;
};

// The same over a grid of strains. Throws as fit_pull, for fewer than eight points.
MembraneLaw fit_membrane(std::span<const StretchPoint> points);

struct SharedLockingLaw {
  double Cxx = 0, Cyy = 0, Cxy = 0;   // N/m
  double beta = 0, alpha = 0, r = 1;  // N/m, 1, 1
  FitError course, wale;
};

// Least squares over a grid of strains, beta not below 0, r from 0.05 to 20. Throws as fit_membrane.
SharedLockingLaw fit_shared_locking(std::span<const StretchPoint> points);

}  // namespace loopwright
