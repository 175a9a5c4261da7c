// A line on the terminal that says how far long work is.
#pragma once
#include <chrono>
#include <string>

namespace loopwright {

// Writes to standard error, and only if that is a terminal; at most ten times a second. The line is wiped at
// the end.
class ProgressBar {
 public:
  explicit ProgressBar(std::string what);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // share: 0 to 1; note: a few words after the bar.
  void show(double share, const std::string& note = {});

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool terminal_ = false, shown_ = false;
  Clock::time_point last_{};
};

}  // namespace loopwright
