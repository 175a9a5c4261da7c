// The subcommands: what each is asked for, and one function each in a file of its name. A command writes its
// results, says what went wrong on standard error and returns the exit status: 0, 1 after an error, 130 after
// Ctrl-C.
#pragma once
#include <optional>
#include <string>
#include <vector>

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
  PieceRequest piece;
};
int run(const BuildCommand& command);

struct PictureRequest {
  std::string view = "front";
  std::string size = "1600x1200";  // pixels
};

struct RelaxCommand {
  std::string file, out, json, render;
  PieceRequest piece{.start_from_cell = true};
  PictureRequest picture;
  int threads = 0;  // 0: all
  std::optional<int> most_iterations;
};
int run(const RelaxCommand& command);

struct RenderCommand {
  std::string file, out;
  PieceRequest piece;
  PictureRequest picture;
};
int run(const RenderCommand& command);

struct MeasureCommand {
  std::string file, json;
};
int run(const MeasureCommand& command);

}  // namespace loopwright
