// Places of a large piece where yarn is far from rest while all else is near it: a leg that was pressed
// almost to the core of another by a step that was good for all the others, a loop that snapped past one.
// Newton's method would go on for them alone, with the whole piece. Here each is brought to rest by itself,
// everything round it standing still, before the next step of the whole (nonlinear elimination: Lanzkron,
// Rose and Wilkes, SIAM Journal on Scientific Computing 17, 538 (1996)).
#pragma once
#include "mechanics/assembly.hpp"

namespace loopwright {

struct SpotsReport {
  int spots = 0;           // brought nearer to rest
  int iterations = 0;      // Newton steps of theirs
  ContactHistory history;  // friction's, of the piece, after them; of no spot: not filled
};

// Not in periodic cells, where yarn resists twist or closes on itself: a spot cannot tell what that does.
bool may_have_hot_spots(const YarnModel& model);

// `gradient` belongs to `state`; friction's history goes along. Steps are certified as those of the piece
// are: a spot whose steps are not, or that would leave the yarn known round it, stays as it was. Does nothing
// where forces are spread over the piece, and where there can be no spots.
SpotsReport settle_hot_spots(const YarnModel& model, const Unknowns& gradient, double tolerance,
                             YarnState& state, const ContactHistory& history);

}  // namespace loopwright
