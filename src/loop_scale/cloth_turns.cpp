#include "loop_scale/cloth_turns.hpp"

#include "loop_scale/tube_walls.hpp"

namespace loopwright {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// At the edges of a flat tube the map sees neighbours on one side only; in space the course goes on in the
// other wall.
void turn_edges(const YarnGraph& graph, const LoopModel& model, const std::vector<Vec3>& places,
                std::vector<Rotation>& turns) {
  const auto lower = [&](LoopId id) { return at(model.points.lower[id.position()]); };
  const std::vector<std::int8_t> walls = tube_walls(graph, rounds_of(graph, model.points));
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    const Loop& loop = graph.loops[k];
    const std::vector<LoopId>& yarn = graph.yarns[loop.yarn.position()].loops;
    const std::size_t order = static_cast<std::size_t>(loop.order);
    if (order == 0 || order + 1 >= yarn.size() || loop.parents.empty()) continue;
    const LoopId before = yarn[order - 1], after = yarn[order + 1];
    if (walls[k] * walls[before.position()] >= 0 && walls[k] * walls[after.position()] >= 0) continue;
    Vec3 course = places[lower(after)] - places[lower(before)];
    if (loop.direction == Direction::left) course = -course;
    const Vec3 wale = places[at(model.points.upper[k])] - places[lower(loop.parents.front())];
    turns[k] = mean_rotation({course, wale, {}}, turns[k]);
  }
}

}  // namespace

std::vector<Rotation> cloth_turns(const YarnGraph& graph, const LoopModel& model,
                                  const std::vector<Vec3>& places) {
  std::vector<std::uint8_t> known;
  std::vector<Rotation> turns = model.map.frames(places, &known);
  turn_edges(graph, model, places, turns);
  const auto add = [](Rotation& sum, const Rotation& turn) {
    sum.x += turn.x, sum.y += turn.y, sum.z += turn.z;
  };
  const Rotation nothing{{}, {}, {}};
  for (bool going_on = true; going_on;) {
    going_on = false;
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < graph.loops.size(); ++k) {
      if (known[k] != 0) continue;
      Rotation sum = nothing;
      int count = 0;
      const auto take = [&](LoopId id) {
        if (known[id.position()] == 0) return;
        add(sum, turns[id.position()]);
        ++count;
      };
      const Loop& loop = graph.loops[k];
      for (const std::vector<LoopId>* list : {&loop.parents, &loop.children})
        for (const LoopId id : *list) take(id);
      const std::vector<LoopId>& yarn = graph.yarns[loop.yarn.position()].loops;
      for (const int other : {loop.order - 1, loop.order + 1})
        if (count == 0 && other >= 0 && other < static_cast<int>(yarn.size()) &&
            graph.loop(yarn[static_cast<std::size_t>(other)]).direction == loop.direction)
          take(yarn[static_cast<std::size_t>(other)]);
      if (count == 0) continue;
      turns[k] = mean_rotation(sum, turns[k]);
      found.push_back(k);
    }
    for (const std::size_t k : found) known[k] = 1, going_on = true;
  }
  std::vector<Rotation> at_points;
  for (const BindingPoint& point : model.points.points) {
    const std::vector<LoopId>& loops = point.lower_of.empty() ? point.upper_of : point.lower_of;
    Rotation sum = nothing;
    for (const LoopId id : loops) add(sum, turns[id.position()]);
    at_points.push_back(mean_rotation(sum, turns[loops.front().position()]));
  }
  return at_points;
}

}  // namespace loopwright
