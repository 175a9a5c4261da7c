// The loop-scale model in the hand: masses that are pulled with the mouse, let go, and come to rest.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "loop_scale/loop_model.hpp"
#include "loop_scale/settle.hpp"
#include "outputs/structure_picture.hpp"
#include "pipeline.hpp"

namespace loopwright {

class LoopMotion {
 public:
  // Throws std::invalid_argument as build_loop_model() does. `places`: held.
  LoopMotion(const Knitting& knitting, const std::vector<PiecePlace>& held);

  // Goes on by so many stable steps; false once nothing moves.
  bool advance(int steps);
  void reset();  // back to the start

  // The mass nearest to a line of sight within `reach` (d), the foremost of several.
  std::optional<std::size_t> mass_at(const Vec3& from, const Vec3& direction, double reach) const;
  // The letter of a loop that is drawn through the mass's binding point, or held by it.
  SourceLocation letter_at(std::size_t mass) const;
  void grab(std::size_t mass);      // it stays where it is put
  void grab_edge(PiecePlace edge);  // all masses of an edge go together
  void move_grabbed(const Vec3& by);
  void let_go();
  bool grabbed() const { return !grabbed_.empty(); }

  const LoopModel& model() const { return model_; }
  const NetState& state() const { return state_; }
  StructureScene scene(StructureStyle style) const { return structure_scene(model_, state_, style); }
  // Largest force on a free mass and fastest mass, in shares of the net's own scales as settle() has them.
  double force() const { return force_; }
  double speed() const { return speed_; }

 private:
  void rebuild();
  void measure();

  const YarnGraph graph_;
  LoopModel model_;
  std::vector<Clamp> held_;  // without the hand
  std::vector<std::int32_t> grabbed_;
  std::unique_ptr<NetKernel> kernel_;
  NetState state_;
  double force_ = 1, speed_ = 1;
};

}  // namespace loopwright
