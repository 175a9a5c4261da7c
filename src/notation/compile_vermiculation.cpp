// Knits a notation to its size: passes become instructions, in the order in which the carriage meets the
// needles. What is implied (transfers before a course on the other bed, gating, margins, bind-off) is told in
// docs/notation.md.
#include <algorithm>
#include <cmath>
#include <map>

#include "notation/piece_plan.hpp"
#include "notation/read_vermiculation.hpp"

namespace loopwright {
namespace {

struct TooMany {};  // thrown and caught inside the compiler alone: ends it when the piece is too large

class Compiler {
 public:
  Compiler(const Vermiculation& source, const FabricOptions& options, Diagnostics& diagnostics)
      : source_(source), options_(options), diagnostics_(diagnostics) {}

  Program program() {
    describe();
    const auto plan = plan_piece(source_, options_, program_.settings, diagnostics_);
    if (!plan) return std::move(program_);
    plan_ = *plan;
    const auto width = static_cast<std::size_t>(plan_.last - plan_.first);
    front_held_.assign(width, 0);
    rear_held_.assign(width, 0);
    try {
      knit_piece();
    } catch (const TooMany&) {
      program_.instructions.clear();
      program_.instructions.shrink_to_fit();
      program_.repeat_starts.clear();
      program_.window = {};
      diagnostics_.error({}, "the piece takes more than " + std::to_string(options_.most_instructions) +
                                 " instructions, or as many idle letters; give a smaller ;;Size");
    }
    return std::move(program_);
  }

 private:
  void describe() {
    program_.file = source_.file;
    program_.version = source_.version;
    program_.settings = source_.settings;
    program_.headers = source_.headers;
    for (std::size_t i = 0; i < source_.yarns.size(); ++i) {
      const bool named = i < source_.carriers.size();
      program_.carriers.push_back(named ? source_.carriers[i] : source_.yarns[i].name);
      program_.yarns.push_back(source_.yarns[i].data);
    }
  }

  void knit_piece() {
    last_direction_.assign(source_.yarns.size(), Direction::none);
    const int total = plan_.courses + 2 * plan_.margin_courses;
    int knitted = 0;
    std::vector<int> held_at_start;
    while (knitted < total) {
      // every repeat starts with the beds at home, so that all repeats are alike
      standing_ = {};
      program_.repeat_starts.push_back(position());
      if (knitted == plan_.margin_courses) held_at_start = held_in_window();
      for (const CourseLine& line : source_.lines) {
        if (knitted == total && !plan_.whole) break;
        const bool at_repeat = position() == program_.repeat_starts.back();
        if (plan_.margin_wales > 0 && (at_repeat || line.knits())) mark_window(knitted, held_at_start);
        knit_line(line);
        if (line.knits()) ++knitted;
      }
    }
    program_.repeat_starts.push_back(position());
    if (plan_.edges == Edges::bound_off) bind_off();
    take_carriers_out();
    warn_of_idle_notation();
  }

  // A racking holds to the end of its line; one that stands alone on a line holds until the next such line.
  void knit_line(const CourseLine& line) {
    racking_ = standing_.racking;
    racking_at_ = standing_.at;
    bool racks_alone = true;
    for (const Pass& pass : line.passes) {
      // letters that make no instruction take time all the same
      if ((letters_met_ += front_held_.size()) > 50 * options_.most_instructions) throw TooMany();
      racks_alone = racks_alone && pass.cells.empty();
      if (pass.carries_yarn()) {
        knit(pass);
      } else {
        transfer(pass);
      }
    }
    if (racks_alone) standing_ = {0, racking_, racking_at_};
  }

  int position() const { return static_cast<int>(program_.instructions.size()); }

  // Sets where the wanted piece starts and ends, before the line that follows `knitted` courses.
  void mark_window(int knitted, const std::vector<int>& held_at_start) {
    ProgramWindow& window = program_.window;
    if (knitted == plan_.margin_courses && window.needles == 0) {
      window = {0, plan_.wales, position(), 0};
    } else if (knitted == plan_.margin_courses + plan_.courses && window.instructions == 0) {
      window.instructions = position() - window.first_instruction;
      if (plan_.edges != Edges::periodic) return;
      const std::vector<int> held = held_in_window();
      const auto differs = std::mismatch(held.begin(), held.end(), held_at_start.begin());
      if (differs.first == held.end()) return;
      const auto place = static_cast<int>(differs.first - held.begin());
      const Needle needle{place < plan_.wales ? Bed::front : Bed::back, place % plan_.wales};
      diagnostics_.error({}, "the notation does not close to a periodic cell: needle " + to_string(needle) +
                                 " holds " + std::to_string(*differs.second) +
                                 " loops where the repeat starts and " + std::to_string(*differs.first) +
                                 " where it ends; add the missing courses");
    }
  }

