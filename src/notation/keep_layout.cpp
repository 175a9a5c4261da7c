// What an edited programme still shares with the file that it came from is found by comparison: the programme
// that the file makes is written as lines in the same way as the edited one, and of the lines that agree the
// file's own are kept.
#include "notation/keep_layout.hpp"

#include <algorithm>
#include <numeric>

#include "notation/needle_diagram.hpp"
#include "notation/piece_plan.hpp"
#include "notation/scan.hpp"
#include "notation/write_vermiculation.hpp"

namespace loopwright {
namespace {

using Kind = WrittenLine::Kind;

constexpr std::size_t most_changed_places = 2'000;  // lines put in or taken out: each moves the whole file
constexpr std::size_t most_pairs = 4'000'000;       // lines against lines, where they are compared
constexpr std::size_t most_lines_written = 50'000;

bool same_instruction(const Instruction& a, const Instruction& b) {
  return a.op == b.op && a.direction == b.direction && a.needle == b.needle && a.target == b.target &&
         a.carriers == b.carriers && a.value == b.value && a.value2 == b.value2 && a.text == b.text;
}

// The programme that the notation makes under the settings that `program` was knitted with.
Program original_of(const Program& program, const Vermiculation& notation) {
  FabricOptions options;
  options.edges = program.settings.edges;
  options.size_wales = program.settings.size_wales;
  options.size_courses = program.settings.size_courses;
  Diagnostics unsaid;
  return compile_vermiculation(notation, options, unsaid);
}

// The racking that lines start with after this one: a line of rackings alone holds on.
double standing_after(const CourseLine& line, double standing) {
  const bool racks_alone = std::all_of(line.passes.begin(), line.passes.end(),
                                       [](const Pass& pass) { return pass.cells.empty(); });
  for (const Pass& pass : line.passes)
    for (const RackMark& mark : pass.racks)
      if (racks_alone) standing = mark.racking;
  return standing;
}

// The lines of all repeats, one after another, and their layout.
struct WholeNotation {
  Vermiculation notation;
  std::vector<std::size_t> first_line;  // of each repeat
};

void append_written(const std::vector<WrittenLine>& written, std::size_t& at, std::vector<WrittenLine>& all) {
  for (; at < written.size() && written[at].kind != Kind::close; ++at) {
    if (written[at].kind == Kind::course) all.push_back(written[at]);
    if (written[at].kind != Kind::open) continue;
    std::vector<WrittenLine> body;
    append_written(written, ++at, body);
    if (at == written.size()) return;
    for (std::size_t copy = 0; copy < written[at].times; ++copy)
      all.insert(all.end(), body.begin(), body.end());
  }
}

// The notation as often as the piece has repeats; the last one may end early. Every repeat starts with the
// beds at home: one that leaves them elsewhere is led by a line that says so.
std::optional<WholeNotation> whole_notation(const Vermiculation& source, const PiecePlan& plan) {
  const auto first_course = std::find_if(source.written.begin(), source.written.end(),
                                         [](const WrittenLine& line) { return line.kind >= Kind::open; });
  std::vector<WrittenLine> body(first_course, source.written.end());
  std::vector<CourseLine> lines = source.lines;
  std::vector<WrittenLine> each;  // the lines' layout, brackets written out
  std::size_t at = 0;
  append_written(body, at, each);
  if (each.size() != lines.size()) return std::nullopt;
  const int total = plan.courses + 2 * plan.margin_courses;
  const auto repeats_begun = static_cast<std::size_t>((total - 1) / plan.repeat_courses + 1);
  if (repeats_begun * (lines.size() + 1) > most_lines_written) return std::nullopt;
  double standing = 0;
  for (const CourseLine& line : lines) standing = standing_after(line, standing);
  const bool led = standing != 0 && repeats_begun > 1;
  if (led) {
    CourseLine home;
    home.passes.emplace_back().racks.push_back({});
    lines.insert(lines.begin(), home);
    for (auto* layout : {&body, &each}) layout->insert(layout->begin(), {Kind::course, "R0", 1, "\n"});
  }
  // the piece ends with its last course, unless all of the notation is knitted
  const int courses_of_last = (total - 1) % plan.repeat_courses + 1;
  std::size_t last = 0;
  for (int knitted = 0; last < lines.size() && (knitted < courses_of_last || plan.whole); ++last)
    if (lines[last].knits()) ++knitted;
  const std::size_t repeats = last == lines.size() ? repeats_begun : repeats_begun - 1;

  WholeNotation whole{source, {}};
  std::vector<WrittenLine>& written = whole.notation.written;
  written.assign(source.written.begin(), first_course);
  whole.notation.lines.clear();
  for (std::size_t r = 0; r < repeats_begun; ++r) {
    whole.first_line.push_back(whole.notation.lines.size() + (led ? 1 : 0));
    const auto end = r < repeats ? lines.end() : lines.begin() + static_cast<std::ptrdiff_t>(last);
    whole.notation.lines.insert(whole.notation.lines.end(), lines.begin(), end);
  }
  if (repeats > 1) written.push_back({Kind::open, "[", 1, "\n"});
  if (repeats > 0) written.insert(written.end(), body.begin(), body.end());
  if (repeats > 1) written.push_back({Kind::close, "]*" + std::to_string(repeats), repeats, "\n"});
  if (repeats < repeats_begun)
    written.insert(written.end(), each.begin(), each.begin() + static_cast<std::ptrdiff_t>(last));
  return whole;
}

// --- lines against lines

// Pairs (place in a, place in b) of equal lines, both rising: a longest common run of lines.
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

std::optional<Pairs> equal_lines(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  Pairs pairs;
  std::size_t begin = 0, end_a = a.size(), end_b = b.size();
  for (; begin < std::min(end_a, end_b) && a[begin] == b[begin]; ++begin) pairs.emplace_back(begin, begin);
  Pairs last;
  for (; end_a > begin && end_b > begin && a[end_a - 1] == b[end_b - 1]; --end_a, --end_b)
    last.emplace_back(end_a - 1, end_b - 1);
  const std::size_t rows = end_a - begin, columns = end_b - begin;
  if (rows > 0 && columns > 0) {
    if (rows > most_pairs / columns) return std::nullopt;
    // length[i][k]: of the longest common run of a from i on and b from k on
    std::vector<std::uint32_t> length((rows + 1) * (columns + 1), 0);
    const auto at = [&](std::size_t i, std::size_t k) -> std::uint32_t& {
      return length[i * (columns + 1) + k];
    };
    for (std::size_t i = rows; i-- > 0;)
      for (std::size_t k = columns; k-- > 0;)
        at(i, k) = a[begin + i] == b[begin + k] ? at(i + 1, k + 1) + 1 : std::max(at(i + 1, k), at(i, k + 1));
    for (std::size_t i = 0, k = 0; i < rows && k < columns;) {
      if (a[begin + i] == b[begin + k])
        pairs.emplace_back(begin + i++, begin + k++);
      else if (at(i + 1, k) >= at(i, k + 1))
        ++i;
      else
        ++k;
    }
  }
  pairs.insert(pairs.end(), last.rbegin(), last.rend());
  return pairs;
}

// The tiles of a row side by side, as wide as the piece.
void widen(std::vector<Cell>& row, std::size_t wales) {
  const std::vector<Cell> tile = row;
  row.resize(wales);
  for (std::size_t w = 0; w < wales; ++w) row[w] = tile[w % tile.size()];
}

class Merger {
 public:
  Merger(const Program& program, const Extent& extent, const PiecePlan& plan)
      : program_(program), extent_(extent), plan_(plan), notation_(notation_with_settings(program)) {
    extent_.gating = plan.gating;
  }

