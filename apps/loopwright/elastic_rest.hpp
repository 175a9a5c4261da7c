// The rest without friction from which stiffness and sensitivities are read.
#pragma once
#include <optional>
#include <string>

#include "files.hpp"

namespace loopwright {

// read_piece for that: without friction, with fine samples. A saved state is taken as the piece that it is.
std::optional<Piece> read_elastic_piece(const std::string& file, const PieceRequest& request);

// Brings a piece to rest without friction, with a bar, and says on standard error what is wrong with it: not
// at rest, not whole. `status` is exit_good if it can be gone on with.
struct ElasticRest {
  RelaxResult relaxed;
  Assessment assessment;
  int status = exit_good;
};
ElasticRest elastic_rest_of(const std::string& file, const Piece& piece);

}  // namespace loopwright
