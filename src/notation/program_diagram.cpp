#include "notation/program_diagram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

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

ProgramDiagram::ProgramDiagram(const Program& program, std::size_t first_pass, std::size_t most_passes)
    : program_(program), runs_(passes_of(program)) {
  passes_in_all_ = runs_.size();
  runs_.erase(runs_.begin(), runs_.begin() + static_cast<std::ptrdiff_t>(std::min(first_pass, runs_.size())));
  if (runs_.size() > most_passes) runs_.resize(most_passes);
  frame_.name = program.settings.name;
  for (std::size_t i = 0; i < program.carriers.size(); ++i)
    frame_.yarns.push_back({program.carriers[i], i < program.yarns.size() ? program.yarns[i].colour : ""});
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const ProgramPass& run : runs_) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Instruction& each = program.instructions[i];
      if (each.op < Op::knit) continue;
      const bool two = each.op == Op::xfer || each.op == Op::split;
      first = std::min({first, each.needle.index, two ? each.target.index : each.needle.index});
      last = std::max({last, each.needle.index, two ? each.target.index : each.needle.index});
      frame_.rear_bed = frame_.rear_bed || two || !is_front(each.needle.bed);
    }
  }
  if (runs_.empty()) return;
  frame_.first_needle = first;
  frame_.wales = last - first + 1;
  frame_.courses = runs_.back().course;
}

DiagramPass ProgramDiagram::pass(std::size_t k) const {
  return pass_of(program_, runs_[k], frame_.first_needle, frame_.wales);
}

NeedleDiagram needle_diagram(const Program& program, const DiagramOptions& options,
                             std::size_t* passes_in_all) {
  const ProgramDiagram lines(program, options.first_pass, options.most_passes);
  if (passes_in_all) *passes_in_all = lines.passes_in_all();
  NeedleDiagram diagram = lines.frame();
  if (static_cast<std::size_t>(diagram.wales) * lines.size() > most_diagram_needles)
    throw std::invalid_argument("the diagram is too large; ask for fewer passes");
  for (std::size_t k = 0; k < lines.size(); ++k) diagram.passes.push_back(lines.pass(k));
  return diagram;
}

}  // namespace loopwright
