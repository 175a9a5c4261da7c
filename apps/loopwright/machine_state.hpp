// What the machine stage found, loop by loop and carrier by carrier, as JSON for another program to check.
#pragma once
#include "outputs/write_json.hpp"
#include "pipeline.hpp"

namespace loopwright {

// `file`, `accepted`, `errors` ([line, message] pairs), and what was knitted. Lines are those of the file.
// What there is of a programme with errors is given too.
//   loops_at_end   {needle: [[carrier, line], ...]} in stack order, oldest in the hook first
//   stack_heights  {needle: loops on it at the end}; empty needles are left out
//   most_stack     loops in the highest stack that was cast off, dropped or left
//   carriers       {carrier: {last_used_at: needle and side ("f3+") or null, active: still in at the end}}
//   loops_made
//   loops          one line of words a loop, in the order formed: its carrier and line; every needle it came
//                  onto, with the line, as f3@40; `through` and the places in this list of its parents, if it
//                  has any; and its end, cast_off@60, dropped@60 or held
//   uses           one line of words a step of a carrier, in file order: the line, the carrier, the needle it
//                  was beside before (`in` for a yarn's first step) and its position after
JsonObject machine_state(const Diagnostics& diagnostics, const Knitting& knitting);

}  // namespace loopwright
