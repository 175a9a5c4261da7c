// How large a piece a notation is knitted to: repeat, size, margins, gating.
#pragma once
#include <optional>

#include "base/diagnostics.hpp"
#include "notation/vermiculation.hpp"

namespace loopwright {

struct PiecePlan {
  Edges edges = Edges::held;
  Gating gating = Gating::opposite;
  int repeat_wales = 1, repeat_courses = 1;  // of the notation
  int wales = 0, courses = 0;                // wanted
  int margin_wales = 0, margin_courses = 0;  // on each side, whole repeats
  // A notation that is knitted once, as it stands: what follows its last course is done as well.
  bool whole = false;
  int first = 0, last = 0;  // needles of the piece with its margins: [first, last)
};

/// Fills edges, size and repeat of `settings` as well. Nothing if there is no piece: `diagnostics` says why,
/// or holds errors already.
std::optional<PiecePlan> plan_piece(const Vermiculation& source, const FabricOptions& options,
                                    FabricSettings& settings, Diagnostics& diagnostics);

}  // namespace loopwright
