// A spot of a piece (hot_spots.hpp) as a model of its own, cut out of the piece's and put back.
#pragma once
#include "mechanics/contact_history.hpp"
#include "mechanics/yarn_model.hpp"

namespace loopwright {

// A part of the piece as a model of its own: what moves, and the yarn round it, held.
struct Spot {
  YarnModel model;
  YarnState state;
  std::vector<std::int32_t> node_of, segment_of;  // of the piece
  std::vector<std::int32_t> segment_in;           // [segment of the piece] here, or -1
};

// Of the piece's `segments`, in any order; control points that do not move (moves: [node of the piece]) are
// held.
Spot cut_out(const YarnModel& whole, const YarnState& state, const std::vector<std::uint8_t>& moves,
             std::vector<std::int32_t> segments);
// What friction knows of the contacts inside the spot, by its own segments.
ContactHistory history_in(const Spot& spot, const ContactHistory& history);
// Places and contacts of the spot as they are now; contacts of which neither side could move stay as they
// were.
void put_back(const Spot& spot, const ContactHistory& own, YarnState& state, ContactHistory& history);

}  // namespace loopwright
