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

  JsonObject all = results(assessment, state);
  people(command.json) << command.file << ": " << summary(assessment) << '\n';
  if (command.modes > 0)
    tell_stability(command.file, state.fabric, relax_options(state), command.modes, all,
                   people(command.json));
  if (!command.json.empty()) write_json(command.json, all);
  const auto passed = state.numbers.find("pass_throughs");
  const int pass_throughs = passed != state.numbers.end() ? static_cast<int>(passed->second) : 0;
  return say_if_broken(command.file, assessment, pass_throughs) ? exit_error : exit_good;
}

}  // namespace loopwright
