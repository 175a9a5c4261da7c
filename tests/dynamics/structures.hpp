// Small pieces of the library's structures, and of letters, up to their first curves.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/fit_fabric.hpp"
#include "geometry/geometry_options.hpp"
#include "geometry/type_points.hpp"
#include "geometry/window.hpp"
#include "machine/run_machine.hpp"
#include "mechanics/yarn_material.hpp"
#include "notation/read_program.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {

struct SmallPiece {
  Fabric fabric;
  YarnMaterial material;
};

inline SmallPiece small_piece(const std::string& text) {
  Diagnostics diagnostics("structure");
  const Program program = read_program_text(text, ".verm", diagnostics);
  const KnittingRecord record = run_machine(program, diagnostics);
  const YarnGraph graph = build_yarn_graph(program, record, diagnostics);
  if (!diagnostics.ok()) {
    std::ostringstream what;
    what << diagnostics;
    throw std::runtime_error(what.str());
  }
  const GeometryOptions options = make_geometry_options(program);
  const PlacedPiece placed = place_type_points(graph, options);
  SmallPiece piece;
  piece.fabric =
      fit_fabric(cut_window(graph, options, placed, program_window(graph, program.window)), graph, options);
  piece.material = yarn_material(reference_yarn(program), piece.fabric.diameter_mm);
  return piece;
}

// The structure with another size: `size` as "6 wales x 4 courses".
inline SmallPiece small_piece(const std::filesystem::path& file, const std::string& size) {
  std::ifstream stream(file);
  std::string text, line;
  while (std::getline(stream, line)) text += (line.starts_with(";;Size:") ? ";;Size: " + size : line) + '\n';
  return small_piece(text);
}

inline std::vector<std::filesystem::path> library() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) /
                                                               "examples/structures"))
    if (entry.path().extension() == ".verm") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace loopwright
