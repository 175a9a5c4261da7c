// The size of a swatch from the periodic cell of its pattern: yarn by yarn, with what it went through.
#pragma once
#include <filesystem>
#include <string>

#include "experiments/as_knitted.hpp"
#include "geometry/window.hpp"
#include "machine_model.hpp"
#include "pipeline.hpp"

namespace loopwright {

constexpr int measured_wales = 60, measured_courses = 60;  // of a swatch, inside its border

struct SwatchPrediction {
  double width_mm = 0, height_mm = 0, mass_g = 0;
  double stretched_width_mm = 0, stretched_height_mm = 0;
  int cell_wales = 0, cell_courses = 0, loops = 0, newton_iterations = 0, pass_throughs = 0;
  int interlacings = 0, interlacings_intact = 0;
  bool converged = false, stretched_converged = false;
  // Every interlacing was there in the first geometry, and no step let yarn through yarn: whatever the
  // reading at rest finds, they are there.
  bool is_certified = false;
  double seconds_knit = 0, seconds_geometry = 0, seconds_relax = 0, seconds_stretch = 0;
  std::string trouble;  // why there is no prediction; else empty
};

struct SwatchWork {
  MachineModel machine;
  bool stretched = false;  // also under the load
  int most_iterations = 600;
  std::filesystem::path state;  // the relaxed cell is written here, if it is not empty
};

// The swatch as the machine knits it. Throws std::invalid_argument if the programme has errors.
double now_s();  // of a clock that does not jump

Knitting knit_swatch(const std::filesystem::path& file, const MachineModel& machine);
// The loops that are measured: 60 wales by 60 courses in the middle, the border's courses at either end.
LoopSelection measured_loops(const YarnGraph& graph);
// Share of the loops that have a neighbour, in their course or wale, which shows its other face.
double two_faced_share(const YarnGraph& graph, const Fabric& fabric);

// All the yarn in its loops, floats and bed changes.
double swatch_mass_g(const YarnGraph& graph, const PlacedPiece& piece, const GeometryOptions& options,
                     const MachineModel& machine);
// How a cell is relaxed, whatever edges its programme has.
RelaxOptions swatch_options(const Fabric& first, const Program& program, int most_iterations);
// A cell of so many needles through what the machine does to it.
KnittedRest relax_first(const Fabric& first, const YarnGraph& graph, const Program& program,
                        const MachineModel& machine, int needles, int most_iterations);

SwatchPrediction predict_by_cell(const std::filesystem::path& file, const SwatchWork& work);

}  // namespace loopwright
