// Whatever bytes come in, the knitout reader must come back, its places must lie inside the text, and what it
// understood must survive writing and reading.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "notation/read_knitout.hpp"
#include "notation/read_vermiculation.hpp"
#include "notation/write_knitout.hpp"
#include "notation/write_vermiculation.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace loopwright;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics("fuzz.k"), again("fuzz.k");
  const Program program = read_knitout(text, diagnostics);
  if (program.carriers.size() != program.yarns.size()) std::abort();
  for (const Diagnostic& each : diagnostics.list()) {
    if (each.at.line < 0 || each.at.column < 0 || each.at.column > static_cast<int>(size) + 1) std::abort();
  }
  const Program copy = read_knitout(write_knitout(program), again);
  if (copy.instructions.size() != program.instructions.size()) std::abort();
  // as a fabric file: with a word on each thing that it cannot say, or whole
  if (program.instructions.size() > 300) return 0;
  Diagnostics lost("fuzz.k"), written("fuzz.verm");
  const std::string fabric = write_vermiculation(program, lost);
  FabricOptions options;
  options.most_instructions = 100'000;
  if (lost.ok() && (read_vermiculation(fabric, written, options), !written.ok())) std::abort();
  return 0;
}
