// A thread of its own that runs one task at a time, always the latest that was handed in: what an edit makes
// out of date is told to stop, and what it still waited for is never begun.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace loopwright {

class LatestOnly {
 public:
  // A task looks at the flag as often as it can and returns soon after it is set. It throws nothing.
  using Task = std::function<void(const std::atomic<bool>& cancelled)>;

  LatestOnly();
  ~LatestOnly();  // cancels and waits
  LatestOnly(const LatestOnly&) = delete;
  LatestOnly& operator=(const LatestOnly&) = delete;

  void start(Task task);
  void cancel();
  bool busy() const;  // a task runs or waits
  void wait();        // until none does

 private:
  void run();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Task next_;
  std::shared_ptr<std::atomic<bool>> cancelled_;  // of the task that runs
  bool running_ = false, ending_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace loopwright
