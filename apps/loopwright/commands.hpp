// The subcommands: what each is asked for, and one function each in a file of its name. A command writes its
// results, says what went wrong on standard error and returns the exit status: 0, 1 after an error, 130 after
// Ctrl-C.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "outputs/export_options.hpp"
#include "pipeline.hpp"

namespace loopwright {

inline constexpr int exit_good = 0, exit_error = 1, exit_interrupted = 130;

// Files named in a request: empty means not wanted; for JSON "-" is standard output.
struct CheckCommand {
  std::vector<std::string> files;
  std::string json, machine_state;
  std::string machine;  // whose rules to ask as well: "shima", "kniterate" or nobody's
};
int run(const CheckCommand& command);

struct DiagramCommand {
  std::string file, out;
  std::string size;           // wales x courses; empty: one repeat
  bool whole = false;         // as large as the file says
  int first = 1, most = 200;  // of a knitout file's passes
};
int run(const DiagramCommand& command);

struct ConvertCommand {
  std::string file, out;
  std::string machine;    // "shima" or "kniterate"; empty: shima for fabric files, any for knitout
  bool bind_off = false;  // instead of dropping the last loops
};
int run(const ConvertCommand& command);

struct BuildCommand {
  std::string file, out, json;
  std::string layout = "flat";  // flat, or loop: at rest at loop scale
  PieceRequest piece;
};
int run(const BuildCommand& command);

// A stretch test. Strains as shares of the relaxed size, in the order in which they are gone to.
struct StretchCommand {
  std::string file, out, csv, plot;
  PieceRequest piece{.start_from_cell = true, .segments_per_loop = 24};
  std::string direction = "course";  // course, wale, both, shear
  std::vector<double> to{0.3};
  double step = 0.02;
  std::vector<double> load{};         // N/m; not empty: forces are prescribed, not strains
  std::optional<double> load_step{};  // default: a twentieth of the largest load
  bool held_across = false;
  int threads = 0;  // 0: all
};
int run(const StretchCommand& command);

// Membrane constants of a cell. Strains of the grid in any order; 0 is always among them.
struct HomogeniseCommand {
  std::string file, csv, plot, json;
  PieceRequest piece{.periodic = true, .friction = 0.0, .segments_per_loop = 24};
  std::vector<double> course{-0.05, 0.05, 0.1, 0.15, 0.2}, wale{-0.1, -0.05, 0.05, 0.1}, shear{-0.1, 0.1};
  double course_pull = 0.3, wale_pull = 0.15;  // how far the pulls go to which the law is fitted
  double step = 0.02;
  int threads = 0;  // 0: all
};
int run(const HomogeniseCommand& command);

// How size and stiffness of a cell depend on its yarn's data. Deviations: KEY=PERCENT.
struct SensitivityCommand {
  std::string file, csv, json;
  PieceRequest piece{.periodic = true, .friction = 0.0, .segments_per_loop = 24};
  std::vector<std::string> deviations;
  int threads = 0;  // 0: all
};
int run(const SensitivityCommand& command);

struct PictureRequest {
  std::string view = "front";
  std::string size = "1600x1200";  // pixels
};

struct RelaxCommand {
  std::string file, out, json, render;
  PieceRequest piece{.start_from_cell = true};
  PictureRequest picture;
  int threads = 0;            // 0: all
  int modes = 0;              // lowest modes to report, and stability
  std::optional<double> set;  // share of the curvature at rest that the yarn keeps
  bool let_go = false;        // take the plates of a finite piece away in the end
  std::optional<int> most_iterations;
};
int run(const RelaxCommand& command);

// What moves the loop-scale model (docs/loop_scale.md).
struct LoopRequest {
  std::string law = "along";
  bool coupling = false, gravity = false;
  double shear = 0, fold = 0.25, bend = 0, damping = 1;
  std::vector<std::string> clamps, pulls;  // places; PLACE:cN
  double take_down_cN = 0, ramp_s = 0;
};

struct RenderCommand {
  std::string file, out;
  PieceRequest piece;
  PictureRequest picture;
  std::string style = "yarn";     // yarn, structure, sides
  std::string moment = "stable";  // of the loop model: start, stable, both
  LoopRequest loop;
};
int run(const RenderCommand& command);

struct ExportCommand {
  std::string file, out;
  std::string format;           // empty: by the suffix
  std::string repeats = "1x1";  // cells of a periodic fabric
  ExportOptions options;
  PieceRequest piece;
};
int run(const ExportCommand& command);

struct AnimateCommand {
  std::string file, out;
  std::string model = "loop", style = "structure";
  std::string binding = "contact";  // yarn model: barycentric, sliding, contact
  std::string size;                 // yarn model: wales x courses; empty: as the file says
  double stretch = 0;               // yarn model: share by which the sides are pulled apart
  LoopRequest loop;
  PictureRequest picture;
  int frames = 48, threads = 0;
  std::optional<double> seconds;
  bool no_pictures = false;
};
int run(const AnimateCommand& command);

struct MeasureCommand {
  std::string file, json;
  PieceRequest piece;  // of curves: their yarn and unit
  int modes = 0;
};
int run(const MeasureCommand& command);

// The desktop application, which takes this program's place.
struct ViewCommand {
  std::string file;  // empty: none is opened
};
int run(const ViewCommand& command);

}  // namespace loopwright
