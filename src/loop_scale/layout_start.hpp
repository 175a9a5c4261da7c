// From where a piece relaxes at loop scale: tubes laid round, torn pieces by their springs' lengths, ribs and
// purls from a sheet that folds once it is at rest.
#pragma once
#include <vector>

#include "loop_scale/loop_model.hpp"
#include "loop_scale/settle.hpp"

namespace loopwright {

// A start without folds, and the damping of its sheet over the net's.
struct LayoutStart {
  std::vector<Vec3> places;  // by binding point, in d
  double damping = 1;
};

// Places are empty for a sheet without folds: it starts as the structure model has it.
LayoutStart layout_start(const YarnGraph& graph, const LoopModel& model);

struct FoldedSheet {
  std::vector<Vec3> places;  // by binding point, in d
  SettleResult result;       // of the sheet
};

// From a start without folds to one with them: the piece comes to rest as a sheet, whose springs are as long
// as the folded ones reach along it, then the stitches of the two beds go to their two sides of the sheet.
// Folded from the start, ribs and purls of a piece that still has far to go fold any way.
FoldedSheet folded_sheet(const YarnGraph& graph, const LoopModel& model, const LayoutStart& start,
                         const SettleOptions& settling);

}  // namespace loopwright
