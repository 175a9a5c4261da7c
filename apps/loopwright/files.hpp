// What the subcommands share: reading a piece from a notation or a saved state, and what they write.
#pragma once
#include <optional>
#include <ostream>
#include <string>

#include "commands.hpp"
#include "outputs/render.hpp"
#include "piece.hpp"

namespace loopwright {

bool names_a_state(const std::string& file);

// Reads a saved state, curves of another program, or a notation up to its first geometry. Says what is wrong
// on standard error; nothing if there was an error.
std::optional<Piece> read_piece(const std::string& file, const PieceRequest& request);

// The same for who only looks at it: a saved state need not say how it is gone on with.
std::optional<State> read_fabric(const std::string& file, const PieceRequest& request);

// Puts the notation that a state was knitted from into it, where `file` is one: text in UTF-8.
void keep_notation(const std::string& file, State& state);

// Throws FileError if a file of that name could not be written, before long work is done for it. Empty and
// "-" pass.
void require_writable(const std::string& file);

// Throws std::invalid_argument for a size that is not WIDTHxHEIGHT, and for a name that is not that of a PNG.
RenderOptions render_options(const PictureRequest& request, const std::string& png);

// Where a line for people goes: standard output, unless JSON has that place.
std::ostream& people(const std::string& json);

// One line with the sizes of a cloth and whether it is whole.
std::string summary(const Assessment& assessment);

// Says on standard error if the cloth is not what the machine knitted; then its results are worth nothing.
bool say_if_broken(const std::string& file, const Assessment& assessment, int pass_throughs);

// The lowest modes of cloth at rest and whether it is stable without friction: added to `all`, and said on
// `out` in a line.
void tell_stability(const std::string& file, const Fabric& fabric, const RelaxOptions& options, int modes,
                    JsonObject& all, std::ostream& out);

}  // namespace loopwright
