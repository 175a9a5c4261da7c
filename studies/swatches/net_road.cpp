#include "net_road.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "experiments/as_knitted.hpp"
#include "geometry/find_repeat.hpp"
#include "geometry/fit_fabric.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "outputs/atomic_file.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

constexpr int bits = pattern_wales * pattern_courses;
constexpr FacePattern all_rear = (1U << bits) - 1;

bool rear_at(FacePattern pattern, int wale, int course) {
  const int w = (wale % pattern_wales + pattern_wales) % pattern_wales;
  const int c = (course % pattern_courses + pattern_courses) % pattern_courses;
  return (pattern >> (c * pattern_wales + w) & 1U) != 0;
}

FacePattern shifted(FacePattern pattern, int wales, int courses, bool mirrored) {
  FacePattern result = 0;
  for (int c = 0; c < pattern_courses; ++c)
    for (int w = 0; w < pattern_wales; ++w)
      if (rear_at(pattern, mirrored ? wales - w : wales + w, courses + c))
        result |= 1U << (c * pattern_wales + w);
  return result;
}

// A programme that knits the pattern, as KnitDB's do: what is to show the other face is first moved over.
std::string programme_of(FacePattern pattern) {
  constexpr int wales = 6 * pattern_wales, courses = 8 * pattern_courses;
  std::ostringstream text;
  text << ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  const auto bed = [&](int w, int c) { return rear_at(pattern, w, c) ? 'b' : 'f'; };
  for (int w = wales - 1; w >= 0; --w)
    if (w % 2 == 1) text << "tuck - f" << w << " 1\n";
  for (int w = 0; w < wales; ++w)
    if (w % 2 == 0) text << "tuck + f" << w << " 1\n";
  std::string on(static_cast<std::size_t>(wales), 'f');
  for (int c = 0; c < courses; ++c) {
    for (int w = 0; w < wales; ++w) {
      char& at = on[static_cast<std::size_t>(w)];
      if (at != bed(w, c)) text << "xfer " << at << w << ' ' << bed(w, c) << w << '\n';
      at = bed(w, c);
    }
    for (int k = 0; k < wales; ++k) {
      const int w = c % 2 == 0 ? wales - 1 - k : k;
      text << "knit " << (c % 2 == 0 ? '-' : '+') << ' ' << on[static_cast<std::size_t>(w)] << w << " 1\n";
    }
    if (c == 1) text << "releasehook 1\n";
  }
  text << "outhook 1\n";
  return text.str();
}

LoopSize relaxed_size(FacePattern pattern, const MachineModel& machine) {
  Diagnostics diagnostics("cell");
  Program program = read_knitout(programme_of(pattern), diagnostics);
  apply(machine, program);
  const YarnGraph graph = build_yarn_graph(program, run_machine(program, diagnostics), diagnostics);
  if (!diagnostics.ok()) throw std::logic_error("a cell's own programme has errors");
  LoopSelection inside(graph.loops.size(), 0);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Loop& loop = graph.loops[i];
    inside[i] = !loop.parents.empty() && !loop.children.empty() && loop.slot >= 2 && loop.slot < 22 ? 1 : 0;
  }
  const std::optional<FoundRepeat> repeat = find_repeat(graph, inside, 2);
  if (!repeat) throw std::logic_error("a cell's own programme does not repeat");
  const GeometryOptions geometry = make_geometry_options(program);
  const PlacedPiece piece = place_type_points(graph, geometry);
  const Fabric first = fit_fabric(cut_periodic_cell(graph, geometry, piece, repeat->range), graph, geometry);
  const KnittedRest rest = relax_first(first, graph, program, machine, repeat->range.wales, 400);
  const Fabric& fabric = rest.relaxed.fabric;
  return {fabric.width * fabric.diameter_mm / repeat->range.wales,
          fabric.height * fabric.diameter_mm / repeat->courses,
          rest.on_machine.converged && rest.relaxed.converged};
}

}  // namespace

