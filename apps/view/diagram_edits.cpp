#include "diagram_edits.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace loopwright {
namespace {

char letter_at(const std::vector<Cell>& row, int wale) {
  return row.empty() ? '-' : row[static_cast<std::size_t>(wale) % row.size()].letter;
}

// A change that is done as a whole or not at all.
template <class Change>
std::string at_once(Vermiculation& notation, const Change& change) {
  Vermiculation tried = notation;
  std::string problem = change(tried);
  if (problem.empty()) notation = std::move(tried);
  return problem;
}

std::string put(Vermiculation& notation, NeedlePlace place, char letter, bool rear_row) {
  const LetterMeaning meaning = meaning_of(letter, rear_row);
  place.bed = meaning.bed;
  return change_operation(notation, place, meaning.operation);
}

}  // namespace

int repeat_width(const Vermiculation& notation) {
  int wales = 1;
  for (const CourseLine& line : notation.lines)
    for (const Pass& pass : line.passes)
      for (const std::size_t width : {pass.cells.size(), pass.rear.size()})
        if (width > 0) wales = std::lcm(wales, static_cast<int>(width));
  return wales;
}

LetterMeaning meaning_of(char letter, bool rear_row) {
  const Bed bed = rear_row ? Bed::back : Bed::front;
  switch (letter) {
    case 'g':
      return {NeedleOperation::stitch, Bed::front};
    case 'e':
      return {NeedleOperation::stitch, Bed::back};
    case 'v':
      return {NeedleOperation::tuck, Bed::front};
    case 'n':
      return {NeedleOperation::tuck, Bed::back};
    case 's':
      return {NeedleOperation::split, Bed::front};
    case 'S':
      return {NeedleOperation::split, Bed::back};
    case 't':
      return {NeedleOperation::transfer, Bed::front};
    case 'T':
      return {NeedleOperation::transfer, Bed::back};
    case 'd':
      return {NeedleOperation::drop, Bed::front};
    case 'D':
      return {NeedleOperation::drop, Bed::back};
    case '.':
      return {NeedleOperation::missed, bed};
    case '-':
      return {NeedleOperation::inactive, bed};
    default:
      return {NeedleOperation::unused, bed};
  }
}

CopiedNeedles copied(const Vermiculation& notation, const DiagramArea& area) {
  CopiedNeedles copy;
  copy.wales = area.last_wale - area.first_wale + 1;
  for (std::size_t l = area.first_line; l <= area.last_line && l < notation.lines.size(); ++l) {
    copy.lines.emplace_back();
    for (const Pass& pass : notation.lines[l].passes) {
      CopiedNeedles::CopiedPass row{pass.both_beds, {}, {}};
      for (int w = area.first_wale; w <= area.last_wale; ++w) {
        row.front += letter_at(pass.cells, w);
        if (pass.both_beds) row.rear += letter_at(pass.rear, w);
      }
      copy.lines.back().push_back(std::move(row));
    }
  }
  return copy;
}

std::string paste(Vermiculation& notation, const CopiedNeedles& copy, std::size_t line, int wale) {
  return at_once(notation, [&](Vermiculation& tried) -> std::string {
    const int repeat = repeat_width(tried);
    for (std::size_t l = 0; l < copy.lines.size() && line + l < tried.lines.size(); ++l) {
      const auto& rows = copy.lines[l];
      for (std::size_t p = 0; p < rows.size() && p < tried.lines[line + l].passes.size(); ++p) {
        if (rows[p].both_beds)
          if (std::string problem = write_on_both_beds(tried, line + l, p); !problem.empty()) return problem;
        const bool target_both = tried.lines[line + l].passes[p].both_beds;
        for (int w = 0; w < std::min(copy.wales, repeat); ++w) {
          const NeedlePlace place{line + l, p, Bed::front, (wale + w) % repeat};
          const char front = rows[p].front[static_cast<std::size_t>(w)];
          // a single row's rear letters belong to the rear row of a pass that has one
          const bool to_rear = !rows[p].both_beds && target_both && is_rear_letter(front);
          if (std::string problem = put(tried, place, front, to_rear); !problem.empty()) return problem;
          if (rows[p].both_beds)
            if (std::string problem = put(tried, place, rows[p].rear[static_cast<std::size_t>(w)], true);
                !problem.empty())
              return problem;
        }
      }
    }
    return {};
  });
}

std::string repeat_lines(Vermiculation& notation, std::size_t first, std::size_t last, int times) {
  return at_once(notation, [&](Vermiculation& tried) -> std::string {
    if (first > last || last >= tried.lines.size()) return "there are no such courses";
    const std::vector<CourseLine> lines(tried.lines.begin() + static_cast<std::ptrdiff_t>(first),
                                        tried.lines.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    std::size_t at = last + 1;
    for (int k = 0; k < times; ++k)
      for (const CourseLine& line : lines)
        if (std::string problem = insert_line(tried, at++, line); !problem.empty()) return problem;
    return {};
  });
}

std::string remove_lines(Vermiculation& notation, std::size_t first, std::size_t last) {
  return at_once(notation, [&](Vermiculation& tried) -> std::string {
    if (first > last || last >= tried.lines.size()) return "there are no such courses";
    if (last - first + 1 == tried.lines.size()) return "the last course stays: a fabric needs one";
    for (std::size_t l = last + 1; l-- > first;)
      if (std::string problem = remove_line(tried, l); !problem.empty()) return problem;
    return {};
  });
}

std::string fill(Vermiculation& notation, const DiagramArea& area, Bed bed, NeedleOperation operation) {
  return at_once(notation, [&](Vermiculation& tried) -> std::string {
    for (std::size_t l = area.first_line; l <= area.last_line && l < tried.lines.size(); ++l)
      for (std::size_t p = 0; p < tried.lines[l].passes.size(); ++p) {
        if (tried.lines[l].passes[p].cells.empty()) continue;
        for (int w = area.first_wale; w <= area.last_wale; ++w)
          if (std::string problem = change_operation(tried, {l, p, bed, w}, operation); !problem.empty())
            return problem;
      }
    return {};
  });
}

}  // namespace loopwright
