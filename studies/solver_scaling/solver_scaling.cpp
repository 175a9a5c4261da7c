// How the cost of rest grows with the piece: held pieces of a notation's repeat, from their relaxed cell to
// rest and then to rest with the frame two per cent wider.
//   study_solver_scaling FILE.verm N...      pieces of N x N loops
// With REST_ONLY in the environment the frame is not pulled, with PARTS=4 in four equal parts instead of at
// once; with VERBOSE every step says how it went.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "pipeline.hpp"

namespace {

using namespace loopwright;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double peak_MiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void print_row(const char* what, std::size_t loops, const RelaxResult& r, double seconds) {
  const InterlacingCheck check = check_interlacings(r.fabric);
  std::printf("%-8s %7zu  %3d %6.1f %3d  %8.2f %7.2f  %7.0f  %s %d/%d %d\n", what, loops, r.newton_iterations,
              r.newton_iterations > 0 ? static_cast<double>(r.linear_iterations) / r.newton_iterations : 0,
              r.factorisations, seconds, 1e3 * seconds / static_cast<double>(loops), peak_MiB(),
              r.converged ? "rest" : "NOT AT REST", check.intact, check.expected, r.pass_throughs);
  std::fflush(stdout);
}

RelaxResult timed(const char* what, std::size_t loops, const Fabric& fabric, RelaxOptions& options) {
  if (std::getenv("VERBOSE"))
    options.on_progress = [](const RelaxProgress& p) {
      std::printf("  %s %d %.3e\n", p.phase.c_str(), p.newton_iterations, p.residual);
      return true;
    };
  const auto begin = std::chrono::steady_clock::now();
  RelaxResult result = relax(fabric, options);
  print_row(what, loops, result, seconds_since(begin));
  return result;
}

int run(const std::string& file, int n) {
  Diagnostics diagnostics(file);
  FabricOptions size;
  size.size_wales = size.size_courses = n;
  size.edges = Edges::held;
  const Knitting knitting = knit_with(file, size, diagnostics);
  if (!diagnostics.ok()) return 1;
  const PieceRequest request{.start_from_cell = true};
  Fabric fabric = first_geometry(knitting, request);
  RelaxOptions options = relax_options(fabric, knitting.program, request);
  std::optional<Fabric> started = start_from_relaxed_cell(knitting, request, fabric, options);
  if (!started) {
    std::printf("%s: no start from the relaxed cell\n", file.c_str());
    return 1;
  }
  fabric = std::move(*started);
  const std::size_t loops = fabric.loops.size();
  RelaxResult rest = timed("rest", loops, fabric, options);
  if (!rest.converged) return 1;
  if (std::getenv("REST_ONLY")) return 0;
  // The frame two per cent wider, all yarn carried along, at once or in equal parts.
  const char* parts_wanted = std::getenv("PARTS");
  const int parts = parts_wanted ? std::max(1, std::atoi(parts_wanted)) : 1;
  options.model.free.width = false;
  options.model.plates = rest.plates;
  const double wider = std::pow(1.02, 1.0 / parts);
  for (int part = 1; part <= parts; ++part) {
    options.history = rest.history;
    rest.fabric.width *= wider;
    for (FabricYarn& yarn : rest.fabric.yarns)
      for (Vec3& p : yarn.control_points) p.x *= wider;
    const std::string what = parts == 1 ? "+2 %" : std::to_string(part) + " of " + std::to_string(parts);
    rest = timed(what.c_str(), loops, rest.fabric, options);
    if (!rest.converged) return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: study_solver_scaling FILE.verm N...\n");
    return 2;
  }
  std::printf("%s\n            loops  Newton its/step factors  seconds ms/loop peak MiB\n", argv[1]);
  int status = 0;
  for (int k = 2; k < argc; ++k) status = std::max(status, run(argv[1], std::atoi(argv[k])));
  return status;
}
