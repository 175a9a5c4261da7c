// The list of all energies. The derivative check runs over it, so an energy that is not here is not used.
#pragma once
#include <tuple>

#include "mechanics/energies/bend.hpp"
#include "mechanics/energies/contact.hpp"
#include "mechanics/energies/friction.hpp"
#include "mechanics/energies/plates.hpp"
#include "mechanics/energies/stretch.hpp"

namespace loopwright {
using AllEnergies = std::tuple<Stretch, Bend, Contact, Friction, Plates>;
}
