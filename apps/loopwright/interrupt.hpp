// Ctrl-C during long work: the work stops at the next step and what was reached is kept.
#pragma once

namespace loopwright {

// While one lives, SIGINT and SIGTERM are noted instead of ending the program; a second one ends it at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
};

bool interrupted();

}  // namespace loopwright