  std::vector<int> held_in_window() const {
    std::vector<int> held;
    for (const auto* bed : {&front_held_, &rear_held_}) {
      held.insert(held.end(), bed->begin() + plan_.margin_wales,
                  bed->begin() + plan_.margin_wales + plan_.wales);
    }
    return held;
  }

  int& front_held(int needle) { return front_held_[static_cast<std::size_t>(needle - plan_.first)]; }
  int& rear_held(int needle) { return rear_held_[static_cast<std::size_t>(needle - plan_.first)]; }
  bool in_piece(int needle) const { return needle >= plan_.first && needle < plan_.last; }

  static const Cell& cell_of(const std::vector<Cell>& cells, int wale) {
    const int width = static_cast<int>(cells.size());
    return cells[static_cast<std::size_t>(((wale % width) + width) % width)];
  }

  Instruction& add(Op op, SourceLocation at) {
    if (program_.instructions.size() == options_.most_instructions) throw TooMany();
    Instruction& instruction = program_.instructions.emplace_back();
    instruction.op = op;
    instruction.at = at;
    return instruction;
  }

  void add_rack(double racking, SourceLocation at) {
    if (racking == machine_racking_) return;
    add(Op::rack, at).value = racking;
    machine_racking_ = racking;
  }

  // Moves all that `from` holds to `to`; an empty needle has nothing to move.
  bool add_transfer(Needle from, Needle to, SourceLocation at) {
    int& source = from.bed == Bed::front ? front_held(from.index) : rear_held(from.index);
    if (source == 0) return false;
    int& target = to.bed == Bed::front ? front_held(to.index) : rear_held(to.index);
    Instruction& instruction = add(Op::xfer, at);
    instruction.needle = from;
    instruction.target = to;
    target += source;
    source = 0;
    return true;
  }

  void rack_to(const RackMark& mark) {
    racking_ = mark.racking;
    racking_at_ = mark.at;
  }

  // Racking that leads the pass, and what trails it: a pass of rackings alone has only the former.
  void rack_before(const Pass& pass) {
    for (const RackMark& mark : pass.racks) {
      if (mark.before == 0) rack_to(mark);
    }
  }
  void rack_after(const Pass& pass) {
    for (const RackMark& mark : pass.racks) {
      if (mark.before > 0 && mark.before == pass.cells.size()) rack_to(mark);
    }
  }

  // The rackings between a pass's letters, as (wale before which it stands, mark), in the order of the wales.
  std::vector<std::pair<int, const RackMark*>> rackings_between(const Pass& pass) const {
    std::vector<const RackMark*> inner;
    for (const RackMark& mark : pass.racks) {
      if (mark.before > 0 && mark.before < pass.cells.size()) inner.push_back(&mark);
    }
    std::vector<std::pair<int, const RackMark*>> result;
    if (inner.empty()) return result;
    const int width = static_cast<int>(pass.cells.size());
    for (int start = plan_.first - ((plan_.first % width) + width) % width; start < plan_.last;
         start += width) {
      for (const RackMark* mark : inner) {
        const int wale = start + static_cast<int>(mark->before);
        if (wale > plan_.first && wale < plan_.last) result.emplace_back(wale, mark);
      }
    }
    return result;
  }

  void transfer(const Pass& pass) {
    rack_before(pass);
    const auto rackings = rackings_between(pass);
    for (const std::vector<Cell>* row : {&pass.cells, &pass.rear}) {
      auto next_racking = rackings.begin();
      for (int w = plan_.first; w < plan_.last && !row->empty(); ++w) {
        for (; next_racking != rackings.end() && next_racking->first == w; ++next_racking) {
          rack_to(*next_racking->second);
        }
        const Cell& cell = cell_of(*row, w);
        if (cell.letter == 'T' || cell.letter == 't') transfer_needle(cell, w);
        if (cell.letter == 'D' || cell.letter == 'd') drop_needle(cell, w);
      }
    }
    rack_after(pass);
  }

