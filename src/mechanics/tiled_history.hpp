// A piece that starts from its relaxed cell, as mechanics sees it: the contacts that it has copied and those
// that were cut off.
#pragma once
#include "geometry/start_from_cell.hpp"
#include "mechanics/contact_history.hpp"
#include "mechanics/yarn_model.hpp"

namespace loopwright {

// Friction's history of the piece: what holds the cell at rest holds the piece's inside too. Contacts with
// yarn that the piece does not have are left out.
ContactHistory tiled_history(const Fabric& cell, const ContactHistory& history, const StartFromCell& start);

// Holds the piece's yarn where yarn touches it in the cell that the piece does not have, so that the frame
// bears what was cut off. (The ring of loops that is held alone leaves such yarn free where loops reach over
// several courses, as tucks do: a full cardigan's lower edge then settled for forty steps.)
void hold_cut_contacts(const Fabric& cell, const ModelOptions& options, StartFromCell& start);

}  // namespace loopwright