  std::optional<Vermiculation> merged() {
    const Program original = original_of(program_, *program_.notation);
    if (original.repeat_starts.size() < 2 || notation_.yarns.size() < program_.carriers.size())
      return std::nullopt;
    if (!extent_.repeat) {
      auto whole = whole_notation(notation_, plan_);
      if (!whole) return std::nullopt;
      notation_ = std::move(whole->notation);
      first_line_ = std::move(whole->first_line);
    }
    Diagnostics lost;
    made_ = lines_of(original, extent_of(original), lost);
    wanted_ = lines_of(program_, extent_, lost);
    if (lost.warnings() > 0) return std::nullopt;
    slots_.assign(notation_.lines.size(), {});
    fresh_.assign(notation_.lines.size(), false);
    if (!find_slots(original) || !compare() || !put_lines()) return std::nullopt;
    keep_rackings();
    if (!fit_width()) return std::nullopt;
    if (!extent_.repeat) {
      const bool binds_off =
          extent_.end < program_.instructions.size() && program_.settings.edges == Edges::bound_off;
      notation_.settings.edges = binds_off ? Edges::bound_off : Edges::free;
      notation_.settings.size_wales = notation_.settings.size_courses = 0;
    }
    keep_gating();
    return std::move(notation_);
  }

 private:
  // The part of the unchanged programme that corresponds to what is written of the changed one.
  Extent extent_of(const Program& original) const {
    Extent extent = extent_;
    const std::vector<int>& starts = original.repeat_starts;
    const std::size_t taken = starts.size() > 3 ? 1 : 0;
    extent.begin = extent_.repeat ? static_cast<std::size_t>(starts[taken]) : 0;
    extent.end = static_cast<std::size_t>(extent_.repeat ? starts[taken + 1] : starts.back());
    return extent;
  }

