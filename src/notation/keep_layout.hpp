// A Program that came from a fabric file, written with that file's comments and layout.
#pragma once
#include <optional>

#include "notation/decompile.hpp"
#include "notation/program.hpp"
#include "notation/vermiculation.hpp"

namespace loopwright {

/// Whether two programmes have the same instructions, wherever these stand in their files.
bool same_instructions(const Program& a, const Program& b);

/// The program's notation as it was read, with headers changed where the program's settings, yarns or
/// carriers are not what the file says. Its instructions are not looked at.
Vermiculation notation_with_settings(const Program& program);

/// The program's notation with the lines changed whose instructions were changed: what the file's other lines
/// say is kept as it is written. `extent` as for decompile; one that is no repeat writes every repeat.
/// Nothing where layout and instructions cannot be brought together. Whether the result makes the programme's
/// instructions is for the caller to try.
std::optional<Vermiculation> notation_with_changes(const Program& program, const Extent& extent);

/// The needles of the piece that the program's notation is knitted to; nothing if it cannot be knitted.
std::optional<Extent> needles_of_notation(const Program& program);

}  // namespace loopwright
