// Time of each stretch of the road on named scenes. Scenes are examples, so that tests, documentation and
// figures speak of the same cloth.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "pipeline.hpp"

namespace loopwright {
namespace {

std::string example(const std::string& name) { return LOOPWRIGHT_SOURCE_DIR "/examples/structures/" + name; }

Knitting knitted(const std::string& file, const PieceRequest& request) {
  Diagnostics diagnostics(file);
  Knitting knitting = knit(file, request, diagnostics);
  if (!diagnostics.ok()) throw std::runtime_error(file + " has errors");
  return knitting;
}

// notation -> machine -> topology of a piece of n x n loops
void read_and_knit(benchmark::State& state) {
  const std::string size = std::to_string(state.range(0));
  const std::string text =
      ";!vermiculation-1\n;;Size: " + size + " wales x " + size + " courses\n;;Edges: bound-off\nge\n";
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("loopwright-bench-" + size + ".verm");
  std::ofstream(file) << text;
  std::size_t loops = 0;
  for (auto _ : state) loops = knitted(file, {}).graph.loops.size();
  std::filesystem::remove(file);
  state.counters["loops"] = static_cast<double>(loops);
}
BENCHMARK(read_and_knit)->Arg(60)->Arg(240)->Unit(benchmark::kMillisecond);

// geometry: layout, curves, fit
void first_geometry_of(benchmark::State& state, const std::string& name) {
  const Knitting knitting = knitted(example(name), {});
  for (auto _ : state) benchmark::DoNotOptimize(first_geometry(knitting, {}));
}
BENCHMARK_CAPTURE(first_geometry_of, plain, "plain.verm")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(first_geometry_of, cable, "cable.verm")->Unit(benchmark::kMillisecond);

// mechanics: a periodic cell from its first geometry to rest
void relax_cell(benchmark::State& state, const std::string& name) {
  PieceRequest cell;
  cell.periodic = true;
  const Knitting knitting = knitted(example(name), cell);
  const Fabric fabric = first_geometry(knitting, cell);
  const RelaxOptions options = relax_options(fabric, knitting.program, cell);
  RelaxResult result;
  for (auto _ : state) result = relax(fabric, options);
  state.counters["newton"] = result.newton_iterations;
  state.counters["converged"] = result.converged ? 1 : 0;
}
BENCHMARK_CAPTURE(relax_cell, plain, "plain.verm")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(relax_cell, rib, "rib.verm")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(relax_cell, garter, "garter.verm")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(relax_cell, moss, "moss.verm")->Unit(benchmark::kMillisecond);

// mechanics: a held piece
void relax_window(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  PieceRequest window;
  window.window = WindowSize{size, size};
  const Knitting knitting = knitted(example("plain.verm"), window);
  const Fabric fabric = first_geometry(knitting, window);
  const RelaxOptions options = relax_options(fabric, knitting.program, window);
  RelaxResult result;
  for (auto _ : state) result = relax(fabric, options);
  state.counters["newton"] = result.newton_iterations;
  state.counters["converged"] = result.converged ? 1 : 0;
}
BENCHMARK(relax_window)->Arg(4)->Arg(8)->Arg(16)->Unit(benchmark::kMillisecond);

// experiments
void assess_piece(benchmark::State& state) {
  const Fabric fabric = first_geometry(knitted(example("plain.verm"), {}), {});
  for (auto _ : state) benchmark::DoNotOptimize(assess(fabric));
}
BENCHMARK(assess_piece)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopwright
