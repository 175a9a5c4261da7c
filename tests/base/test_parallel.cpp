#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/parallel.hpp"

namespace loopwright {
namespace {

class Parallel : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(0); }
};
INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 3, 7));

TEST_P(Parallel, EveryChunkOnceAndAllDoneOnReturn) {
  EXPECT_EQ(thread_count(), GetParam());
  for (const int chunks : {0, 1, 2, 5, 64, 1000}) {
    std::vector<std::atomic<int>> runs(static_cast<std::size_t>(chunks));
    parallel_chunks(chunks, [&](int i) { ++runs[static_cast<std::size_t>(i)]; });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
  }
}

TEST_P(Parallel, SumsByChunkAreEqualToTheLastBit) {
  const auto sum = [] {
    std::vector<double> partial(37);
    parallel_chunks(37, [&](int c) {
      for (int k = 0; k < 1000; ++k)
        partial[static_cast<std::size_t>(c)] += std::sin(c * 1000.0 + k) / (k + 1);
    });
    double total = 0;
    for (const double p : partial) total += p;
    return total;
  };
  const double here = sum();
  set_thread_count(1);
  EXPECT_EQ(here, sum());
}

TEST_P(Parallel, TheLowestFailureIsRethrownAndThePoolGoesOn) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    try {
      parallel_chunks(50, [](int i) {
        if (i == 20 || i == 21 || i == 45) throw std::runtime_error(std::to_string(i));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), "20");
    }
    std::atomic<int> count = 0;
    parallel_chunks(50, [&](int) { ++count; });
    EXPECT_EQ(count, 50);
  }
}

TEST_P(Parallel, CallsFromInsideRunToo) {
  std::atomic<int> count = 0;
  parallel_chunks(6, [&](int) { parallel_chunks(7, [&](int) { ++count; }); });
  EXPECT_EQ(count, 42);
}

TEST_P(Parallel, ManySmallRounds) {
  std::vector<int> values(8);
  for (int round = 0; round < 2000; ++round)
    parallel_chunks(8, [&](int i) { ++values[static_cast<std::size_t>(i)]; });
  EXPECT_THAT(values, testing::Each(2000));
}

// A copy of the process has none of the pool's threads: it must neither wait for them nor join them at its
// end.
TEST_P(Parallel, AForkedProcessWorksAndEnds) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "ThreadSanitizer starts no threads after a fork";
#endif
  std::atomic<int> before = 0;
  parallel_chunks(50, [&](int) { ++before; });
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::atomic<int> count = 0;
    parallel_chunks(50, [&](int) { ++count; });
    std::_Exit(count == 50 ? 0 : 1);
  }
  int status = -1;
  pid_t ended = 0;
  for (int tenths = 0; tenths < 100 && ended == 0; ++tenths) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  if (ended == 0) kill(child, SIGKILL), waitpid(child, &status, 0);
  EXPECT_EQ(ended, child) << "the copy hangs";
  EXPECT_EQ(status, 0);
  parallel_chunks(50, [&](int) { ++before; });
  EXPECT_EQ(before, 100);
}

TEST(ParallelThreads, ZeroIsTheNumberOfProcessors) {
  set_thread_count(0);
  EXPECT_GE(thread_count(), 1);
}

}  // namespace
}  // namespace loopwright
