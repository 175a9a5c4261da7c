// knitout from text to yarn graph: a real swatch of KnitDB (202,268 bytes, 7,476 knits, 3,462 transfers), and
// programmes of any length, whose memory must grow with their loops and no faster.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

std::string swatch() {
  const char* corpus = std::getenv("LOOPWRIGHT_CORPUS");
  const std::filesystem::path folder = corpus ? corpus : LOOPWRIGHT_SOURCE_DIR "/../shared/corpus";
  std::ostringstream text;
  text << std::ifstream(folder / "knitdb" / "2_1_004Stockinette.knitout", std::ios::binary).rdbuf();
  return text.str();
}

// Plain, 500 needles wide, with a cable of one over one in every twentieth course.
std::string plain_programme(std::int64_t operations) {
  constexpr int needles = 500;
  std::string text = ";!knitout-2\n;;Carriers: 1\nin 1\n";
  text.reserve(static_cast<std::size_t>(operations) * 14 + 100);
  for (std::int64_t done = 1, course = 0; done < operations; ++course) {
    for (int k = 0; k < needles && done < operations; ++k, ++done) {
      const bool right = course % 2 == 0;
      text += right ? "knit + f" : "knit - f";
      text += std::to_string(right ? k : needles - 1 - k) + " 1\n";
    }
    if (course % 20 == 19 && done < operations) {
      text += "xfer f9 b9\nxfer f10 b10\nrack 1\nxfer b9 f10\nrack -1\nxfer b10 f9\nrack 0\n";
      done += 7;
    }
  }
  return text + "out 1\n";
}

void read_run_and_graph(benchmark::State& state, const std::string& text) {
  if (text.empty()) return state.SkipWithError("no corpus: set LOOPWRIGHT_CORPUS to where it lies");
  double loops = 0, bytes = 0;
  for (auto _ : state) {
    const std::size_t before = mallinfo2().uordblks + mallinfo2().hblkhd;
    Diagnostics diagnostics;
    const Program program = read_knitout(text, diagnostics);
    const KnittingRecord record = run_machine(program, diagnostics);
    const YarnGraph graph = build_yarn_graph(program, record, diagnostics);
    if (!diagnostics.ok()) return state.SkipWithError("the programme has errors");
    loops = static_cast<double>(graph.loops.size());
    bytes = static_cast<double>(mallinfo2().uordblks + mallinfo2().hblkhd - before);
  }
  state.counters["loops"] = loops;
  state.counters["bytes_per_loop"] = bytes / loops;
}

void knitout_swatch(benchmark::State& state) { read_run_and_graph(state, swatch()); }
BENCHMARK(knitout_swatch)->Unit(benchmark::kMillisecond);

void knitout_operations(benchmark::State& state) {
  read_run_and_graph(state, plain_programme(state.range(0)));
}
BENCHMARK(knitout_operations)
    ->RangeMultiplier(10)
    ->Range(10'000, 10'000'000)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

void read_knitout_swatch(benchmark::State& state) {
  const std::string text = swatch();
  if (text.empty()) return state.SkipWithError("no corpus: set LOOPWRIGHT_CORPUS to where it lies");
  for (auto _ : state) {
    Diagnostics diagnostics;
    benchmark::DoNotOptimize(read_knitout(text, diagnostics));
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(text.size()) * state.iterations());
}
BENCHMARK(read_knitout_swatch)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopwright
