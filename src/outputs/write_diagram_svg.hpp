// Needle diagrams drawn on point paper: the running thread of each pass round, behind or into the needles.
#pragma once
#include <filesystem>
#include <string>

#include "notation/needle_diagram.hpp"

namespace loopwright {

/// The drawing as SVG in mm. A dot is a needle, a row of dots a bed seen from above, front bed below, rear
/// bed above it where it works; a line of graph is a pass, the first at the bottom. The yarn closes a loop
/// round a needle that knits, goes into the hook of one that tucks and past one that misses; a cross is an
/// inactive needle, an upright arrow a transfer (dashed where the notation leaves it unsaid), a level arrow
/// along the rear bed a racking. The pitch is 7 mm, or less, down to 2.6 mm, where that lets the drawing fit
/// the text area of an A4 page (186 mm x 273 mm), in up to four columns of courses where there are many
/// lines; a larger one gets a larger sheet.
std::string diagram_svg(const NeedleDiagram& diagram);

/// Writes it; `-` is standard output. Throws FileError.
void write_diagram_svg(const std::filesystem::path& path, const NeedleDiagram& diagram);

}  // namespace loopwright
