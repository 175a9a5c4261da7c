// The needle diagram of a programme: its instructions, pass by pass.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "notation/needle_diagram.hpp"
#include "notation/program_passes.hpp"

namespace loopwright {
namespace {

NeedleOperation operation_of(const Instruction& instruction) {
  const bool yarn = carries_yarn(instruction);
  switch (instruction.op) {
    case Op::knit:
      return yarn ? NeedleOperation::stitch : NeedleOperation::drop;
    case Op::tuck:
      return yarn ? NeedleOperation::tuck : NeedleOperation::missed;
    case Op::split:
      return yarn ? NeedleOperation::split : NeedleOperation::transfer;
    case Op::xfer:
      return NeedleOperation::transfer;
    case Op::drop:
      return NeedleOperation::drop;
    default:
      return NeedleOperation::missed;
  }
}

DiagramPass pass_of(const Program& program, const ProgramPass& run, int first_needle, int wales) {
  DiagramPass pass;
  const Instruction& first = program.instructions[run.begin];
  pass.course = run.course;
  pass.carries_yarn = run.yarn;
  pass.direction = first.direction;
  pass.racking = run.racking;
  pass.at = first.at;
  if (run.yarn)
    for (const CarrierId id : first.carriers) pass.yarns.push_back(static_cast<int>(id.position()));
  for (int w = 0; w < wales; ++w) {
    pass.front.push_back({NeedleOperation::unused, static_cast<double>(first_needle + w), {}});
    pass.rear.push_back({NeedleOperation::unused, first_needle + w + run.racking, {}});
  }
  for (std::size_t i = run.begin; i < run.end; ++i) {
    const Instruction& each = program.instructions[i];
    if (each.op < Op::knit) continue;
    auto& row = is_front(each.needle.bed) ? pass.front : pass.rear;
    DiagramNeedle& needle = row[static_cast<std::size_t>(each.needle.index - first_needle)];
    needle.operation = operation_of(each);
    needle.at = each.at;
  }
  return pass;
}

}  // namespace

NeedleDiagram needle_diagram(const Program& program, const DiagramOptions& options,
                             std::size_t* passes_in_all) {
  NeedleDiagram diagram;
  diagram.name = program.settings.name;
  for (std::size_t i = 0; i < program.carriers.size(); ++i)
    diagram.yarns.push_back({program.carriers[i], i < program.yarns.size() ? program.yarns[i].colour : ""});
  std::vector<ProgramPass> runs = passes_of(program);
  if (passes_in_all) *passes_in_all = runs.size();
  runs.erase(runs.begin(),
             runs.begin() + static_cast<std::ptrdiff_t>(std::min(options.first_pass, runs.size())));
  if (runs.size() > options.most_passes) runs.resize(options.most_passes);
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const ProgramPass& run : runs) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Instruction& each = program.instructions[i];
      if (each.op < Op::knit) continue;
      const bool two = each.op == Op::xfer || each.op == Op::split;
      first = std::min({first, each.needle.index, two ? each.target.index : each.needle.index});
      last = std::max({last, each.needle.index, two ? each.target.index : each.needle.index});
      diagram.rear_bed = diagram.rear_bed || two || !is_front(each.needle.bed);
    }
  }
  if (runs.empty()) return diagram;
  diagram.first_needle = first;
  diagram.wales = last - first + 1;
  if (static_cast<std::size_t>(diagram.wales) * runs.size() > most_diagram_needles)
    throw std::invalid_argument("the diagram is too large; ask for fewer passes");
  diagram.courses = runs.back().course;
  for (const ProgramPass& run : runs)
    diagram.passes.push_back(pass_of(program, run, diagram.first_needle, diagram.wales));
  return diagram;
}

}  // namespace loopwright
