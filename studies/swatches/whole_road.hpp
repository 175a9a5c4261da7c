// A whole swatch, yarn by yarn: cast-on, moss border and pattern, from the needles to the table.
#pragma once
#include <functional>

#include "cell_road.hpp"

namespace loopwright {

// What the swatch goes through, one after the other.
enum class WholeStage { on_machine, let_go, pulled, laid_flat };
constexpr std::array<const char*, 4> whole_stage_names{"on_machine", "let_go", "pulled", "laid_flat"};

// The inner 60 x 60 after a stage.
struct WholeSize {
  double width_mm = 0, height_mm = 0;                // means over its courses and wales
  double middle_width_mm = 0, middle_height_mm = 0;  // of its middle courses and wales, a third of them
  int newton_iterations = 0, pass_throughs = 0, interlacings = 0, interlacings_intact = 0;
  bool converged = false;
  double seconds = 0;
};

struct WholeWork {
  MachineModel machine;
  // The state after every stage is kept there, and a run that finds one goes on from it.
  std::filesystem::path states;
  int most_iterations = 400;  // of a stage
  std::function<void(WholeStage, const RelaxProgress&)> on_progress;
  std::function<void(WholeStage, const WholeSize&)> on_stage;
};

// Sizes after all stages, or up to the first that did not come to rest. On the machine the border loops hold
// the piece at the needles' pitch, under take-down; then nothing holds it but the plates. Pulled: dead loads
// on its border loops. Throws std::invalid_argument if the programme has errors, FileError.
std::vector<WholeSize> relax_whole(const std::filesystem::path& file, const WholeWork& work);

}  // namespace loopwright
