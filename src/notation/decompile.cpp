// Passes of a programme as lines of letters.
#include "notation/decompile.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "notation/fabric_headers.hpp"
#include "notation/parse_course.hpp"
#include "notation/program_passes.hpp"
#include "notation/scan.hpp"
#include "notation/write_knitout.hpp"
#include "notation/write_vermiculation.hpp"

namespace loopwright {
namespace {

using Kind = WrittenLine::Kind;

bool is_loop(Op op) { return op == Op::knit || op == Op::tuck || op == Op::split; }
Bed hook_bed(Bed bed) { return is_front(bed) ? Bed::front : Bed::back; }
Needle hook(Needle needle) { return {hook_bed(needle.bed), needle.index}; }
Needle facing(Needle needle) { return {is_front(needle.bed) ? Bed::back : Bed::front, needle.index}; }
char letter_of(const Instruction& each) {
  const bool front = is_front(each.needle.bed);
  if (each.op == Op::miss) return '.';
  if (each.op == Op::tuck) return front ? 'v' : 'n';
  if (each.op == Op::split) return front ? 's' : 'S';
  return front ? 'g' : 'e';
}

class Decompiler {
 public:
  Decompiler(const Program& program, const Extent& extent, Diagnostics& lost)
      : program_(program), extent_(extent), lost_(lost) {}

  DecompiledProgram decompiled() {
    const std::vector<ProgramPass> passes = passes_of(program_);
    result_.file = program_.file;
    name_yarns(passes);
    find_gating(passes);
    last_direction_.assign(program_.carriers.size(), Direction::none);
    starts_left_.assign(program_.carriers.size(), false);
    seen_in_repeat_ = starts_left_;
    tell_machine_state();
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const ProgramPass& pass = passes[i];
      const bool wanted = pass.begin >= extent_.begin && pass.end <= extent_.end;
      if (pass.yarn)
        add_yarn_pass(passes, i, wanted);
      else
        add_transfers(passes, i, wanted);
    }
    std::vector<CourseLine> wide = result_.lines;
    narrow_rows();
    fold_lines();
    return {std::move(result_), std::move(wide), std::move(line_begins_), std::move(carrier_of_yarn_)};
  }

 private:
  void lose(const Instruction& each, const std::string& what) { lost_.warning(each.at, what); }

  // --- yarns and settings

  void name_yarns(const std::vector<ProgramPass>& passes) {
    std::set<std::size_t> used;
    for (const ProgramPass& pass : passes)
      if (pass.yarn)
        for (const CarrierId id : program_.instructions[pass.begin].carriers) used.insert(id.position());
    bool names_fit = true;  // as names of yarns
    for (const std::size_t c : used) {
      const std::string& name = program_.carriers[c];
      names_fit = names_fit && name.size() <= 20 && is_letter(name.front()) &&
                  std::all_of(name.begin(), name.end(), [](char x) { return is_letter(x) || is_digit(x); });
    }
    yarn_of_.assign(program_.carriers.size(), 0);
    for (const std::size_t c : used) {
      const auto place = result_.yarns.size();
      yarn_of_[c] = static_cast<int>(place);
      carrier_of_yarn_.push_back(c);
      const std::string letter(1, static_cast<char>('A' + place % 26));
      result_.yarns.push_back({names_fit ? program_.carriers[c] : letter, program_.yarns[c], {1, 1}});
      if (!names_fit) result_.carriers.push_back(program_.carriers[c]);
    }
    result_.settings = program_.settings;
    result_.settings.repeat_wales = result_.settings.repeat_courses = 0;
    if (!extent_.repeat) {
      result_.settings.edges = Edges::free;
      result_.settings.size_wales = result_.settings.size_courses = 0;
    }
    for (const auto& [name, value] : program_.headers)
      if (name.starts_with("X-") && !is_fabric_header(name.substr(2)))
        result_.headers.emplace_back(name, value);
  }

