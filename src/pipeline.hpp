// The whole road on one page: from a notation to relaxed, measured cloth. Each call below is one stretch of
// it; a program that wants to look in between calls the stages themselves, in the same order.
//
//   knit            read_program -> run_machine -> build_yarn_graph
//   first_geometry  place_type_points -> cut_window or cut_periodic_cell -> fit_fabric
//   relax_piece     relax, with relax_options
//   assess          measure, check_interlacings, min_clearance
//   results         all numbers as one JSON object; saved_state, write_fabric, render: the rest of outputs
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostics.hpp"
#include "experiments/measure.hpp"
#include "geometry/fabric.hpp"
#include "geometry/interlacing.hpp"
#include "geometry/linking.hpp"
#include "machine/knitting_record.hpp"
#include "mechanics/relax.hpp"
#include "notation/program.hpp"
#include "notation/vermiculation.hpp"
#include "outputs/exchange/curves_to_fabric.hpp"
#include "outputs/state.hpp"
#include "outputs/write_json.hpp"
#include "topology/yarn_graph.hpp"

namespace loopwright {

// Wales and courses to take from the middle of a piece; 0: all of them.
struct WindowSize {
  int wales = 0, courses = 0;
};
// "16x16", "allx16", "16xall". Throws std::invalid_argument that says so.
WindowSize parsed_window(std::string_view text);

// What is wanted of a file's fabric. Neither: what the file's edges say; the whole piece for knitout.
struct PieceRequest {
  bool periodic = false;               // one repeat of the structure, as a cell
  std::optional<WindowSize> window{};  // a part with held edges
  bool start_from_cell = false;  // held pieces of a repeated notation: relax() starts from the relaxed repeat
  std::optional<double> friction{};  // coefficient of yarn on yarn, instead of the yarn's own
  // Files of curves (BCC, .yarns, OBJ lines), which say little of their yarn: its data as a yarn header
  // states them, and the length of the file's unit.
  std::string curve_yarn{};
  std::optional<double> curve_unit_mm{};
  double segments_per_loop = 12;  // splines' segments in a loop of the notation's length
};

// notation -> machine -> topology. What is wrong is said in `diagnostics`; what could be understood is there.
struct Knitting {
  Program program;
  KnittingRecord record;
  YarnGraph graph;
};
Knitting knit(const std::filesystem::path& file, const PieceRequest& request, Diagnostics& diagnostics);
// The same with a size or edges of its own instead of the file's.
Knitting knit_with(const std::filesystem::path& file, const FabricOptions& options, Diagnostics& diagnostics);

// geometry: the yarns in space before mechanics. Throws std::invalid_argument where the piece has no such
// part.
Fabric first_geometry(const Knitting& knitting, const PieceRequest& request);

// outputs (the reading side): the curves of another program's file as yarns, and how relax() is to treat
// them: free in space, the ends of open yarns held where they are. What is said of the yarn is read into
// `diagnostics`. Throws FileError and std::invalid_argument that say what is wrong with the file or missing.
struct ImportedCurves {
  CurveFabric curves;
  RelaxOptions options;
};
ImportedCurves import_curves(const std::filesystem::path& file, const PieceRequest& request,
                             Diagnostics& diagnostics);

// mechanics: how relax() is to treat a first geometry, from the data of its thickest yarn. Friction: what is
// asked for, else the yarn's own, else 0.25 (the middle of what is measured for wool, cotton and acrylic).
RelaxOptions relax_options(const Fabric& fabric, const Program& program, const PieceRequest& request);
// A held piece of a repeated notation, with every loop as it is in the relaxed periodic cell of one repeat:
// nearly at rest from the start, and options made ready for it: no grow-in, and friction as it holds the
// cell. Nothing where the piece has no such cell; then it starts from the first geometry.
std::optional<Fabric> start_from_relaxed_cell(const Knitting& knitting, const PieceRequest& request,
                                              const Fabric& first, RelaxOptions& options);
// The same for a saved state: it holds what is needed, and how far it was. Throws std::invalid_argument if
// not.
RelaxOptions relax_options(const State& state);

// relax(); a piece that no frame holds then gets the width and height at which its loops came to rest.
RelaxResult relax_piece(const Fabric& fabric, const RelaxOptions& options);

// experiments: what is measured, and whether the cloth still is what the machine knitted.
struct Assessment {
  Measurements measured;
  InterlacingCheck interlacings;
  Clearance clearance;
  int closed_yarns = 0;            // that end in their own beginning
  std::vector<LinkedPair> linked;  // those of them that hang in each other
};
Assessment assess(const Fabric& fabric);

// outputs: keys with their units, as docs/command.md lists them.
JsonObject results(const Assessment& assessment);
JsonObject results(const Assessment& assessment, const RelaxResult& relaxed);
// What a saved state holds beside the fabric, so that it can be gone on with and measured. `radius`: share of
// the yarn's full radius to which it has grown, 0 for a first geometry.
State saved_state(const Fabric& fabric, const RelaxOptions& options, double radius);
State saved_state(const RelaxResult& relaxed, const RelaxOptions& options, double radius);

}  // namespace loopwright
