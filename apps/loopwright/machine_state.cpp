#include "machine_state.hpp"

#include <algorithm>
#include <string>

namespace loopwright {
namespace {

int line_of(const Program& program, int instruction) {
  return program.instructions[static_cast<std::size_t>(instruction)].at.line;
}

std::string position(const YarnStep& step) {
  return to_string(step.needle) + (step.direction == Direction::left ? "-" : "+");
}

std::string end_of(const LoopRecord& loop, const Program& program) {
  if (loop.fate == LoopFate::held) return "held";
  return (loop.fate == LoopFate::dropped ? "dropped@" : "cast_off@") +
         std::to_string(line_of(program, loop.fate_instruction));
}

JsonArray errors(const Diagnostics& diagnostics) {
  JsonArray list;
  for (const Diagnostic& d : diagnostics.list())
    if (d.severity == Severity::error) list.emplace_back(JsonArray{d.at.line, d.message});
  return list;
}

const std::string& carrier_of(const Knitting& knitting, YarnId yarn) {
  return knitting.program.carriers[knitting.record.yarns[yarn.position()].carrier.position()];
}

JsonArray loops(const Knitting& knitting) {
  const Program& program = knitting.program;
  JsonArray list;
  list.reserve(knitting.record.loops.size());
  for (const LoopRecord& loop : knitting.record.loops) {
    std::string words =
        carrier_of(knitting, loop.yarn) + ' ' + std::to_string(line_of(program, loop.instruction)) + ' ';
    for (const Placement& p : loop.placements)
      words += to_string(p.needle) + '@' + std::to_string(line_of(program, p.instruction)) + ' ';
    if (!loop.parents.empty()) words += "through ";
    for (const LoopId parent : loop.parents) words += std::to_string(parent.value) + ' ';
    list.emplace_back(words + end_of(loop, program));
  }
  return list;
}

// Steps of all yarns in file order; those of one instruction in the order of its carriers.
JsonArray uses(const Knitting& knitting) {
  struct Use {
    const YarnRecord* yarn;
    const YarnStep* step;
    std::size_t place;  // of the carrier among those of the instruction
  };
  const Program& program = knitting.program;
  std::vector<Use> all;
  for (const YarnRecord& yarn : knitting.record.yarns)
    for (const YarnStep& step : yarn.steps) {
      const auto& set = program.instructions[static_cast<std::size_t>(step.instruction)].carriers;
      const auto place = std::find(set.begin(), set.end(), yarn.carrier) - set.begin();
      all.push_back({&yarn, &step, static_cast<std::size_t>(place)});
    }
  std::sort(all.begin(), all.end(), [](const Use& a, const Use& b) {
    return std::pair(a.step->instruction, a.place) < std::pair(b.step->instruction, b.place);
  });
  JsonArray list;
  list.reserve(all.size());
  for (const Use& use : all) {
    const bool first = use.step == &use.yarn->steps.front();
    list.emplace_back(std::to_string(line_of(program, use.step->instruction)) + ' ' +
                      program.carriers[use.yarn->carrier.position()] + ' ' +
                      (first ? "in" : to_string(use.step->from)) + ' ' + position(*use.step));
  }
  return list;
}

JsonObject carriers(const Knitting& knitting) {
  const auto& names = knitting.program.carriers;
  std::vector<JsonValue> last(names.size());
  std::vector<char> active(names.size(), false);
  for (const YarnRecord& yarn : knitting.record.yarns) {
    if (yarn.steps.empty()) continue;
    last[yarn.carrier.position()] = position(yarn.steps.back());
    active[yarn.carrier.position()] = yarn.out_instruction < 0;
  }
  JsonObject all;
  for (std::size_t i = 0; i < names.size(); ++i)
    all.emplace_back(names[i], JsonObject{{"last_used_at", last[i]}, {"active", active[i] != 0}});
  return all;
}

}  // namespace

JsonObject machine_state(const Diagnostics& diagnostics, const Knitting& knitting) {
  const KnittingRecord& record = knitting.record;
  JsonObject at_end, heights;
  for (const NeedleStack& stack : record.held) {
    if (stack.loops.empty()) continue;
    JsonArray made;
    for (const LoopId id : stack.loops) {
      const LoopRecord& loop = record.loops[id.position()];
      made.emplace_back(
          JsonArray{carrier_of(knitting, loop.yarn), line_of(knitting.program, loop.instruction)});
    }
    heights.emplace_back(to_string(stack.needle), made.size());
    at_end.emplace_back(to_string(stack.needle), std::move(made));
  }
  int most = 0;
  for (const int height : record.stack_height) most = std::max(most, height);
  return {{"file", diagnostics.file()},
          {"accepted", diagnostics.ok()},
          {"errors", errors(diagnostics)},
          {"loops_at_end", std::move(at_end)},
          {"stack_heights", std::move(heights)},
          {"most_stack", most},
          {"carriers", carriers(knitting)},
          {"loops_made", record.loops.size()},
          {"loops", loops(knitting)},
          {"uses", uses(knitting)}};
}

}  // namespace loopwright