  // Half-pitch gating where all stitches are made half-way between needles, as a fabric file without a word
  // on it is knitted.
  void find_gating(const std::vector<ProgramPass>& passes) {
    bool half = true, whole = true;
    for (const ProgramPass& pass : passes) {
      if (!pass.yarn) continue;
      half = half && pass.racking - std::floor(pass.racking) == 0.5;
      whole = whole && pass.racking == std::floor(pass.racking);
    }
    gating_ = half && !passes.empty() ? 0.5 : 0;
    result_.gating = gating_ > 0 ? Gating::half_pitch : Gating::opposite;
    if (extent_.gating) gating_ = extent_.gating == Gating::half_pitch ? 0.5 : 0;
    if (extent_.gating) result_.gating = extent_.gating;
    if (whole) result_.gating.reset();  // set again where needles that face each other take yarn in one pass
  }

  void tell_machine_state() {
    std::set<std::size_t> left;
    for (const Instruction& each : program_.instructions) {
      switch (each.op) {
        case Op::inhook:
        case Op::releasehook:
        case Op::outhook:
          lose(
              each,
              "'" + std::string(name_of(each.op)) +
                  "': the yarn inserting hook is not in the notation; carriers come in and leave without it");
          break;
        case Op::stitch:
          lose(each,
               "'stitch': stitch values are not in the notation; ;;Loop-Length says how long loops are");
          break;
        case Op::pause:
          lose(each, "'pause' is not in the notation");
          break;
        case Op::extension:
          // a colour stands with the yarn
          if (!each.text.starts_with("x-vis-color"))
            lose(each, "machine settings are not in the notation: " + quoted(each.text));
          break;
        default:
          break;
      }
      if (each.op == Op::out || each.op == Op::outhook)
        for (const CarrierId id : each.carriers) left.insert(id.position());
      if (each.op != Op::in && each.op != Op::inhook) continue;
      for (const CarrierId id : each.carriers)
        if (left.contains(id.position()))
          lose(each, "carrier " + program_.carriers[id.position()] +
                         " comes in a second time; in the notation its yarn is one piece");
    }
  }

  // --- needles

  int& held(Needle needle) { return held_[hook(needle)]; }
  std::size_t place(Needle needle) const { return static_cast<std::size_t>(needle.index - extent_.first); }
  bool inside(Needle needle) const {
    return needle.index >= extent_.first && needle.index < extent_.first + extent_.wales;
  }
  Needle shifted(Needle needle) const { return {needle.bed, needle.index - extent_.first}; }

  std::vector<Cell> row(char letter, SourceLocation at) const {
    return std::vector<Cell>(static_cast<std::size_t>(extent_.wales), Cell{letter, at});
  }

  // --- passes

  struct Meeting {
    Needle needle;
    char letter;
    SourceLocation at;
  };

  void add_yarn_pass(const std::vector<ProgramPass>& passes, std::size_t index, bool wanted) {
    const ProgramPass& source = passes[index];
    const Instruction& first = program_.instructions[source.begin];
    Pass pass;
    pass.at = first.at;
    name_feeder(first, pass, wanted);
    std::vector<Meeting> met;
    bool one_each = true;  // one needle for each wale says it, without transfers that are not there
    for (std::size_t i = source.begin; i < source.end; ++i) {
      const Instruction& each = program_.instructions[i];
      if (!carries_yarn(each)) continue;
      if (wanted) tell_slider(each);
      if (wanted && each.op == Op::split && !are_facing(each, source.racking))
        lose(each, "the needles do not face each other; this split is a stitch");
      const Needle needle = hook(each.needle), other = facing(needle);
      if (inside(needle)) met.push_back({needle, letter_of(each), each.at});
      one_each = one_each && !meets_both(met, needle);
      if (is_loop(each.op))
        one_each = one_each && held(other) == 0;
      else
        one_each = one_each && (held(needle) > 0 || held(other) == 0) &&
                   (is_front(needle.bed) ? held(other) == 0 || held(needle) > 0 : held(other) == 0);
    }
    if (wanted) put_letters(pass, met, one_each);
    if (wanted && !one_each) put_missed(pass, met, source.racking);
    // what takes the carrier past needles alone says so by its direction
    if (wanted && !pass.knits()) pass.direction = first.direction;
    for (std::size_t i = source.begin; i < source.end; ++i) {
      const Instruction& each = program_.instructions[i];
      if (!carries_yarn(each) || each.op == Op::miss) continue;
      const int loops = static_cast<int>(each.carriers.size());
      if (each.op == Op::split) held(each.target) += held(each.needle);
      held(each.needle) = each.op == Op::tuck ? held(each.needle) + loops : loops;
    }
    if (!wanted || met.empty()) return;  // nothing of it lies in the repeat
    const double racking = source.racking - gating_;
    add_to_lines(std::move(pass), racking, source, index > 0 ? &passes[index - 1] : nullptr);
  }