  struct Lines {
    std::vector<CourseLine> wide, narrow;
    std::vector<std::size_t> begin;
    std::vector<std::string> text;  // of the wide ones
  };

  // Lines that name the yarns as the file does.
  Lines lines_of(const Program& program, const Extent& extent, Diagnostics& lost) const {
    DecompiledProgram all = decompile(program, extent, lost);
    Lines lines{std::move(all.wide), std::move(all.notation.lines), std::move(all.begin), {}};
    for (auto* each : {&lines.wide, &lines.narrow})
      for (CourseLine& line : *each)
        for (Pass& pass : line.passes) {
          if (!pass.carries_yarn()) continue;
          if (pass.yarns.empty()) pass.yarns.push_back(0);
          for (int& yarn : pass.yarns)
            yarn = static_cast<int>(all.carrier_of_yarn[static_cast<std::size_t>(yarn)]);
          if (pass.yarns == std::vector<int>{0}) pass.yarns.clear();
        }
    for (const CourseLine& line : lines.wide) lines.text.push_back(write_course(line, notation_.yarns));
    return lines;
  }

  // Which line of the file each line of the unchanged programme comes from: found by knitting the notation
  // once more with its lines numbered.
  bool find_slots(const Program& original) {
    Vermiculation numbered = *program_.notation;
    int number = 0;
    for (CourseLine& line : numbered.lines) {
      ++number;
      for (Pass& pass : line.passes) {
        pass.at.line = number;
        for (auto* row : {&pass.cells, &pass.rear})
          for (Cell& cell : *row) cell.at.line = number;
      }
    }
    const Program again = original_of(program_, numbered);
    if (!same_instructions(again, original)) return false;
    for (const std::size_t begin : made_.begin) {
      const int line = again.instructions[begin].at.line - 1;
      if (line < 0) return false;
      auto slot = static_cast<std::size_t>(line);
      if (!extent_.repeat) {
        const auto next = std::upper_bound(original.repeat_starts.begin(), original.repeat_starts.end(),
                                           static_cast<int>(begin));
        const auto repeat = static_cast<std::size_t>(next - original.repeat_starts.begin()) - 1;
        if (repeat >= first_line_.size()) return false;
        slot += first_line_[repeat];
      }
      if (slot >= slots_.size() || (!slot_of_.empty() && slot < slot_of_.back())) return false;
      ++slots_[slot].made;
      slot_of_.push_back(slot);
    }
    return true;
  }

