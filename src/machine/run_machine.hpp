// The V-bed virtual machine: runs a programme instruction by instruction, as knitout's reference says, and
// records what every needle and carrier did. Impossible acts are told with their line and left out; the rest
// still runs.
#pragma once
#include "machine/knitting_record.hpp"

namespace loopwright {

// What is possible but seldom meant is a warning beyond these.
inline constexpr int longest_float = 20;        // needles between two loops that the same yarn forms in turn
inline constexpr int most_loops_on_needle = 9;  // spacer fabrics reach nine

// Time and memory linear in the number of instructions (a programme that racks by many needles with loops on
// both beds also pays for the needles that it carries past each other).
KnittingRecord run_machine(const Program& program, Diagnostics& diagnostics);

}  // namespace loopwright