  // Whether the needle that faces the last one was met as well.
  static bool meets_both(const std::vector<Meeting>& met, Needle needle) {
    // needles come in the order of their slots, so the facing one is near
    for (std::size_t i = met.size(), seen = 0; i-- > 0 && seen < 40; ++seen)
      if (met[i].needle == facing(needle)) return true;
    return false;
  }

  // A repeat's first pass by a yarn says its direction if that is not what an empty machine starts with: the
  // repeat is the first one as well.
  void name_feeder(const Instruction& first, Pass& pass, bool wanted) {
    const std::size_t leading = first.carriers.front().position();
    for (const CarrierId id : first.carriers) pass.yarns.push_back(yarn_of_[id.position()]);
    if (pass.yarns == std::vector<int>{0}) pass.yarns.clear();
    const Direction last = last_direction_[leading];
    const Direction expected = last == Direction::right ? Direction::left : Direction::right;
    if (last == Direction::none) starts_left_[leading] = first.direction == Direction::left;
    const bool is_first = extent_.repeat && wanted && !seen_in_repeat_[leading];
    if (wanted) seen_in_repeat_[leading] = true;
    if (first.direction != expected || (is_first && starts_left_[leading])) pass.direction = first.direction;
    for (const CarrierId id : first.carriers) last_direction_[id.position()] = first.direction;
  }

  void tell_slider(const Instruction& each) {
    const bool gives = each.op == Op::xfer || each.op == Op::split;
    for (const Needle needle : {each.needle, gives ? each.target : each.needle}) {
      if (!is_slider(needle.bed)) continue;
      lose(each, "sliders are not in the notation: " + to_string(needle) + " becomes its needle");
      return;
    }
  }

  // Whether what a transfer or a split gives can go where it says.
  static bool are_facing(const Instruction& each, double racking) {
    const bool front = is_front(each.needle.bed);
    const double there = front ? each.needle.index - racking : each.needle.index + racking;
    return is_front(each.target.bed) != front && each.target.index == there;
  }

  void put_letters(Pass& pass, const std::vector<Meeting>& met, bool one_each) {
    pass.both_beds = !one_each;
    pass.cells = row('-', pass.at);
    if (!one_each) pass.rear = pass.cells;
    for (const Meeting& each : met) {
      std::vector<Cell>& cells = one_each || is_front(each.needle.bed) ? pass.cells : pass.rear;
      cells[place(each.needle)] = {each.letter, each.at};
    }
    const auto forms = [](const Cell& cell) { return cell.letter != '-' && cell.letter != '.'; };
    for (std::size_t w = 0; w < pass.rear.size() && !result_.gating; ++w)
      if (forms(pass.cells[w]) && forms(pass.rear[w])) result_.gating = Gating::opposite;
  }

  // A needle that keeps its loops while the one that it faces works is missed, not inactive; the programme
  // has no word for it.
  void put_missed(Pass& pass, const std::vector<Meeting>& met, double racking) {
    if (racking != std::floor(racking)) return;
    const int offset = static_cast<int>(racking);
    for (const Meeting& each : met) {
      if (each.letter == '.') continue;
      const bool front = is_front(each.needle.bed);
      const Needle idle{front ? Bed::back : Bed::front, each.needle.index + (front ? -offset : offset)};
      if (!inside(idle) || held(idle) == 0) continue;
      Cell& cell = (front ? pass.rear : pass.cells)[place(idle)];
      if (cell.letter == '-') cell.letter = '.';
    }
  }

