#include "latest_only.hpp"

#include <utility>

namespace loopwright {

LatestOnly::LatestOnly()
    : cancelled_(std::make_shared<std::atomic<bool>>(false)), thread_([this] { run(); }) {}

LatestOnly::~LatestOnly() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    next_ = nullptr;
    *cancelled_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LatestOnly::start(Task task) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(task);
    *cancelled_ = true;
  }
  changed_.notify_all();
}

void LatestOnly::cancel() {
  const std::lock_guard lock(mutex_);
  next_ = nullptr;
  *cancelled_ = true;
}

bool LatestOnly::busy() const {
  const std::lock_guard lock(mutex_);
  return running_ || next_;
}

void LatestOnly::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !running_ && !next_; });
}

void LatestOnly::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || next_; });
    if (ending_) return;
    const Task task = std::exchange(next_, nullptr);
    const auto cancelled = cancelled_ = std::make_shared<std::atomic<bool>>(false);
    running_ = true;
    lock.unlock();
    task(*cancelled);
    lock.lock();
    running_ = false;
    changed_.notify_all();
  }
}

}  // namespace loopwright
