// Changes of a notation at a needle. Whether the result can be written is the parser's to say: every change
// is tried on a copy, whose text is read again.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "notation/needle_diagram.hpp"
#include "notation/parse_course.hpp"
#include "notation/scan.hpp"
#include "notation/write_vermiculation.hpp"

namespace loopwright {
namespace {

using Kind = WrittenLine::Kind;

// Empty if the line can be written and read back.
std::string refusal_of(const CourseLine& line, const Vermiculation& notation) {
  Diagnostics diagnostics;
  const CourseLine read = parse_course(write_course(line, notation.yarns), 1, notation.yarns, diagnostics);
  if (!diagnostics.ok()) return diagnostics.list().front().message;
  return same_course(read, line) ? "" : "the notation cannot say this";
}

// Takes the changed line into the notation if it can be written.
std::string accept(Vermiculation& notation, std::size_t line, CourseLine&& changed) {
  std::string refusal = refusal_of(changed, notation);
  if (refusal.empty()) notation.lines[line] = std::move(changed);
  return refusal;
}

std::string no_such_pass(const Vermiculation& notation, std::size_t line, std::size_t pass) {
  if (line >= notation.lines.size()) return "there is no line " + std::to_string(line + 1);
  if (pass >= notation.lines[line].passes.size()) return "the line has no pass " + std::to_string(pass + 1);
  return {};
}

// Least common width of all passes; 0 beyond what a pass may hold.
std::size_t repeat_wales(const Vermiculation& notation) {
  std::size_t wales = 1;
  for (const CourseLine& line : notation.lines) {
    for (const Pass& pass : line.passes) {
      for (const std::size_t width : {pass.cells.size(), pass.rear.size()}) {
        if (width > 0) wales = std::lcm(wales, width);
        if (wales > most_wales) return 0;
      }
    }
  }
  return wales;
}

void repeat_cells(std::vector<Cell>& cells, std::size_t wales) {
  const std::size_t width = cells.size();
  for (std::size_t i = width; i < wales; ++i) {
    const Cell cell = cells[i - width];
    cells.push_back(cell);
  }
}

// Writes a pass out to so many wales; the rackings between its letters go with them.
void widen(Pass& pass, std::size_t wales) {
  const std::size_t width = pass.cells.size();
  if (width == 0) return;
  std::vector<RackMark> racks, inner;
  for (const RackMark& mark : pass.racks) (mark.before == 0 ? racks : inner).push_back(mark);
  const auto trailing = std::stable_partition(inner.begin(), inner.end(),
                                              [&](const RackMark& mark) { return mark.before < width; });
  for (std::size_t start = 0; start < wales; start += width) {
    for (auto mark = inner.begin(); mark != trailing; ++mark)
      racks.push_back({start + mark->before, mark->racking, mark->at});
  }
  for (auto mark = trailing; mark != inner.end(); ++mark) racks.push_back({wales, mark->racking, mark->at});
  pass.racks = std::move(racks);
  repeat_cells(pass.cells, wales);
  if (pass.both_beds) repeat_cells(pass.rear, wales);
}

bool is_idle(NeedleOperation operation) {
  return operation == NeedleOperation::missed || operation == NeedleOperation::inactive;
}

char letter_of(NeedleOperation operation, Bed bed) {
  switch (operation) {
    case NeedleOperation::stitch:
      return bed == Bed::front ? 'g' : 'e';
    case NeedleOperation::tuck:
      return bed == Bed::front ? 'v' : 'n';
    case NeedleOperation::transfer:
      return bed == Bed::front ? 't' : 'T';
    case NeedleOperation::split:
      return bed == Bed::front ? 's' : 'S';
    case NeedleOperation::drop:
      return bed == Bed::front ? 'd' : 'D';
    case NeedleOperation::missed:
      return '.';
    case NeedleOperation::inactive:
      return '-';
    default:
      return 0;
  }
}

bool works(char letter) { return letter != '.' && letter != '-'; }
bool works_on(char letter, Bed bed) { return works(letter) && is_rear_letter(letter) == (bed == Bed::back); }

// What is wrong with the place, and for change_operation the pass's row that holds the needle.
std::string check_place(const Vermiculation& notation, NeedlePlace place) {
  if (std::string problem = no_such_pass(notation, place.line, place.pass); !problem.empty()) return problem;
  if (is_slider(place.bed)) return "sliders are not in the notation";
  const std::size_t wales = repeat_wales(notation);
  if (wales == 0) return "the repeat is too wide to be written out";
  if (place.needle < 0 || static_cast<std::size_t>(place.needle) >= wales)
    return "the repeat has needles 0 to " + std::to_string(wales - 1);
  if (notation.lines[place.line].passes[place.pass].cells.empty())
    return "the line racks the beds and has no needles";
  return {};
}

const Cell& cell_at(const Pass& pass, NeedlePlace place) {
  const std::vector<Cell>& row = pass.both_beds && place.bed == Bed::back ? pass.rear : pass.cells;
  return row[static_cast<std::size_t>(place.needle) % row.size()];
}

// --- lines and their brackets

std::size_t closing(const std::vector<WrittenLine>& written, std::size_t open) {
  std::size_t depth = 0;
  for (std::size_t i = open; i < written.size(); ++i) {
    if (written[i].kind == Kind::open) ++depth;
    if (written[i].kind == Kind::close && --depth == 0) return i;
  }
  return written.size();
}

std::size_t courses_in(const std::vector<WrittenLine>& written, std::size_t begin, std::size_t end) {
  std::size_t courses = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (written[i].kind == Kind::course) ++courses;
    if (written[i].kind != Kind::open) continue;
    const std::size_t close = closing(written, i);
    if (close == written.size()) continue;
    courses += written[close].times * courses_in(written, i + 1, close);
    i = close;
  }
  return courses;
}

// Opens the bracket so that copy `copy` of it stands alone between what is left of it.
void open_bracket(std::vector<WrittenLine>& written, std::size_t open, std::size_t copy) {
  const std::size_t close = closing(written, open);
  const std::size_t times = written[close].times;
  const std::vector<WrittenLine> body(written.begin() + static_cast<std::ptrdiff_t>(open) + 1,
                                      written.begin() + static_cast<std::ptrdiff_t>(close));
  std::vector<WrittenLine> opened;
  bool comments = true;  // lines of comments stand with the first copy alone
  const auto add = [&](std::size_t copies) {
    if (copies == 0) return;
    if (copies > 1) opened.push_back({Kind::open, "[", 1});
    for (const WrittenLine& line : body) {
      if (line.kind == Kind::text && !comments) continue;
      opened.push_back(line);
    }
    comments = false;
    if (copies > 1) opened.push_back({Kind::close, "]*" + std::to_string(copies), copies});
  };
  add(copy);
  add(1);
  add(times - copy - 1);
  written.erase(written.begin() + static_cast<std::ptrdiff_t>(open),
                written.begin() + static_cast<std::ptrdiff_t>(close) + 1);
  written.insert(written.begin() + static_cast<std::ptrdiff_t>(open), opened.begin(), opened.end());
}

// Place in `written` of line `line` or, to insert before it, of the outermost bracket that starts with it.
// Brackets that stand in the way are opened. written.size() if there is no such line.
std::size_t place_of(std::vector<WrittenLine>& written, std::size_t line, bool to_insert) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < written.size(); ++i) {
    const Kind kind = written[i].kind;
    if (at == line && (kind == Kind::course || (to_insert && kind == Kind::open))) return i;
    if (kind == Kind::course) ++at;
    if (kind != Kind::open) continue;
    const std::size_t close = closing(written, i);
    if (close == written.size()) return close;
    const std::size_t length = courses_in(written, i + 1, close);
    if (line < at + length * written[close].times) {
      open_bracket(written, i, (line - at) / length);
      --i;  // what stands there now is looked at again
      continue;
    }
    at += length * written[close].times;
    i = close;
  }
  return written.size();
}

}  // namespace

