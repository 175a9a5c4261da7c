// loopwright render: a picture of a first geometry or of a saved state.
#include "files.hpp"
#include "loop_model.hpp"
#include "outputs/image.hpp"

namespace loopwright {

int run(const RenderCommand& command) {
  if (structure_style(command.style)) return render_structure(command);
  const RenderOptions options = render_options(command.picture, command.out);
  require_writable(command.out);
  const std::optional<Piece> piece = read_piece(command.file, command.piece);
  if (!piece) return exit_error;
  write_png(command.out, render(piece->state.fabric, options));
  return exit_good;
}

}  // namespace loopwright
