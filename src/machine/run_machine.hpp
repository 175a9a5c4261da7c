// The V-bed virtual machine: runs a programme instruction by instruction, as knitout's reference says, and
// records what every needle and carrier did. Impossible acts are told with their line and left out; the rest
// still runs.
#pragma once
#include "machine/knitting_record.hpp"

namespace loopwright {

// From here on a stack is told by review(). Machines take more, spacer fabrics reach 9.
inline constexpr int most_loops_on_needle = 4;
// A yarn that has gone past no more needles than these, as at the edge of a jacquard, is not caught there.
inline constexpr int most_needles_passed = 4;
// To the right of where the yarn inserting hook is parked.
inline constexpr int needles_behind_hook = 5;

// Time and memory linear in the number of instructions (a programme that racks by many needles with loops on
// both beds also pays for the needles that it carries past each other).
KnittingRecord run_machine(const Program& program, Diagnostics& diagnostics);

}  // namespace loopwright
