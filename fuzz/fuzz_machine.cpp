// Whatever programme comes in, wrong ones too, the machine must come to its end: its record and the yarn
// graph are consistent, and what is said of the programme stands at places that it has.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "machine/machine_rules.hpp"
#include "machine/review.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "topology/build_yarn_graph.hpp"

namespace {

using namespace loopwright;

void require(bool good) {
  if (!good) std::abort();
}

void require_consistent(const Program& program, const KnittingRecord& record) {
  const int end = static_cast<int>(program.instructions.size());
  std::size_t held = 0;
  for (const NeedleStack& stack : record.held) held += stack.loops.size();
  for (const LoopRecord& loop : record.loops) {
    require(!loop.placements.empty() && loop.instruction >= 0 && loop.instruction < end);
    for (const Placement& placement : loop.placements)
      require(placement.instruction >= loop.instruction && placement.instruction < end);
    for (const LoopId parent : loop.parents)
      require(parent.valid() && parent.position() < record.loops.size());
    if (loop.fate == LoopFate::held) --held;
    require((loop.fate == LoopFate::held) == (loop.fate_instruction < 0));
  }
  require(held == 0);
  require(record.carriers.size() == program.carriers.size());
  for (const KickBack& kick : record.kick_backs)
    require(kick.instruction >= 0 && kick.instruction < end && kick.carrier.valid());
  require(record.carriage_passes >= record.passes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics("fuzz.k");
  const Program program = read_knitout(text, diagnostics);
  const KnittingRecord record = run_machine(program, diagnostics);
  require_consistent(program, record);
  review(program, record, diagnostics);
  check_machine_rules(program, MachineKind::shima, diagnostics);
  check_machine_rules(program, MachineKind::kniterate, diagnostics);
  const YarnGraph graph = build_yarn_graph(program, record, diagnostics);
  require(validate_yarn_graph(graph).empty());
  for (const Diagnostic& each : diagnostics.list())
    require(each.at.line >= 0 && each.at.column >= 0 && each.at.column <= static_cast<int>(size) + 1);
  return 0;
}
