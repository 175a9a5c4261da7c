// The passes of a programme: runs of instructions that one traverse of the carriage makes.
#pragma once
#include <vector>

#include "notation/program.hpp"

namespace loopwright {

/// Needle instructions [begin, end) of Program::instructions, with machine state between them: stitches,
/// tucks and misses in one direction by the same carriers at one racking, needle by needle, or transfers and
/// drops at one racking of which none uses a needle twice.
struct ProgramPass {
  std::size_t begin = 0, end = 0;
  double racking = 0;
  int course =
      1;  // counted from 1; feeders that follow one another share one, a feeder that comes again starts one
  bool yarn = false;
};

std::vector<ProgramPass> passes_of(const Program& program);

/// Whether it lays yarn or takes a carrier past a needle.
bool carries_yarn(const Instruction& instruction);

}  // namespace loopwright
