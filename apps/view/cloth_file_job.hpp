// Files of cloth in the window: saved states, which go on relaxing, and curves of other programs.
#pragma once
#include "cloth_job.hpp"
#include "piece.hpp"

namespace loopwright {

// Whether a file's suffix says that it holds cloth, not a notation.
bool names_cloth(const std::filesystem::path& file);

// As make_cloth(). A state of at most `most_loops` loops, or one that says that it is at rest, goes on
// relaxing; curves and larger states do where `most_loops` says that it was asked for.
void show_cloth_file(const ClothRequest& request, const std::atomic<bool>& cancelled, const ShowMoment& show);

}  // namespace loopwright
