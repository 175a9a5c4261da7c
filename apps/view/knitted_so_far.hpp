// A piece on its way: what of its yarns is knitted when the machine has come to an instruction. Loops have
// the places that they have in the whole piece.
#pragma once
#include <optional>
#include <vector>

#include "geometry/fabric.hpp"
#include "outputs/yarn_renderer.hpp"
#include "topology/yarn_graph.hpp"

namespace loopwright {

// By yarn of the fabric: the parameter up to which loops that `instruction` or an earlier one formed take it;
// 0 where there are none yet.
std::vector<double> fed_until(const Fabric& fabric, const YarnGraph& graph, int instruction);

// The triangles of the scene up to there; nothing, where `fed` is empty: all. `every`: the scene was made of
// every k-th control point.
std::optional<std::vector<YarnRenderer::Run>> runs_until(const YarnScene& scene, const Fabric& fabric,
                                                         const std::vector<double>& fed, int every = 1);

}  // namespace loopwright