  void add_transfers(const std::vector<ProgramPass>& passes, std::size_t index, bool wanted) {
    const ProgramPass& source = passes[index];
    const bool implied = is_implied(passes, index);
    Pass pass;
    pass.at = program_.instructions[source.begin].at;
    pass.cells = row('.', pass.at);
    pass.rear = pass.cells;
    bool any = false, transfers = false, both = false;
    for (std::size_t i = source.begin; i < source.end; ++i) {
      const Instruction& each = program_.instructions[i];
      if (each.op < Op::knit) continue;
      if (each.op == Op::amiss || (each.op == Op::tuck && each.carriers.empty())) {
        if (wanted) lose(each, "'amiss' is not in the notation");
        continue;
      }
      const bool gives = each.op == Op::xfer || each.op == Op::split;
      // an empty needle gives nothing
      if (each.op == Op::miss || held(each.needle) == 0) continue;
      if (wanted) tell_slider(each);
      if (gives && !are_facing(each, source.racking)) {
        if (wanted) lose(each, "the needles do not face each other; this transfer is left out");
        continue;
      }
      if (gives) held(each.target) += held(each.needle);
      held(each.needle) = 0;
      if (!inside(each.needle)) continue;
      const bool front = is_front(each.needle.bed);
      const std::size_t w = place(each.needle);
      (front ? pass.cells : pass.rear)[w] = {gives ? (front ? 't' : 'T') : (front ? 'd' : 'D'), each.at};
      any = true;
      transfers = transfers || gives;
      both = both || (pass.cells[w].letter != '.' && pass.rear[w].letter != '.');
    }
    if (!wanted || implied || !any) return;
    pass.both_beds = both;
    if (!both) {
      for (std::size_t w = 0; w < pass.cells.size(); ++w)
        if (pass.rear[w].letter != '.') pass.cells[w] = pass.rear[w];
      pass.rear.clear();
    }
    // to drop a loop the beds may stand anywhere
    add_to_lines(std::move(pass), transfers ? std::optional(source.racking) : std::nullopt, source, nullptr);
  }

  // Whether the next course brings these loops over by itself, being written with one needle for each wale.
  bool is_implied(const std::vector<ProgramPass>& passes, std::size_t index) {
    const ProgramPass& source = passes[index];
    if (source.racking != 0 || index + 1 >= passes.size() || !passes[index + 1].yarn) return false;
    if (passes[index + 1].begin >= extent_.end && source.end <= extent_.end) return false;
    std::set<Needle> formed, given;
    const ProgramPass& next = passes[index + 1];
    for (std::size_t i = next.begin; i < next.end; ++i) {
      const Instruction& each = program_.instructions[i];
      if (!carries_yarn(each)) continue;
      if (formed.contains(facing(hook(each.needle)))) return false;
      if (each.op == Op::miss) return false;
      formed.insert(hook(each.needle));
    }
    for (std::size_t i = source.begin; i < source.end; ++i) {
      const Instruction& each = program_.instructions[i];
      if (each.op < Op::knit) continue;
      if (each.op != Op::xfer || is_slider(each.needle.bed) || is_slider(each.target.bed)) return false;
      if (held(each.needle) == 0) continue;
      if (each.target != facing(each.needle) || !formed.contains(each.target)) return false;
      given.insert(each.needle);
    }
    // and whether it would bring no others
    return std::all_of(formed.begin(), formed.end(), [&](Needle needle) {
      return held(facing(needle)) == 0 || given.contains(facing(needle));
    });
  }

  // --- lines

