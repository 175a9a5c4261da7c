// Fabrics for the tests of mechanics: cells and pieces made from their notation, and pieces of free yarn.
#pragma once
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "geometry/fit_fabric.hpp"
#include "geometry/periodic_cell.hpp"
#include "geometry/window.hpp"
#include "machine/run_machine.hpp"
#include "mechanics/relax.hpp"
#include "notation/read_vermiculation.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {

// First geometry of `courses` (vermiculation letters) with loops of `loop_length` d. `edges`: "periodic"
// gives one cell, "held" a piece; `size` is "4 wales x 3 courses" or empty.
inline Fabric knitted(const std::string& courses, const std::string& edges, const std::string& size,
                      double loop_length = 17, double segments_per_loop = 12) {
  std::ostringstream text;
  text << ";!vermiculation-1\n;;Yarn-A: diameter=1 mm\n;;Loop-Length: " << loop_length << " mm\n"
       << (size.empty() ? "" : ";;Size: " + size + "\n") << ";;Edges: " << edges << "\n"
       << courses << "\n";
  Diagnostics diagnostics("test.verm");
  const Program program = read_vermiculation(text.str(), diagnostics);
  const KnittingRecord record = run_machine(program, diagnostics);
  const YarnGraph graph = build_yarn_graph(program, record, diagnostics);
  if (!diagnostics.ok()) {
    std::ostringstream what;
    what << diagnostics;
    throw std::runtime_error(what.str());
  }
  const GeometryOptions options = make_geometry_options(program);
  const PlacedPiece piece = place_type_points(graph, options);
  const YarnCurves curves = edges == "periodic"
                                ? cut_periodic_cell(graph, options, piece, cell_range(program))
                                : cut_window(graph, options, piece, program_window(graph, program.window));
  return fit_fabric(curves, graph, options, {segments_per_loop});
}

// A free yarn whose control points are along(0) .. along(count - 1).
inline FabricYarn free_yarn(int count, double rest_length, const std::function<Vec3(int)>& along) {
  FabricYarn yarn;
  yarn.segment_rest_length = rest_length;
  for (int i = 0; i < count; ++i) yarn.control_points.push_back(along(i));
  yarn.held.assign(static_cast<std::size_t>(count), 0);
  return yarn;
}

inline Fabric fabric_of(std::vector<FabricYarn> yarns) {
  Fabric fabric;
  fabric.yarns = std::move(yarns);
  fabric.width = fabric.height = 10;
  return fabric;
}

// Holds the first and last `count` control points: place and direction of both ends.
inline void hold_ends(FabricYarn& yarn, int count) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    yarn.held[k] = yarn.held[yarn.held.size() - 1 - k] = 1;
}

inline RelaxOptions frictionless() {
  RelaxOptions options;
  options.model.material = {.stretch_stiffness = 3000,
                            .bend_stiffness = 1,
                            .contact = {.outer = 1, .core = 0.5, .stiffness = 400, .exponent = 2.4},
                            .friction = 0};
  return options;
}

// No plates, no grow-in, fixed measures: a yarn alone in space.
inline RelaxOptions yarn_alone(double tolerance) {
  RelaxOptions options = frictionless();
  options.model.free = {false, false, false};
  options.grow_in = false;
  options.plate_room = -1;
  options.tolerance = tolerance;
  return options;
}

// frictionless() with friction and with forces in newtons.
inline RelaxOptions with_friction(double friction, double bend_stiffness_N_m2) {
  RelaxOptions options = frictionless();
  options.model.material.friction = friction;
  options.model.material.reference_bend_N_m2 = bend_stiffness_N_m2;
  return options;
}

}  // namespace loopwright
