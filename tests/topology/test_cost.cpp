// What a programme costs from its text to its yarn graph.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <ctime>

#include "machine/corpus.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

struct Cost {
  double seconds = 0;  // of the processor, so that a busy machine does not matter
  double bytes = 0;    // kept by programme, record and graph
  std::size_t loops = 0;
};

Cost cost_of(const std::string& text) {
  const std::size_t before = mallinfo2().uordblks + mallinfo2().hblkhd;
  const std::clock_t start = std::clock();
  Diagnostics said;
  const Program program = read_knitout(text, said);
  const KnittingRecord record = run_machine(program, said);
  const YarnGraph graph = build_yarn_graph(program, record, said);
  Cost cost;
  cost.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  cost.bytes = static_cast<double>(mallinfo2().uordblks + mallinfo2().hblkhd - before);
  cost.loops = graph.loops.size();
  EXPECT_TRUE(said.ok()) << said;
  return cost;
}

TEST(Cost, a_swatch_of_200_kb_takes_less_than_a_twentieth_of_a_second) {
  SKIP_WITHOUT_CORPUS();
#ifndef NDEBUG
  GTEST_SKIP() << "only a release build is fast";
#endif
  const std::string text = corpus_text("knitdb/2_1_004Stockinette.knitout");
  ASSERT_EQ(text.size(), 202'268u);
  double best = 1;
  for (int k = 0; k < 5; ++k) {
    const Cost cost = cost_of(text);
    EXPECT_EQ(cost.loops, 7476u);
    best = std::min(best, cost.seconds);
  }
  RecordProperty("milliseconds", std::to_string(best * 1e3));
  EXPECT_LT(best, 0.05);
}

// Plain on 100 needles, and a transfer there and back now and then.
std::string programme(int courses) {
  std::string text = ";!knitout-2\n;;Carriers: 1\nin 1\n";
  for (int course = 0; course < courses; ++course) {
    for (int k = 0; k < 100; ++k)
      text +=
          (course % 2 == 0 ? "knit + f" + std::to_string(k) : "knit - f" + std::to_string(99 - k)) + " 1\n";
    if (course % 10 == 9) text += "xfer f5 b5\nrack 1\nrack 0\nxfer b5 f5\n";
  }
  return text + "out 1\n";
}

TEST(Cost, memory_is_linear_in_loops) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer counts its own memory";
#endif
  const Cost small = cost_of(programme(100)), large = cost_of(programme(4000));
  ASSERT_EQ(small.loops, 10'000u);
  ASSERT_EQ(large.loops, 400'000u);
  const double per_loop = large.bytes / 400'000, per_loop_small = small.bytes / 10'000;
  RecordProperty("bytes_per_loop", std::to_string(per_loop));
  EXPECT_LT(per_loop, 1.1 * per_loop_small);
  EXPECT_GT(per_loop, 100);  // it has been counted at all
}

}  // namespace
}  // namespace loopwright