  // The letter stands at the needle that gives. Rear needle B faces front needle B + racking.
  void transfer_needle(const Cell& cell, int wale) {
    if (racking_ != std::floor(racking_)) {
      if (!said_fractional_) {
        diagnostics_.error(cell.at,
                           "transfers need needles that face each other; write a whole racking, e.g. 'R0'");
      }
      said_fractional_ = true;
      return;
    }
    const int offset = static_cast<int>(racking_);
    const bool to_rear = cell.letter == 't';
    const Needle from{to_rear ? Bed::front : Bed::back, wale};
    const Needle to{to_rear ? Bed::back : Bed::front, to_rear ? wale - offset : wale + offset};
    bool& effective = moving_cells_[{cell.at.line, cell.at.column}];
    if (!in_piece(to.index)) {
      effective = true;  // at the edge of the piece the loop stays where it is
      return;
    }
    if ((to_rear ? front_held(wale) : rear_held(wale)) == 0) return;
    effective = true;
    add_rack(racking_, racking_at_.line > 0 ? racking_at_ : cell.at);
    add_transfer(from, to, cell.at);
  }

  void drop_needle(const Cell& cell, int wale) {
    int& held = cell.letter == 'd' ? front_held(wale) : rear_held(wale);
    bool& effective = moving_cells_[{cell.at.line, cell.at.column}];
    if (held == 0) return;
    effective = true;
    add(Op::drop, cell.at).needle = {cell.letter == 'd' ? Bed::front : Bed::back, wale};
    held = 0;
  }

  // A course on one needle per wale knits a wale's loops where they are wanted: those on the facing needle
  // come over.
  void imply_transfers(const Pass& pass) {
    for (const bool to_rear : {true, false}) {
      for (int w = plan_.first; w < plan_.last; ++w) {
        const Cell& cell = cell_of(pass.cells, w);
        const bool wants_rear = is_rear_letter(cell.letter);
        if (!forms_loop(cell.letter) || wants_rear != to_rear) continue;
        if ((to_rear ? front_held(w) : rear_held(w)) == 0) continue;
        add_rack(0, cell.at);
        add_transfer({to_rear ? Bed::front : Bed::back, w}, {to_rear ? Bed::back : Bed::front, w}, cell.at);
      }
    }
  }

  struct Action {
    double slot = 0;  // on the common axis: front i at i, rear i at i + racking
    Needle needle;
    const Cell* cell = nullptr;
  };

  // Actions of the wales [begin, end) in the order in which a carriage moving to the right meets them.
  void find_actions(const Pass& pass, int begin, int end, double racking) {
    actions_.clear();
    for (int w = begin; w < end; ++w) {
      const Cell& cell = cell_of(pass.cells, w);
      if (cell.letter == '-') continue;
      bool rear = is_rear_letter(cell.letter);
      if (!pass.both_beds && cell.letter == '.') rear = rear_held(w) > 0 && front_held(w) == 0;
      actions_.push_back({rear ? w + racking : w, {rear ? Bed::back : Bed::front, w}, &cell});
    }
    if (pass.both_beds) {
      for (int w = begin; w < end; ++w) {
        const Cell& cell = cell_of(pass.rear, w);
        if (cell.letter != '-') actions_.push_back({w + racking, {Bed::back, w}, &cell});
      }
    }
    const auto before = [](const Action& a, const Action& b) {
      return a.slot != b.slot ? a.slot < b.slot : is_front(a.needle.bed) && !is_front(b.needle.bed);
    };
    if (!std::is_sorted(actions_.begin(), actions_.end(), before)) {
      std::stable_sort(actions_.begin(), actions_.end(), before);
    }
    keep_one_of_facing(pass);
  }

  // Of two needles that face each other one can act; a missed needle gives way to the one that knits.
  void keep_one_of_facing(const Pass& pass) {
    std::size_t kept = 0;
    for (const Action& action : actions_) {
      if (kept > 0 && actions_[kept - 1].slot == action.slot) {
        Action& facing = actions_[kept - 1];
        if (!forms_loop(action.cell->letter)) continue;
        if (forms_loop(facing.cell->letter)) {
          if (said_collision_ != &pass) {
            diagnostics_.error(action.cell->at, "needle " + to_string(action.needle) + " faces " +
                                                    to_string(facing.needle) +
                                                    " and both take yarn in one pass; "
                                                    "use ';;Gating: half-pitch', or miss one of them");
          }
          said_collision_ = &pass;
          continue;
        }
        facing = action;
        continue;
      }
      actions_[kept++] = action;
    }
    actions_.resize(kept);
  }

