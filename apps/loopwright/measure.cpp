// loopwright measure: sizes, densities and the interlacing check of a saved state, or of curves.
#include <stdexcept>

#include "files.hpp"
#include "outputs/exchange/curve_file.hpp"

namespace loopwright {

int run(const MeasureCommand& command) {
  if (!names_a_state(command.file) && !names_curves(command.file))
    throw std::invalid_argument(command.file +
                                ": measure takes a saved state (relax or build makes one) or curves");
  require_writable(command.json);
  const std::optional<State> read = read_fabric(command.file, command.piece);
  if (!read) return exit_error;
  const State& state = *read;
  const Assessment assessment = assess(state.fabric);

  // what the run that made the state found, beside what is measured now
  JsonObject all = results(assessment);
  const auto number = [&](const char* key) { return state.numbers.find(key); };
  const auto none = state.numbers.end();
  for (const char* key : {"pass_throughs", "newton_iterations", "linear_iterations"})
    if (number(key) != none) all.emplace_back(key, static_cast<long long>(number(key)->second));
  if (number("converged") != none) all.emplace_back("converged", number("converged")->second != 0);
  if (number("residual") != none) all.emplace_back("residual", number("residual")->second);
  people(command.json) << command.file << ": " << summary(assessment) << '\n';
  if (command.modes > 0)
    tell_stability(command.file, state.fabric, relax_options(state), command.modes, all,
                   people(command.json));
  if (!command.json.empty()) write_json(command.json, all);
  const int pass_throughs =
      number("pass_throughs") != none ? static_cast<int>(number("pass_throughs")->second) : 0;
  return say_if_broken(command.file, assessment, pass_throughs) ? exit_error : exit_good;
}

}  // namespace loopwright
