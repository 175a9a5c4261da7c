// KnittingRecord: what every needle and carrier of the V-bed did, as found by running a Program.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "notation/program.hpp"

namespace loopwright {

// A loop's stay on a needle. `slot` is the needle's place on the common axis, in needle pitches: front i ->
// i, back i -> i + racking (the exact racking, so an all-needle racking gives half-way places).
struct Placement {
  int instruction = -1;  // index into Program::instructions when it came onto this needle
  Needle needle;
  double slot = 0;
};

enum class LoopKind : std::uint8_t {
  knit,     // drawn through the loops that were on the needle (its parents)
  cast_on,  // knitted on an empty needle: no parents
  tuck,     // laid on a needle over what it holds
  split     // drawn through its parents, which went to the opposite needle instead of being cast off
};

enum class LoopFate : std::uint8_t { cast_off, dropped, held };  // held: still on a needle at the end

struct LoopRecord {
  YarnId yarn;
  LoopKind kind = LoopKind::knit;
  Direction direction = Direction::right;  // of the carrier when it was formed
  int instruction = -1;
  int pass = -1;  // carriage pass that formed it
  // A tuck made against the way that its yarn was travelling: its two legs cross. (Whoever draws a stitch
  // through held loops pulls its yarn straight, so only tucks stay so.)
  bool twisted = false;
  bool on_empty_needle = false;       // nothing was on its needle: a cast-on, knitted or tucked
  double racking = 0;                 // when it was formed
  std::vector<Placement> placements;  // where it was formed, then every needle it was moved to
  std::vector<LoopId> parents;  // loops that it was drawn through, in stack order (oldest in the hook first)
  LoopFate fate = LoopFate::held;
  int fate_instruction = -1;  // what cast it off or dropped it; -1 while held

  const Placement& formed() const { return placements.front(); }
  const Placement& last() const { return placements.back(); }
};

// What a yarn met, in order: a loop, or a needle that it passed without a loop (miss).
struct YarnStep {
  LoopId loop;  // invalid for a miss
  Needle needle;
  double slot = 0;
  Direction direction = Direction::right;
  int instruction = -1;
  // Beside it the carrier stood just before, after transfers took it along; first step of a yarn: `needle`.
  Needle from;
};

struct YarnRecord {
  CarrierId carrier;
  std::vector<YarnStep> steps;  // a carrier taken out and in again starts a new yarn
  int in_instruction = -1, out_instruction = -1;
};

// Two loops whose left-right order at the end differs from that at first, because racking carried them past
// each other while they were on opposite beds: the one on the front bed passed in front. `front_moved`: +1 if
// it moved to the right relative to the other, -1 to the left. Passings that undid each other are left out;
// two loops wound round each other have several entries, the fronts taking turns. `instruction`: what moved
// or cast off one of them after the last passing, in whose order the list is.
struct LoopCrossing {
  LoopId front, back;
  int front_moved = 0;
  int instruction = -1;
};

// Where a carrier was at the end, or when it was last taken out; after transfers took it along.
struct CarrierPlace {
  std::optional<Needle> needle;  // none: never used
  Direction side = Direction::none;
  bool in = false;  // still in at the end
};

// The carriage passes a carrier that is in the way to the other side of its needle, before an instruction
// acts: `side` of the needle that its yarn comes from, or of the first needle of its own pass.
struct KickBack {
  int instruction = -1;  // before this one
  CarrierId carrier;
  Needle needle;
  Direction side = Direction::none;
};

// Acts that are possible but seldom meant, counted as they happen; `review` makes sentences of them.
struct Acts {
  int count = 0;
  int first = -1;     // instruction of the first one
  Needle needle;      // of the first one
  int highest = 0;    // stacks: most loops
  CarrierId carrier;  // caught yarn: whose
};

// The loops that a needle holds at some time, in stack order, first in the hook first.
struct NeedleStack {
  Needle needle;
  std::vector<LoopId> loops;
};

// A change of the racking; re-stated rackings are no change.
struct RackingChange {
  int instruction = -1;
  double racking = 0;  // from this instruction on
};

struct KnittingRecord {
  std::vector<LoopRecord> loops;  // in the order in which they were formed
  std::vector<YarnRecord> yarns;
  std::vector<LoopCrossing> crossings;
  std::vector<RackingChange> rackings;  // in time order; the racking is 0 before the first
  std::vector<NeedleStack> held;        // at the end, by needle
  // The stack in which each loop was when it was cast off, dropped or left at the end: `stack_rank` counts
  // from the front of the fabric (+z) to its back, 0 in front; `stack_height` is the number of loops that lay
  // there.
  std::vector<int> stack_rank, stack_height;
  int passes = 0;                      // runs of yarn in one direction: LoopRecord::pass counts these
  int carriage_passes = 0;             // traverses of the carriage, transfers and kick-backs included
  std::vector<CarrierPlace> carriers;  // by CarrierId
  std::vector<KickBack> kick_backs;    // in time order
  Acts drops_of_empty, transfers_of_empty, tall_stacks, caught_yarns, hook_blocked, hook_to_right;
};

}  // namespace loopwright
