#include "geometry/find_repeat.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>

namespace loopwright {
namespace {

int quarters(double slots) { return static_cast<int>(std::lround(4 * slots)); }

// The region as a table: rows are passes that formed loops, columns slots; in each place a number that says
// what was formed there (0: nothing).
struct StitchTable {
  int first_slot = 0, columns = 0;
  std::vector<int> passes;             // [row]
  std::vector<int> all_instructions;   // first instruction of every pass of the whole piece
  int first_row = 0;                   // number of passes[0] among these
  std::vector<std::int32_t> stitches;  // [row * columns + column]

  int rows() const { return static_cast<int>(passes.size()); }
  std::int32_t at(int row, int column) const {
    return stitches[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(column)];
  }
};

// Passes that formed loops, numbered in order; [pass] -> row, over the whole piece.
std::map<int, int> rows_of_passes(const YarnGraph& graph) {
  std::map<int, int> rows;
  for (const Loop& loop : graph.loops) rows[loop.pass] = 0;
  int row = 0;
  for (auto& [pass, number] : rows) number = row++;
  return rows;
}

// What makes a loop like another one, in words that can be compared.
std::string description(const YarnGraph& graph, const std::map<int, int>& rows, LoopId id,
                        const std::vector<std::vector<std::pair<LoopId, bool>>>& crossings) {
  const Loop& loop = graph.loop(id);
  const int row = rows.at(loop.pass);
  std::string text;
  const auto add = [&text](int number) { text += std::to_string(number) + ' '; };
  const auto add_place = [&](LoopId other) {
    add(quarters(graph.loop(other).slot - loop.slot));
    add(rows.at(graph.loop(other).pass) - row);
  };
  add(graph.yarns[loop.yarn.position()].carrier.value);
  add(quarters(loop.slot - std::floor(loop.slot)));
  add(static_cast<int>(loop.kind));
  add(static_cast<int>(loop.side));
  add(static_cast<int>(loop.bed));
  add(static_cast<int>(loop.head_bed));
  add(quarters(loop.head_slot - loop.slot));
  add(loop.head_rank);
  add(loop.head_count);
  for (const LoopId parent : loop.parents) add_place(parent);
  text += '/';
  for (const LoopId child : loop.children) add_place(child);
  text += '/';
  for (const auto& [other, in_front] : crossings[id.position()]) {
    add_place(other);
    add(in_front ? 1 : 0);
  }
  return text;
}

StitchTable stitch_table(const YarnGraph& graph, const LoopSelection& region) {
  const std::map<int, int> rows = rows_of_passes(graph);
  std::vector<std::vector<std::pair<LoopId, bool>>> crossings(graph.loops.size());
  for (const LegCrossing& crossing : graph.leg_crossings) {
    crossings[crossing.front.position()].emplace_back(crossing.back, true);
    crossings[crossing.back.position()].emplace_back(crossing.front, false);
  }
  StitchTable table;
  std::map<int, int> instructions;  // of a pass, its first
  int last_slot = 0;
  bool first = true;
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const Loop& loop = graph.loops[i];
    const auto [entry, fresh] = instructions.emplace(loop.pass, loop.instruction);
    if (!fresh) entry->second = std::min(entry->second, loop.instruction);
    if (region[i] == 0) continue;
    const int slot = static_cast<int>(std::floor(loop.slot));
    table.first_slot = first ? slot : std::min(table.first_slot, slot);
    last_slot = first ? slot : std::max(last_slot, slot);
    first = false;
    table.passes.push_back(loop.pass);
  }
  if (first) return table;
  std::sort(table.passes.begin(), table.passes.end());
  table.passes.erase(std::unique(table.passes.begin(), table.passes.end()), table.passes.end());
  for (const auto& [pass, instruction] : instructions) table.all_instructions.push_back(instruction);
  table.first_row = rows.at(table.passes.front());
  table.columns = last_slot - table.first_slot + 1;

