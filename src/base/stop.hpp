// Stopping long work from outside. Whoever starts it sets a StopScope round it; the work asks at places where
// it may end, some hundred times a second, and leaves by an exception. Functions on the way need no
// parameter for it.
#pragma once
#include <atomic>
#include <exception>

namespace loopwright {

// Thrown by stop_if_told(); no fault of anything, so no message for people.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

// While it lives, stop_if_told() in this thread looks at `told`. The innermost scope counts.
class StopScope {
 public:
  explicit StopScope(const std::atomic<bool>& told);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const std::atomic<bool>* outer_;
};

// Throws Stopped if the scope of this thread was told; nothing where there is no scope. Costs a load: to be
// called once a loop or a yarn, not once a sample.
void stop_if_told();

}  // namespace loopwright