  void knit(const Pass& pass) {
    if (!pass.both_beds) imply_transfers(pass);
    rack_before(pass);
    const std::vector<CarrierId> carriers = bring_in(pass);
    Direction& last = last_direction_[carriers.front().position()];
    const Direction direction = pass.direction != Direction::none ? pass.direction
                                : last == Direction::right        ? Direction::left
                                                                  : Direction::right;
    for (const CarrierId id : carriers) last_direction_[id.position()] = direction;
    last_carriers_ = carriers;
    last_at_ = pass.at;
    // the runs between rackings inside the course, in the order in which the carriage reaches them
    auto rackings = rackings_between(pass);
    std::vector<int> bounds{plan_.first};
    for (const auto& racking : rackings) bounds.push_back(racking.first);
    bounds.push_back(plan_.last);
    const int runs = static_cast<int>(bounds.size()) - 1;
    for (int i = 0; i < runs; ++i) {
      const int run = direction == Direction::right ? i : runs - 1 - i;
      if (i > 0)
        rack_to(*rackings[static_cast<std::size_t>(direction == Direction::right ? run - 1 : run)].second);
      knit_run(pass, bounds[static_cast<std::size_t>(run)], bounds[static_cast<std::size_t>(run) + 1],
               direction, carriers);
    }
    rack_after(pass);
  }

  void knit_run(const Pass& pass, int begin, int end, Direction direction,
                const std::vector<CarrierId>& carriers) {
    const double racking = racking_ + (plan_.gating == Gating::half_pitch ? 0.5 : 0);
    find_actions(pass, begin, end, racking);
    if (actions_.empty()) return;
    add_rack(racking, racking_at_.line > 0 ? racking_at_ : pass.at);
    if (direction == Direction::left) std::reverse(actions_.begin(), actions_.end());
    const int yarns = static_cast<int>(carriers.size());
    join(direction, actions_.front());
    for (const Action& action : actions_) {
      const char letter = action.cell->letter;
      const std::optional<Needle> target = split_target(action, racking);
      const Op op = letter == '.'                    ? Op::miss
                    : letter == 'v' || letter == 'n' ? Op::tuck
                    : target                         ? Op::split
                                                     : Op::knit;
      Instruction& instruction = add(op, action.cell->at);
      instruction.direction = direction;
      instruction.needle = action.needle;
      instruction.carriers = carriers;
      int& held =
          is_front(action.needle.bed) ? front_held(action.needle.index) : rear_held(action.needle.index);
      if (target) {
        instruction.target = *target;
        (target->bed == Bed::front ? front_held(target->index) : rear_held(target->index)) += held;
      }
      if (op == Op::knit || op == Op::split) held = yarns;
      if (op == Op::tuck) held += yarns;
    }
  }

  // Where the old loops of a split go. None for other letters, and at the edge of the piece, where it is a
  // stitch.
  std::optional<Needle> split_target(const Action& action, double racking) {
    if (action.cell->letter != 's' && action.cell->letter != 'S') return std::nullopt;
    if (racking != std::floor(racking)) {
      if (!said_split_) {
        diagnostics_.error(action.cell->at,
                           "a split needs needles that face each other; write ';;Gating: opposite', or with "
                           "half-pitch gating a racking of a half before it, e.g. 'R-0.5'");
      }
      said_split_ = true;
      return std::nullopt;
    }
    const int offset = static_cast<int>(racking);
    const bool front = action.needle.bed == Bed::front;
    const Needle target{front ? Bed::back : Bed::front, action.needle.index + (front ? -offset : offset)};
    return in_piece(target.index) ? std::optional(target) : std::nullopt;
  }

  std::vector<CarrierId> bring_in(const Pass& pass) {
    std::vector<CarrierId> carriers, arriving;
    for (const int yarn : pass.yarns) carriers.emplace_back(yarn);
    if (carriers.empty()) carriers.emplace_back(0);
    for (const CarrierId id : carriers) {
      if (last_direction_[id.position()] == Direction::none) arriving.push_back(id);
    }
    if (!arriving.empty()) add(Op::in, pass.at).carriers = arriving;
    if (arriving.size() < carriers.size()) joining_ = arriving;
    return carriers;
  }

