#include "notation/needle_diagram.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "notation/piece_plan.hpp"

namespace loopwright {
namespace {

NeedleOperation operation_of(char letter) {
  switch (letter) {
    case 'g':
    case 'e':
      return NeedleOperation::stitch;
    case 'v':
    case 'n':
      return NeedleOperation::tuck;
    case 's':
    case 'S':
      return NeedleOperation::split;
    case 'T':
    case 't':
      return NeedleOperation::transfer;
    case 'D':
    case 'd':
      return NeedleOperation::drop;
    case '.':
      return NeedleOperation::missed;
    default:
      return NeedleOperation::inactive;
  }
}

const Cell& cell_of(const std::vector<Cell>& cells, int wale) {
  return cells[static_cast<std::size_t>(wale) % cells.size()];
}

// Walks through the notation as the machine would, with the wales closed to a ring.
class DiagramMaker {
 public:
  DiagramMaker(const Vermiculation& source, const DiagramOptions& options)
      : source_(source), options_(options) {}

  NeedleDiagram diagram() {
    Diagnostics diagnostics;
    FabricSettings settings = source_.settings;
    settings.size_wales = settings.size_courses = 0;
    const auto plan = plan_piece(source_, {}, settings, diagnostics);
    if (!plan) return {};
    diagram_.name = source_.settings.name;
    for (const VermiculationYarn& yarn : source_.yarns)
      diagram_.yarns.push_back({yarn.name, yarn.data.colour});
    diagram_.repeat_wales = plan->repeat_wales;
    diagram_.repeat_courses = plan->repeat_courses;
    diagram_.gating = plan->gating == Gating::half_pitch ? 0.5 : 0;
    const int repeats = (fewest_wales + plan->repeat_wales - 1) / plan->repeat_wales;
    diagram_.wales = options_.wales > 0 ? options_.wales : repeats * plan->repeat_wales;
    diagram_.courses = options_.courses > 0 ? options_.courses : plan->repeat_courses;
    // the ring is closed after whole repeats, of which the paper may show a part
    ring_ = (diagram_.wales + plan->repeat_wales - 1) / plan->repeat_wales * plan->repeat_wales;
    check_size(*plan);
    front_held_.assign(static_cast<std::size_t>(ring_), false);
    rear_held_ = front_held_;
    if (repeats_on(*plan)) {
      knit(plan->repeat_courses);
      diagram_.passes.clear();
    }
    last_direction_.assign(source_.yarns.size(), Direction::none);
    knit(diagram_.courses);
    for (DiagramPass& pass : diagram_.passes) trim(pass);
    return std::move(diagram_);
  }

 private:
  void check_size(const PiecePlan& plan) const {
    std::size_t passes = 0;
    for (const CourseLine& line : source_.lines) passes += 2 * line.passes.size();  // with implied transfers
    const auto repeats = static_cast<std::size_t>(diagram_.courses / plan.repeat_courses + 1);
    if (static_cast<std::size_t>(ring_) * passes * repeats > most_diagram_needles)
      throw std::invalid_argument("the diagram is too large; ask for fewer wales and courses");
  }

  bool repeats_on(const PiecePlan& plan) const {
    const bool whole = plan.edges == Edges::free || plan.edges == Edges::bound_off;
    return !whole || source_.settings.size_courses > plan.repeat_courses;
  }

  void knit(int courses) {
    course_ = 1;
    last_direction_.resize(source_.yarns.size(), Direction::none);
    while (course_ <= courses) {
      standing_ = 0;
      for (std::size_t l = 0; l < source_.lines.size(); ++l) {
        // a repeat is shown with the transfers at its end, a piece of so many courses without
        if (options_.courses > 0 && course_ > courses) break;
        knit_line(l);
      }
    }
  }

  void knit_line(std::size_t index) {
    const CourseLine& line = source_.lines[index];
    racking_ = standing_;
    bool racks_alone = true;
    for (std::size_t p = 0; p < line.passes.size(); ++p) {
      const Pass& pass = line.passes[p];
      racks_alone = racks_alone && pass.cells.empty();
      if (pass.carries_yarn() && !pass.both_beds) imply_transfers(pass);
      for (const RackMark& mark : pass.racks)
        if (mark.before == 0) racking_ = mark.racking;
      if (!pass.cells.empty()) add_pass(pass, index, p);
      for (const RackMark& mark : pass.racks)
        if (mark.before > 0 && mark.before == pass.cells.size()) racking_ = mark.racking;
    }
    if (racks_alone) standing_ = racking_;
    if (line.knits()) ++course_;
  }

  DiagramPass new_pass(SourceLocation at, double racking) const {
    DiagramPass pass;
    pass.course = course_;
    pass.at = at;
    pass.racking = racking;
    for (int w = 0; w < ring_; ++w) {
      pass.front.push_back({NeedleOperation::unused, static_cast<double>(w), {}});
      pass.rear.push_back({NeedleOperation::unused, w + racking, {}});
    }
    return pass;
  }

  static std::size_t index(int wale) { return static_cast<std::size_t>(wale); }

  // The loops of a wale that is knitted on the other bed come over first.
  void imply_transfers(const Pass& source) {
    DiagramPass pass = new_pass(source.at, 0);
    pass.implied = true;
    bool any = false;
    for (int w = 0; w < ring_; ++w) {
      const Cell& cell = cell_of(source.cells, w);
      if (!forms_loop(cell.letter)) continue;
      const bool to_rear = is_rear_letter(cell.letter);
      std::vector<bool>& from = to_rear ? front_held_ : rear_held_;
      if (!from[index(w)]) continue;
      from[index(w)] = false;
      (to_rear ? rear_held_ : front_held_)[index(w)] = true;
      (to_rear ? pass.front : pass.rear)[index(w)].operation = NeedleOperation::transfer;
      any = any || w < diagram_.wales;
    }
    if (any) diagram_.passes.push_back(std::move(pass));
  }

