// Cells of any loop length and yarn diameter, brought to rest, and what is read off them.
#pragma once
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/fit_fabric.hpp"
#include "geometry/periodic_cell.hpp"
#include "machine/run_machine.hpp"
#include "mechanics/relax.hpp"
#include "notation/read_vermiculation.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {

// The first geometry of a cell; lengths in mm.
inline Fabric cell_of(const std::string& courses, double loop_length, double diameter, double segments) {
  std::ostringstream text;
  text << ";!vermiculation-1\n;;Yarn-A: diameter=" << diameter << " mm\n;;Loop-Length: " << loop_length
       << " mm\n;;Edges: periodic\n"
       << courses << "\n";
  Diagnostics diagnostics("cell");
  const Program program = read_vermiculation(text.str(), diagnostics);
  const YarnGraph graph = build_yarn_graph(program, run_machine(program, diagnostics), diagnostics);
  if (!diagnostics.ok()) throw std::runtime_error("the cell has errors");
  const GeometryOptions options = make_geometry_options(program);
  const PlacedPiece piece = place_type_points(graph, options);
  return fit_fabric(cut_periodic_cell(graph, options, piece, cell_range(program)), graph, options,
                    {segments});
}

// The yarn of the reference relaxations, with B = 1e-8 N m^2.
inline RelaxOptions hard_yarn(double friction) {
  RelaxOptions options;
  options.model.material = {3000, 1, {1, 0.5, 400, 2.4}, friction, 1e-8};
  options.model.free = {true, true, false};
  return options;
}

// In two stages, as in study_cells: grown in at fixed measures, then let go. Where yarn does not fit into the
// measures that it is drawn with, it grows in free.
inline RelaxResult rested(const Fabric& start, RelaxOptions options) {
  RelaxOptions grow = options;
  grow.model.free = {false, false, false};
  grow.tolerance = 0.05;
  grow.set = 0;  // yarn is set where it comes to rest
  const RelaxResult grown = relax(start, grow);
  options.grow_in = !grown.converged;
  return relax(grown.converged ? grown.fabric : start, options);
}

struct Spacing {
  double loop_length = 0;  // d, as it is
  double Kc = 0, Kw = 0;   // loop length over course and wale spacing
};

inline Spacing spacing(const Fabric& fabric) {
  Spacing s;
  for (const FabricYarn& yarn : fabric.yarns)
    s.loop_length += arc_length(fabric, yarn) / static_cast<double>(fabric.loops.size());
  s.Kc = s.loop_length * fabric.courses / fabric.height;
  s.Kw = s.loop_length * fabric.wales / fabric.width;
  return s;
}

// Width and height to these multiples of what they are; the yarn goes along.
inline void rescale(Fabric& fabric, double wide, double high) {
  for (FabricYarn& yarn : fabric.yarns)
    for (Vec3& p : yarn.control_points) p.x *= wide, p.y *= high;
  fabric.width *= wide;
  fabric.height *= high;
}

// First to `from` of the width, then width and height in turn pulled and pushed by 10 % to 1 %; then free.
inline RelaxResult shaken(const RelaxResult& start, RelaxOptions options, double from) {
  RelaxResult at = start;
  options.grow_in = false;
  const auto go = [&](double wide, double high) {
    rescale(at.fabric, wide, high);
    options.history = at.history;
    options.model.free = {wide == 1, high == 1, false};
    at = relax(at.fabric, options);
  };
  go(from, 1);
  for (double by = 0.1; by > 0.009; by *= 0.8) {
    go(1 + by, 1), go(1 / (1 + by), 1);
    go(1, 1 + by), go(1, 1 / (1 + by));
  }
  go(1, 1);
  return at;
}

// A curve that rises (nearly) everywhere, read off by straight lines; NaN beyond its ends.
struct Curve {
  std::vector<double> strain, stress, across;

  void add(double e, double s, double a) {
    strain.push_back(e);
    stress.push_back(s);
    across.push_back(a);
  }
  double at(const std::vector<double>& x, const std::vector<double>& y, double wanted) const {
    for (std::size_t k = 1; k < x.size(); ++k)
      if (x[k] >= wanted && x[k - 1] <= wanted)
        return y[k - 1] + (y[k] - y[k - 1]) * (wanted - x[k - 1]) / (x[k] - x[k - 1]);
    return std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace loopwright
