#include "machine/carriage.hpp"

#include <algorithm>

namespace loopwright {
namespace {

// What can share a pass.
enum Kind : int { yarn, dropping, a_missing, transferring, to_sliders, from_sliders, splitting };

Kind kind_of(const Instruction& instruction, bool has_yarn) {
  switch (instruction.op) {
    case Op::knit:
      return has_yarn ? yarn : dropping;
    case Op::drop:
      return dropping;
    case Op::tuck:
      return has_yarn ? yarn : a_missing;
    case Op::amiss:
      return a_missing;
    case Op::split:
      if (has_yarn) return splitting;
      [[fallthrough]];
    case Op::xfer:
      if (is_slider(instruction.target.bed)) return to_sliders;
      return is_slider(instruction.needle.bed) ? from_sliders : transferring;
    default:
      return yarn;
  }
}

Direction opposite(Direction direction) {
  return direction == Direction::right ? Direction::left : Direction::right;
}

}  // namespace

bool Carriage::joins(const Instruction& instruction, const std::vector<CarrierId>& set,
                     const Racking& racking) const {
  if (!open_ || kind_ != kind_of(instruction, !set.empty()) || !(racking == racking_)) return false;
  if (set.empty()) return true;
  const long long order = racking.order(instruction.needle);
  return set == set_ && instruction.direction == direction_ &&
         (direction_ == Direction::right ? order > order_ : order < order_);
}

void Carriage::act(const Instruction& instruction, int index, const std::vector<CarrierId>& set,
                   const Racking& racking, Carriers& carriers) {
  const long long order = racking.order(instruction.needle);
  if (instruction.op != Op::miss) kick_others(index, order, set, racking, carriers);

  if (!joins(instruction, set, racking)) {
    // Its own carriers must come from the side that the pass starts from.
    const Direction from = opposite(instruction.direction);
    for (CarrierId id : set) {
      if (!carriers[id].at) continue;  // it is just brought in
      const Park& park = parked_[id.position()];
      const bool beyond = from == Direction::left ? park.order > order : park.order < order;
      if (park.side != from || beyond) kick(id, index, instruction.needle, order, from);
    }
    ++passes_;
    open_ = true;
    kind_ = kind_of(instruction, !set.empty());
    direction_ = instruction.direction;
    set_ = set;
    racking_ = racking;
  }
  order_ = order;
  for (CarrierId id : set) parked_[id.position()] = {order, instruction.direction};
}

void Carriage::kick_others(int index, long long order, const std::vector<CarrierId>& set,
                           const Racking& racking, Carriers& carriers) {
  if (carriers.active().size() == set.size()) return;  // those of the set are all there are
  for (CarrierId id : carriers.active()) {
    const Carrier& carrier = carriers[id];
    if (!carrier.at || std::find(set.begin(), set.end(), id) != set.end()) continue;
    // Its yarn comes from beside `at`, in quarter pitches; the needle that acts has a whole number of halves.
    const long long comes_from = 2 * racking.order(*carrier.at) + static_cast<int>(carrier.side);
    const Direction side = comes_from < 2 * order ? Direction::left : Direction::right;
    const Park& park = parked_[id.position()];
    const bool clear =
        park.side == side && (side == Direction::left ? park.order <= order : park.order >= order);
    if (!clear) kick(id, index, *carrier.at, racking.order(*carrier.at), side);
  }
}

void Carriage::kick(CarrierId id, int index, Needle needle, long long order, Direction side) {
  kick_backs_.push_back({index, id, needle, side});
  parked_[id.position()] = {order, side};
  ++passes_;
  open_ = false;
}

}  // namespace loopwright
