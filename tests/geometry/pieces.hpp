// Pieces that the tests of this stage share: programmes from small charts, and the real ones of the corpus.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/fit_fabric.hpp"
#include "geometry/interlacing.hpp"
#include "geometry/periodic_cell.hpp"
#include "geometry/type_points.hpp"
#include "geometry/window.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {

struct Piece {
  Program program;
  YarnGraph graph;
  GeometryOptions options;
  PlacedPiece placed;
};

inline Piece piece_of_text(const std::string& text) {
  Piece piece;
  Diagnostics diagnostics;
  piece.program = read_knitout(text, diagnostics);
  piece.graph = build_yarn_graph(piece.program, run_machine(piece.program, diagnostics), diagnostics);
  piece.options = make_geometry_options(piece.program);
  piece.placed = place_type_points(piece.graph, piece.options);
  return piece;
}

inline Fabric fabric_of(const Piece& piece, const YarnCurves& curves) {
  return fit_fabric(curves, piece.graph, piece.options);
}
inline Fabric whole_fabric(const Piece& piece) {
  return fabric_of(piece, build_yarn_curves(piece.graph, piece.options));
}

inline std::filesystem::path corpus() {
  const char* folder = std::getenv("LOOPWRIGHT_CORPUS");
  return folder ? folder : LOOPWRIGHT_CORPUS_DEFAULT;
}
inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Courses of `f` (face) and `b` (back) stitches, the first line of the chart knitted first, repeated to
// `wales` x `courses`, knitted to and fro with one carrier; loops are transferred where the bed of a needle
// changes.
inline std::string chart_programme(const std::vector<std::string>& chart, int wales, int courses) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  std::vector<char> bed(static_cast<std::size_t>(wales), ' ');
  for (int course = 0; course < courses; ++course) {
    const std::string& row = chart[static_cast<std::size_t>(course) % chart.size()];
    const auto wanted = [&](int needle) { return row[static_cast<std::size_t>(needle) % row.size()]; };
    for (int needle = 0; needle < wales; ++needle) {
      char& at = bed[static_cast<std::size_t>(needle)];
      const std::string n = std::to_string(needle);
      if (at != ' ' && at != wanted(needle)) text += "xfer " + (at + n) + ' ' + (wanted(needle) + n) + '\n';
      at = wanted(needle);
    }
    const bool to_right = course % 2 == 0;
    for (int k = 0; k < wales; ++k) {
      const int needle = to_right ? k : wales - 1 - k;
      text += std::string("knit ") + (to_right ? '+' : '-') + ' ' +
              (wanted(needle) + std::to_string(needle)) + " 1\n";
    }
  }
  return text + "outhook 1\n";
}

// Starts of the courses of a piece in which every carriage pass is a course.
inline std::vector<int> course_starts(const YarnGraph& graph, int courses_per_repeat) {
  std::vector<int> starts;
  int last_pass = -1, passes = 0;
  for (const Loop& loop : graph.loops) {
    if (loop.pass == last_pass) continue;
    last_pass = loop.pass;
    if (passes++ % courses_per_repeat == 0) starts.push_back(loop.instruction);
  }
  return starts;
}

// The repeat of a chart as a periodic cell, from the middle of a piece of several.
inline Fabric chart_cell(const std::vector<std::string>& chart) {
  const int wales = static_cast<int>(chart.front().size()), courses = static_cast<int>(chart.size());
  const Piece piece = piece_of_text(chart_programme(chart, 5 * wales + 4, 5 * courses + 4));
  CellRange range;
  range.first_slot = 2 * wales;
  range.wales = wales;
  range.repeat_starts = course_starts(piece.graph, courses);
  range.repeat = 2;
  return fabric_of(piece, cut_periodic_cell(piece.graph, piece.options, piece.placed, range));
}

}  // namespace loopwright
