// The loop-scale model: steps of the mass-spring net against what memory can carry, and frames of a net with
// its centrelines.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "loop_scale/loop_model.hpp"
#include "loop_scale/net_kernel.hpp"
#include "loop_scale/nurbs.hpp"
#include "pipeline.hpp"

namespace loopwright {
namespace {

// Weft and warp springs of plain, `side` x `side` masses.
MassSpringNet plain_net(int side) {
  MassSpringNet net = traditional_net(side, side, 4.2, 3.2, 1e-6, {200, 0, 0});
  net.damping = 1e-3;
  return net;
}

void net_step(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(1)));
  const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(state.range(0)))));
  const MassSpringNet net = plain_net(side);
  NetKernel kernel(net);
  std::vector<Vec3> places = grid_places(side, side, 4.2, 3.2);
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i].x += 0.1 * std::sin(0.01 * static_cast<double>(i));
  NetState moving = state_at_rest(places);
  const double h = 0.5 * kernel.stable_step();
  constexpr int steps = 10;
  kernel.advance(moving, h, 2);
  for (auto _ : state) kernel.advance(moving, h, steps);
  // a call evaluates the springs once more than it steps
  const double masses = static_cast<double>(kernel.masses());
  const double sweeps = static_cast<double>(state.iterations()) * (steps + 1);
  state.counters["steps_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * steps, benchmark::Counter::kIsRate);
  state.counters["bytes_per_mass"] = kernel.bytes_per_mass();
  state.counters["bytes_per_s"] =
      benchmark::Counter(sweeps * masses * kernel.bytes_per_mass(), benchmark::Counter::kIsRate);
  set_thread_count(0);
}
BENCHMARK(net_step)
    ->ArgNames({"masses", "threads"})
    ->Args({10'000, 1})
    ->Args({10'000, 2})
    ->Args({1'000'000, 1})
    ->Args({1'000'000, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// What the machine's memory carries: a[i] = b[i] + s c[i] over arrays far larger than the caches.
void memory_triad(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  const std::size_t n = 12'000'000, part = n / 64;
  std::vector<double> a(n, 0), b(n, 1), c(n, 2);
  for (auto _ : state) {
    parallel_chunks(64, [&](int k) {
      const std::size_t first = static_cast<std::size_t>(k) * part;
      for (std::size_t i = first; i < first + part; ++i) a[i] = b[i] + 0.5 * c[i];
    });
    benchmark::ClobberMemory();
  }
  state.counters["bytes_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(part * 64) * 24,
                         benchmark::Counter::kIsRate);
  set_thread_count(0);
}
BENCHMARK(memory_triad)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

// A frame of a knitted plain piece: ten steps, and the centreline's type value points.
void frame_with_centrelines(benchmark::State& state) {
  const std::string side = std::to_string(state.range(0));
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("loopwright-bench-loop-" + side + ".verm");
  std::ofstream(file) << ";!vermiculation-1\n;;Size: " << side << " wales x " << side
                      << " courses\n;;Edges: free\ng\n";
  Diagnostics diagnostics(file.string());
  const Knitting knitting = knit(file, {}, diagnostics);
  std::filesystem::remove(file);
  if (!diagnostics.ok()) throw std::runtime_error("the plain piece has errors");
  const LoopModel model = build_loop_model(knitting.graph, knitting.program);
  NetKernel kernel(model.net);
  NetState moving = state_at_rest(model.start);
  const double h = 0.5 * kernel.stable_step();
  std::vector<Vec3> points;
  for (auto _ : state) {
    kernel.advance(moving, h, 10);
    const std::vector<Vec3> places = positions_of(moving);
    model.map.map(places, model.map.frames(places), points);
    // control points of every yarn, for a renderer that draws splines
    std::size_t first = 0;
    for (const CurveYarn& yarn : model.curves.yarns) {
      const std::vector<Vec3> own(points.begin() + static_cast<std::ptrdiff_t>(first),
                                  points.begin() + static_cast<std::ptrdiff_t>(first + yarn.points.size()));
      benchmark::DoNotOptimize(interpolate(own, {3, Parametrisation::chord_length, NurbsEnds::natural, {}}));
      first += yarn.points.size();
    }
  }
  state.counters["masses"] = static_cast<double>(model.net.mass.size());
  state.counters["frames_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(frame_with_centrelines)->Arg(30)->Arg(100)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopwright
