// Whatever bytes come in, the knitout reader must come back, its places must lie inside the text, and what it
// understood must survive writing and reading.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "notation/read_knitout.hpp"
#include "notation/write_knitout.hpp"

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
  return 0;
}
