#include <gtest/gtest.h>

#include <thread>

#include "base/stop.hpp"

namespace loopwright {
namespace {

TEST(Stop, OnlyWhereAScopeWasTold) {
  std::atomic<bool> told{true}, untold{false};
  stop_if_told();  // no scope: nothing happens
  {
    const StopScope outer(told);
    EXPECT_THROW(stop_if_told(), Stopped);
    {
      const StopScope inner(untold);
      EXPECT_NO_THROW(stop_if_told());
    }
    EXPECT_THROW(stop_if_told(), Stopped);
    // another thread is not told
    std::thread([] { EXPECT_NO_THROW(stop_if_told()); }).join();
  }
  EXPECT_NO_THROW(stop_if_told());
}

}  // namespace
}  // namespace loopwright
