#include "cloth.hpp"

#include <utility>

namespace loopwright::python {

Cloth::Cloth(RelaxRun run, const State& before) : linked_before_(std::move(run.linked_before)) {
  piece_.state = saved_state(run);
  piece_.state.texts = before.texts;
  piece_.options = std::move(run.options);
  RelaxResult& result = run.result;
  // ready to be gone on with: friction keeps its history, plates stand where they are
  piece_.options.grow_in = run.radius < 1;
  piece_.options.model.plates = result.plates;
  piece_.options.history = std::move(result.history);
  message_ = result.message;
  stopped_ = result.stopped;
  result.fabric = {};
  rest_ = std::move(result);
}

std::optional<double> Cloth::number(const char* key) const {
  const auto found = state().numbers.find(key);
  if (found == state().numbers.end()) return std::nullopt;
  return found->second;
}

const Assessment& Cloth::assessment() const {
  std::call_once(measured_, [this] { assessment_ = assess(fabric()); });
  return *assessment_;
}

std::optional<RelaxResult> Cloth::at_rest() const {
  if (!rest_ || stopped_) return std::nullopt;
  RelaxResult result = *rest_;
  result.fabric = fabric();
  result.history = piece_.options.history;
  return result;
}

bool Cloth::whole() const {
  const int passed = static_cast<int>(number("pass_throughs").value_or(0));
  return is_whole(assessment(), passed) && (!rest_ || assessment().linked == linked_before_);
}

}  // namespace loopwright::python
