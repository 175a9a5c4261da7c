#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "experiments/curl.hpp"
#include "mechanics/assembly.hpp"

namespace loopwright {
namespace {

// `wales` x `courses` repeats of a cell as a piece with cut ends.
Fabric patch_of(const Fabric& cell, int wales, int courses) {
  Fabric patch;
  patch.diameter_mm = cell.diameter_mm;
  patch.width = wales * cell.width, patch.height = courses * cell.height;
  for (int n = 0; n < courses; ++n)
    for (const FabricYarn& yarn : cell.yarns) {
      FabricYarn piece = yarn;
      piece.periodic = false;
      piece.shift = {0, 0};
      piece.held.clear();
      piece.control_points.clear();
      const Vec3 from = cell.lattice(yarn.shift[0] > 0 ? 0 : wales, n);
      const int points = wales * static_cast<int>(yarn.control_points.size()) + 3;
      for (int i = 0; i < points; ++i) piece.control_points.push_back(control_point(cell, yarn, i) + from);
      patch.yarns.push_back(std::move(piece));
    }
  return patch;
}

// dE/dkappa of a patch along its courses and its wales.
std::array<double, 2> slopes(const Fabric& patch, const ModelOptions& options) {
  ModelOptions loose = options;
  loose.material.friction = 0;
  loose.plates = {};
  loose.point_loads.clear();
  loose.free = {false, false, false};
  const YarnModel model = build_yarn_model(patch, loose);
  const YarnState state = build_yarn_state(patch);
  Assembly assembly(model);
  Unknowns gradient;
  BlockMatrix hessian;
  assembly.update_pairs(state, 1.01 * model.contact.outer);
  assembly.hessian(state, gradient, hessian);
  std::array<double, 2> slope{};
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const Vec3 &p = state.nodes[i], &g = gradient.u[i];
    slope[0] += -p.x * p.z * g.x + 0.5 * p.x * p.x * g.z;
    slope[1] += -p.y * p.z * g.y + 0.5 * p.y * p.y * g.z;
  }
  return slope;
}

}  // namespace

CurlMoment curl_moment(const Fabric& cell, const ModelOptions& options) {
  if (!cell.periodic) throw std::invalid_argument("curl moments are those of a periodic cell");
  for (const FabricYarn& yarn : cell.yarns)
    if (!yarn.periodic || std::abs(yarn.shift[0]) != 1 || yarn.shift[1] != 0)
      throw std::invalid_argument("curl moments need yarns that close after one repeat along their course");
  // Patches so large that what touches never reaches over more than one of their edges' neighbours.
  constexpr double reach = 12;  // d: two loops of slack yarn
  const int wales = 2 + static_cast<int>(std::ceil(reach / cell.width)),
            courses = 2 + static_cast<int>(std::ceil(reach / cell.height));
  std::array<double, 2> cell_slope{};
  for (const int less_wales : {0, 1})
    for (const int less_courses : {0, 1}) {
      const std::array<double, 2> one =
          slopes(patch_of(cell, wales - less_wales, courses - less_courses), options);
      const double sign = less_wales == less_courses ? 1 : -1;
      for (std::size_t k = 0; k < 2; ++k) cell_slope[k] += sign * one[k];
    }
  const double area = cell.width * cell.height;
  return {cell_slope[0] / area, cell_slope[1] / area};
}

}  // namespace loopwright