  // Lines that agree are kept. Between two that agree, one that stands at the place of another in the file,
  // or is its only counterpart, becomes that line; the rest is put in after the line before it.
  bool compare() {
    const auto pairs = equal_lines(made_.text, wanted_.text);
    if (!pairs) return false;
    std::size_t a = 0, b = 0;
    const auto between = [&](std::size_t end_a, std::size_t end_b) {
      const bool as_many = end_a - a == end_b - b;
      for (std::size_t i = a; i < end_a; ++i) slots_[slot_of_[i]].kept = false;
      for (; b < end_b; ++b) {
        std::size_t partner = a;
        const int line = wanted_.wide[b].passes.front().at.line;
        while (!as_many && partner < end_a && made_.wide[partner].passes.front().at.line != line) ++partner;
        if (partner < end_a) a = partner + 1;
        if (a > 0)
          slots_[slot_of_[a - 1]].becomes.push_back(b);
        else
          before_all_.push_back(b);
      }
      a = end_a;
    };
    for (const auto& [i, k] : *pairs) {
      between(i, k);
      slots_[slot_of_[i]].becomes.push_back(k);
      a = i + 1;
      b = k + 1;
    }
    between(slot_of_.size(), wanted_.wide.size());
    return true;
  }

  bool put_in(std::size_t line, std::size_t wanted) {
    if (!insert_line(notation_, line, wanted_.narrow[wanted]).empty()) return false;
    fresh_.insert(fresh_.begin() + static_cast<std::ptrdiff_t>(line), true);
    return ++places_ <= most_changed_places;
  }

  bool put_lines() {
    for (std::size_t s = slots_.size(); s-- > 0;) {
      const Slot& slot = slots_[s];
      if (slot.made == 0) continue;  // a racking, say: it stays
      if (slot.becomes.empty()) {
        if (++places_ > most_changed_places || !remove_line(notation_, s).empty()) return false;
        fresh_.erase(fresh_.begin() + static_cast<std::ptrdiff_t>(s));
        continue;
      }
      for (std::size_t k = slot.becomes.size(); k-- > (slot.kept ? slot.made : 1);)
        if (!put_in(s + 1, slot.becomes[k])) return false;
      if (slot.kept) continue;
      notation_.lines[s] = wanted_.narrow[slot.becomes.front()];
      fresh_[s] = true;
    }
    for (std::size_t k = before_all_.size(); k-- > 0;)
      if (!put_in(0, before_all_[k])) return false;
    return true;
  }

  // A changed line says its racking as if the beds were at home; a racking on a line of its own before it
  // holds on.
  void keep_rackings() {
    double standing = 0;
    for (std::size_t i = 0; i < notation_.lines.size(); ++i) {
      CourseLine& line = notation_.lines[i];
      std::vector<RackMark>& first = line.passes.front().racks;
      if (fresh_[i] && standing != 0 && (first.empty() || first.front().before > 0)) {
        std::vector<RackMark> home{{0, 0, line.passes.front().at}};
        home.insert(home.end(), first.begin(), first.end());
        first = std::move(home);
      }
      standing = standing_after(line, standing);
    }
  }

  // Rows that do not divide the piece are written out, and one if the piece would lose its width.
  bool fit_width() {
    const auto wales = static_cast<std::size_t>(extent_.wales);
    std::size_t width = 1;
    Pass* first = nullptr;
    for (CourseLine& line : notation_.lines) {
      for (Pass& pass : line.passes) {
        if (pass.cells.empty()) continue;
        if (!first && pass.carries_yarn()) first = &pass;
        const bool fits =
            wales % pass.cells.size() == 0 && (!pass.both_beds || wales % pass.rear.size() == 0);
        if (!fits && !write_out(pass, wales)) return false;
        width = std::lcm(width, pass.cells.size());
        if (pass.both_beds) width = std::lcm(width, pass.rear.size());
      }
    }
    return width == wales || (first && write_out(*first, wales));
  }

  static bool write_out(Pass& pass, std::size_t wales) {
    for (RackMark& mark : pass.racks) {
      if (mark.before == 0) continue;
      if (mark.before < pass.cells.size()) return false;
      mark.before = wales;
    }
    widen(pass.cells, wales);
    if (pass.both_beds) widen(pass.rear, wales);
    return true;
  }

  // Where the file left it to the letters, they may say something else now.
  void keep_gating() {
    Diagnostics unsaid;
    FabricSettings settings = notation_.settings;
    const auto plan = plan_piece(notation_, {}, settings, unsaid);
    if (plan && plan->gating != plan_.gating) notation_.gating = plan_.gating;
  }

  // What becomes of a line of the file.
  struct Slot {
    std::size_t made = 0;              // lines of the programme that the file makes come from it
    bool kept = true;                  // all of those are in the edited programme
    std::vector<std::size_t> becomes;  // lines of the edited programme that stand in its place
  };

