// The twist of every yarn of a fabric (energies/twist.hpp), followed from state to state by the area that its
// tangents sweep. Where it starts is the twist of yarn that was straight, was laid without turning and
// went into its shape the short way: the area between its tangents and the directions in which it runs from
// loop to loop.
#pragma once
#include <vector>

#include "mechanics/energies/twist.hpp"
#include "mechanics/linear/block_matrix.hpp"
#include "mechanics/yarn_model.hpp"

namespace loopwright {

class YarnTwist {
 public:
  explicit YarnTwist(const YarnModel& model);

  bool counts() const { return counts_; }  // does any yarn resist twist?
  // Finds the twist in a state from that in the one last settled in (without one, from straight yarn).
  // `extended`: its control points, as YarnModel::base lists them. A tangent must not turn by more than half
  // a turn in between.
  void measure(const YarnState& state, const std::vector<Vec3>& extended);
  // Takes the state last measured as the one to go on from.
  void settle();

  // Of the state last measured.
  double energy() const;
  double couple(std::size_t yarn) const;  // C (psi L + Theta) / L
  // [yarns that resist twist] what of the energy's second derivative couples all of a yarn: C / L times the
  // dyad of dTheta. The rest is couple() times the second derivative of Theta, segment by segment.
  std::vector<Dyad> dyads(const std::vector<Vec3>& extended,
                          const std::vector<std::array<double, 2>>& fractions) const;

 private:
  double first_turn(const YarnModel::Yarn& yarn, const YarnState& state,
                    const std::vector<Vec3>& extended) const;
  Vec3 running(const YarnModel::Yarn& yarn, const YarnState& state, const std::vector<Vec3>& extended,
               int segment, std::size_t end) const;

  const YarnModel& model_;
  bool counts_ = false;
  std::vector<double> angle_, settled_angle_;  // [yarn] psi L + Theta
  std::vector<ArcEnds> tangents_, settled_;    // [segment] of yarns that resist twist
  std::vector<double> swept_;                  // [segment]
};

}  // namespace loopwright
