// Passes of a programme as lines of letters: the first half of writing a Program as a fabric file.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "base/diagnostics.hpp"
#include "notation/program.hpp"
#include "notation/vermiculation.hpp"

namespace loopwright {

/// Which part of a programme is written: all of it, or one repeat of a fabric file.
struct Extent {
  std::size_t begin = 0, end = 0;  // instructions
  int first = 0, wales = 0;        // needles
  bool repeat = false;
  std::optional<Gating> gating;  // none: as most of the passes have it
};

struct DecompiledProgram {
  Vermiculation notation;          // rows no wider than need be, equal lines in brackets
  std::vector<CourseLine> wide;    // the same lines, each row as wide as the extent
  std::vector<std::size_t> begin;  // of each line, its first instruction
  std::vector<std::size_t> carrier_of_yarn;
};

/// What vermiculation cannot say is left out and told as a warning in `lost`.
DecompiledProgram decompile(const Program& program, const Extent& extent, Diagnostics& lost);

}  // namespace loopwright
