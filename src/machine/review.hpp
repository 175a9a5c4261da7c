// What a knitter would say of a programme that runs: warnings for what is possible but seldom meant, advice
// for what is usual but may go wrong on the machine. Each kind is said once, with its first place and how
// often it occurs, so that a long programme does not drown in them.
#pragma once
#include "machine/knitting_record.hpp"

namespace loopwright {

inline constexpr int longest_float = 20;      // needles between two loops that the same yarn forms in turn
inline constexpr double largest_racking = 4;  // what most machines do without a thought
inline constexpr int longest_wait = 1000;     // instructions from `in` to the first use

/// `record` must be what run_machine gave for `program`. A fabric file says the structure alone, so its
/// cast-on and its end are not looked at: `loopwright convert` makes them.
void review(const Program& program, const KnittingRecord& record, Diagnostics& diagnostics);

}  // namespace loopwright