FacePattern representative(FacePattern pattern) {
  FacePattern least = pattern;
  for (const FacePattern seen : {pattern, pattern ^ all_rear})
    for (int w = 0; w < pattern_wales; ++w)
      for (int c = 0; c < pattern_courses; ++c)
        for (const bool mirrored : {false, true}) least = std::min(least, shifted(seen, w, c, mirrored));
  return least;
}

LoopSizes relax_face_cells(const MachineModel& machine) {
  LoopSizes sizes;
  for (FacePattern pattern = 0; pattern <= all_rear; ++pattern)
    if (representative(pattern) == pattern) sizes[pattern] = relaxed_size(pattern, machine);
  return sizes;
}

void write_loop_sizes(const std::filesystem::path& path, const LoopSizes& sizes) {
  AtomicFile file(path);
  file.stream() << "pattern,wale_mm,course_mm,converged\n";
  for (const auto& [pattern, size] : sizes)
    file.stream() << pattern << ',' << size.wale_mm << ',' << size.course_mm << ',' << size.converged << '\n';
  file.commit();
}

LoopSizes read_loop_sizes(const std::filesystem::path& path) {
  LoopSizes sizes;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    FacePattern pattern = 0;
    LoopSize size;
    char comma = 0;
    if (fields >> pattern >> comma >> size.wale_mm >> comma >> size.course_mm >> comma >> size.converged)
      sizes[pattern] = size;
  }
  return sizes;
}

SwatchPrediction predict_by_net(const std::filesystem::path& file, const MachineModel& machine,
                                const LoopSizes& sizes) {
  const auto start = std::chrono::steady_clock::now();
  SwatchPrediction p;
  const Knitting knitting = knit_swatch(file, machine);
  const YarnGraph& graph = knitting.graph;
  const GeometryOptions geometry = make_geometry_options(knitting.program);
  p.mass_g = swatch_mass_g(graph, place_type_points(graph, geometry), geometry, machine);

  // Faces by wale and course; a place without a loop of its own shows what lies below.
  const LoopSelection inside = measured_loops(graph);
  std::map<int, int> rows;
  double first_slot = INFINITY;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (inside[i] != 0) {
      rows[graph.loops[i].pass] = 0;
      first_slot = std::min(first_slot, graph.loops[i].slot);
    }
  int count = 0;
  for (auto& [pass, row] : rows) row = count++;
  std::vector<std::vector<int>> rear(rows.size(), std::vector<int>(measured_wales, 0));
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (inside[i] != 0) {
      const Loop& loop = graph.loops[i];
      const int wale =
          std::clamp(static_cast<int>(std::lround(loop.slot - first_slot)), 0, measured_wales - 1);
      rear[static_cast<std::size_t>(rows[loop.pass])][static_cast<std::size_t>(wale)] =
          loop.side == StitchSide::rear ? 1 : 0;
    }

  double width = 0, height = 0, weight = 0;
  const auto height_count = static_cast<int>(rows.size());
  for (int r = 0; r + pattern_courses <= height_count; ++r)
    for (int w = 0; w + pattern_wales <= measured_wales; ++w) {
      FacePattern pattern = 0;
      for (int c = 0; c < pattern_courses; ++c)
        for (int k = 0; k < pattern_wales; ++k)
          if (rear[static_cast<std::size_t>(r + c)][static_cast<std::size_t>(w + k)] != 0)
            pattern |= 1U << (c * pattern_wales + k);
      const auto found = sizes.find(representative(pattern));
      if (found == sizes.end()) throw std::invalid_argument("the table of loop sizes lacks a pattern");
      width += found->second.wale_mm;
      height += found->second.course_mm;
      weight += 1;
    }
  p.width_mm = measured_wales * width / weight;
  p.height_mm = measured_courses * height / weight;
  p.converged = true;
  p.loops = static_cast<int>(graph.loops.size());
  p.seconds_knit = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return p;
}

}  // namespace loopwright
