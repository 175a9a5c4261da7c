#include "progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace loopwright {

ProgressBar::ProgressBar(std::string what) : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(double share, const std::string& note) {
  if (!terminal_) return;
  const Clock::time_point now = Clock::now();
  if (shown_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  shown_ = true;
  constexpr int width = 30;
  const int percent = static_cast<int>(std::lround(100 * std::clamp(share, 0.0, 1.0)));
  const std::string bar(static_cast<std::size_t>(percent * width / 100), '#');
  std::fprintf(stderr, "\r\033[K%s [%-*s] %3d %%  %s", what_.c_str(), width, bar.c_str(), percent,
               note.c_str());
  std::fflush(stderr);
}

}  // namespace loopwright
