// Energy, gradient and Hessian of a whole fabric.
//
// Unknowns: a displacement u_i of every control point and a change g of the measures (width, height, skew), which carries
// all points along affinely: x_i = u_i + M_i g with M_i = [[xi, 0, eta], [0, eta, 0], [0, 0, 0]] and (xi, eta) the
// point's fractional coordinates, plus (m, n) for an image. Held points move with the measures only.
#pragma once
#include <vector>

#include "mechanics/contact/segment_pairs.hpp"
#include "mechanics/linear/block_matrix.hpp"
#include "mechanics/yarn_model.hpp"

namespace loopwright {

struct EnergyParts {
  double stretch = 0, bend = 0, contact = 0, plates = 0;
  double total() const { return stretch + bend + contact + plates; }
};

class Assembly {
 public:
  explicit Assembly(const YarnModel& model);

  // Finds the pairs of segments within `range`; later calls see contact only among these, so every state that
  // they are given must stay within half of (range - outer diameter) of this one.
  void update_pairs(const YarnState& state, double range);
  const std::vector<SegmentPair>& pairs() const { return pairs_; }

  // Infinite where two samples are inside a core.
  EnergyParts energy(const YarnState& state);
  // Gradient with held points' u-part set to zero and measures that are not free set to zero.
  EnergyParts gradient(const YarnState& state, Unknowns& gradient);
  // Gradient and full Hessian; rows and columns of what is held are those of the identity. Only for the state that
  // update_pairs() was last given: the pattern holds the pairs that are in contact there.
  EnergyParts hessian(const YarnState& state, Unknowns& gradient, BlockMatrix& hessian);

  // The metric of steps, on the Hessian's pattern: squared relative motion of neighbouring control points along the yarn and of
  // segments in contact, plus a little of the motion itself. What makes a step untrue is turning of yarn and sliding of
  // contacts, so rigid and long-wave motion is all but free and step counts need not grow with the piece.
  void metric(BlockMatrix& hessian) const;

  // Places of contact samples in the last state given.
  const SamplePlaces& places() const { return places_; }
  // Fractional coordinates (xi, eta) of the control points in a state.
  std::vector<std::array<double, 2>> fractions(const YarnState& state) const;
  // state + step, with the measures' affine part.
  YarnState moved(const YarnState& state, const Unknowns& step, double scale) const;

 private:
  EnergyParts terms(const YarnState& state, Unknowns* gradient, BlockMatrix* hessian);
  void prepare(const YarnState& state);
  void build_pattern(BlockMatrix& hessian) const;
  bool in_contact(const SegmentPair& pair) const;
  double law_scale(int segment_a, int segment_b) const;

  const YarnModel& model_;
  std::vector<SegmentPair> pairs_;
  std::vector<Vec3> extended_;
  SamplePlaces places_;
  std::vector<std::array<double, 2>> fraction_;  // [extended]
};

}  // namespace loopwright
