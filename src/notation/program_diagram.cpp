// The needle diagram of a programme: its instructions, pass by pass.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "notation/needle_diagram.hpp"

namespace loopwright {
namespace {

bool carries_yarn(const Instruction& instruction) {
  return (instruction.op == Op::knit || instruction.op == Op::tuck || instruction.op == Op::miss ||
          instruction.op == Op::split) &&
         !instruction.carriers.empty();
}

NeedleOperation operation_of(const Instruction& instruction) {
  const bool yarn = carries_yarn(instruction);
  switch (instruction.op) {
    case Op::knit:
      return yarn ? NeedleOperation::stitch : NeedleOperation::drop;
    case Op::tuck:
      return yarn ? NeedleOperation::tuck : NeedleOperation::missed;
    case Op::split:
      return yarn ? NeedleOperation::split : NeedleOperation::transfer;
    case Op::xfer:
      return NeedleOperation::transfer;
    case Op::drop:
      return NeedleOperation::drop;
    default:
      return NeedleOperation::missed;
  }
}

class PassFinder {
 public:
  explicit PassFinder(const Program& program) : program_(program) {}

  struct Run {
    std::size_t begin = 0, end = 0;  // instructions
    double racking = 0;
    int course = 0;
    bool yarn = false;
  };

  // Machine state stands between runs and belongs to none.
  std::vector<Run> runs() {
    for (std::size_t i = 0; i < program_.instructions.size(); ++i) {
      const Instruction& each = program_.instructions[i];
      if (each.op == Op::rack) racking_ = each.value;
      if (each.op == Op::pause) open_ = false;
      if (each.op < Op::knit) continue;
      if (!goes_on(each)) begin_run(i, each);
      runs_.back().end = i + 1;
      last_ = &each;
      used_.push_back(each.needle);
      if (each.op == Op::xfer || each.op == Op::split) used_.push_back(each.target);
    }
    return std::move(runs_);
  }

 private:
  double slot(Needle needle) const { return is_front(needle.bed) ? needle.index : needle.index + racking_; }

  bool goes_on(const Instruction& each) const {
    if (!open_ || runs_.empty() || runs_.back().racking != racking_) return false;
    const bool yarn = carries_yarn(each);
    if (yarn != runs_.back().yarn) return false;
    if (!yarn)
      return std::none_of(used_.begin(), used_.end(), [&](Needle n) {
        return n == each.needle || (each.op == Op::xfer && n == each.target);
      });
    if (each.direction != last_->direction || each.carriers != last_->carriers) return false;
    const double step = slot(each.needle) - slot(last_->needle);
    return each.direction == Direction::right ? step > 0 : step < 0;
  }

  void begin_run(std::size_t index, const Instruction& each) {
    // two passes over the same needles are two courses; feeders that follow one another share one
    const bool yarn = carries_yarn(each);
    if (yarn && std::any_of(course_.begin(), course_.end(),
                            [&](const auto& carriers) { return carriers == each.carriers; })) {
      ++courses_;
      course_.clear();
    }
    if (yarn) course_.push_back(each.carriers);
    runs_.push_back({index, index, racking_, courses_, yarn});
    used_.clear();
    open_ = true;
  }

  const Program& program_;
  std::vector<Run> runs_;
  double racking_ = 0;
  bool open_ = false;
  const Instruction* last_ = nullptr;
  std::vector<Needle> used_;                    // by the run
  std::vector<std::vector<CarrierId>> course_;  // carriers that have knitted in this course
  int courses_ = 1;
};

DiagramPass pass_of(const Program& program, const PassFinder::Run& run, int first_needle, int wales) {
  DiagramPass pass;
  const Instruction& first = program.instructions[run.begin];
  pass.course = run.course;
  pass.carries_yarn = run.yarn;
  pass.direction = first.direction;
  pass.racking = run.racking;
  pass.at = first.at;
  if (run.yarn)
    for (const CarrierId id : first.carriers) pass.yarns.push_back(static_cast<int>(id.position()));
  for (int w = 0; w < wales; ++w) {
    pass.front.push_back({NeedleOperation::unused, static_cast<double>(first_needle + w), {}});
    pass.rear.push_back({NeedleOperation::unused, first_needle + w + run.racking, {}});
  }
  for (std::size_t i = run.begin; i < run.end; ++i) {
    const Instruction& each = program.instructions[i];
    if (each.op < Op::knit) continue;
    auto& row = is_front(each.needle.bed) ? pass.front : pass.rear;
    DiagramNeedle& needle = row[static_cast<std::size_t>(each.needle.index - first_needle)];
    needle.operation = operation_of(each);
    needle.at = each.at;
  }
  return pass;
}

}  // namespace

NeedleDiagram needle_diagram(const Program& program, const DiagramOptions& options,
                             std::size_t* passes_in_all) {
  NeedleDiagram diagram;
  diagram.name = program.settings.name;
  for (std::size_t i = 0; i < program.carriers.size(); ++i)
    diagram.yarns.push_back({program.carriers[i], i < program.yarns.size() ? program.yarns[i].colour : ""});
  std::vector<PassFinder::Run> runs = PassFinder(program).runs();
  if (passes_in_all) *passes_in_all = runs.size();
  runs.erase(runs.begin(),
             runs.begin() + static_cast<std::ptrdiff_t>(std::min(options.first_pass, runs.size())));
  if (runs.size() > options.most_passes) runs.resize(options.most_passes);
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const PassFinder::Run& run : runs) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Instruction& each = program.instructions[i];
      if (each.op < Op::knit) continue;
      const bool two = each.op == Op::xfer || each.op == Op::split;
      first = std::min({first, each.needle.index, two ? each.target.index : each.needle.index});
      last = std::max({last, each.needle.index, two ? each.target.index : each.needle.index});
      diagram.rear_bed = diagram.rear_bed || two || !is_front(each.needle.bed);
    }
  }
  if (runs.empty()) return diagram;
  diagram.first_needle = first;
  diagram.wales = last - first + 1;
  if (static_cast<std::size_t>(diagram.wales) * runs.size() > most_diagram_needles)
    throw std::invalid_argument("the diagram is too large; ask for fewer passes");
  diagram.courses = runs.back().course;
  for (const PassFinder::Run& run : runs)
    diagram.passes.push_back(pass_of(program, run, diagram.first_needle, diagram.wales));
  return diagram;
}

}  // namespace loopwright
