// YarnGraph: yarns as ordered lists of loops, who is drawn through whom, and what each float passes.
// Geometry needs nothing else; positions here are in needles and courses, never in space.
#pragma once
#include <vector>

#include "machine/knitting_record.hpp"

namespace loopwright {

enum class StitchSide : std::int8_t {
  front = 1,
  rear = -1
};  // front: drawn from back to front (face stitch)

struct Loop {
  YarnId yarn;
  int order = -1;  // place in its yarn's list of loops
  LoopKind kind = LoopKind::knit;
  StitchSide side = StitchSide::front;  // bed on which it was formed
  Direction direction = Direction::right;
  double slot = 0;            // where it was formed, in needle pitches on the common axis
  double head_slot = 0;       // where its head was when its children were drawn through it (or at the end)
  Bed bed = Bed::front;       // formed on
  Bed head_bed = Bed::front;  // head last held on
  int pass = -1;              // carriage pass that formed it
  int head_rank = 0,
      head_count = 1;  // place of its head in its stack, 0 in front (+z), and how many lie there
  int instruction = -1, head_instruction = -1;  // formed; cast off or dropped (-1: still held)
  SourceLocation at;
  std::vector<LoopId> parents;   // drawn through these, stack order
  std::vector<LoopId> children;  // loops drawn through this one (several when plated)
  LoopFate fate = LoopFate::held;
};

// A held loop that a float passes: the float runs behind it on the front bed, in front of it on the back bed.
struct PassedLoop {
  LoopId loop;
  double slot = 0;  // where the float passes it
  Bed bed = Bed::front;
};

// The yarn between loop `order` and loop `order + 1` of a yarn.
struct Float {
  LoopId from, to;                 // either may be invalid at a yarn's ends
  std::vector<PassedLoop> passed;  // in yarn order; empty between neighbours
  std::vector<Needle> missed;      // needles named by miss instructions, in order
};

struct GraphYarn {
  CarrierId carrier;
  std::vector<LoopId> loops;  // in yarn order
  std::vector<Float> floats;  // floats[k] joins loops[k] and loops[k + 1]; size = loops.size() - 1
};

// Two loops whose legs cross, e.g. in a cable: `front` lies in front (+z) of `back`.
struct LegCrossing {
  LoopId front, back;
};

// What must be interlaced: the two feet of `child` pass through the head of `parent` with opposite signs.
struct Interlacing {
  LoopId parent, child;
  int sign =
      1;  // +1: front stitch, the child's first foot goes from back (-z) to front (+z) through the head
};

struct YarnGraph {
  std::vector<GraphYarn> yarns;
  std::vector<Loop> loops;
  std::vector<LegCrossing> leg_crossings;
  std::vector<Interlacing> interlacings;  // N of them; from the machine's record alone
  std::vector<LoopId> unheld;             // heads that nothing holds: dropped without a child, they will run
  std::vector<LoopId> left_on_needles;

  const Loop& loop(LoopId id) const { return loops[id.position()]; }
};

}  // namespace loopwright
