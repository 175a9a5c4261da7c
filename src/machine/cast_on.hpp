// Which needles a pattern needs cast on, and in which passes.
#pragma once
#include <vector>

#include "machine/knitting_record.hpp"
#include "machine/racking.hpp"

namespace loopwright {

struct CastOn {
  std::vector<Needle> needles;  // from left to right, front before rear
  bool beds_apart = false;      // no pass of the pattern knits on both beds
  Racking racking;              // at which the pattern starts to knit
};

/// Looks at the instructions of the first repeat of a fabric file; `record` is what it knits.
CastOn cast_on_of(const Program& fabric, const KnittingRecord& record);

/// One pass: its needles from left to right.
struct CastOnPass {
  std::vector<Needle> needles;
  Direction direction = Direction::right;
};
/// Every other needle, then the rest; the first pass holds the needle that it comes to first. Beds that are
/// apart are knitted front to the right and rear to the left, as a tube is.
std::vector<CastOnPass> cast_on_passes(const CastOn& cast_on, Direction first);

}  // namespace loopwright
