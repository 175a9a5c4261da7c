// Whatever fabric file comes in: if it is right, the programme that is made of it for either machine is read
// back as it was written and runs without an error, and nothing is left on needles or carriers.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "machine/knittable.hpp"
#include "machine/review.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "notation/read_vermiculation.hpp"
#include "notation/write_knitout.hpp"

namespace {

using namespace loopwright;

void require(bool good) {
  if (!good) std::abort();
}

void convert(const Program& fabric, MachineKind machine) {
  Diagnostics told("fuzz.verm"), said("fuzz.k");
  const KnittableProgram knittable = make_knittable(fabric, machine, told);
  if (!told.ok()) return;  // too many yarns
  const Program program = read_knitout(write_knitout(knittable.program), said);
  require(program.instructions.size() == knittable.program.instructions.size());
  const KnittingRecord record = run_machine(program, said);
  require(said.ok());
  require(record.held.empty());
  for (const CarrierPlace& carrier : record.carriers) require(!carrier.in);
  require(knittable.pattern_begin <= knittable.pattern_end);
  check_machine_rules(program, machine, said);
  review(program, record, said);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const Edges edges : {Edges::free, Edges::bound_off}) {
    Diagnostics diagnostics("fuzz.verm");
    FabricOptions options;
    options.edges = edges;
    options.most_instructions = 5'000;  // small pieces: many of them
    const Program fabric = read_vermiculation(text, diagnostics, options);
    if (!diagnostics.ok()) return 0;
    convert(fabric, MachineKind::shima);
    convert(fabric, MachineKind::kniterate);
  }
  return 0;
}
