// The loop-scale model as a layout: where increases, decreases, short rows and tubes find their shape before
// there is yarn. Gives first curves with the interlacings of the machine's record, for the yarn-scale model.
#pragma once
#include <vector>

#include "geometry/layout.hpp"
#include "loop_scale/loop_model.hpp"
#include "loop_scale/settle.hpp"

namespace loopwright {

struct RelaxedLayout {
  LoopModel model;
  NetState state{};
  SettleResult result{};
  YarnCurves curves{};  // at `state`
  // whether `state` is the folded sheet from which the net was to relax, because more of its interlacings are
  // right; `result` is the sheet's then
  bool is_sheet = false;
  int wrong = 0;  // interlacings that are not as the machine knitted them, of all
};

// What a layout needs beside weft and warp springs: shear, else courses slide along each other; folds;
// bending, else a tube stays flat.
LoopModelOptions layout_options();
SettleOptions layout_settling();  // to 2e-4

// Starts from the structure model. A piece that is knitted mostly in rounds starts laid round a cylinder of
// its width: flat, it is at rest as well, and no spring would open it.
RelaxedLayout relaxed_layout(const YarnGraph& graph, const Program& program,
                             const LoopModelOptions& options = layout_options(),
                             const SettleOptions& settling = layout_settling());

// The layout where the masses are, and first curves there. `places`: by binding point, in d.
Layout placed_layout(const YarnGraph& graph, const LoopModel& model, const std::vector<Vec3>& places);
YarnCurves placed_curves(const YarnGraph& graph, const LoopModel& model, const std::vector<Vec3>& places);

// A run of loops that neighbours in a course make in one direction on one bed.
struct CourseMeasure {
  int pass = 0, stitches = 0;
  double width = 0;   // along the lower binding points, in d
  double height = 0;  // mean y of them
};
std::vector<CourseMeasure> course_measures(const YarnGraph& graph, const RelaxedLayout& layout);

// A round of a tube: loops from one bed to the other and back.
struct RoundMeasure {
  int loops = 0;
  double perimeter = 0;  // in d
  double roundness = 0;  // enclosed area over that of a circle of this perimeter
  Vec3 centre, area;     // mean place; enclosed area along its normal, d^2
};
std::vector<RoundMeasure> round_measures(const YarnGraph& graph, const RelaxedLayout& layout);

// What the rounds of a tube enclose, from each to the next that lies less than half a round's length away, in
// d^3.
double enclosed_volume(const std::vector<RoundMeasure>& rounds);

}  // namespace loopwright
