// Energy, gradient and Hessian of a whole fabric.
//
// Unknowns: a displacement u_i of every control point and a change g of the measures (width, height, skew),
// which carries all points along affinely: x_i = u_i + M_i g with M_i = [[xi, 0, eta], [0, eta, 0], [0, 0,
// 0]] and (xi, eta) the point's fractional coordinates, plus (m, n) for an image. Held points move with the
// measures only.
#pragma once
#include <algorithm>
#include <vector>

#include "mechanics/contact/segment_pairs.hpp"
#include "mechanics/contact_history.hpp"
#include "mechanics/energies/friction.hpp"
#include "mechanics/linear/block_matrix.hpp"
#include "mechanics/yarn_model.hpp"
#include "mechanics/yarn_twist.hpp"

namespace loopwright {

struct SegmentLanes;
struct SegmentLanesTerm;

struct EnergyParts {
  double stretch = 0, bend = 0, twist = 0, contact = 0, plates = 0;
  double friction = 0;  // work against friction since the last Hessian: not stored in the cloth
  double load = 0;      // of the loads on measures and points: minus load times place
  double stored() const { return stretch + bend + twist + contact + plates; }
  double total() const { return stored() + friction + load; }
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
  // The same sums, and [segment] what of them is stretch, bend and contact, of a pair at its first segment.
  EnergyParts energy(const YarnState& state, std::vector<double>& of_segments);
  // Gradient (zero for what is held) and full Hessian; rows and columns of what is held are those of the
  // identity. Only for the state that update_pairs() was last given: the pattern holds the pairs that are in
  // contact there. With friction this also takes down every contact's load, normal and place: until the next
  // call, energy() counts friction work from this state.
  EnergyParts hessian(const YarnState& state, Unknowns& gradient, BlockMatrix& hessian);
  // The same without the Hessian: half of the work.
  EnergyParts gradient(const YarnState& state, Unknowns& gradient);
  // dE/d(width, height, skew) of the cloth at the last Hessian's state, without loads: what the frame bears,
  // for measures that are not free as well.
  const Measures& measure_forces() const { return measure_forces_; }
  // The elastic slip of every contact that carries load, sorted like pairs(): friction's history, to go on
  // with.
  const ContactHistory& history() const { return remembered_; }
  void set_history(ContactHistory history) { remembered_ = std::move(history); }
  // Moves the friction history along: the cloth has gone from the last Hessian's state to this one.
  void accept(const YarnState& state);

  // The metric of steps, on the Hessian's pattern: squared relative motion of neighbouring control points
  // along the yarn and of segments in contact, plus a little of the motion itself. What makes a step untrue
  // is turning of yarn and sliding of contacts, so rigid and long-wave motion is all but free and step counts
  // need not grow with the piece.
  // `weights`: [control point] how many times more its motion against others counts; empty: once.
  void metric(BlockMatrix& hessian, const std::vector<float>& weights = {}) const;

  // Places of contact samples in the last state given.
  const SamplePlaces& places() const { return places_; }
  // Fractional coordinates (xi, eta) of the control points in a state.
  std::vector<std::array<double, 2>> fractions(const YarnState& state) const;
  // Gives back what every evaluation makes anew (places of samples and the like), for as long as a linear
  // solution needs the memory.
  void drop_places();
  // state + step, with the measures' affine part.
  YarnState moved(const YarnState& state, const Unknowns& step, double scale) const;

 private:
  struct FrictionContact {
    std::int32_t a = 0, b = 0;  // segments, b at lattice image (m, n)
    std::int8_t m = 0, n = 0;
    Friction law;
  };
  struct Chunk;
  EnergyParts with_friction(const YarnState& state, std::vector<double>* of_segments);
  EnergyParts terms(const YarnState& state, Unknowns* gradient, BlockMatrix* hessian,
                    std::vector<double>* of_segments = nullptr);
  FourNodes nodes_of(int segment) const;
  // Chunks are ranges of control points that depend on the fabric alone.
  int chunk_count() const { return std::clamp(model_.nodes / 3000, 1, 16); }
  std::int32_t first_of_chunk(int chunk) const {
    return static_cast<std::int32_t>(static_cast<std::int64_t>(model_.nodes) * chunk / chunk_count());
  }
  bool touches(const Chunk& chunk, int segment) const;
  void gather(const std::int32_t* segments, std::size_t count, bool fractions, SegmentLanes& to) const;
  void add_segments(Chunk& chunk) const;
  void add_plates(int segment, Chunk& chunk) const;
  void add_twist(int segment, Chunk& chunk) const;
  bool contact_input(const SegmentPair& pair, const Vec3& image, double reach, ContactPairInput& in) const;
  void add_contacts(Chunk& chunk);
  FrictionContact add_friction(const SegmentPair& pair, const YarnState& state, ContactTerm& term) const;
  void add_dyads(Unknowns& gradient, BlockMatrix* hessian);
  void scatter(const SegmentLanesTerm& term, std::size_t lane, int segment, Chunk& chunk) const;
  void scatter(const ContactTerm& term, const SegmentPair& pair, Chunk& chunk) const;
  Vec3 remembered_slip(const SegmentPair& pair) const;
  Vec3 relative_place(const FrictionContact& contact, const YarnState& state) const;
  void prepare(const YarnState& state);
  void find_moved();
  bool may_touch(const SegmentPair& pair, double reach, const YarnState& state) const;
  void build_pattern(BlockMatrix& hessian);
  void listed_pattern(BlockMatrix& hessian) const;
  bool in_contact(const SegmentPair& pair) const;
  double law_scale(int segment_a, int segment_b) const;

  const YarnModel& model_;
  YarnTwist twist_;
  std::vector<SegmentPair> pairs_;
  // Where the extended points and the lattice were when these were found; how far the samples of each segment
  // have moved since, at most.
  std::vector<Vec3> listed_;
  Measures listed_measures_{};
  std::vector<double> moved_;
  std::vector<std::int32_t> active_;       // pairs in contact in the last Hessian's state
  std::vector<FrictionContact> friction_;  // one for each of these, if there is friction
  ContactHistory remembered_;              // of the last accepted step
  std::vector<std::int32_t> diagonal_;     // places of the last Hessian's diagonal blocks
  std::vector<Vec3> extended_;
  SamplePlaces places_;
  std::vector<std::array<double, 2>> fraction_;  // [extended]
  Measures measure_forces_{};
};

}  // namespace loopwright