  // Several loops may lie in one place (two beds, half-way slots): all of them, in order.
  std::map<std::pair<int, int>, std::vector<std::string>> found;
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    if (region[i] == 0) continue;
    const Loop& loop = graph.loops[i];
    const auto row =
        std::lower_bound(table.passes.begin(), table.passes.end(), loop.pass) - table.passes.begin();
    const int column = static_cast<int>(std::floor(loop.slot)) - table.first_slot;
    found[{static_cast<int>(row), column}].push_back(description(graph, rows, LoopId(i), crossings));
  }
  std::map<std::vector<std::string>, std::int32_t> numbers;
  table.stitches.assign(static_cast<std::size_t>(table.rows()) * static_cast<std::size_t>(table.columns), 0);
  for (auto& [place, stitches] : found) {
    std::sort(stitches.begin(), stitches.end());
    const auto number = static_cast<std::int32_t>(numbers.size()) + 1;
    table.stitches[static_cast<std::size_t>(place.first) * static_cast<std::size_t>(table.columns) +
                   static_cast<std::size_t>(place.second)] = numbers.emplace(stitches, number).first->second;
  }
  return table;
}

bool rows_alike(const StitchTable& table, int a, int b) {
  for (int c = 0; c < table.columns; ++c)
    if (table.at(a, c) != table.at(b, c)) return false;
  return true;
}

bool columns_alike(const StitchTable& table, int a, int b) {
  for (int r = 0; r < table.rows(); ++r)
    if (table.at(r, a) != table.at(r, b)) return false;
  return true;
}

// Part of the region, in rows or columns from `first` on, that repeats after `period`.
struct Stretch {
  int period = 0, first = 0, size = 0;
};

// The longest run in which `alike(k, k + period)` holds, with the period that follows it.
template <typename Alike>
Stretch longest_run(int count, int period, const Alike& alike) {
  Stretch best{period, 0, 0};
  int run = 0;
  for (int k = 0; k + period < count; ++k) {
    run = alike(k, k + period) ? run + 1 : 0;
    if (run + period > best.size && run > 0) best = {period, k - run + 1, run + period};
  }
  return best;
}

// The table without `margin` columns on either side.
StitchTable without_margins(const StitchTable& table, int margin) {
  StitchTable inner = table;
  inner.first_slot += margin;
  inner.columns -= 2 * margin;
  inner.stitches.clear();
  for (int r = 0; r < table.rows(); ++r)
    for (int c = margin; c < table.columns - margin; ++c) inner.stitches.push_back(table.at(r, c));
  return inner;
}

// The table without the passes at its ends that the region only grazes: it need not follow passes where wales
// of one piece rise faster than others.
StitchTable whole_rows(StitchTable table) {
  std::vector<int> filled;
  for (int r = 0; r < table.rows(); ++r) {
    filled.push_back(0);
    for (int c = 0; c < table.columns; ++c) filled.back() += table.at(r, c) != 0 ? 1 : 0;
  }
  if (filled.empty()) return table;
  const int most = *std::max_element(filled.begin(), filled.end());
  int first = 0, last = table.rows();
  while (first < last && 10 * filled[static_cast<std::size_t>(first)] < 9 * most) ++first;
  while (last > first && 10 * filled[static_cast<std::size_t>(last) - 1] < 9 * most) --last;
  const auto place = [&table](int row) { return static_cast<std::ptrdiff_t>(row) * table.columns; };
  table.stitches = {table.stitches.begin() + place(first), table.stitches.begin() + place(last)};
  table.passes = {table.passes.begin() + first, table.passes.begin() + last};
  table.first_row += first;
  return table;
}

