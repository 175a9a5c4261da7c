// Carriage: the traverses that a programme takes, and the carriers that it must kick out of the way.
//
// A carriage pass is a longest run of instructions of one kind, direction, carrier set, racking and stitch
// setting whose places advance strictly; transfers, drops and a-misses have no direction and come in any
// order. A carrier stays parked beyond the last needle of its pass, nobody knows how far. Whoever works on a
// needle that lies between a carrier's park and the needle that its yarn comes from has it kicked back first;
// so has a pass whose own carrier is parked on the side to which it goes. (Rules: the Shima converter's;
// `miss` moves a carrier as told and kicks nobody.)
#pragma once
#include <vector>

#include "machine/carriers.hpp"
#include "machine/racking.hpp"

namespace loopwright {

class Carriage {
 public:
  explicit Carriage(const Program& program) : parked_(program.carriers.size()) {}

  // A change of stitch or speed, a pause or a hook ends the pass that is under way.
  void end_pass() { open_ = false; }
  // An instruction acts on its needle with the yarns of `set`; before the carriers are moved.
  void act(const Instruction& instruction, int index, const std::vector<CarrierId>& set,
           const Racking& racking, Carriers& carriers);

  int passes() const { return passes_; }
  std::vector<KickBack>& kick_backs() { return kick_backs_; }

 private:
  struct Park {
    long long order = 0;               // somewhere beyond this place (Racking::order), ...
    Direction side = Direction::none;  // ... on this side of it
  };
  bool joins(const Instruction& instruction, const std::vector<CarrierId>& set, const Racking& racking) const;
  void kick(CarrierId id, int index, Needle needle, long long order, Direction side);
  void kick_others(int index, long long order, const std::vector<CarrierId>& set, const Racking& racking,
                   Carriers& carriers);

  std::vector<Park> parked_;  // by carrier; counts while the carrier stands at a needle
  std::vector<KickBack> kick_backs_;
  int passes_ = 0;
  // The pass that is under way.
  bool open_ = false;
  int kind_ = 0;
  Direction direction_ = Direction::none;
  std::vector<CarrierId> set_;
  Racking racking_;
  long long order_ = 0;
};

}  // namespace loopwright
