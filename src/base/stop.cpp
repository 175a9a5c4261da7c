#include "base/stop.hpp"

namespace loopwright {
namespace {

thread_local const std::atomic<bool>* told_in_this_thread = nullptr;

}  // namespace

StopScope::StopScope(const std::atomic<bool>& told) : outer_(told_in_this_thread) {
  told_in_this_thread = &told;
}

StopScope::~StopScope() { told_in_this_thread = outer_; }

void stop_if_told() {
  if (told_in_this_thread && told_in_this_thread->load(std::memory_order_relaxed)) throw Stopped();
}

}  // namespace loopwright