  void add_pass(const Pass& source, std::size_t line, std::size_t place) {
    const bool knits = source.carries_yarn();
    DiagramPass pass = new_pass(source.at, racking_ + (knits ? diagram_.gating : 0));
    pass.line = line;
    pass.pass = place;
    pass.carries_yarn = knits;
    if (knits) find_feeder(source, pass);
    for (int w = 0; w < ring_; ++w) put_cell(source, pass, w);
    set_rear_slots(source, pass);
    if (knits) hold_stitches(pass);
    move_loops(pass);
    diagram_.passes.push_back(std::move(pass));
  }

  void find_feeder(const Pass& source, DiagramPass& pass) {
    pass.yarns = source.yarns.empty() ? std::vector<int>{0} : source.yarns;
    Direction& last = last_direction_[static_cast<std::size_t>(pass.yarns.front())];
    pass.direction = source.direction != Direction::none ? source.direction
                     : last == Direction::right          ? Direction::left
                                                         : Direction::right;
    for (const int yarn : pass.yarns) last_direction_[static_cast<std::size_t>(yarn)] = pass.direction;
  }

  void put_cell(const Pass& source, DiagramPass& pass, int w) const {
    const auto put = [&](std::vector<DiagramNeedle>& row, const Cell& cell) {
      row[index(w)].operation = operation_of(cell.letter);
      row[index(w)].at = cell.at;
    };
    const Cell& cell = cell_of(source.cells, w);
    if (source.both_beds) {
      put(pass.front, cell);
      put(pass.rear, cell_of(source.rear, w));
    } else if (cell.letter == '-') {
      put(pass.front, cell);
      put(pass.rear, cell);
    } else if (cell.letter == '.') {
      put(rear_held_[index(w)] && !front_held_[index(w)] ? pass.rear : pass.front, cell);
    } else {
      put(is_rear_letter(cell.letter) ? pass.rear : pass.front, cell);
    }
  }

  // A racking between the letters is made when the carriage gets there.
  void set_rear_slots(const Pass& source, DiagramPass& pass) {
    const double gating = pass.carries_yarn ? diagram_.gating : 0;
    const auto width = source.cells.size();
    const auto change_before = [&](int w, bool leftward) {
      // moving left, the mark before wale w + 1 is met on the way to wale w
      const std::size_t before = index(w + (leftward ? 1 : 0)) % width;
      for (const RackMark& mark : source.racks)
        if (mark.before > 0 && mark.before < width && mark.before == before) racking_ = mark.racking;
    };
    const bool leftward = pass.carries_yarn && pass.direction == Direction::left;
    for (int i = 0; i < ring_; ++i) {
      const int w = leftward ? ring_ - 1 - i : i;
      if (i > 0) change_before(w, leftward);
      pass.rear[index(w)].slot = w + racking_ + gating;
    }
  }

  void hold_stitches(const DiagramPass& pass) {
    const auto takes_yarn = [](const DiagramNeedle& needle) {
      return needle.operation == NeedleOperation::stitch || needle.operation == NeedleOperation::tuck;
    };
    for (std::size_t w = 0; w < pass.front.size(); ++w) {
      if (takes_yarn(pass.front[w])) front_held_[w] = true;
      if (takes_yarn(pass.rear[w])) rear_held_[w] = true;
    }
  }

  // Front needles give first; an empty needle gives nothing. A needle that splits holds a loop afterwards.
  void move_loops(const DiagramPass& pass) {
    for (const bool front : {true, false}) {
      for (int w = 0; w < ring_; ++w) {
        const DiagramNeedle& needle = (front ? pass.front : pass.rear)[index(w)];
        std::vector<bool>& from = front ? front_held_ : rear_held_;
        const bool splits = needle.operation == NeedleOperation::split;
        if (needle.operation == NeedleOperation::drop) from[index(w)] = false;
        if (needle.operation != NeedleOperation::transfer && !splits) continue;
        const bool gives = from[index(w)];
        from[index(w)] = splits;
        if (!gives) continue;
        const int racking = static_cast<int>(std::lround(pass.rear[index(w)].slot)) - w;
        const int target = ((front ? w - racking : w + racking) % ring_ + ring_) % ring_;
        (front ? rear_held_ : front_held_)[index(target)] = true;
      }
    }
  }

  void trim(DiagramPass& pass) {
    pass.front.resize(index(diagram_.wales));
    pass.rear.resize(index(diagram_.wales));
    const auto works = [](const DiagramNeedle& needle) {
      return needle.operation != NeedleOperation::unused && needle.operation != NeedleOperation::inactive;
    };
    // transfers to the rear bed need it as well
    diagram_.rear_bed = diagram_.rear_bed || std::any_of(pass.rear.begin(), pass.rear.end(), works) ||
                        (!pass.carries_yarn && std::any_of(pass.front.begin(), pass.front.end(), works));
  }

  const Vermiculation& source_;
  const DiagramOptions& options_;
  NeedleDiagram diagram_;
  int ring_ = 0;                              // wales that are walked through: whole repeats
  std::vector<bool> front_held_, rear_held_;  // whether each needle holds loops
  std::vector<Direction> last_direction_;     // by yarn
  double standing_ = 0, racking_ = 0;
  int course_ = 1;
};

}  // namespace

NeedleDiagram needle_diagram(const Vermiculation& notation, const DiagramOptions& options) {
  return DiagramMaker(notation, options).diagram();
}

}  // namespace loopwright
