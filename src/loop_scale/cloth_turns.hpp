// How cloth that was moved is turned at every binding point: along its courses, along its wales, out of it.
#pragma once
#include <vector>

#include "loop_scale/loop_model.hpp"

namespace loopwright {

// `places`: by binding point, in d. By binding point: from the loops that have their feet there, else those
// that have their heads there. Loops that do not know it take it from those they are drawn through or that
// are drawn through them, else from their neighbours in the yarn.
std::vector<Rotation> cloth_turns(const YarnGraph& graph, const LoopModel& model,
                                  const std::vector<Vec3>& places);

}  // namespace loopwright
