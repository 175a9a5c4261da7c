// Whatever bytes come in, the fabric file reader must come back, and a Program without errors must be whole.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "notation/read_vermiculation.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace loopwright;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics diagnostics("fuzz.verm");
  FabricOptions options;
  options.most_instructions = 20'000;  // small pieces: it is the reader that is tried, not the memory
  const Program program = read_vermiculation(text, diagnostics, options);
  if (!diagnostics.ok()) return 0;
  const int count = static_cast<int>(program.instructions.size());
  const ProgramWindow& window = program.window;
  if (count == 0 || program.repeat_starts.size() < 2) std::abort();
  if (window.first_instruction < 0 || window.instructions < 0 ||
      window.first_instruction + window.instructions > count) {
    std::abort();
  }
  if (window.needles > 0 && window.instructions == 0) std::abort();
  for (const Instruction& each : program.instructions) {
    for (const CarrierId id : each.carriers) {
      if (id.position() >= program.carriers.size()) std::abort();
    }
  }
  return 0;
}
