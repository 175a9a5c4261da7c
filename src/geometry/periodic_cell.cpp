#include "geometry/periodic_cell.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <map>
#include <stdexcept>
#include <string>

#include "geometry/assemble.hpp"

namespace loopwright {
namespace {

// A loop's place in its repeat: bed, slot in quarter needles from the cell's first slot, and in which of the
// repeat's passes that form loops it was made, counted from its first.
struct RepeatPlace {
  bool front = true;
  int quarter_slot = 0, pass = 0;
  friend auto operator<=>(const RepeatPlace&, const RepeatPlace&) = default;
};

using Shift = std::array<int, 2>;
Shift operator+(const Shift& a, const Shift& b) { return {a[0] + b[0], a[1] + b[1]}; }
Shift operator-(const Shift& a, const Shift& b) { return {a[0] - b[0], a[1] - b[1]}; }

class CellCutter {
 public:
  CellCutter(const YarnGraph& graph, const CellRange& range) : graph_(graph), range_(range) {
    if (range.wales <= 0 || range.repeat < 0 ||
        range.repeat + 1 >= static_cast<int>(range.repeat_starts.size()))
      throw std::invalid_argument("periodic cell: the range names no repeat of the piece");
    number_passes();
    places_.resize(graph.loops.size());
    shifts_.resize(graph.loops.size());
    for (std::size_t i = 0; i < graph.loops.size(); ++i) {
      const Loop& loop = graph.loops[i];
      const int block = block_of(loop.instruction);
      const int quarter = static_cast<int>(std::lround(4 * (loop.slot - range.first_slot)));
      const int width = 4 * range.wales;
      const int m = quarter >= 0 ? quarter / width : -((width - 1 - quarter) / width);
      const bool front = is_front(loop.bed);
      places_[i] = {front, quarter - m * width, pass_numbers_.at({block, loop.pass})};
      shifts_[i] = {m, block - range.repeat};
      if (m == 0 && block == range.repeat) {
        cell_.emplace(places_[i], LoopId(i));
        loops_.push_back(LoopId(i));
      }
    }
    if (loops_.empty()) throw std::invalid_argument("periodic cell: no loop lies in the range");
  }

  const std::vector<LoopId>& loops() const { return loops_; }

  // The cell's loop that `id` is an image of, and the shift to it.
  LoopId counterpart(LoopId id, Shift& shift) const {
    const auto found = cell_.find(places_[id.position()]);
    if (found == cell_.end())
      throw std::invalid_argument(
          "periodic cell: the loop of line " + std::to_string(graph_.loop(id).at.line) +
          " has no counterpart in the repeat; take a cell away from the edges, of whole repeats");
    shift = shifts_[id.position()];
    return found->second;
  }

  // The same without the error: invalid where there is none.
  CellImage image_of(LoopId id) const {
    const auto found = cell_.find(places_[id.position()]);
    if (found == cell_.end()) return {};
    return {found->second, shifts_[id.position()]};
  }

  // Calls visit(loop, shift) for the loops of the curve that begins with the cell's loop `start`, in their
  // order along it: on the curve they lie at this shift from their places in the cell. Returns the shift at
  // which the curve comes back to its start. `done`: the loops that were visited, by this and earlier walks.
  template <typename Visit>
  Shift walk(LoopId start, std::vector<std::uint8_t>& done, const Visit& visit) const {
    Shift at{0, 0};
    LoopId id = start;
    do {
      const Loop& loop = graph_.loop(id);
      if (done[id.position()] != 0)
        throw std::invalid_argument("periodic cell: two yarns lead to the loop of line " +
                                    std::to_string(loop.at.line));
      done[id.position()] = 1;
      const auto order = static_cast<std::size_t>(loop.order);
      const GraphYarn& yarn = graph_.yarns[loop.yarn.position()];
      if (order + 1 >= yarn.loops.size())
        throw std::invalid_argument("periodic cell: the yarn of line " + std::to_string(loop.at.line) +
                                    " ends in the cell");
      visit(id, at);
      Shift step;
      id = counterpart(yarn.loops[order + 1], step);
      at = at + step;
    } while (id != start);
    return at;
  }

  LoopId image(LoopId id, const Shift& wanted) const {
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (shifts_[i] == wanted && places_[i] == places_[id.position()]) return LoopId(i);
    return {};
  }

 private:
  // Passes that form loops, counted in each repeat from its first. What lies before the first repeat may be
  // no whole one: it is counted so that its last pass stands where a repeat has its last.
  void number_passes() {
    for (const Loop& loop : graph_.loops) pass_numbers_[{block_of(loop.instruction), loop.pass}] = 0;
    std::map<int, int> counts;
    for (auto& [key, number] : pass_numbers_) number = counts[key.first]++;
    const int before = counts[-1], whole = counts[range_.repeat];
    for (auto& [key, number] : pass_numbers_)
      if (key.first == -1) number += whole - before;
  }

  int block_of(int instruction) const {
    const auto after =
        std::upper_bound(range_.repeat_starts.begin(), range_.repeat_starts.end(), instruction);
    return static_cast<int>(after - range_.repeat_starts.begin()) - 1;
  }

