// The knitout reader: text of a version-2 knitout file to a Program.
// Specification: https://textiles-lab.github.io/knitout/knitout.html (document version 0.6).
#pragma once
#include <string_view>

#include "base/diagnostics.hpp"
#include "notation/program.hpp"

namespace loopwright {

inline constexpr int largest_needle = 10'000;                 // needle indices run from -largest_needle to it
inline constexpr std::size_t most_carriers = 100;             // of one programme
inline constexpr std::size_t most_instructions = 20'000'000;  // of one programme

/// Reads a knitout file. Whatever is wrong is said in `diagnostics` with line, column and remedy; a line with
/// an error is left out and reading goes on, so the Program holds every instruction that was understood, in
/// file order. Only the form is checked: whether a carrier is in or a transfer is aligned is the machine's to
/// say. Forms that knitout defines as another operation stay as written: `knit` with no carriers (a drop),
/// `tuck` with none (an amiss), `split` with none (a transfer). `;!source:` marks are kept in
/// Program::source_marks.
Program read_knitout(std::string_view text, Diagnostics& diagnostics);

}  // namespace loopwright
