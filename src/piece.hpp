// What the programs on top of the road share, the command and the Python module: a piece with all that
// mechanics needs to go on with it, from a notation, a saved state or curves, and one watched run to its
// rest.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline.hpp"

namespace loopwright {

// A fabric and how mechanics is to treat it.
struct Piece {
  State state;
  RelaxOptions options;
};

// The keys of State::texts under which a state keeps the notation that it was knitted from, and that text's
// suffix.
inline constexpr const char* state_notation = "notation";
inline constexpr const char* state_notation_suffix = "notation_suffix";
// Puts it there, unless it is no text in UTF-8.
void keep_notation(State& state, std::string text, std::string suffix);

// What the caller states instead of the file: a sweep over loop lengths, the yarn of a knitout file that
// names none. In the words of a fabric file's headers: {"Loop-Length", "5.9 mm"}
// (notation/fabric_headers.hpp; Size and Edges are FabricOptions).
struct StatedHeaders {
  std::vector<std::pair<std::string, std::string>> settings{};
  std::string yarn{};  // of every carrier; keys that it leaves out stay as the file says them
};

// knit_with() of a notation in memory, whose program gets `stated` before it is knitted. `suffix` (".verm")
// decides where the text's first line does not say what it is.
Knitting knit_text(std::string_view text, std::string_view suffix, const FabricOptions& options,
                   const StatedHeaders& stated, Diagnostics& diagnostics);

// Up to the first geometry; a held piece of a repeated notation, if `request` wants it, up to its relaxed
// repeat, which `on_progress` sees. Throws std::invalid_argument where the piece has no such part.
Piece first_piece(const Knitting& knitting, const PieceRequest& request,
                  const std::function<bool(const RelaxProgress&)>& on_progress = {});
// The whole piece where the loop-scale model comes to rest, instead of the flat layout.
Piece loop_layout_piece(const Knitting& knitting, const PieceRequest& request);
// A saved state that is gone on with. Throws std::invalid_argument if it does not hold what that needs.
Piece piece_of(State state);
Piece piece_of(const ImportedCurves& imported);

// Follows relax(): how far it is, and how far the yarn has grown, for who saves what was reached.
class RelaxWatch {
 public:
  explicit RelaxWatch(const RelaxOptions& options)
      : tolerance_(options.tolerance), grows_(options.grow_in), radius_(grows_ ? 0 : 1) {}

  // Share of the work that is done, 0 to 1, never falling: the first half is growing in, the second follows
  // the residual down to the tolerance on a logarithmic scale.
  double share(const RelaxProgress& progress);
  double radius() const { return radius_; }

 private:
  double tolerance_ = 0, first_residual_ = 0, best_ = 0;
  bool grows_ = true;
  double radius_ = 0;
  RelaxProgress last_;
};

// A piece brought to rest.
struct RelaxRun {
  RelaxResult result;    // counts of earlier runs of a state that was gone on with are in its own
  RelaxOptions options;  // as they were at the end
  double radius = 0;     // share of the full yarn radius that was reached
  bool let_go = false;
  std::vector<LinkedPair> linked_before;  // closed yarns; linked otherwise after the run, the cloth is broken
};

// relax_piece(), watched. `let_go`: the plates of a finite piece are taken away in the end. `on_progress`
// false stops. What piece.options.on_progress holds is not called.
RelaxRun run_relax(const Piece& piece, bool let_go,
                   const std::function<bool(const RelaxProgress&, double share)>& on_progress = {});
State saved_state(const RelaxRun& run);

// results() of a state, with what the run that made it found: converged, residual, pass_throughs and its
// counts, where the state says them.
JsonObject results(const Assessment& assessment, const State& state);

// Whether the cloth is what the machine knitted: every interlacing there, no yarn through another.
bool is_whole(const Assessment& assessment, int pass_throughs);

// For stiffness, which is read off second derivatives of the energy: without friction, with fine samples.
// Contact samples lie 0.09 d apart: at 0.18 d the ripple of sampled contacts makes the stiffness of
// plain at rest up to 70 % wrong, at 0.09 d up to 5 % (docs/homogenise.md).
Piece elastic_piece(Piece piece);

}  // namespace loopwright
