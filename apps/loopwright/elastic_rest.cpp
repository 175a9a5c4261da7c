#include "elastic_rest.hpp"

#include <iostream>
#include <utility>

#include "homogenise.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"

namespace loopwright {

std::optional<Piece> read_elastic_piece(const std::string& file, const PieceRequest& request) {
  std::optional<Piece> piece = read_piece(file, names_a_state(file) ? PieceRequest{} : request);
  if (!piece) return piece;
  return elastic_piece(std::move(*piece));
}

ElasticRest elastic_rest_of(const std::string& file, const Piece& piece) {
  ProgressBar bar("relaxing");
  ElasticRest rest;
  rest.relaxed = elastic_rest_of(piece, [&bar](const char*, double share, const std::string& note) {
    bar.show(share, note);
    return !interrupted();
  });
  if (rest.relaxed.stopped) {
    std::cerr << file << ": stopped before the cloth was at rest\n";
    rest.status = exit_interrupted;
    return rest;
  }
  rest.assessment = assess(rest.relaxed.fabric);
  if (say_if_broken(file, rest.assessment, rest.relaxed.pass_throughs)) rest.status = exit_error;
  if (!rest.relaxed.converged)
    std::cerr << file << ": warning: not sharply at rest: " << rest.relaxed.message << ", residual "
              << rest.relaxed.residual << " B/d^2\n";
  return rest;
}

}  // namespace loopwright
