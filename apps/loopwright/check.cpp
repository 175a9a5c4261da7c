// loopwright check: what is wrong in files, one line a finding, and for a good file what it would knit.
#include <iostream>

#include "commands.hpp"
#include "machine/machine_rules.hpp"
#include "machine/review.hpp"
#include "machine_state.hpp"
#include "outputs/write_json.hpp"

namespace loopwright {
namespace {

JsonObject findings(const Diagnostics& diagnostics, const Knitting& knitting) {
  JsonArray list;
  for (const Diagnostic& d : diagnostics.list()) {
    JsonObject one;
    one.emplace_back("severity", std::string(to_string(d.severity)));
    if (d.at.line > 0) one.emplace_back("line", d.at.line);
    if (d.at.column > 0) one.emplace_back("column", d.at.column);
    one.emplace_back("message", d.message);
    list.emplace_back(std::move(one));
  }
  return {{"file", diagnostics.file()},
          {"errors", diagnostics.errors()},
          {"warnings", diagnostics.warnings()},
          {"advice", diagnostics.advice()},
          {"instructions", knitting.program.instructions.size()},
          {"passes", knitting.record.passes},
          {"carriage_passes", knitting.record.carriage_passes},
          {"kick_backs", knitting.record.kick_backs.size()},
          {"yarns", knitting.graph.yarns.size()},
          {"loops", knitting.graph.loops.size()},
          {"interlacings", knitting.graph.interlacings.size()},
          {"unheld_loops", knitting.graph.unheld.size()},
          {"loops_left_on_needles", knitting.graph.left_on_needles.size()},
          {"diagnostics", std::move(list)}};
}

}  // namespace

int run(const CheckCommand& command) {
  // findings are what is asked for here, so they go to standard output, unless JSON has that place
  std::ostream& out = command.json == "-" ? std::cerr : std::cout;
  bool good = true;
  JsonArray files, states;
  for (const std::string& file : command.files) {
    Diagnostics diagnostics(file);
    const Knitting knitting = knit(file, {}, diagnostics);
    review(knitting.program, knitting.record, diagnostics);
    if (const auto machine = machine_named(command.machine))
      check_machine_rules(knitting.program, *machine, diagnostics);
    good = good && diagnostics.ok();
    out << diagnostics;
    if (diagnostics.ok())
      out << file << ": " << knitting.graph.loops.size() << " loops, " << knitting.graph.yarns.size()
          << " yarns, " << knitting.record.passes << " passes, " << knitting.graph.interlacings.size()
          << " interlacings\n";
    if (!command.json.empty()) files.emplace_back(findings(diagnostics, knitting));
    if (!command.machine_state.empty()) states.emplace_back(machine_state(diagnostics, knitting));
  }
  if (!command.json.empty()) write_json(command.json, {{"files", std::move(files)}});
  if (!command.machine_state.empty()) write_json(command.machine_state, {{"files", std::move(states)}});
  return good ? exit_good : exit_error;
}

}  // namespace loopwright