  const YarnGraph& graph_;
  const CellRange& range_;
  std::map<std::pair<int, int>, int> pass_numbers_;  // (repeat, pass)
  std::vector<RepeatPlace> places_;
  std::vector<Shift> shifts_;
  std::map<RepeatPlace, LoopId> cell_;
  std::vector<LoopId> loops_;
};

// a2 from the places of the next or the last repeat.
Vec3 course_vector(const CellCutter& cutter, const Layout& layout) {
  Vec3 sum;
  double count = 0;
  for (const int n : {1, -1}) {
    for (const LoopId id : cutter.loops()) {
      const LoopId other = cutter.image(id, {0, n});
      if (!other.valid()) continue;
      sum += (layout.lower[other.position()] - layout.lower[id.position()]) * n;
      count += 1;
    }
    if (count > 0) break;
  }
  if (count == 0) throw std::invalid_argument("periodic cell: needs a repeat before or after it");
  return sum / count;
}

}  // namespace

CellRange cell_range(const Program& program) {
  const int wales = program.settings.repeat_wales;
  const int repeats = static_cast<int>(program.repeat_starts.size());
  if (wales <= 0 || repeats < 3)
    throw std::invalid_argument(
        "periodic cell: the programme has no repeat of its own, or fewer than three of it");
  CellRange range;
  range.wales = wales;
  range.repeat_starts = program.repeat_starts;
  range.repeat_starts.push_back(static_cast<int>(program.instructions.size()));
  int first = 0, last = repeats - 1;
  if (program.window.instructions > 0) {
    const int begin = program.window.first_instruction, end = begin + program.window.instructions;
    while (first + 1 < repeats && program.repeat_starts[static_cast<std::size_t>(first)] < begin) ++first;
    while (last > first && range.repeat_starts[static_cast<std::size_t>(last) + 1] > end) --last;
  }
  range.repeat = (first + last) / 2;
  range.first_slot = program.window.first_needle;
  if (program.window.needles > 0) range.first_slot += (program.window.needles / wales - 1) / 2 * wales;
  return range;
}

YarnCurves cut_periodic_cell(const YarnGraph& graph, const GeometryOptions& options, const PlacedPiece& piece,
                             const CellRange& range) {
  const CellCutter cutter(graph, range);
  YarnCurves curves;
  curves.diameter_mm = options.diameter_mm;
  curves.periodic = true;
  const Vec3 a2 = course_vector(cutter, piece.layout);
  curves.width = range.wales * piece.layout.slot_pitch;
  curves.height = a2.y;
  curves.skew = a2.x;
  const auto lattice = [&](const Shift& shift) {
    return Vec3{shift[0] * curves.width + shift[1] * curves.skew, shift[1] * curves.height, 0};
  };

  std::vector<std::uint8_t> done(graph.loops.size(), 0);
  std::vector<Shift> moved(graph.loops.size());  // by which image of a loop lies on its curve
  for (const LoopId start : cutter.loops()) {
    if (done[start.position()] != 0) continue;
    const int yarn = graph.loop(start).yarn.value;
    CurveYarn curve = empty_curve(graph, options, yarn);
    curve.periodic = true;
    curve.shift = cutter.walk(start, done, [&](LoopId id, const Shift& at) {
      const Loop& loop = graph.loop(id);
      moved[id.position()] = at;
      const std::size_t y = loop.yarn.position(), order = static_cast<std::size_t>(loop.order);
      const PlacedSinker& before = piece.sinkers[y][order];
      if (curve.points.empty()) curve.points.push_back(before.points[before.middle]);
      append_loop(loop, id, before, piece.loops[id.position()], piece.sinkers[y][order + 1], options,
                  lattice(at), curve);
    });
    curve.points.pop_back();  // the first point again, one period on
    curves.yarns.push_back(std::move(curve));
  }
  for (const Interlacing& interlacing : graph.interlacings) {
    if (done[interlacing.child.position()] == 0) continue;
    Shift of_parent;
    const LoopId parent = cutter.counterpart(interlacing.parent, of_parent);
    PlacedInterlacing placed;
    placed.parent = parent;
    placed.child = interlacing.child;
    placed.sign = interlacing.sign;
    placed.shift = moved[parent.position()] - moved[interlacing.child.position()] - of_parent;
    curves.interlacings.push_back(placed);
  }
  curves.wales = wales_of(graph, cutter.loops());
  curves.courses = courses_of(piece.layout, cutter.loops(), curves.wales);
  return curves;
}

std::vector<CellImage> cell_images(const YarnGraph& graph, const CellRange& range) {
  const CellCutter cutter(graph, range);
  std::vector<Shift> moved(graph.loops.size(), Shift{0, 0});
  std::vector<std::uint8_t> done(graph.loops.size(), 0);
  for (const LoopId start : cutter.loops())
    if (done[start.position()] == 0)
      cutter.walk(start, done, [&](LoopId id, const Shift& at) { moved[id.position()] = at; });
  std::vector<CellImage> images;
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    images.push_back(cutter.image_of(LoopId(i)));
    if (const LoopId loop = images.back().loop; loop.valid())
      images.back().shift = images.back().shift - moved[loop.position()];
  }
  return images;
}

}  // namespace loopwright
