// Mechanics by its kernels, per loop, on pieces of plain in their relaxed shape; and whole relaxations with
// their memory.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "base/parallel.hpp"
#include "geometry/fit_fabric.hpp"
#include "geometry/periodic_cell.hpp"
#include "machine/run_machine.hpp"
#include "mechanics/linear/cholesky.hpp"
#include "mechanics/safe_step.hpp"
#include "notation/read_vermiculation.hpp"
#include "pipeline.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

constexpr double range = 1.6;

std::string plain_text(const std::string& headers) {
  return ";!vermiculation-1\n;;Yarn-A: diameter=1 mm\n;;Loop-Length: 17 mm\n" + headers + "g\n";
}

RelaxOptions frictionless() {
  RelaxOptions options;
  options.model.material = {3000, 1, {1, 0.5, 400, 2.4}, 0};
  return options;
}

// n x n copies of a relaxed plain cell, each course one open yarn; nothing is held.
const Fabric& tiled_plain(int n) {
  static std::map<int, Fabric> made;
  if (const auto found = made.find(n); found != made.end()) return found->second;
  Diagnostics diagnostics("plain");
  const Program program = read_vermiculation(plain_text(";;Edges: periodic\n"), diagnostics);
  const YarnGraph graph = build_yarn_graph(program, run_machine(program, diagnostics), diagnostics);
  const GeometryOptions options = make_geometry_options(program);
  const YarnCurves curves =
      cut_periodic_cell(graph, options, place_type_points(graph, options), cell_range(program));
  const Fabric cell = relax(fit_fabric(curves, graph, options), frictionless()).fabric;
  Fabric piece;
  piece.width = n * cell.width;
  piece.height = n * cell.height;
  const FabricYarn& loop = cell.yarns.at(0);
  const int points = static_cast<int>(loop.control_points.size());
  for (int course = 0; course < n; ++course) {
    FabricYarn yarn = loop;
    yarn.periodic = false;
    yarn.control_points.clear();
    for (int i = 0; i < n * points + 3; ++i)
      yarn.control_points.push_back(control_point(cell, loop, i) + cell.lattice(0, course));
    yarn.held.assign(yarn.control_points.size(), 0);
    piece.yarns.push_back(std::move(yarn));
  }
  return made[n] = piece;
}

// One piece with its pairs, gradient and Hessian, on one thread.
struct Kernels {
  explicit Kernels(int n, double stretch_only = 0)
      : model(build_yarn_model(tiled_plain(n), frictionless().model)),
        state(build_yarn_state(tiled_plain(n))),
        assembly(model) {
    set_thread_count(1);
    assembly.update_pairs(state, stretch_only > 0 ? stretch_only : range);
    assembly.hessian(state, gradient, hessian);
    assembly.metric(hessian);
    hessian.measure_metric = {1, 1, 1};
  }
  ~Kernels() { set_thread_count(0); }
  YarnModel model;
  YarnState state;
  Assembly assembly;
  Unknowns gradient;
  BlockMatrix hessian;
};

// Processor time per loop of the piece.
void per_loop(benchmark::State& state, int n) {
  state.counters["per_loop"] =
      benchmark::Counter(static_cast<double>(n) * n,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Pairs within a tenth of a diameter: none, so that only stretch, bend and the pattern are left.
void stretch_and_bend(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n, 0.1);
  for (auto _ : state) k.assembly.hessian(k.state, k.gradient, k.hessian);
  per_loop(state, n);
}
void stretch_bend_and_contact(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n);
  for (auto _ : state) k.assembly.hessian(k.state, k.gradient, k.hessian);
  state.counters["pairs_per_loop"] = static_cast<double>(k.assembly.pairs().size()) / n / n;
  per_loop(state, n);
}
void energy_alone(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n);
  for (auto _ : state) benchmark::DoNotOptimize(k.assembly.energy(k.state));
  per_loop(state, n);
}
void pair_search(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n);
  for (auto _ : state) k.assembly.update_pairs(k.state, range);
  per_loop(state, n);
}
void safe_step_check(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n);
  const YarnState target = k.assembly.moved(k.state, k.gradient, 1e-3);
  for (auto _ : state)
    benchmark::DoNotOptimize(safe_step(k.model, k.assembly, k.state, target, range, 1, 0.7));
  per_loop(state, n);
}
void hessian_product(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n);
  Unknowns product;
  for (auto _ : state) {
    multiply(k.hessian, k.gradient, product);
    benchmark::DoNotOptimize(product.u.data());
  }
  // Blocks, their columns, the border; x and y stay in the cache.
  const double bytes = static_cast<double>(k.hessian.column.size()) * (sizeof(Block) + sizeof(std::int32_t)) +
                       static_cast<double>(k.hessian.rows()) * (sizeof(Block) + 2 * sizeof(Vec3));
  state.counters["blocks_per_loop"] = static_cast<double>(k.hessian.column.size()) / n / n;
  state.counters["GB/s"] = benchmark::Counter(bytes * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
  per_loop(state, n);
}
void cholesky_factor(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n);
  Cholesky cholesky;
  bool definite = cholesky.factor(k.hessian, 1);  // the order is found here, once
  for (auto _ : state) definite = cholesky.factor(k.hessian, 1);
  if (!definite) state.SkipWithError("not positive definite");
  state.counters["entries_per_loop"] = cholesky.factor_entries() / n / n;
  per_loop(state, n);
}
void cholesky_solve(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n);
  Cholesky cholesky;
  if (!cholesky.factor(k.hessian, 1)) state.SkipWithError("not positive definite");
  Unknowns x;
  for (auto _ : state) cholesky.solve(k.gradient, x);
  per_loop(state, n);
}
void sizes(benchmark::internal::Benchmark* b) { b->Arg(10)->Arg(20)->Arg(40)->Unit(benchmark::kMicrosecond); }
BENCHMARK(stretch_and_bend)->Apply(sizes);
BENCHMARK(stretch_bend_and_contact)->Apply(sizes);
BENCHMARK(energy_alone)->Apply(sizes);
BENCHMARK(pair_search)->Apply(sizes);
BENCHMARK(safe_step_check)->Apply(sizes);
BENCHMARK(hessian_product)->Apply(sizes);
BENCHMARK(cholesky_factor)->Apply(sizes);
BENCHMARK(cholesky_solve)->Apply(sizes);

// A held piece from its notation to rest, as the command relaxes it. Peak memory is that of the whole process
// so far, so run one size at a time to read it: --benchmark_filter='relax_held/60'.
void relax_held(benchmark::State& state) {
  const std::string n = std::to_string(state.range(0));
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("loopwright-held-" + n + ".verm");
  std::ofstream(file) << plain_text(";;Size: " + n + " wales x " + n + " courses\n;;Edges: held\n");
  Diagnostics diagnostics(file);
  PieceRequest request;
  request.start_from_cell = true;
  RelaxResult result;
  for (auto _ : state) {
    const Knitting knitting = knit(file, request, diagnostics);
    const Fabric first = first_geometry(knitting, request);
    RelaxOptions options = relax_options(first, knitting.program, request);
    const std::optional<Fabric> start = start_from_relaxed_cell(knitting, request, first, options);
    result = relax(start ? *start : first, options);
  }
  std::filesystem::remove(file);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
  state.counters["newton"] = result.newton_iterations;
  state.counters["linear"] = result.linear_iterations;
  state.counters["converged"] = result.converged ? 1 : 0;
  per_loop(state, static_cast<int>(state.range(0)));
}
BENCHMARK(relax_held)->Arg(20)->Arg(60)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace loopwright
