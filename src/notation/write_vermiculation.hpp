// The text of a fabric file: from its parsed form, and from a Program where vermiculation can say it.
#pragma once
#include <string>

#include "base/diagnostics.hpp"
#include "notation/vermiculation.hpp"

namespace loopwright {

/// The notation as text. A line of the file that still says what the data say stands as it was written, with
/// its blanks, groups and comments, so text -> parse_vermiculation -> write_vermiculation changes nothing but
/// line ends. A line that was changed is written anew in the canonical way of docs/notation.md, its comment
/// kept; a bracket whose copies no longer agree is opened. parse_vermiculation of the result gives
/// `notation` again (same_notation).
std::string write_vermiculation(const Vermiculation& notation);

/// One course line in the canonical way.
std::string write_course(const CourseLine& line, const std::vector<VermiculationYarn>& yarns);

/// Whether two notations say the same: headers, yarns and lines, wherever they stand in their files.
bool same_notation(const Vermiculation& a, const Vermiculation& b);
bool same_course(const CourseLine& a, const CourseLine& b);

/// The Program as a fabric file. Knitted to its size this makes the same loops on the same needles by the
/// same yarns in the same order, and the same transfers, counted from the left-most needle used. What
/// vermiculation cannot say (drops of loops, splits, sliders, the hook, stitch values, a carrier that comes
/// in again, ...; docs/notation.md has the list) is left out and told as a warning in `diagnostics` with its
/// place; the text is knitted again and compared, so without a warning nothing of that was lost. A Program
/// that came from a fabric file gets its repeat, size and edges back, not its comments. An error, and no
/// text, for a programme that knits nothing or that is too wide or too long for a fabric file.
std::string write_vermiculation(const Program& program, Diagnostics& diagnostics);

}  // namespace loopwright
