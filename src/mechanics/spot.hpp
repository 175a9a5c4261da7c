// A spot of a piece (hot_spots.hpp) as a model of its own, cut out of the piece's and put back.
#pragma once
#include <map>
#include <span>

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

// Friction's history while spots change some of it: what a spot has changed is kept beside the rest, which
// may be long, until all are done.
class ChangedHistory {
 public:
  explicit ChangedHistory(const ContactHistory& before) : before_(before) {}
  // What friction knows of the contacts inside the spot, by its own segments.
  ContactHistory inside(const Spot& spot) const;
  // Contacts of which at least one side may have moved, as they are now.
  void put_back(const Spot& spot, const ContactHistory& own);
  ContactHistory whole() const;

 private:
  std::span<const ContactSlip> of(std::int32_t segment) const;  // those whose first segment this is

  const ContactHistory& before_;
  std::map<std::int32_t, ContactHistory> changed_;  // by first segment: all of its contacts
};

}  // namespace loopwright
