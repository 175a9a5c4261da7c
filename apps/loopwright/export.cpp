// loopwright export: a fabric in the format of another program.
#include <charconv>
#include <iostream>
#include <stdexcept>

#include "files.hpp"
#include "outputs/write_fabric.hpp"

namespace loopwright {
namespace {

// "3x2": cells along each lattice vector.
std::array<int, 2> parsed_repeats(const std::string& text) {
  std::array<int, 2> repeats{0, 0};
  const char* const end = text.data() + text.size();
  const auto [cross, fault] = std::from_chars(text.data(), end, repeats[0]);
  if (fault == std::errc() && cross != end && *cross == 'x') {
    const auto [rest, second] = std::from_chars(cross + 1, end, repeats[1]);
    if (second == std::errc() && rest == end) return repeats;
  }
  throw std::invalid_argument("--repeats is COLUMNSxROWS, each from 1 to 1000, not '" + text + "'");
}

}  // namespace

int run(const ExportCommand& command) {
  const FabricFormat format =
      command.format.empty() ? fabric_format(command.out) : format_named(command.format);
  ExportOptions options = command.options;
  options.repeats = parsed_repeats(command.repeats);
  require_writable(command.out);
  const std::optional<State> state = read_fabric(command.file, command.piece);
  if (!state) return exit_error;
  const Fabric& fabric = state->fabric;
  write_fabric(command.out, *state, format, options);
  std::size_t segments = 0;
  for (const FabricYarn& yarn : fabric.yarns) segments += static_cast<std::size_t>(yarn.segments());
  std::cout << command.file << ": " << fabric.yarns.size() << " yarns, " << fabric.loops.size() << " loops, "
            << segments << " spline segments in " << command.out << '\n';
  return exit_good;
}

}  // namespace loopwright
