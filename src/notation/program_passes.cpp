#include "notation/program_passes.hpp"

#include <algorithm>
#include <set>

namespace loopwright {
namespace {

class PassFinder {
 public:
  explicit PassFinder(const Program& program) : program_(program) {}

  // Machine state stands between runs and belongs to none.
  std::vector<ProgramPass> runs() {
    for (std::size_t i = 0; i < program_.instructions.size(); ++i) {
      const Instruction& each = program_.instructions[i];
      // a repeat of a fabric file starts anew
      for (;
           repeat_ < program_.repeat_starts.size() && program_.repeat_starts[repeat_] <= static_cast<int>(i);
           ++repeat_)
        open_ = false;
      if (each.op == Op::rack) racking_ = each.value;
      if (each.op == Op::pause) open_ = false;
      if (each.op < Op::knit) continue;
      if (!goes_on(each)) begin_run(i, each);
      runs_.back().end = i + 1;
      last_ = &each;
      if (runs_.back().yarn) continue;
      used_.insert(each.needle);
      if (each.op == Op::xfer || each.op == Op::split) used_.insert(each.target);
    }
    return std::move(runs_);
  }

 private:
  double slot(Needle needle) const { return is_front(needle.bed) ? needle.index : needle.index + racking_; }

  bool goes_on(const Instruction& each) const {
    if (!open_ || runs_.empty() || runs_.back().racking != racking_) return false;
    const bool yarn = carries_yarn(each);
    if (yarn != runs_.back().yarn) return false;
    if (!yarn) return !used_.contains(each.needle) && !(each.op == Op::xfer && used_.contains(each.target));
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
  std::vector<ProgramPass> runs_;
  double racking_ = 0;
  std::size_t repeat_ = 0;
  bool open_ = false;
  const Instruction* last_ = nullptr;
  std::set<Needle> used_;                       // by a run of transfers
  std::vector<std::vector<CarrierId>> course_;  // carriers that have knitted in this course
  int courses_ = 1;
};

}  // namespace

bool carries_yarn(const Instruction& instruction) {
  return (instruction.op == Op::knit || instruction.op == Op::tuck || instruction.op == Op::miss ||
          instruction.op == Op::split) &&
         !instruction.carriers.empty();
}

std::vector<ProgramPass> passes_of(const Program& program) { return PassFinder(program).runs(); }

}  // namespace loopwright