std::optional<FoundRepeat> repeat_in(const StitchTable& table, int least_seen) {
  if (table.columns < 2 || table.rows() < 2) return std::nullopt;

  // Courses: nearly all of them. The first and last pass of a region border on other stitches, and patterns
  // often have a plain course or two there.
  constexpr double rows_share = 0.85, nearly_all = 0.9, longer_share = 0.3;
  const auto same_rows = [&table](int a, int b) { return rows_alike(table, a, b); };
  Stretch courses;
  for (int period = 1; period < table.rows() && courses.period == 0; ++period) {
    const Stretch run = longest_run(table.rows(), period, same_rows);
    if (run.size >= rows_share * table.rows() && run.size - period >= std::min(period, least_seen))
      courses = run;
  }
  if (courses.period == 0) return std::nullopt;

  // Wales, in the passes that repeat.
  StitchTable part = table;
  part.passes.resize(static_cast<std::size_t>(courses.size));
  part.stitches.assign(table.stitches.begin() + courses.first * table.columns,
                       table.stitches.begin() + (courses.first + courses.size) * table.columns);
  const auto same_columns = [&part](int a, int b) { return columns_alike(part, a, b); };
  // The smallest period that holds nearly everywhere and is seen twice; else a longer one must cover clearly
  // more than a shorter one does: a period of nearly all columns holds trivially.
  Stretch wales;
  for (int period = 1; period < table.columns; ++period) {
    const Stretch run = longest_run(table.columns, period, same_columns);
    if (run.size < 2 * period && run.size < period + least_seen) continue;
    if (run.size >= nearly_all * table.columns && run.size >= 2 * period) {
      wales = run;
      break;
    }
    if (wales.period == 0 || run.size > wales.size + longer_share * table.columns) wales = run;
  }
  if (wales.period == 0) return std::nullopt;

  FoundRepeat found;
  found.courses = courses.period;
  found.wales_share = static_cast<double>(wales.size) / table.columns;
  found.courses_share = static_cast<double>(courses.size) / table.rows();
  found.range.wales = wales.period;
  found.range.first_slot = table.first_slot + wales.first + (wales.size - wales.period) / 2;
  // The middle repeat, and all that fit into the piece before and after it.
  const auto& starts = part.all_instructions;
  const int first = part.first_row + courses.first + (courses.size - courses.period) / 2;
  int start = first % courses.period;
  for (; start < static_cast<int>(starts.size()); start += courses.period) {
    if (start == first) found.range.repeat = static_cast<int>(found.range.repeat_starts.size());
    found.range.repeat_starts.push_back(starts[static_cast<std::size_t>(start)]);
  }
  found.range.repeat_starts.push_back(std::numeric_limits<int>::max());
  // The cell's height is its distance from what repeats before or after it.
  if (first < 1 && first + courses.period >= static_cast<int>(starts.size())) return std::nullopt;
  return found;
}

}  // namespace

std::optional<FoundRepeat> find_repeat(const YarnGraph& graph, const LoopSelection& region, int least_seen) {
  const StitchTable table = whole_rows(stitch_table(graph, region));
  // A region's sides may have stitches of their own in some courses: then its middle decides.
  for (const int part : {0, 12, 6}) {
    const int margin = part == 0 ? 0 : table.columns / part;
    std::optional<FoundRepeat> found = repeat_in(without_margins(table, margin), least_seen);
    if (!found) continue;
    found->wales_share *= static_cast<double>(table.columns - 2 * margin) / table.columns;
    return found;
  }
  return std::nullopt;
}

std::optional<FoundRepeat> find_repeat(const YarnGraph& graph) {
  const std::map<int, int> rows = rows_of_passes(graph);
  double first = 0, last = 0;
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    first = i == 0 ? graph.loops[i].slot : std::min(first, graph.loops[i].slot);
    last = i == 0 ? graph.loops[i].slot : std::max(last, graph.loops[i].slot);
  }
  const double middle_row = (static_cast<double>(rows.size()) - 1) / 2, middle_slot = (first + last) / 2;
  for (const double share : {0.9, 2.0 / 3, 0.5}) {
    LoopSelection region(graph.loops.size(), 0);
    for (std::size_t i = 0; i < region.size(); ++i) {
      const Loop& loop = graph.loops[i];
      if (std::abs(rows.at(loop.pass) - middle_row) < share * (middle_row + 0.5) &&
          std::abs(loop.slot - middle_slot) < share * (last - first + 1) / 2)
        region[i] = 1;
    }
    if (std::optional<FoundRepeat> found = find_repeat(graph, region)) return found;
  }
  return std::nullopt;
}

}  // namespace loopwright
