#include "loop_scale/layout_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "loop_scale/cloth_turns.hpp"
#include "loop_scale/metric_start.hpp"
#include "loop_scale/tube_walls.hpp"

namespace loopwright {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// How far a tube is open at every binding point: not at all where the cloth is flat (its yarn goes to and fro
// between the walls, or is knitted before or after the tube), fully from `reach` courses on.
std::vector<double> openness_of(const YarnGraph& graph, const LoopModel& model, double reach) {
  std::vector<std::vector<std::size_t>> next(model.wall.size());
  for (std::size_t k = 0; k < graph.loops.size(); ++k) {
    const std::size_t a = at(model.points.lower[k]), b = at(model.points.upper[k]);
    next[a].push_back(b), next[b].push_back(a);
  }
  std::vector<double> courses(model.wall.size(), -1);
  std::vector<std::size_t> reached;
  for (std::size_t i = 0; i < courses.size(); ++i)
    if (model.wall[i] == 0) courses[i] = 0, reached.push_back(i);
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const std::size_t i : next[reached[k]])
      if (courses[i] < 0) courses[i] = courses[reached[k]] + 1, reached.push_back(i);
  for (double& course : courses) {
    const double share = course < 0 ? 1 : std::min(1.0, course / reach);
    course = share * share * (3 - 2 * share);
  }
  return courses;
}

// A flat tube laid round a cylinder of its width: the front wall in front, the rear one behind. Toward flat
// cloth it closes, over as many courses as it is wide. Where less than half the piece is knitted in rounds it
// is no tube: empty.
std::vector<Vec3> round_start(const YarnGraph& graph, const LoopModel& model) {
  std::size_t in_rounds = 0;
  for (const Round& round : rounds_of(graph, model.points))
    in_rounds += round.one.size() + round.other.size();
  if (2 * in_rounds < graph.loops.size()) return {};
  double left = model.start[0].x, right = left;
  for (const Vec3& p : model.start) left = std::min(left, p.x), right = std::max(right, p.x);
  const double wide = right - left + model.geometry.wale_pitch, radius = wide / std::numbers::pi;
  const std::vector<double> open = openness_of(graph, model, wide / model.geometry.course_pitch);
  std::vector<Vec3> places = model.start;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (model.wall[i] == 0) continue;  // flat cloth before or after the tube
    const double share = (places[i].x - left + model.geometry.wale_pitch / 2) / wide;
    const double angle = std::numbers::pi * (1 - share);
    const Vec3 round{(left + right) / 2 + radius * std::cos(angle), places[i].y,
                     model.wall[i] * radius * std::sin(angle)};
    places[i] = places[i] * (1 - open[i]) + round * open[i];
  }
  return places;
}

// Whether the flat start tears many loops far from what they are joined to: whole stretches of needles were
// moved against the rows before, as in decreases all along the rows.
bool is_torn(const MassSpringNet& net, const std::vector<Vec3>& start) {
  constexpr double far = 2, few = 0.05;
  double torn = 0, warps = 0;
  for (const Spring& spring : net.springs) {
    if (spring.kind != SpringKind::warp) continue;
    warps += 1;
    if (distance(start[at(spring.a)], start[at(spring.b)]) > far * norm(spring.rest)) torn += 1;
  }
  return torn > few * warps;
}

// Whether stitches lie on both sides of the cloth.
bool is_folded(const MassSpringNet& net) {
  return std::any_of(net.springs.begin(), net.springs.end(), [](const Spring& s) { return s.rest.z != 0; });
}

// Such a piece laid out by the lengths of its springs instead of its needles, facing as the flat one does on
// the whole. Empty where that cannot be.
std::vector<Vec3> metric_places(const YarnGraph& graph, const LoopModel& model) {
  std::vector<Vec3> places = metric_start(model.net);
  if (places.empty()) return places;
  Rotation whole{{}, {}, {}};
  for (const Rotation& turn : cloth_turns(graph, model, places))
    whole.x += turn.x, whole.y += turn.y, whole.z += turn.z;
  whole = mean_rotation(whole, {});
  for (Vec3& place : places) place = whole.transposed(place);
  return places;
}

}  // namespace

FoldedSheet folded_sheet(const YarnGraph& graph, const LoopModel& model, const LayoutStart& start,
                         const SettleOptions& settling) {
  MassSpringNet sheet = model.net;
  for (Spring& spring : sheet.springs) {
    const Vec3 along{spring.rest.x, spring.rest.y, 0};
    if (norm(along) > 0.1 * norm(spring.rest)) spring.rest = along;
  }
  sheet.damping *= start.damping;
  NetState state = state_at_rest(start.places);
  NetKernel kernel(sheet);
  FoldedSheet result{{}, settle(kernel, sheet, state, settling)};
  std::vector<Vec3>& places = result.places;
  places = positions_of(state);
  const std::vector<Rotation> turns = cloth_turns(graph, model, places);
  double depth[3] = {0, 0, 0}, count[3] = {0, 0, 0};  // mean z of a wall
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t w = static_cast<std::size_t>(model.wall[i] + 1);
    depth[w] += model.start[i].z;
    count[w] += 1;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t w = static_cast<std::size_t>(model.wall[i] + 1);
    places[i] += turns[i].z * (model.start[i].z - depth[w] / count[w]);
  }
  return result;
}

LayoutStart layout_start(const YarnGraph& graph, const LoopModel& model) {
  LayoutStart start;
  start.places = round_start(graph, model);
  if (start.places.empty() && is_torn(model.net, model.start)) start.places = metric_places(graph, model);
  if (start.places.empty() && is_folded(model.net)) {
    start.places = model.start;
    for (std::size_t i = 0; i < start.places.size(); ++i)
      if (model.wall[i] == 0) start.places[i].z = 0;
    // slowly: what overshoots in a plane passes through itself
    start.damping = 5;
  }
  return start;
}

}  // namespace loopwright
