// loopwright build: the first geometry, before mechanics.
#include "files.hpp"
#include "outputs/write_fabric.hpp"

namespace loopwright {

int run(const BuildCommand& command) {
  fabric_format(command.out);
  require_writable(command.out);
  require_writable(command.json);
  const std::optional<Piece> piece = read_piece(command.file, command.piece);
  if (!piece) return exit_error;
  const Assessment assessment = assess(piece->state.fabric);
  write_fabric(command.out, piece->state);
  if (!command.json.empty()) write_json(command.json, results(assessment));
  people(command.json) << command.file << ": " << summary(assessment) << '\n';
  return say_if_broken(command.file, assessment, 0) ? exit_error : exit_good;
}

}  // namespace loopwright
