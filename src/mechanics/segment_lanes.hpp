// Stretch and bend of several segments at once, each in a lane of its own: what Assembly sums.
#pragma once
#include "mechanics/energies/bend.hpp"
#include "mechanics/energies/stretch.hpp"
#include "mechanics/linear/block_matrix.hpp"

namespace loopwright {

struct SegmentLanes {
  std::array<std::array<Lanes, 3>, 4> points;  // control points, d
  StretchOf<Lanes> stretch;
  BendOf<Lanes> bend;  // its `natural` is set where these are evaluated
  bool set = false;
  std::array<Lanes, 4> natural_curvature;         // counts if set
  std::array<std::array<Lanes, 2>, 4> fractions;  // (xi, eta) of the control points; for derivatives only
};

struct SegmentLanesTerm {
  Lanes stretch, bend;  // energies
  std::array<std::array<Lanes, 3>, 4> gradient;
  // [lane]: as SegmentBlocks has them, each in one piece as the matrix has it.
  std::array<std::array<Block, 10>, lanes> blocks;
  // The Hessian times M = [[xi, 0, eta], [0, eta, 0], [0, 0, 0]] of all points: [lane], by point; M' times
  // that; M' times the gradient.
  std::array<std::array<Block, 4>, lanes> border;
  std::array<Lanes, 9> corner;
  std::array<Lanes, 3> measures;
};

void evaluate(const SegmentLanes& segments, SegmentLanesTerm& term);
void energies(const SegmentLanes& segments, Lanes& stretch, Lanes& bend);

}  // namespace loopwright
