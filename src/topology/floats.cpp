#include "topology/floats.hpp"

#include <algorithm>

#include "base/stop.hpp"
#include "topology/needle_replay.hpp"

namespace loopwright {
namespace {

// Places of the carrier in quarter pitches: a needle at 2 * Racking::order, its left and right sides one less
// and more.
using Place = long long;

Place place(const Racking& racking, Needle needle) { return 2 * racking.order(needle); }

long long floor_quarter(long long x) { return x >= 0 ? x / 4 : -((-x + 3) / 4); }

struct Pass {
  PassedLoop passed;
  Place at = 0;
  bool to_right = false;
};

// The float that a yarn is laying.
struct OpenFloat {
  bool open = false;  // there is a loop before it
  LoopId from;
  std::vector<Pass> passes;
  std::vector<Needle> missed;
};

class FloatTracer {
 public:
  FloatTracer(const Program& program, const KnittingRecord& record, YarnGraph& graph)
      : graph_(graph), replay_(program, record), open_(record.yarns.size()) {}

  void trace_step(YarnId yarn, const YarnStep& step, const YarnStep* before);

 private:
  void pass_between(OpenFloat& open, Place from, Place to);
  void close(YarnId yarn, OpenFloat& open, LoopId to, Place at);

  YarnGraph& graph_;
  NeedleReplay replay_;
  std::vector<OpenFloat> open_;  // by yarn
  std::vector<Pass> reached_;    // scratch
};

void FloatTracer::trace_step(YarnId yarn, const YarnStep& step, const YarnStep* before) {
  replay_.advance_to(step.instruction);
  OpenFloat& open = open_[yarn.position()];
  Place to = place(replay_.racking(), step.needle);
  if (before && open.open) {
    Place from = place(replay_.racking(), step.from);
    if (!before->loop.valid()) from += static_cast<int>(before->direction);
    pass_between(open, from, step.loop.valid() ? to : to + static_cast<int>(step.direction));
  }
  if (!step.loop.valid()) {
    if (open.open) open.missed.push_back(step.needle);
    return;
  }
  if (open.open) close(yarn, open, step.loop, to);
  open.open = true;
  open.from = step.loop;
}

void FloatTracer::pass_between(OpenFloat& open, Place from, Place to) {
  const Racking& racking = replay_.racking();
  const bool to_right = from < to;
  const Place low = std::min(from, to), high = std::max(from, to);
  if (low % 2 == 0 && high - low <= (racking.between() ? 2 : 4))
    return;  // neighbours: no needle lies between
  const Place start = place(racking, replay_.needle_of(open.from));

  // Held loops from left to right, front before back where they face each other.
  reached_.clear();
  for (Bed bed : {Bed::front, Bed::front_slider, Bed::back, Bed::back_slider}) {
    const Place zero = place(racking, {bed, 0});
    const auto [first, last] =
        replay_.needles().range(bed, floor_quarter(low - zero) + 1, -floor_quarter(zero - high) - 1);
    for (int position = first; position < last; ++position) {
      const Needle needle = replay_.needles().needle(position);
      const Place at = place(racking, needle);
      if (at == start) continue;
      for (LoopId loop : replay_.held(position))
        reached_.push_back({{loop, racking.slot(needle), bed}, at, to_right});
    }
  }
  std::stable_sort(reached_.begin(), reached_.end(),
                   [](const Pass& a, const Pass& b) { return a.at < b.at; });
  if (!to_right) std::reverse(reached_.begin(), reached_.end());

  // Passing back over the loop that was passed last undoes both.
  for (const Pass& pass : reached_) {
    const bool undone = !open.passes.empty() && open.passes.back().passed.loop == pass.passed.loop &&
                        open.passes.back().to_right != pass.to_right;
    if (undone)
      open.passes.pop_back();
    else
      open.passes.push_back(pass);
  }
}

void FloatTracer::close(YarnId yarn, OpenFloat& open, LoopId to, Place at) {
  Float done;
  done.from = open.from;
  done.to = to;
  for (const Pass& pass : open.passes)
    if (pass.at != at) done.passed.push_back(pass.passed);
  done.missed = std::move(open.missed);
  graph_.yarns[yarn.position()].floats.push_back(std::move(done));
  open.passes.clear();
  open.missed.clear();
}

}  // namespace

void trace_floats(const Program& program, const KnittingRecord& record, YarnGraph& graph) {
  // All steps of all yarns in the order of their instructions, by counting.
  struct StepOf {
    YarnId yarn;
    std::size_t step = 0;
  };
  std::vector<std::size_t> next(program.instructions.size() + 1);
  for (const YarnRecord& yarn : record.yarns)
    for (const YarnStep& step : yarn.steps) ++next[static_cast<std::size_t>(step.instruction) + 1];
  for (std::size_t k = 1; k < next.size(); ++k) next[k] += next[k - 1];
  std::size_t count = 0;
  for (const YarnRecord& yarn : record.yarns) count += yarn.steps.size();
  std::vector<StepOf> steps(count);
  for (std::size_t y = 0; y < record.yarns.size(); ++y)
    for (std::size_t s = 0; s < record.yarns[y].steps.size(); ++s)
      steps[next[static_cast<std::size_t>(record.yarns[y].steps[s].instruction)]++] = {YarnId(y), s};

  FloatTracer tracer(program, record, graph);
  for (const StepOf& at : steps) {
    stop_if_told();
    const std::vector<YarnStep>& yarn_steps = record.yarns[at.yarn.position()].steps;
    tracer.trace_step(at.yarn, yarn_steps[at.step], at.step > 0 ? &yarn_steps[at.step - 1] : nullptr);
  }
}

}  // namespace loopwright
