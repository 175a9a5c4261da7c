// What one make of machine asks of a programme beyond knitout: its carriers, rackings, widths and hooks. The
// rules are those of the makers' public converters (knitout-backend-swg for Shima Seiki,
// knitout-backend-kniterate); each is told as an error, since that converter would stop at it.
//
// The machine itself (run_machine) is not asked: a programme is good for a machine if both say no error.
#pragma once
#include <optional>
#include <string_view>

#include "machine/knitting_record.hpp"

namespace loopwright {

enum class MachineKind : std::uint8_t { shima, kniterate };

struct MachineLimits {
  std::string_view name;  // as people write it
  int carriers = 0;       // named 1, 2, ...; the Carriers header lists them all
  int width = 0;          // needles of a bed, unless the Width header says otherwise
  double all_needle = 0;  // the fraction of a racking at which all needles knit
  std::optional<double> farthest_racking;
  int yarns_in_a_stitch = 1;  // plating
  bool has_hook = false, has_sliders = false;
  bool has_stitch_table = false;  // stitch and speed values are places in tables of the machine
};

MachineLimits limits_of(MachineKind machine);
/// "shima" or "kniterate"; nothing for anything else.
std::optional<MachineKind> machine_named(std::string_view name);

/// Says in `diagnostics` what the machine cannot do. Time linear in instructions.
void check_machine_rules(const Program& program, MachineKind machine, Diagnostics& diagnostics);

}  // namespace loopwright
