// Contact law between two points of yarn at centreline distance D: a soft shell round a hard core.
//
//   phi(D) = k W^2 / (p (p - 1)) [ y^(1-p) - 1 + (1 - p)(1 - y) ],   y = (D - Dc) / W,   W = Do - Dc,   D <
//   Do phi(D) = 0                                                                                          D
//   >= Do
//
// Do: outer (soft) diameter, where contact begins; Dc: core diameter, where phi diverges; p > 1: how fast.
// Near Do it is k/2 (Do - D)^2 (continuous value and slope; integrated along two yarns the second derivative
// is continuous too). It is a density per length of both yarns: the energy of two yarns is the double
// integral of phi over their lengths, each pair counted once. k has the unit energy / length^4 (in the unit
// system of the model, B/d^5). Source of the form: measured yarn compression, Singal et al., Nature
// Communications 15, 2622 (2024).
#pragma once
#include <cmath>
#include <limits>

#include "mechanics/energies/lanes.hpp"

namespace loopwright {

struct ContactLaw {
  double outer = 1;        // Do
  double core = 0.5;       // Dc
  double stiffness = 400;  // k
  double exponent = 2.4;   // p

  struct Value {
    double energy = 0, slope = 0, curvature = 0;  // phi, d phi / dD, d2 phi / dD2
  };

  // For D < outer. At or inside the core the energy is infinite: such a state is never accepted.
  Value operator()(double D) const {
    const double W = outer - core, y = (D - core) / W;
    if (y <= 0) return {std::numeric_limits<double>::infinity(), 0, 0};
    const double p = exponent;
    const double y_p = std::exp(-p * std::log(y));  // y^-p
    Value v;
    v.energy = stiffness * W * W / (p * (p - 1)) * (y_p * y - 1 + (1 - p) * (1 - y));
    v.slope = -stiffness * W / p * (y_p - 1);
    v.curvature = stiffness * y_p / y;
    return v;
  }

  // The same for several distances at once.
  LOOPWRIGHT_INLINE void evaluate(const Lanes& D, Lanes& energy, Lanes& slope, Lanes& curvature) const {
    const double W = outer - core, p = exponent;
    const Lanes y = (D - core) / W, one = Lanes{} + 1.0, sound = y > 0.0 ? y : one;
    Lanes log_y, y_p;
    logarithm(sound, log_y);
    exponential(-p * log_y, y_p);
    const auto inside = y <= 0.0;
    energy = inside ? Lanes{} + std::numeric_limits<double>::infinity()
                    : stiffness * W * W / (p * (p - 1)) * (y_p * y - 1.0 + (1 - p) * (1.0 - y));
    slope = inside ? Lanes{} : -stiffness * W / p * (y_p - 1.0);
    curvature = inside ? Lanes{} : stiffness * y_p / sound;
  }

  // The same law for yarns whose mean diameter is `scale` times the reference.
  ContactLaw scaled(double scale) const { return {outer * scale, core * scale, stiffness, exponent}; }
};

}  // namespace loopwright
