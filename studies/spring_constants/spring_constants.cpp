// Spring constants of the loop-scale model from the yarn-scale model: how the energy of a relaxed
// frictionless cell changes with its width and height, and where its binding points lie. Printed without
// dimension, so that they serve any yarn of about these ratios: lengths over the loop length l, stiffness
// times l^3 over B (bend stiffness of the yarn). src/loop_scale/spring_constants.cpp holds the table.
//
//   pulled by 10 % in one direction, free in the other:  E - E0 = 1/2 K (0.1 w)^2 per loop,  and how much the
//   other spacing gives way;  w: wale spacing, c: course spacing
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "mechanics/relax.hpp"
#include "reference_cell.hpp"

namespace loopwright {
namespace {

struct Structure {
  const char *name, *courses;
};
constexpr std::array<Structure, 3> structures{{{"plain", "g"}, {"rib", "ge"}, {"garter", "g\ne"}}};

RelaxOptions options_of(bool free) {
  RelaxOptions options;
  options.model.material = {3000, 1, {1, 0.5, 400, 2.4}, 0};
  options.model.free = {free, free, false};
  options.grow_in = false;
  return options;
}

Fabric stretched(Fabric fabric, double x, double y) {
  fabric.width *= 1 + x;
  fabric.height *= 1 + y;
  for (FabricYarn& yarn : fabric.yarns)
    for (Vec3& p : yarn.control_points) p = {p.x * (1 + x), p.y * (1 + y), p.z};
  return fabric;
}

// Binding point O of a loop: the middle of its two feet, which lie at 0.255 of the way from the middle of the
// sinker to the top of the head in the loop of the first paper.
Vec3 lower_point(const Fabric& fabric, const LoopSpan& span) {
  const FabricYarn& yarn = fabric.yarns[static_cast<std::size_t>(span.yarn)];
  constexpr double share = 0.255;
  return (position(fabric, yarn, span.begin + share * (span.apex - span.begin)) +
          position(fabric, yarn, span.end - share * (span.end - span.apex))) /
         2;
}

void print_row(const Structure& structure) {
  RelaxOptions grow = options_of(false);
  grow.grow_in = true;
  grow.tolerance = 0.05;
  const RelaxResult rest =
      relax(relax(reference_cell(structure.name, structure.courses, 24), grow).fabric, options_of(true));
  const Fabric& cell = rest.fabric;
  const double loops = static_cast<double>(cell.loops.size());
  double l = 0;
  for (const FabricYarn& yarn : cell.yarns) l += arc_length(cell, yarn) / loops;
  const double w = cell.width / cell.wales, c = cell.height / cell.courses;

  // Secant stiffness at `strain`: pulled in one direction, free in the other.
  constexpr double strain = 0.1;
  const double scale = l * l * l, before = rest.energy.total() / loops;
  std::printf("%-7s w/l %.4f  c/l %.4f", structure.name, w / l, c / l);
  for (const bool weft : {true, false}) {
    RelaxOptions pull = options_of(true);
    (weft ? pull.model.free.width : pull.model.free.height) = false;
    const RelaxResult one = relax(stretched(cell, weft ? strain : 0, weft ? 0 : strain), pull);
    const double way = strain * (weft ? w : c);
    const double across = weft ? one.fabric.height / cell.courses - c : one.fabric.width / cell.wales - w;
    std::printf("  K_%s l^3/B %8.1f  %s %7.4f%s", weft ? "weft" : "warp",
                2 * (one.energy.total() / loops - before) / (way * way) * scale, weft ? "dc/dw" : "dw/dc",
                across / way, one.converged ? "" : " (not converged)");
  }
  std::printf("\n");
  for (const LoopSpan& span : cell.loops) {
    const Vec3 o = lower_point(cell, span) / l;
    std::printf("        loop %d side %+d  O/l %8.4f %8.4f %8.4f\n", span.loop.value,
                static_cast<int>(span.side), o.x, o.y, o.z);
  }
}

}  // namespace
}  // namespace loopwright

int main() {
  std::printf("frictionless cells, l/d 17, EA d^2/B 3000, 24 points per loop\n");
  for (const loopwright::Structure& structure : loopwright::structures) loopwright::print_row(structure);
}
