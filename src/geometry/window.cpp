#include "geometry/window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/assemble.hpp"

namespace loopwright {
namespace {

// A tube: two layers, each knitted for itself, and at most turns the yarn goes over to the other bed.
bool is_tube(const YarnGraph& graph, const Layout& layout) {
  const auto overlaid = std::count(layout.overlaid.begin(), layout.overlaid.end(), 1);
  if (2 * static_cast<std::size_t>(overlaid) < graph.loops.size()) return false;
  int turns = 0, turns_over = 0, steps = 0, steps_over = 0;
  for (const GraphYarn& yarn : graph.yarns)
    for (std::size_t k = 0; k + 1 < yarn.loops.size(); ++k) {
      const Loop& from = graph.loop(yarn.loops[k]);
      const Loop& to = graph.loop(yarn.loops[k + 1]);
      const bool over = is_front(from.bed) != is_front(to.bed);
      (from.direction == to.direction ? steps : turns) += 1;
      if (over) (from.direction == to.direction ? steps_over : turns_over) += 1;
    }
  return turns > 0 && 10 * turns_over > 6 * turns && 10 * steps_over < steps;
}

struct Gap {
  double limit = 0;  // lies in the gap
  double miss = 0;   // how many loops more or less than wanted are nearer than that, and how small the gap is
};

// The gap in sorted distances near the `wanted`-th that cuts a course off cleanly: the widest for its place.
Gap gap_near(const std::vector<double>& distances, std::size_t wanted, std::size_t columns) {
  Gap best;
  best.miss = std::numeric_limits<double>::infinity();
  const std::size_t low = wanted > columns ? wanted - columns : 1;
  double widest = 1e-12;
  for (std::size_t k = low; k < std::min(wanted + columns, distances.size()); ++k)
    widest = std::max(widest, distances[k] - distances[k - 1]);
  for (std::size_t k = low; k < std::min(wanted + columns, distances.size()); ++k) {
    const double off =
        std::abs(static_cast<double>(k) - static_cast<double>(wanted)) / static_cast<double>(columns);
    const double miss = off + 1 - (distances[k] - distances[k - 1]) / widest;
    if (miss < best.miss) best = {(distances[k] + distances[k - 1]) / 2, miss};
  }
  return best;
}

}  // namespace

LoopSelection middle_window(const YarnGraph& graph, const Layout& layout, int wales, int courses) {
  const std::size_t n = graph.loops.size();
  LoopSelection selection(n, 1);
  if (n == 0) return selection;
  std::vector<double> slots;
  for (const Loop& loop : graph.loops) slots.push_back(loop.slot);
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end(), [](double a, double b) { return b - a < 0.25; }),
              slots.end());
  std::size_t columns = slots.size();
  if (wales > 0 && static_cast<std::size_t>(wales) < slots.size() && !is_tube(graph, layout)) {
    columns = static_cast<std::size_t>(wales);
    const std::size_t first = (slots.size() - columns) / 2;
    const double low = slots[first] - 0.125, high = slots[first + columns - 1] + 0.125;
    for (std::size_t i = 0; i < n; ++i)
      selection[i] = graph.loops[i].slot >= low && graph.loops[i].slot <= high;
  }
  if (courses <= 0) return selection;

  // Courses grow from the middle level until there are wales x courses loops, two layers counted as two.
  std::vector<double> levels;
  double overlaid = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (selection[i] == 0) continue;
    levels.push_back(layout.lower[i].y);
    overlaid += layout.overlaid[i];
  }
  const double layers = 1 + overlaid / static_cast<double>(levels.size());
  const double wanted = static_cast<double>(columns) * courses * layers;
  if (wanted >= static_cast<double>(levels.size())) return selection;
  // An odd number of courses lies round a course, an even one round the gap between two: the better of the
  // two centres.
  std::sort(levels.begin(), levels.end());
  const double middle = (levels[levels.size() / 2] + levels[(levels.size() - 1) / 2]) / 2;
  const double course = (levels.back() - levels.front()) * static_cast<double>(columns) * layers /
                        static_cast<double>(levels.size());
  double best_centre = middle, best_limit = 0, best_miss = std::numeric_limits<double>::infinity();
  for (const double centre : {middle, middle + course / 2}) {
    std::vector<double> distances;
    for (const double level : levels) distances.push_back(std::abs(level - centre));
    std::sort(distances.begin(), distances.end());
    const auto [limit, miss] = gap_near(distances, static_cast<std::size_t>(wanted), columns);
    if (miss >= best_miss) continue;
    best_miss = miss;
    best_limit = limit;
    best_centre = centre;
  }
  for (std::size_t i = 0; i < n; ++i)
    if (std::abs(layout.lower[i].y - best_centre) > best_limit) selection[i] = 0;
  return selection;
}

LoopSelection program_window(const YarnGraph& graph, const ProgramWindow& window) {
  LoopSelection selection(graph.loops.size(), 1);
  if (window.needles <= 0 && window.instructions <= 0) return selection;
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const Loop& loop = graph.loops[i];
    const bool needle =
        window.needles <= 0 || (loop.slot > window.first_needle - 0.5 &&
                                loop.slot < window.first_needle + window.needles - 0.5 + 1e-9);
    const bool time =
        window.instructions <= 0 || (loop.instruction >= window.first_instruction &&
                                     loop.instruction < window.first_instruction + window.instructions);
    selection[i] = needle && time;
  }
  return selection;
}

YarnCurves cut_window(const YarnGraph& graph, const GeometryOptions& options, const PlacedPiece& piece,
                      const LoopSelection& selection) {
  std::vector<YarnRun> runs;
  for (const YarnRun& whole : whole_yarns(graph)) {
    const GraphYarn& yarn = graph.yarns[static_cast<std::size_t>(whole.yarn)];
    for (int k = 0; k < whole.count; ++k) {
      if (selection[yarn.loops[static_cast<std::size_t>(k)].position()] == 0) continue;
      const bool joins =
          !runs.empty() && runs.back().yarn == whole.yarn && runs.back().first + runs.back().count == k;
      if (joins)
        ++runs.back().count;
      else
        runs.push_back({whole.yarn, k, 1});
    }
  }
  return assemble_runs(graph, options, piece, runs);
}

}  // namespace loopwright
