// loopwright build: the first geometry, before mechanics.
#include <iostream>
#include <stdexcept>

#include "files.hpp"
#include "outputs/write_fabric.hpp"

namespace loopwright {
namespace {

// The whole piece where the loop-scale model comes to rest, instead of the flat layout.
std::optional<Piece> read_relaxed_layout(const BuildCommand& command) {
  if (command.piece.periodic || command.piece.window)
    throw std::invalid_argument("--layout loop is for whole pieces, not for a cell or window");
  if (names_a_state(command.file))
    throw std::invalid_argument(command.file + ": a layout is found from a notation, not from a saved state");
  Diagnostics diagnostics(command.file);
  const Knitting knitting = knit(command.file, command.piece, diagnostics);
  std::optional<Piece> piece;
  if (diagnostics.ok()) {
    try {
      piece = loop_layout_piece(knitting, command.piece);
    } catch (const std::invalid_argument& fault) {
      diagnostics.error({}, fault.what());
    }
  }
  std::cerr << diagnostics;
  return piece;
}

}  // namespace

int run(const BuildCommand& command) {
  fabric_format(command.out);
  require_writable(command.out);
  require_writable(command.json);
  std::optional<Piece> piece =
      command.layout == "loop" ? read_relaxed_layout(command) : read_piece(command.file, command.piece);
  if (!piece) return exit_error;
  const Assessment assessment = assess(piece->state.fabric);
  keep_notation(command.file, piece->state);
  write_fabric(command.out, piece->state);
  if (!command.json.empty()) write_json(command.json, results(assessment));
  people(command.json) << command.file << ": " << summary(assessment) << '\n';
  return say_if_broken(command.file, assessment, 0) ? exit_error : exit_good;
}

}  // namespace loopwright