std::string change_operation(Vermiculation& notation, NeedlePlace place, NeedleOperation operation) {
  if (std::string problem = check_place(notation, place); !problem.empty()) return problem;
  const char letter = letter_of(operation, place.bed);
  if (letter == 0) return "the notation has no letter for this";
  CourseLine changed = notation.lines[place.line];
  Pass& pass = changed.passes[place.pass];
  const char before = cell_at(pass, place).letter;
  if (!pass.both_beds && is_idle(operation) && works(before) && !works_on(before, place.bed))
    return {};  // the facing needle works; this one is idle already
  if (before == letter) return {};
  widen(pass, repeat_wales(notation));
  std::vector<Cell>& row = pass.both_beds && place.bed == Bed::back ? pass.rear : pass.cells;
  row[static_cast<std::size_t>(place.needle)].letter = letter;
  return accept(notation, place.line, std::move(changed));
}

std::string add_operation(Vermiculation& notation, NeedlePlace place, NeedleOperation operation) {
  if (std::string problem = check_place(notation, place); !problem.empty()) return problem;
  if (is_idle(operation)) return "an operation that is added does something";
  if (works(cell_at(notation.lines[place.line].passes[place.pass], place).letter))
    return "the needle works already; change its operation instead";
  return change_operation(notation, place, operation);
}

std::string remove_operation(Vermiculation& notation, NeedlePlace place) {
  if (std::string problem = check_place(notation, place); !problem.empty()) return problem;
  if (!works_on(cell_at(notation.lines[place.line].passes[place.pass], place).letter, place.bed))
    return "the needle does nothing that could be taken away";
  return change_operation(notation, place, NeedleOperation::missed);
}

std::string change_racking(Vermiculation& notation, std::size_t line, std::size_t pass,
                           std::optional<double> racking) {
  if (std::string problem = no_such_pass(notation, line, pass); !problem.empty()) return problem;
  CourseLine changed = notation.lines[line];
  std::vector<RackMark> racks;
  if (racking) racks.push_back({0, *racking + 0.0, changed.passes[pass].at});
  for (const RackMark& mark : changed.passes[pass].racks)
    if (mark.before > 0) racks.push_back(mark);
  changed.passes[pass].racks = std::move(racks);
  return accept(notation, line, std::move(changed));
}

