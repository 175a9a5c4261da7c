// What a fabric is like when it is measured depends, with friction, on what it went through: it was knitted
// at the pitch of the needles, under take-down, hung below them while the next courses were made, was let go,
// and pulled straight by hand; and it is measured flat.
#pragma once
#include "mechanics/relax.hpp"

namespace loopwright {

struct KnittingHistory {
  double machine_width_mm = 0;  // of the fabric (cell, piece in a frame) on the needles
  double take_down_N = 0;  // pull along the wales on that width, while it is on the needles and below them
  // Kept flat, on the needles and after: between plates that leave the outermost centrelines so far apart; 0:
  // not at all. A jersey rolls up if it may, and no ruler is laid to cloth like that.
  double flat_gap_mm = 0;
  double hand_pull_N_m = 0;  // tension along the courses and the wales at once, let go again; 0: not pulled
};

struct KnittedRest {
  RelaxResult on_machine;  // at rest on the needles
  RelaxResult hanging;     // below them: still under take-down, as wide as it likes
  RelaxResult relaxed;     // let go; its counts of steps are those of all
};

// `first`: a first geometry of a periodic cell, or of a piece whose frame can move. Relaxed between the
// plates with the machine's width and take-down (set there, if options.set says so), then with its width free
// under the take-down, then free, then pulled both ways and let go, friction keeping its history. Throws
// std::invalid_argument for a history that cannot be, for a load without the yarn's reference_bend_N_m2, and
// like relax().
KnittedRest relax_as_knitted(const Fabric& first, const RelaxOptions& options,
                             const KnittingHistory& history);

// On from where a run ended, friction's history with it, under another load; counts are those of the whole
// way, and it has converged if both have. `options.grow_in` must be off. Throws like relax().
RelaxResult relax_on(const RelaxResult& from, RelaxOptions options, const Measures& load);

}  // namespace loopwright
