// Rails: carriers of one rail cannot pass each other. The Carriers header lists them from left to right, as
// in `L1,L2;R1,R2`.
#pragma once
#include "machine/knitting_record.hpp"

namespace loopwright {

/// Warns of the first carrier that goes past another of its rail.
void review_rails(const Program& program, const KnittingRecord& record, Diagnostics& diagnostics);

}  // namespace loopwright
