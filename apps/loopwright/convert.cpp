// loopwright convert: a fabric file as a programme that a machine can knit, and knitout as a fabric file.
// What is written has been read back, run and held against the machine's rules before.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "commands.hpp"
#include "machine/knittable.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "notation/read_program.hpp"
#include "notation/write_knitout.hpp"
#include "notation/write_vermiculation.hpp"
#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

// What is to be written, and a line about it for people; nothing if there was an error, which is said.
struct Converted {
  std::string text, summary;
};

std::string count_of(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

// Reads the text back as whoever gets the file will, and says what is wrong with it.
void check_knitout(const std::string& text, const std::optional<MachineKind>& machine,
                   Diagnostics& diagnostics) {
  const Program program = read_knitout(text, diagnostics);
  run_machine(program, diagnostics);
  if (machine) check_machine_rules(program, *machine, diagnostics);
}

Converted fabric_to_knitout(const std::string& text, const ConvertCommand& command, MachineKind machine,
                            Diagnostics& diagnostics) {
  // A machine knits the piece alone: what the file says of margins and periodic edges is for mechanics.
  FabricOptions options;
  Diagnostics said_later;
  const bool bound_off = parse_vermiculation(text, said_later).settings.edges == Edges::bound_off;
  options.edges = bound_off || command.bind_off ? Edges::bound_off : Edges::free;
  const Program fabric = read_program_text(text, ".verm", diagnostics, options);
  if (!diagnostics.ok()) return {};
  const KnittableProgram knittable = make_knittable(fabric, machine, diagnostics);
  if (!diagnostics.ok()) return {};
  const auto pattern = static_cast<std::size_t>(knittable.pattern_end - knittable.pattern_begin);
  return {write_knitout(knittable.program),
          count_of(pattern, "operation") + " of the pattern, " +
              count_of(static_cast<std::size_t>(knittable.cast_on_needles), "needle") + " cast on, " +
              (options.edges == Edges::bound_off ? "bound off" : "dropped at the end") + ", for a " +
              std::string(limits_of(machine).name)};
}

Converted to_knitout(const std::string& text, bool is_fabric, const ConvertCommand& command,
                     Diagnostics& diagnostics) {
  std::optional<MachineKind> machine = machine_named(command.machine);
  if (is_fabric && !machine) machine = MachineKind::shima;
  Converted converted;
  if (is_fabric) {
    converted = fabric_to_knitout(text, command, *machine, diagnostics);
  } else {
    const Program program = read_knitout(text, diagnostics);
    converted = {write_knitout(program), count_of(program.instructions.size(), "operation")};
  }
  if (!diagnostics.ok()) return {};
  Diagnostics of_result(command.out);
  check_knitout(converted.text, machine, of_result);
  std::cerr << of_result;
  if (!of_result.ok()) diagnostics.error({}, "nothing is written: the machine cannot knit the result");
  return converted;
}

Converted to_fabric(const std::string& text, Diagnostics& diagnostics) {
  const Program program = read_knitout(text, diagnostics);
  run_machine(program, diagnostics);
  if (!diagnostics.ok()) return {};
  Diagnostics lost(diagnostics.file());
  Converted converted{write_vermiculation(program, lost), {}};
  for (const Diagnostic& d : lost.list()) diagnostics.add(d);
  converted.summary = lost.warnings() == 0 ? "nothing was lost"
                                           : count_of(static_cast<std::size_t>(lost.warnings()), "thing") +
                                                 " could not be expressed";
  return converted;
}

}  // namespace

int run(const ConvertCommand& command) {
  const std::string suffix = std::filesystem::path(command.out).extension();
  const bool wants_knitout = suffix == ".k" || suffix == ".knitout";
  if (!wants_knitout && suffix != ".verm")
    throw std::invalid_argument(
        "what to write is told by the suffix: .k or .knitout for knitout, .verm for a "
        "fabric file, not '" +
        command.out + "'");
  Diagnostics diagnostics(command.file);
  const std::optional<std::string> text = read_text(command.file, diagnostics);
  Converted converted;
  if (text) {
    const bool is_fabric = is_fabric_text(*text, std::filesystem::path(command.file).extension().string());
    if (is_fabric && !wants_knitout) throw std::invalid_argument(command.file + " is a fabric file already");
    converted =
        wants_knitout ? to_knitout(*text, is_fabric, command, diagnostics) : to_fabric(*text, diagnostics);
  }
  std::cerr << diagnostics;
  if (!diagnostics.ok()) return exit_error;
  AtomicFile file(command.out);
  file.stream() << converted.text;
  file.commit();
  std::cout << command.out << ": " << converted.summary << '\n';
  return exit_good;
}

}  // namespace loopwright