  const Program& program_;
  Extent extent_;
  const PiecePlan& plan_;
  Vermiculation notation_;
  Lines made_, wanted_;                  // of the programme that the file makes, and of the edited one
  std::vector<std::size_t> first_line_;  // of each repeat, where all are written
  std::vector<Slot> slots_;              // by line of the notation
  std::vector<std::size_t> slot_of_;     // by line of the unchanged programme
  std::vector<std::size_t> before_all_;
  std::vector<bool> fresh_;  // by line of the notation as it becomes
  std::size_t places_ = 0;
};

std::optional<PiecePlan> plan_of(const Program& program) {
  Diagnostics unsaid;
  FabricSettings settings = program.settings;
  FabricOptions options;
  options.edges = settings.edges;
  return plan_piece(*program.notation, options, settings, unsaid);
}

// A name for the yarn of a carrier that the file does not have.
std::string new_yarn_name(const std::string& carrier, const std::vector<VermiculationYarn>& yarns) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(yarns.begin(), yarns.end(), [&](const auto& yarn) { return yarn.name == name; });
  };
  const bool fits =
      carrier.size() <= 20 && !carrier.empty() && is_letter(carrier.front()) &&
      std::all_of(carrier.begin(), carrier.end(), [](char c) { return is_letter(c) || is_digit(c); });
  if (fits && !taken(carrier)) return carrier;
  std::string name = "A";
  while (name.front() < 'Z' && taken(name)) ++name.front();
  return name;
}

}  // namespace

bool same_instructions(const Program& a, const Program& b) {
  return a.carriers == b.carriers &&
         std::equal(a.instructions.begin(), a.instructions.end(), b.instructions.begin(),
                    b.instructions.end(), same_instruction);
}

Vermiculation notation_with_settings(const Program& program) {
  Vermiculation notation = *program.notation;
  const FabricSettings& wanted = program.settings;
  const Edges said = notation.settings.edges.value_or(Edges::held);
  const std::optional<Edges> edges = wanted.edges == said ? notation.settings.edges : wanted.edges;
  notation.settings = wanted;
  notation.settings.edges = edges;
  notation.settings.repeat_wales = notation.settings.repeat_courses = 0;
  notation.headers = program.headers;
  for (std::size_t i = 0; i < program.yarns.size() && i < program.carriers.size(); ++i) {
    if (i == notation.yarns.size())
      notation.yarns.push_back({new_yarn_name(program.carriers[i], notation.yarns), {}, {1, 1}});
    notation.yarns[i].data = program.yarns[i];
  }
  for (std::size_t i = 0; i < program.carriers.size() && i < notation.yarns.size(); ++i) {
    const bool named = i < notation.carriers.size();
    if (program.carriers[i] == (named ? notation.carriers[i] : notation.yarns[i].name)) continue;
    notation.carriers = program.carriers;
    break;
  }
  return notation;
}

std::optional<Extent> needles_of_notation(const Program& program) {
  const auto plan = program.notation ? plan_of(program) : std::nullopt;
  if (!plan) return std::nullopt;
  Extent extent;
  extent.first = plan->first;
  extent.wales = plan->last - plan->first;
  // what stands after the last repeat when it is knitted, if it still stands there
  const Program original = original_of(program, *program.notation);
  extent.end = program.instructions.size();
  if (original.repeat_starts.empty()) return extent;
  const auto after = static_cast<std::ptrdiff_t>(original.repeat_starts.back());
  const auto length = static_cast<std::ptrdiff_t>(original.instructions.size()) - after;
  if (length <= static_cast<std::ptrdiff_t>(program.instructions.size()) &&
      std::equal(original.instructions.begin() + after, original.instructions.end(),
                 program.instructions.end() - length, same_instruction))
    extent.end -= static_cast<std::size_t>(length);
  return extent;
}

std::optional<Vermiculation> notation_with_changes(const Program& program, const Extent& extent) {
  const auto plan = plan_of(program);
  if (!plan) return std::nullopt;
  return Merger(program, extent, *plan).merged();
}

}  // namespace loopwright
