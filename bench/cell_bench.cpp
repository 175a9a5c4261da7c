// Periodic cells of up to nine loops to rest, on one thread with the defaults of `relax`: cold, from the
// first geometry of their notation, and near, from rest with 3 % more or less yarn in every loop. The
// counters say what came out, so that a change of speed that is a change of the state is seen.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>
#include <string>

#include "base/parallel.hpp"
#include "pipeline.hpp"

namespace loopwright {
namespace {

struct Cell {
  Fabric first;
  RelaxOptions options;
};

Cell cell_of(const std::string& structure, bool frictionless) {
  const std::filesystem::path file =
      std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples/structures" / (structure + ".verm");
  Diagnostics diagnostics(file);
  PieceRequest request;
  request.periodic = true;
  if (frictionless) request.friction = 0;
  const Knitting knitting = knit(file, request, diagnostics);
  Cell cell;
  cell.first = first_geometry(knitting, request);
  cell.options = relax_options(cell.first, knitting.program, request);
  return cell;
}

// The cell at rest with `share` of its yarn: a start for a run that has friction's history.
Cell near_rest(const Cell& cold, double share) {
  RelaxResult rest = relax(cold.first, cold.options);
  Cell cell{std::move(rest.fabric), cold.options};
  for (FabricYarn& yarn : cell.first.yarns) yarn.segment_rest_length *= share;
  cell.options.grow_in = false;
  cell.options.history = std::move(rest.history);
  return cell;
}

void to_rest(benchmark::State& state, const std::string& structure, bool frictionless, double share) {
  set_thread_count(1);
  const Cell cold = cell_of(structure, frictionless);
  const Cell cell = share == 0 ? cold : near_rest(cold, share);
  RelaxResult rest;
  for (auto _ : state) rest = relax(cell.first, cell.options);
  set_thread_count(0);
  state.counters["loops"] = static_cast<double>(cell.first.loops.size());
  state.counters["newton"] = rest.newton_iterations;
  state.counters["factors"] = rest.factorisations;
  state.counters["width"] = rest.fabric.width;
  state.counters["height"] = rest.fabric.height;
  if (!rest.converged || rest.pass_throughs > 0) state.SkipWithError(rest.message.c_str());
}

// Those of the library with at most nine loops in a repeat.
const int registered = [] {
  for (const char* structure :
       {"plain", "tube", "rib", "garter", "half_milano", "milano", "moss", "rib_2x2", "interlock",
        "full_cardigan", "half_cardigan", "cross_tuck", "spacer", "lacoste", "ponte_di_roma",
        "french_double_pique", "swiss_double_pique", "racked_rib", "derby_rib"})
    for (const bool frictionless : {false, true})
      for (const auto& [start, share] :
           std::map<std::string, double>{{"cold", 0}, {"near_longer", 1.03}, {"near_shorter", 0.97}})
        benchmark::RegisterBenchmark(
            ("cell_" + start + (frictionless ? "_frictionless/" : "/") + structure).c_str(),
            [=](benchmark::State& state) { to_rest(state, structure, frictionless, share); })
            ->Unit(benchmark::kMillisecond)
            ->MinTime(0.05);
  return 0;
}();

}  // namespace
}  // namespace loopwright
