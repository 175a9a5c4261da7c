// From the structure that a fabric file says to a programme that a machine can knit: carriers come in and are
// held, needles are cast on, the pattern follows as it stands, the end is bound off or dropped, carriers go
// out.
//
// Cast-on: the needles whose first act in the pattern's first repeat forms a loop get one before it, every
// other needle on the way out and the rest on the way back. Where no pass knits on both beds the beds are
// cast on one after the other round and round, so that a tube stays open. Further carriers are tucked in here
// and there over the cast-on. So the pattern's own loops keep their yarns, order, parents and floats; the
// first ones are drawn through the cast-on.
#pragma once
#include "machine/machine_rules.hpp"

namespace loopwright {

struct KnittableProgram {
  Program program;
  int pattern_begin = 0, pattern_end = 0;  // instructions of the pattern
  int cast_on_needles = 0;
};

/// `fabric` is a fabric file read with free or bound-off edges: there is no margin to knit. A machine that
/// has too few carriers is told as an error; what else it cannot do is for check_machine_rules to say.
KnittableProgram make_knittable(const Program& fabric, MachineKind machine, Diagnostics& diagnostics);

}  // namespace loopwright
