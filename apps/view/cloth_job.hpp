// From a text to its cloth, in moments that can be shown: what was read, the first geometry, the yarn on its
// way to rest, the rest. Runs in any thread and can be told to stop between two steps.
#pragma once
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cloth_at_hand.hpp"
#include "knitout_passes.hpp"
#include "pipeline.hpp"

namespace loopwright {

// automatic: one repeat as a cell that tiles the plane, where the notation repeats and its edges are held or
// periodic; else, and for knitout, the whole piece.
enum class PieceChoice { automatic, repeat, whole };

struct ClothRequest {
  std::string text, suffix, name;  // suffix: ".verm" or ".k"; name: for messages
  PieceChoice piece = PieceChoice::automatic;
  // Larger pieces are shown as knitted and relaxed only when asked for (0: none is relaxed).
  std::size_t most_loops = 400;
  std::optional<WindowSize> window{};
  std::filesystem::path cloth_file;      // a saved state or curves of another program, in place of a text
  std::optional<ClothAtHand> at_hand{};  // to go on from, where its loops are those of the text
};

enum class ClothStage {
  reading,      // nothing to show yet
  unusable,     // the notation has errors, or nothing was knitted
  as_knitted,   // the first geometry
  as_saved,     // what a file of cloth holds
  growing,      // on the way: the yarn's core grows in
  relaxing,     // on the way to equilibrium
  at_rest,      // every force is below the tolerance
  not_at_rest,  // ended without that
  stopped       // told to stop
};

struct ClothMoment {
  ClothStage stage = ClothStage::reading;
  std::shared_ptr<const Diagnostics> diagnostics;  // of notation, machine and topology
  std::shared_ptr<const Knitting> knitting;
  std::shared_ptr<const Fabric> fabric;          // none: nothing new to show
  std::shared_ptr<const RelaxOptions> options;   // without callbacks
  std::shared_ptr<const RelaxResult> relaxed;    // at the end alone
  std::shared_ptr<const Measurements> measured;  // with `relaxed`; of curves as the file has them
  std::shared_ptr<const KnitoutPasses> passes;   // of knitout
  std::shared_ptr<const std::string> text;       // of a file of cloth: its notation, or what it holds
  InterlacingCheck interlacings;                 // expected < 0: not counted for this moment
  int iterations = 0;
  double residual = 0, radius = 0, seconds = 0;
  bool went_on = false;      // from the cloth at hand
  int pass_throughs = 0;     // of the runs that made a saved state
  bool linked_anew = false;  // closed yarns hang in each other otherwise than in the file
  std::string message;
  // Whether what is shown may be taken for the cloth that the notation knits.
  bool broken() const {
    return (interlacings.expected >= 0 && interlacings.intact < interlacings.expected) ||
           (relaxed && relaxed->pass_throughs > 0) || pass_throughs > 0 || linked_anew;
  }
};

using ShowMoment = std::function<void(ClothMoment)>;

// Moments on the way come at most this often.
inline constexpr double seconds_between_moments = 0.04;

// Never throws: what goes wrong is a moment that says so. After `cancelled` is set it returns at the next
// step, with a last moment `stopped` that holds what was reached.
void make_cloth(const ClothRequest& request, const std::atomic<bool>& cancelled, const ShowMoment& show);

// The notation's text as the machine and the graph make of it.
Knitting knit_text(const ClothRequest& request, const FabricOptions& options, Diagnostics& diagnostics);

}  // namespace loopwright
