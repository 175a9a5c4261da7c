#include "knitout_passes.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace loopwright {
namespace {

// "3 > 24 knit, 2 miss": carriers, direction, and how many of what.
std::string label_of(const Program& program, const ProgramPass& run) {
  constexpr std::array<std::pair<Op, const char*>, 6> kinds{{{Op::knit, "knit"},
                                                             {Op::tuck, "tuck"},
                                                             {Op::split, "split"},
                                                             {Op::miss, "miss"},
                                                             {Op::xfer, "xfer"},
                                                             {Op::drop, "drop"}}};
  const Instruction& first = program.instructions[run.begin];
  std::string label;
  for (const CarrierId id : first.carriers)
    label += (label.empty() ? "" : "+") + program.carriers[id.position()];
  if (run.yarn) label += first.direction == Direction::left ? " \u2190 " : " \u2192 ";
  bool more = false;
  for (const auto& [op, name] : kinds) {
    const auto count = std::count_if(program.instructions.begin() + static_cast<std::ptrdiff_t>(run.begin),
                                     program.instructions.begin() + static_cast<std::ptrdiff_t>(run.end),
                                     [wanted = op](const Instruction& each) { return each.op == wanted; });
    if (count == 0) continue;
    label += (more ? ", " : "") + std::to_string(count) + " " + name;
    more = true;
  }
  return label;
}

}  // namespace

KnitoutPasses::KnitoutPasses(std::shared_ptr<const Knitting> knitting)
    : knitting_(std::move(knitting)), diagram_(knitting_->program) {
  const Program& program = knitting_->program;
  for (const ProgramPass& run : diagram_.runs()) {
    for (std::size_t i = run.begin; i < run.end; ++i)
      if (program.instructions[i].op >= Op::knit) acts_.push_back(static_cast<std::int32_t>(i));
    const int first = program.instructions[run.begin].at.line,
              last = program.instructions[run.end - 1].at.line;
    if (last > first) folds_.push_back({first, last, label_of(program, run)});
  }
}

const Instruction& KnitoutPasses::at(int act) const {
  return knitting_->program.instructions[static_cast<std::size_t>(instruction(act))];
}

SourceLocation KnitoutPasses::place(int act) const { return at(act).at; }

std::size_t KnitoutPasses::pass_of(int act) const {
  const auto& runs = diagram_.runs();
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), static_cast<std::size_t>(instruction(act)),
                       [](std::size_t index, const ProgramPass& run) { return index < run.begin; });
  return static_cast<std::size_t>(after - runs.begin()) - 1;
}

double KnitoutPasses::slot(int act) const {
  const Needle needle = at(act).needle;
  return needle.index + (is_front(needle.bed) ? 0 : diagram_.runs()[pass_of(act)].racking);
}

const DiagramPass& PassCache::pass(const ProgramDiagram& diagram, std::size_t k) {
  if (const auto found = places_.find(k); found != places_.end()) {
    order_.splice(order_.begin(), order_, found->second);
    return order_.front().second;
  }
  if (order_.size() >= most_kept) {
    places_.erase(order_.back().first);
    order_.pop_back();
  }
  order_.emplace_front(k, diagram.pass(k));
  places_[k] = order_.begin();
  return order_.front().second;
}

void PassCache::clear() {
  order_.clear();
  places_.clear();
}

}  // namespace loopwright
