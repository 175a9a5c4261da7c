// How fine a periodic cell must be: its measures and bend energy over control points per loop and over the
// spacing of contact samples, beside reference relaxations made with another model
// (tests/mechanics/test_periodic_cells.cpp).
#include <chrono>
#include <cstdio>
#include <sstream>
#include <string>

#include "mechanics/relax.hpp"
#include "reference_cell.hpp"

namespace loopwright {
namespace {

struct Structure {
  const char *name, *courses;
  double Kc, Kw,
      bend;  // reference at l/d = 17: loop length over spacings, bend energy times loop length over B
};
constexpr Structure structures[] = {{"plain", "g", 5.295, 4.047, 43.18},
                                    {"rib", "ge", 5.186, 7.333, 30.33},
                                    {"garter", "g\ne", 7.67, 3.580, 38.08},
                                    {"moss", "ge\neg", 6.975, 4.253, 42.88}};

// Frictionless, in two stages: the yarn grows in at fixed measures, then the measures are let go. The yarn of
// the first geometry is too long, and pulls a moss cell into a poor minimum if its measures are free from the
// start.
void print_row(const Structure& structure, double segments, double spacing) {
  RelaxOptions options;
  options.model.material = {3000, 1, {1, 0.5, 400, 2.4}, 0};
  options.model.sample_spacing = spacing;
  options.model.free = {false, false, false};
  options.tolerance = 0.05;
  const Fabric start = reference_cell(structure.name, structure.courses, segments);
  const auto begin = std::chrono::steady_clock::now();
  const RelaxResult grown = relax(start, options);
  options.model.free = {true, true, false};
  options.tolerance = 2e-4;
  options.grow_in = false;
  const RelaxResult result = relax(grown.fabric, options);
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  const Fabric& fabric = result.fabric;
  const double loops = static_cast<double>(fabric.loops.size());
  double length = 0;
  for (const FabricYarn& yarn : fabric.yarns) length += arc_length(fabric, yarn) / loops;
  const double Kc = length * fabric.courses / fabric.height, Kw = length * fabric.wales / fabric.width;
  std::printf("%6.0f  %7.2f  %6.3f  %6.3f  %6.3f  %6.2f  %5d  %5.0f%s\n", segments, spacing, Kc, Kw, Kc / Kw,
              result.energy.bend / loops * length, grown.newton_iterations + result.newton_iterations, ms,
              result.converged ? "" : "  not converged");
}

}  // namespace
}  // namespace loopwright

int main() {
  using namespace loopwright;
  for (const Structure& structure : structures) {
    std::printf("%s, l/d 17, frictionless\n points  spacing      Kc      Kw       R  E_b l/B  steps     ms\n",
                structure.name);
    std::printf("   reference     %6.3f  %6.3f  %6.3f  %6.2f\n", structure.Kc, structure.Kw,
                structure.Kc / structure.Kw, structure.bend);
    for (const double segments : {8, 10, 12, 16, 24, 32, 48}) print_row(structure, segments, 0.18);
    for (const double spacing : {0.4, 0.3, 0.24, 0.12, 0.08}) print_row(structure, 24, spacing);
    std::printf("\n");
  }
}
