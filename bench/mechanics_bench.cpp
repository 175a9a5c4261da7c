// Mechanics by its kernels, per loop, on pieces of plain in their relaxed shape; and whole relaxations with
// their memory.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "base/wide.hpp"
#include "geometry/fit_fabric.hpp"
#include "geometry/periodic_cell.hpp"
#include "machine/run_machine.hpp"
#include "mechanics/energies/lanes.hpp"
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

// What this machine allows one core: doubles read from memory and from the cache, and additions with
// multiplications as the kernels run them (eight independent chains of lanes, no fused products).
double read_rate(std::size_t doubles) {  // bytes a second
  const std::vector<double> data(doubles, 1.0);
  double best = 0;
  for (int trial = 0; trial < 9; ++trial) {
    const int rounds = static_cast<int>(std::max<std::size_t>(1, (std::size_t{1} << 24) / doubles));
    const auto start = std::chrono::steady_clock::now();
    for (int round = 0; round < rounds; ++round) {
      std::array<double, 16> sum{};
      for (std::size_t i = 0; i + 16 <= doubles; i += 16)
        for (std::size_t l = 0; l < 16; ++l) sum[l] += data[i + l];
      benchmark::DoNotOptimize(sum);
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    best = std::max(best, rounds * static_cast<double>(doubles) * sizeof(double) / taken.count());
  }
  return best;
}
LOOPWRIGHT_WIDE void add_and_multiply(int rounds, Lanes& sum, const Lanes& factor, const Lanes& summand) {
  Lanes a = sum, b = a, c = a, d = a, e = a, f = a, g = a, h = a;
  for (int i = 0; i < rounds; ++i) {
    a = a * factor + summand, b = b * factor + summand, c = c * factor + summand, d = d * factor + summand;
    e = e * factor + summand, f = f * factor + summand, g = g * factor + summand, h = h * factor + summand;
  }
  sum = a + b + c + d + e + f + g + h;
}
double flop_rate() {  // a second
  constexpr int rounds = 1'000'000;
  double best = 0;
  for (int trial = 0; trial < 9; ++trial) {
    Lanes sum = Lanes{} + 1.0, factor = Lanes{} + 0.999999, summand = Lanes{} + 1e-6;
    benchmark::DoNotOptimize(factor);
    benchmark::DoNotOptimize(summand);
    const auto start = std::chrono::steady_clock::now();
    add_and_multiply(rounds, sum, factor, summand);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    benchmark::DoNotOptimize(sum);
    best = std::max(best, 16.0 * lanes * rounds / taken.count());
  }
  return best;
}
struct Machine {
  double flops, memory, cache;  // a second
};
const Machine& machine() {
  constexpr std::size_t far_beyond_caches = std::size_t{1} << 24, half_a_cache = std::size_t{1} << 15;
  static const Machine measured{flop_rate(), read_rate(far_beyond_caches), read_rate(half_a_cache)};
  return measured;
}
void machine_alone(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(machine());
  state.counters["Gflop/s"] = 1e-9 * machine().flops;
  state.counters["memory_GB/s"] = 1e-9 * machine().memory;
  state.counters["cache_GB/s"] = 1e-9 * machine().cache;
}
BENCHMARK(machine_alone)->Iterations(1);

// Arithmetic and traffic that a kernel cannot do without, for the whole piece, and the least time that these
// take here, one beside the other. `of_bound`: that time over what the kernel takes.
struct Work {
  double flops, bytes;
};
void against_machine(benchmark::State& state, int n, const Work& work) {
  const double loops = static_cast<double>(n) * n;
  // What is gone through once in a kernel comes from the second-level cache if it all fits half a megabyte.
  const double reading = work.bytes < 5e5 ? machine().cache : machine().memory;
  const double least = std::max(work.flops / machine().flops, work.bytes / reading);
  state.counters["kflop_per_loop"] = 1e-3 * work.flops / loops;
  state.counters["kB_per_loop"] = 1e-3 * work.bytes / loops;
  state.counters["bound_ns_per_loop"] = 1e9 * least / loops;
  state.counters["of_bound"] = benchmark::Counter(least, benchmark::Counter::kIsIterationInvariantRate);
}

// Processor time per loop of the piece.
void per_loop(benchmark::State& state, int n) {
  state.counters["per_loop"] =
      benchmark::Counter(static_cast<double>(n) * n,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Flops of one segment, as written in energies/: to the middle (33); at each of four Gauss points p', p'' and
// their products (33), stretch (34), bend (33), what the law adds (305); the dyad of stretch (108); gradient,
// Hessian and border to control points (33 + 462 + 99); fractions (22), border and corner by v, a, j (234).
// And ten blocks, the border and the gradient are added to what is there.
constexpr double segment_flops =
    33 + 4 * (33 + 34 + 33 + 305) + 108 + (33 + 462 + 99) + 22 + 234 + (10 * 9 + 4 * 9 + 4 * 3);
// Matrix, border and gradient are written once (and fetched before that), places and indices are read.
double matrix_bytes(const BlockMatrix& m) {
  return 2 * static_cast<double>(m.column.size()) * sizeof(Block) +
         static_cast<double>(m.column.size()) * sizeof(std::int32_t) +
         static_cast<double>(m.rows()) * (2 * sizeof(Block) + 4 * sizeof(Vec3));
}

// Contact as it is in this state: distances of samples whose row is near the other segment, pairs of samples
// in the law, segment pairs that are folded into control points.
Work contact_work(const Kernels& k) {
  // In the law: its power by series (70), values (20), force and Hessian (45), sums at both samples (18) and
  // by the weights of b (48). A sample that is touched: its force (20) and Hessian (198) by the weights; of a
  // besides what it has with b (192). A pair of segments: border (1000) and corner (144), 36 blocks.
  constexpr double distance = 8, box = 12, in_law = 70 + 20 + 45 + 18 + 48, fold = 218, with_b = 192,
                   active_blocks = 1000 + 144 + 36 * 9;
  const auto samples = static_cast<std::size_t>(k.model.samples);
  const SamplePlaces& p = k.assembly.places();
  Work work{0, 0};
  for (const SegmentPair& pair : k.assembly.pairs()) {
    if (!(pair.distance2 < 1)) continue;
    work.flops += active_blocks;
    for (std::size_t i = 0; i < samples; ++i) {
      const std::size_t a = static_cast<std::size_t>(pair.a) * samples + i;
      work.flops += box;
      if (squared_distance(p.x[a], p.y[a], p.z[a], p.boxes[static_cast<std::size_t>(pair.b)]) >= 1) continue;
      work.flops += distance * static_cast<double>(samples);
      bool touched = false;
      for (std::size_t j = 0; j < samples; ++j) {
        const std::size_t b = static_cast<std::size_t>(pair.b) * samples + j;
        const bool excluded =
            pair.same_yarn &&
            std::abs(pair.arc_offset + (static_cast<double>(j) - static_cast<double>(i)) *
                                           k.model.yarns[0].rest_length / k.model.samples) < k.model.excluded;
        if (excluded || squared_norm(Vec3{p.x[a] - p.x[b], p.y[a] - p.y[b], p.z[a] - p.z[b]}) >= 1) continue;
        work.flops += in_law;
        touched = true;
      }
      if (touched) work.flops += 2 * fold + with_b;  // of b there are as many, or nearly
    }
  }
  return work;
}

// Pairs within a tenth of a diameter: none, so that only stretch, bend and the pattern are left.
void stretch_and_bend(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n, 0.1);
  for (auto _ : state) k.assembly.hessian(k.state, k.gradient, k.hessian);
  against_machine(state, n, {segment_flops * k.model.segments, matrix_bytes(k.hessian)});
  per_loop(state, n);
}
void stretch_bend_and_contact(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Kernels k(n);
  for (auto _ : state) k.assembly.hessian(k.state, k.gradient, k.hessian);
  against_machine(state, n,
                  {segment_flops * k.model.segments + contact_work(k).flops, matrix_bytes(k.hessian)});
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
  against_machine(state, n, {18.0 * static_cast<double>(k.hessian.column.size()), bytes});
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