  // A pass joins the line of the one before it where a fabric file had them in one line, or where feeders
  // follow one another in a course.
  void add_to_lines(Pass&& pass, std::optional<double> racking, const ProgramPass& source,
                    const ProgramPass* before) {
    const SourceLocation at = program_.instructions[source.begin].at;
    bool joins = before && before->yarn && before->course == source.course && !result_.lines.empty();
    if (extent_.repeat || program_.notation)
      joins = !result_.lines.empty() && at.line > 0 && last_at_.line == at.line &&
              leftmost(source) > last_column_;
    if (joins && result_.lines.back().passes.size() >= 900) joins = false;
    if (!joins) {
      result_.lines.emplace_back();
      line_begins_.push_back(source.begin);
      line_racking_ = 0;
    }
    if (racking && *racking != line_racking_) pass.racks.push_back({0, *racking, pass.at});
    line_racking_ = racking.value_or(line_racking_);
    last_at_ = at;
    last_column_ = leftmost(source);
    result_.lines.back().passes.push_back(std::move(pass));
  }

  int leftmost(const ProgramPass& source) const {
    int column = program_.instructions[source.begin].at.column;
    for (std::size_t i = source.begin; i < source.end; ++i)
      if (program_.instructions[i].op >= Op::knit)
        column = std::min(column, program_.instructions[i].at.column);
    return column;
  }

  // Rows of a repeat are as wide as they need be: `g` in a cable of eight wales. All stay as they are where
  // the repeat would lose its width.
  void narrow_rows() {
    const std::vector<CourseLine> wide = result_.lines;
    std::size_t wales = 1;
    for (CourseLine& line : result_.lines) {
      for (Pass& pass : line.passes) {
        for (std::vector<Cell>* row : {&pass.cells, &pass.rear}) {
          std::size_t unit = 1;
          const auto repeats = [&] {
            for (std::size_t i = unit; i < row->size(); ++i)
              if ((*row)[i].letter != (*row)[i - unit].letter) return false;
            return true;
          };
          while (unit < row->size() && (row->size() % unit != 0 || !repeats())) ++unit;
          row->resize(std::min(unit, row->size()));
          wales = std::lcm(wales, std::max<std::size_t>(row->size(), 1));
        }
      }
    }
    if (wales != static_cast<std::size_t>(extent_.wales)) result_.lines = wide;
  }

  // Brackets round runs of lines that repeat.
  void fold_lines() {
    constexpr std::size_t longest_unit = 64;
    std::vector<std::string> text;
    for (const CourseLine& line : result_.lines) text.push_back(write_course(line, result_.yarns));
    for (std::size_t i = 0; i < text.size();) {
      std::size_t best_unit = 1, best_times = 1;
      for (std::size_t unit = 1; unit <= longest_unit && i + 2 * unit <= text.size(); ++unit) {
        std::size_t end = i + unit;
        while (end < text.size() && text[end] == text[end - unit]) ++end;
        const std::size_t times = std::min((end - i) / unit, most_wales);
        // a bracket is two lines more
        if (times >= 2 && (times - 1) * unit > (best_times - 1) * best_unit && (times - 1) * unit > 2)
          best_unit = unit, best_times = times;
      }
      if (best_times > 1) result_.written.push_back({Kind::open, "[", 1});
      for (std::size_t k = i; k < i + best_unit; ++k) result_.written.push_back({Kind::course, text[k], 1});
      if (best_times > 1)
        result_.written.push_back({Kind::close, "]*" + std::to_string(best_times), best_times});
      i += best_unit * best_times;
    }
  }

  const Program& program_;
  const Extent extent_;
  Diagnostics& lost_;
  Vermiculation result_;
  std::vector<std::size_t> line_begins_;  // by line: its first instruction
  std::vector<int> yarn_of_;              // by carrier
  std::vector<std::size_t> carrier_of_yarn_;
  double gating_ = 0, line_racking_ = 0;
  std::vector<Direction> last_direction_;  // by carrier
  std::vector<bool> starts_left_, seen_in_repeat_;
  std::map<Needle, int> held_;  // loops on each needle
  SourceLocation last_at_;
  int last_column_ = 0;
};

}  // namespace

DecompiledProgram decompile(const Program& program, const Extent& extent, Diagnostics& lost) {
  return Decompiler(program, extent, lost).decompiled();
}

}  // namespace loopwright