std::string change_feeder(Vermiculation& notation, std::size_t line, std::size_t pass,
                          const std::vector<int>& yarns, Direction direction) {
  if (std::string problem = no_such_pass(notation, line, pass); !problem.empty()) return problem;
  for (const int yarn : yarns) {
    if (yarn < 0 || static_cast<std::size_t>(yarn) >= notation.yarns.size())
      return "there is no yarn " + std::to_string(yarn);
    const VermiculationYarn& named = notation.yarns[static_cast<std::size_t>(yarn)];
    if (named.at.line == 0 && notation.yarns.size() == 1)
      return "the file names no yarn; add a header ';;Yarn-" + named.name + ":'";
  }
  CourseLine changed = notation.lines[line];
  changed.passes[pass].yarns = yarns;
  changed.passes[pass].direction = direction;
  return accept(notation, line, std::move(changed));
}

std::string write_on_both_beds(Vermiculation& notation, std::size_t line, std::size_t pass) {
  if (std::string problem = no_such_pass(notation, line, pass); !problem.empty()) return problem;
  CourseLine changed = notation.lines[line];
  Pass& written = changed.passes[pass];
  if (written.both_beds) return {};
  if (written.cells.empty()) return "the line racks the beds and has no needles";
  written.both_beds = true;
  written.rear = written.cells;
  for (Cell& cell : written.cells)
    if (works(cell.letter) && !works_on(cell.letter, Bed::front)) cell.letter = '.';
  for (Cell& cell : written.rear)
    if (works(cell.letter) && !works_on(cell.letter, Bed::back)) cell.letter = '.';
  return accept(notation, line, std::move(changed));
}

std::string insert_line(Vermiculation& notation, std::size_t line, const CourseLine& course) {
  if (std::string refusal = refusal_of(course, notation); !refusal.empty()) return refusal;
  line = std::min(line, notation.lines.size());
  if (courses_in(notation.written, 0, notation.written.size()) == notation.lines.size()) {
    std::size_t place = place_of(notation.written, line, true);
    // comments on lines of their own go with the course below them
    while (line > 0 && line < notation.lines.size() && notation.written[place - 1].kind == Kind::text)
      --place;
    notation.written.insert(notation.written.begin() + static_cast<std::ptrdiff_t>(place),
                            {Kind::course, write_course(course, notation.yarns), 1});
  }
  notation.lines.insert(notation.lines.begin() + static_cast<std::ptrdiff_t>(line), course);
  return {};
}

std::string remove_line(Vermiculation& notation, std::size_t line) {
  if (std::string problem = no_such_pass(notation, line, 0); !problem.empty()) return problem;
  if (courses_in(notation.written, 0, notation.written.size()) == notation.lines.size()) {
    const std::size_t place = place_of(notation.written, line, false);
    notation.written.erase(notation.written.begin() + static_cast<std::ptrdiff_t>(place));
  }
  notation.lines.erase(notation.lines.begin() + static_cast<std::ptrdiff_t>(line));
  return {};
}

namespace {

// Every pass that is not of one letter, written out to the repeat and changed there by `change`.
template <class Change>
std::string change_all_passes(Vermiculation& notation, int wale, const Change& change) {
  const std::size_t wales = repeat_wales(notation);
  if (wales == 0) return "the repeat is too wide to be written out";
  if (wale < 0 || static_cast<std::size_t>(wale) >= wales)
    return "the repeat has wales 0 to " + std::to_string(wales - 1);
  std::vector<CourseLine> changed = notation.lines;
  for (CourseLine& line : changed)
    for (Pass& pass : line.passes) {
      if (pass.cells.size() <= 1 && pass.rear.size() <= 1) continue;
      widen(pass, wales);
      change(pass, static_cast<std::size_t>(wale));
    }
  for (const CourseLine& line : changed)
    if (std::string refusal = refusal_of(line, notation); !refusal.empty()) return refusal;
  notation.lines = std::move(changed);
  return {};
}

}  // namespace

std::string insert_wale(Vermiculation& notation, int wale) {
  return change_all_passes(notation, wale, [](Pass& pass, std::size_t at) {
    for (std::vector<Cell>* row : {&pass.cells, &pass.rear}) {
      if (row->empty()) continue;
      const Cell copy = (*row)[at];
      row->insert(row->begin() + static_cast<std::ptrdiff_t>(at), copy);
    }
    for (RackMark& mark : pass.racks)
      if (mark.before > at) ++mark.before;
  });
}

std::string remove_wale(Vermiculation& notation, int wale) {
  if (repeat_wales(notation) < 2) return "the repeat has a single wale, which stays";
  return change_all_passes(notation, wale, [](Pass& pass, std::size_t at) {
    for (std::vector<Cell>* row : {&pass.cells, &pass.rear})
      if (!row->empty()) row->erase(row->begin() + static_cast<std::ptrdiff_t>(at));
    for (RackMark& mark : pass.racks)
      if (mark.before > at) --mark.before;
  });
}

}  // namespace loopwright
