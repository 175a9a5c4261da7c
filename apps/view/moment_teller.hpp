// How work tells what it came to: the moment as it stands, counted, timed, and not too often.
#pragma once
#include <chrono>

#include "cloth_job.hpp"

namespace loopwright {

class MomentTeller {
 public:
  explicit MomentTeller(const ShowMoment& show) : show_(show) { moment_.interlacings.expected = -1; }

  ClothMoment& moment() { return moment_; }
  void show();  // the moment as it is
  void publish(const Fabric& fabric);
  void fail(const std::string& why);    // nothing to show
  void stop(const std::string& where);  // told to stop before there was anything to show
  void count(const Fabric& fabric);
  void note(const RelaxProgress& progress);
  // Pictures on the way, a few a second; false once `cancelled`.
  std::function<bool(const RelaxProgress&)> watch(const Fabric& from, const std::atomic<bool>& cancelled);
  void finish(RelaxResult result);

 private:
  using Clock = std::chrono::steady_clock;
  const ShowMoment& show_;
  ClothMoment moment_;
  Clock::time_point start_ = Clock::now(), last_shown_ = start_;
};

}  // namespace loopwright
