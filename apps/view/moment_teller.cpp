#include "moment_teller.hpp"

#include <utility>

namespace loopwright {
namespace {

// Counting interlacings costs about as much as a step of a small cell; on the way larger pieces go without.
constexpr std::size_t most_loops_counted_live = 200;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void MomentTeller::show() {
  ClothMoment moment = moment_;
  moment.seconds = seconds_since(start_);
  last_shown_ = Clock::now();
  show_(std::move(moment));
}

void MomentTeller::publish(const Fabric& fabric) {
  moment_.fabric = std::make_shared<const Fabric>(fabric);
  show();
}

void MomentTeller::fail(const std::string& why) {
  moment_.stage = ClothStage::unusable;
  moment_.message = why;
  moment_.fabric = nullptr;
  show();
}

void MomentTeller::stop(const std::string& where) {
  moment_.stage = ClothStage::stopped;
  moment_.message = where;
  moment_.fabric = nullptr;
  show();
}

void MomentTeller::count(const Fabric& fabric) { moment_.interlacings = check_interlacings(fabric); }

void MomentTeller::note(const RelaxProgress& progress) {
  moment_.stage = progress.radius < 1 ? ClothStage::growing : ClothStage::relaxing;
  moment_.iterations = progress.newton_iterations;
  moment_.residual = progress.residual;
  moment_.radius = progress.radius;
}

std::function<bool(const RelaxProgress&)> MomentTeller::watch(const Fabric& from,
                                                              const std::atomic<bool>& cancelled) {
  return [this, &from, &cancelled](const RelaxProgress& progress) {
    note(progress);
    if (progress.state && seconds_since(last_shown_) > seconds_between_moments) {
      const Fabric now = with_state(from, *progress.state);
      if (from.loops.size() <= most_loops_counted_live)
        count(now);
      else
        moment_.interlacings.expected = -1;
      publish(now);
    }
    return !cancelled;
  };
}

void MomentTeller::finish(RelaxResult result) {
  result.fabric.name = moment_.fabric ? moment_.fabric->name : result.fabric.name;
  moment_.stage = result.stopped     ? ClothStage::stopped
                  : result.converged ? ClothStage::at_rest
                                     : ClothStage::not_at_rest;
  moment_.residual = result.residual;
  moment_.iterations = result.newton_iterations;
  moment_.message = result.message;
  count(result.fabric);
  moment_.relaxed = std::make_shared<const RelaxResult>(std::move(result));
  if (!moment_.broken())
    moment_.measured = std::make_shared<const Measurements>(measure(moment_.relaxed->fabric));
  publish(moment_.relaxed->fabric);
}

}  // namespace loopwright
