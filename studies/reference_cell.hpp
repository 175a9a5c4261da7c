// The periodic cells that studies relax: yarn of 1 mm, loops of 17 diameters.
#pragma once
#include <stdexcept>
#include <string>

#include "geometry/fit_fabric.hpp"
#include "geometry/periodic_cell.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_vermiculation.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {

// The first geometry of a cell of these courses in vermiculation letters, with so many segments a loop.
inline Fabric reference_cell(const std::string& name, const std::string& courses, double segments) {
  const std::string text =
      ";!vermiculation-1\n;;Yarn-A: diameter=1 mm\n;;Loop-Length: 17 mm\n;;Edges: periodic\n" + courses +
      "\n";
  Diagnostics diagnostics(name);
  const Program program = read_vermiculation(text, diagnostics);
  const YarnGraph graph = build_yarn_graph(program, run_machine(program, diagnostics), diagnostics);
  if (!diagnostics.ok()) throw std::runtime_error(name + " has errors");
  const GeometryOptions options = make_geometry_options(program);
  const PlacedPiece piece = place_type_points(graph, options);
  return fit_fabric(cut_periodic_cell(graph, options, piece, cell_range(program)), graph, options,
                    {segments});
}

}  // namespace loopwright