  // What comes in must first be used alone (knitout): a yarn that joins one that is in already first goes to
  // where the pass starts.
  void join(Direction direction, const Action& first) {
    if (joining_.empty()) return;
    Instruction& instruction = add(Op::miss, first.cell->at);
    instruction.direction = direction == Direction::right ? Direction::left : Direction::right;
    instruction.needle = first.needle;
    instruction.carriers = std::move(joining_);
    joining_.clear();
  }

  // All loops to the front bed, then from the carrier's side on: each loop goes onto its neighbour's needle
  // and the yarn is knitted through both. The last loop stays on its needle.
  void bind_off() {
    for (int w = plan_.first; w < plan_.last; ++w) {
      if (rear_held(w) == 0) continue;
      add_rack(0, last_at_);
      add_transfer({Bed::back, w}, {Bed::front, w}, last_at_);
    }
    const bool from_right = last_direction_[last_carriers_.front().position()] == Direction::right;
    const int step = from_right ? -1 : 1;
    for (int w = from_right ? plan_.last - 1 : plan_.first; in_piece(w + step); w += step) {
      if (front_held(w) == 0) continue;
      add_rack(0, last_at_);
      add_transfer({Bed::front, w}, {Bed::back, w}, last_at_);
      add_rack(step, last_at_);
      add_transfer({Bed::back, w}, {Bed::front, w + step}, last_at_);
      add_rack(0, last_at_);
      Instruction& instruction = add(Op::knit, last_at_);
      instruction.direction = from_right ? Direction::left : Direction::right;
      instruction.needle = {Bed::front, w + step};
      instruction.carriers = last_carriers_;
      front_held(w + step) = static_cast<int>(last_carriers_.size());
    }
  }

  void take_carriers_out() {
    add_rack(0, last_at_);
    for (std::size_t i = 0; i < last_direction_.size(); ++i) {
      if (last_direction_[i] == Direction::none) continue;
      add(Op::out, last_at_).carriers = {CarrierId(i)};
    }
  }

  void warn_of_idle_notation() {
    for (const auto& [at, effective] : moving_cells_) {
      if (effective) continue;
      diagnostics_.warning(
          {at.first, at.second},
          "there is never a loop to move here; t and d take those of the front needle, T and "
          "D those of the rear needle");
    }
    for (std::size_t i = 0; i < last_direction_.size(); ++i) {
      if (last_direction_[i] != Direction::none) continue;
      diagnostics_.warning(source_.yarns[i].at, "yarn " + source_.yarns[i].name + " is never knitted");
    }
  }

  const Vermiculation& source_;
  const FabricOptions& options_;
  Diagnostics& diagnostics_;
  Program program_;
  PiecePlan plan_;
  std::size_t letters_met_ = 0;
  std::vector<int> front_held_, rear_held_;  // loops on each needle, by needle - plan_.first
  double racking_ = 0;                       // asked for by the notation
  RackMark standing_;                        // the racking that lines start with
  SourceLocation racking_at_;
  double machine_racking_ = 0;             // of the last rack instruction
  std::vector<Direction> last_direction_;  // by yarn; none: the carrier is not in
  std::vector<CarrierId> last_carriers_;
  std::vector<CarrierId> joining_;  // brought in, to be plated with a yarn that is in already
  SourceLocation last_at_;
  std::vector<Action> actions_;                       // of the run being knitted
  std::map<std::pair<int, int>, bool> moving_cells_;  // by line and column: whether it ever moved a loop
  bool said_fractional_ = false, said_split_ = false;
  const Pass* said_collision_ = nullptr;
};

}  // namespace

Program compile_vermiculation(const Vermiculation& vermiculation, const FabricOptions& options,
                              Diagnostics& diagnostics) {
  return compile_vermiculation(std::make_shared<const Vermiculation>(vermiculation), options, diagnostics);
}

Program compile_vermiculation(std::shared_ptr<const Vermiculation> vermiculation,
                              const FabricOptions& options, Diagnostics& diagnostics) {
  Program program = Compiler(*vermiculation, options, diagnostics).program();
  program.notation = std::move(vermiculation);
  return program;
}

Program read_vermiculation(std::string_view text, Diagnostics& diagnostics, const FabricOptions& options) {
  return compile_vermiculation(std::make_shared<const Vermiculation>(parse_vermiculation(text, diagnostics)),
                               options, diagnostics);
}

}  // namespace loopwright
