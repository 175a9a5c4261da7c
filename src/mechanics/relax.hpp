// Equilibrium of a fabric: the yarn is grown in, then Newton's method brings every force to rest.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "mechanics/newton.hpp"
#include "mechanics/yarn_model.hpp"

namespace loopwright {

struct RelaxProgress {
  std::string phase;  // "grow-in" or "relax"
  int newton_iterations = 0;
  double residual = 0;               // largest force on a control point, B/d^2
  double radius = 1;                 // share of the full yarn radius
  const YarnState* state = nullptr;  // where the yarn is; to be looked at until the callback returns
};

struct RelaxOptions {
  ModelOptions model;
  double tolerance = 2e-4;  // largest force on a control point that counts as rest, B/d^2
  int most_iterations = 1500;
  bool grow_in = true;  // start with a thin yarn; false: the fabric is a saved state at full radius
  // Finite pieces lie between two plates, this far (in d) beyond the first geometry's centrelines: plain
  // cloth curls otherwise. Negative: no plates. Periodic cells need none. `model.plates`, if they have a
  // stiffness, stand where they are: a piece that is gone on with keeps its own.
  double plate_room = 0.25;
  // Share of its curvature at rest that the yarn keeps as the shape it has when unloaded, 0 to 1 (steaming,
  // days of rest): relaxed, set there (set_yarn()) and relaxed again. A fabric whose yarn is set already
  // keeps what it has.
  double set = 0;
  ContactHistory history;  // of the run that this one goes on from; empty: contacts start unloaded
  // Called after every iteration; returning false stops the run (what was reached is returned, not
  // converged).
  std::function<bool(const RelaxProgress&)> on_progress;
};

struct RelaxResult {
  Fabric fabric;
  EnergyParts energy;           // B/d
  double residual = 0;          // largest force on a control point, B/d^2
  double measure_residual = 0;  // largest dE/d(width or height) of one wale or course, B/d^2
  int newton_iterations = 0, linear_iterations = 0, factorisations = 0;
  int spot_iterations = 0;    // Newton steps of places settled by themselves (hot_spots.hpp)
  Measures measure_forces{};  // dE/d(width, height, skew), B/d^2, of measures that are held as well
  ContactHistory history;     // friction's, for a run that goes on from here
  FlatPlates plates;          // between which a finite piece lies; stiffness 0: none
  bool converged = false, stopped = false;
  int pass_throughs = 0;  // steps that could not be certified free of crossings: 0, or the result is broken
  std::string message;    // why it ended, in words
};

// Plates so far (d) beyond the outermost control points along z, and plates a gap apart round their middle.
FlatPlates plates_round(const Fabric& fabric, double room);
FlatPlates plates_apart(const Fabric& fabric, double gap);

// Steps, iterations, factors and uncertified steps of a run that `to` went on from.
void add_counts(RelaxResult& to, const RelaxResult& from);

// The fabric with its yarn set in the shape that it has: `share` of the curvature of its centrelines becomes
// their natural curvature; 0: straight. Throws std::invalid_argument for a share outside 0 to 1.
Fabric set_yarn(Fabric fabric, double share);

// Throws std::invalid_argument on non-finite input or yarn data out of range.
RelaxResult relax(const Fabric& fabric, const RelaxOptions& options);

}  // namespace loopwright
