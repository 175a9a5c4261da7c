#include "machine/rails.hpp"

#include <algorithm>
#include <optional>

namespace loopwright {
namespace {

// The rail of each carrier, in the order of the header; empty if every carrier has its own.
std::vector<int> rails_of(const Program& program) {
  std::string header;
  for (const auto& [name, value] : program.headers)
    if (name == "Carriers") header = value;
  std::vector<int> rails;
  if (header.find_first_of(",;") == std::string::npos) return rails;
  int rail = 0;
  for (std::size_t at = 0; at < header.size();) {
    const std::size_t end = std::min(header.find_first_of(" \t,;", at), header.size());
    if (end > at) rails.push_back(rail);
    if (end < header.size() && (header[end] == ' ' || header[end] == '\t')) ++rail;
    at = end + 1;
  }
  rails.resize(program.carriers.size(), -1);
  return rails;
}

struct Step {
  int instruction = 0;
  std::size_t carrier = 0;
  std::optional<double> place;  // none: it goes out
};

std::vector<Step> steps_of(const KnittingRecord& record) {
  std::vector<Step> steps;
  for (const YarnRecord& yarn : record.yarns) {
    for (const YarnStep& step : yarn.steps)
      steps.push_back(
          {step.instruction, yarn.carrier.position(), step.slot + 0.1 * static_cast<int>(step.direction)});
    if (yarn.out_instruction >= 0)
      steps.push_back({yarn.out_instruction, yarn.carrier.position(), std::nullopt});
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.instruction < b.instruction; });
  return steps;
}

}  // namespace

void review_rails(const Program& program, const KnittingRecord& record, Diagnostics& diagnostics) {
  const std::vector<int> rails = rails_of(program);
  if (rails.empty()) return;
  std::vector<std::optional<double>> place(program.carriers.size());
  for (const Step& step : steps_of(record)) {
    const std::size_t own = step.carrier;
    place[own] = step.place;
    for (std::size_t other = 0; other < place.size() && step.place; ++other) {
      if (other == own || rails[other] < 0 || rails[other] != rails[own] || !place[other]) continue;
      if (other < own ? *place[other] <= *step.place : *place[other] >= *step.place) continue;
      diagnostics.warning(program.instructions[static_cast<std::size_t>(step.instruction)].at,
                          "carrier " + program.carriers[own] + " goes past carrier " +
                              program.carriers[other] + ", which runs on the same rail: they collide");
      return;
    }
  }
}

}  // namespace loopwright
