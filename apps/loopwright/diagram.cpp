// loopwright diagram: the running-thread drawing of a fabric file's repeat, or of a knitout file's passes.
#include <iostream>
#include <stdexcept>

#include "commands.hpp"
#include "files.hpp"
#include "notation/needle_diagram.hpp"
#include "notation/read_program.hpp"
#include "outputs/write_diagram_svg.hpp"

namespace loopwright {
namespace {

DiagramOptions options_of(const DiagramCommand& command, const FabricSettings& settings) {
  DiagramOptions options;
  if (command.whole) {
    options.wales = settings.size_wales;
    options.courses = settings.size_courses;
  }
  if (!command.size.empty()) {
    const WindowSize size = parsed_window(command.size);
    options.wales = size.wales;
    options.courses = size.courses;
  }
  options.first_pass = static_cast<std::size_t>(command.first - 1);
  options.most_passes = static_cast<std::size_t>(command.most);
  return options;
}

NeedleDiagram diagram_of_fabric(const std::string& text, const DiagramCommand& command,
                                Diagnostics& diagnostics) {
  const Vermiculation notation = parse_vermiculation(text, diagnostics);
  // what only shows when it is knitted: facing needles, transfers that cannot be made
  compile_vermiculation(notation, {}, diagnostics);
  if (!diagnostics.ok()) return {};
  return needle_diagram(notation, options_of(command, notation.settings));
}

NeedleDiagram diagram_of_knitout(const std::string& text, const std::string& suffix,
                                 const DiagramCommand& command, Diagnostics& diagnostics) {
  const Program program = read_program_text(text, suffix, diagnostics);
  if (!diagnostics.ok()) return {};
  if (command.whole || !command.size.empty())
    throw std::invalid_argument(command.file +
                                ": knitout has no repeat; choose passes by --first and --passes");
  std::size_t passes = 0;
  NeedleDiagram diagram = needle_diagram(program, options_of(command, {}), &passes);
  if (diagram.passes.size() < passes)
    std::cerr << command.file << ": " << diagram.passes.size() << " of " << passes
              << " passes are drawn; --first and --passes choose others\n";
  return diagram;
}

}  // namespace

int run(const DiagramCommand& command) {
  require_writable(command.out);
  Diagnostics diagnostics(command.file);
  NeedleDiagram diagram;
  if (const auto text = read_text(command.file, diagnostics)) {
    const std::string suffix = std::filesystem::path(command.file).extension().string();
    try {
      diagram = is_fabric_text(*text, suffix) ? diagram_of_fabric(*text, command, diagnostics)
                                              : diagram_of_knitout(*text, suffix, command, diagnostics);
      if (diagnostics.ok() && diagram.passes.empty())
        diagnostics.error({}, "there is no pass to draw; --first and --passes choose which");
    } catch (const std::invalid_argument& fault) {
      diagnostics.error({}, fault.what());
    }
  }
  std::cerr << diagnostics;
  if (!diagnostics.ok()) return exit_error;
  write_diagram_svg(command.out, diagram);
  return exit_good;
}

}  // namespace loopwright
