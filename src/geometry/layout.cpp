#include "geometry/layout.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "base/stop.hpp"
#include "geometry/held_events.hpp"

namespace loopwright {
namespace {

// Weights of the least-squares rows. Yarn decides; what lies over each other without being drawn through each
// other only settles what yarn leaves open (e.g. the level of one rib of an interlock against the other).
constexpr double yarn_weight = 1, covered_tuck_weight = 0.3, passed_weight = 0.15, opposite_weight = 0.03;
// A held loop grows by this share of a course for every float or tuck that must find room along its legs.
constexpr double growth_per_event = 0.45, most_growth = 2.5;
constexpr double tuck_height = 0.6;  // of a course, where nothing is held below it
// A loop whose head was moved to another wale may take any direction; the wale there says how high it
// reaches.
constexpr double moved_weight = 0.2;
constexpr double anchor_weight = 1e-9;

class Nodes {  // union-find: lower nodes 0 .. n-1, upper nodes n .. 2n-1
 public:
  explicit Nodes(std::size_t loops) : parent_(2 * loops), loops_(loops) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t lower(LoopId id) { return find(id.position()); }
  std::size_t upper(LoopId id) { return find(loops_ + id.position()); }
  void merge(std::size_t a, std::size_t b) {
    parent_[std::max(find(a), find(b))] = std::min(find(a), find(b));
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

 private:
  std::vector<std::size_t> parent_;
  std::size_t loops_;
};

// Rows sum_k coefficient_k y_k = target, weighted; solved by normal equations.
class LeastSquares {
 public:
  explicit LeastSquares(std::size_t unknowns)
      : right_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns))) {}

  struct Term {
    std::size_t unknown;
    double coefficient;
  };
  void add_row(std::initializer_list<Term> terms, double target, double weight) {
    for (const Term& a : terms) {
      for (const Term& b : terms)
        entries_.emplace_back(static_cast<int>(a.unknown), static_cast<int>(b.unknown),
                              weight * a.coefficient * b.coefficient);
      right_[static_cast<Eigen::Index>(a.unknown)] += weight * a.coefficient * target;
    }
  }
  Eigen::VectorXd solve() const {
    Eigen::SparseMatrix<double> matrix(right_.size(), right_.size());
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    return factors.solve(right_);
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd right_;
};

Nodes binding_nodes(const YarnGraph& graph) {
  Nodes nodes(graph.loops.size());
  for (std::size_t i = 0; i < graph.loops.size(); ++i)
    for (const LoopId parent : graph.loops[i].parents)
      nodes.merge(nodes.lower(LoopId(i)), nodes.upper(parent));
  for (const std::vector<LoopId>& stack : head_stacks(graph))
    for (const LoopId id : stack) nodes.merge(nodes.upper(stack.front()), nodes.upper(id));
  return nodes;
}

double warp_rest(const Loop& loop, std::size_t events, double course_pitch) {
  if (loop.kind == LoopKind::tuck) return tuck_height * course_pitch;
  return course_pitch * (1 + std::min(most_growth, growth_per_event * static_cast<double>(events)));
}

// By loop: the loop on the needle that faced its needle while it was made, if any.
std::vector<LoopId> facing_loops(const YarnGraph& graph) {
  std::vector<LoopId> facing(graph.loops.size());
  std::map<std::pair<bool, int>, LoopId> last;  // by front bed and half slots
  const auto key = [](double slot) { return static_cast<int>(std::lround(2 * slot)); };
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const Loop& loop = graph.loops[i];
    const bool front = is_front(loop.bed);
    for (const int half : {-1, 0, 1}) {
      const auto found = last.find({!front, key(loop.slot) + half});
      if (found == last.end()) continue;
      const Loop& other = graph.loop(found->second);
      if (is_held_at(other, loop.instruction) && facing[i] < found->second) facing[i] = found->second;
    }
    if (is_front(loop.head_bed) == front) last[{front, key(loop.slot)}] = LoopId(i);
  }
  return facing;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::VectorXd levels(const YarnGraph& graph, const GeometryOptions& options, Nodes& nodes,
                       const HeldEvents& events) {
  LeastSquares rows(2 * graph.loops.size());
  for (std::size_t i = 0; i < 2 * graph.loops.size(); ++i) rows.add_row({{i, 1}}, 0, anchor_weight);

  std::vector<bool> covers(graph.loops.size());  // tucks with a held loop below them
  for (std::size_t i = 0; i < graph.loops.size(); ++i)
    for (const HeldEvent& event : events.of_loop[i]) {
      const LoopId held(i);
      if (!event.tuck.valid()) continue;
      covers[event.tuck.position()] = true;
      const double share = events.share_of_tuck(held, event.tuck);
      rows.add_row(
          {{nodes.lower(event.tuck), 1}, {nodes.lower(held), share - 1}, {nodes.upper(held), -share}}, 0,
          passed_weight);
    }
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const LoopId id(i);
    const double lean = graph.loops[i].head_slot - graph.loops[i].slot;
    rows.add_row({{nodes.upper(id), 1}, {nodes.lower(id), -1}},
                 warp_rest(graph.loops[i], events.of_loop[i].size(), options.course_pitch),
                 covers[i]              ? covered_tuck_weight
                 : std::abs(lean) > 0.6 ? moved_weight
                                        : yarn_weight);
  }
  const std::vector<LoopId> facing = facing_loops(graph);
  std::vector<double> faced_by(graph.loops.size()), before(graph.loops.size());
  for (const LoopId held : facing)
    if (held.valid()) faced_by[held.position()] += 1;
  for (std::size_t i = 0; i < facing.size(); ++i) {
    if (!facing[i].valid()) continue;
    const std::size_t held = facing[i].position();
    const double share = (before[held] += 1) / (faced_by[held] + 1);
    rows.add_row(
        {{nodes.lower(LoopId(i)), 1}, {nodes.lower(facing[i]), share - 1}, {nodes.upper(facing[i]), -share}},
        0, opposite_weight);
  }
  for (std::size_t y = 0; y < graph.yarns.size(); ++y) {
    const GraphYarn& yarn = graph.yarns[y];
    for (std::size_t k = 0; k < yarn.floats.size(); ++k) {
      const Float& yarn_float = yarn.floats[k];
      if (!yarn_float.from.valid() || !yarn_float.to.valid()) continue;
      const Loop& from = graph.loop(yarn_float.from);
      const Loop& to = graph.loop(yarn_float.to);
      const double span = to.slot - from.slot;
      const bool turns = from.direction != to.direction;  // the next course: no reason to lie at one level
      const bool waited = rows_waited(graph, yarn_float.from, yarn_float.to) > 0;  // nor here
      if (!turns && !waited)
        rows.add_row({{nodes.lower(yarn_float.to), 1}, {nodes.lower(yarn_float.from), -1}}, 0,
                     yarn_weight / std::max(1.0, std::abs(span)));
      for (const PassedLoop& passed : yarn_float.passed) {
        double along = std::abs(span) < 1e-9 ? 0.5 : std::clamp((passed.slot - from.slot) / span, 0.0, 1.0);
        if (waited) along = is_held_at(graph.loop(passed.loop), to.instruction) ? 1 : 0;
        const double share = events.share_of_float(passed.loop, static_cast<int>(y), static_cast<int>(k));
        rows.add_row({{nodes.lower(yarn_float.from), 1 - along},
                      {nodes.lower(yarn_float.to), along},
                      {nodes.lower(passed.loop), share - 1},
                      {nodes.upper(passed.loop), -share}},
                     0, passed_weight);
      }
    }
  }
  return rows.solve();
}

void mark_faced(const YarnGraph& graph, Layout& layout) {
  layout.faced.assign(graph.loops.size(), 0);
  layout.overlaid.assign(graph.loops.size(), 0);
  const std::vector<LoopId> facing = facing_loops(graph);
  for (std::size_t i = 0; i < facing.size(); ++i) {
    if (!facing[i].valid()) continue;
    const std::size_t other = facing[i].position();
    layout.faced[i] = layout.faced[other] = 1;
    if (std::abs(graph.loops[i].slot - graph.loops[other].slot) < 0.25)
      layout.overlaid[i] = layout.overlaid[other] = 1;
  }
}

// z of every node: the mean of the loops that have their feet there, by the bed that they were formed on; a
// head that nothing was drawn through stays at its own bed.
std::vector<double> node_heights(const YarnGraph& graph, const GeometryOptions& options, Nodes& nodes,
                                 const std::vector<std::uint8_t>& faced) {
  std::vector<double> sum(2 * graph.loops.size()), count(sum.size());
  std::vector<double> offset;
  for (const std::uint8_t over : faced)
    offset.push_back(over != 0 ? options.overlap_offset : options.two_bed_offset);
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const std::size_t node = nodes.lower(LoopId(i));
    sum[node] += (is_front(graph.loops[i].bed) ? 1 : -1) * offset[i] * options.shape_radius();
    count[node] += 1;
  }
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const std::size_t node = nodes.upper(LoopId(i));
    if (count[node] > 0) continue;
    sum[node] = (is_front(graph.loops[i].head_bed) ? 1 : -1) * offset[i] * options.shape_radius();
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (count[i] > 0) sum[i] /= count[i];
  return sum;
}

// Tucks on one needle lie below its binding point and below each other, the older the lower.
void lower_tucks(const YarnGraph& graph, const GeometryOptions& options, Layout& layout) {
  constexpr double step = 0.35;  // of a course
  for (std::vector<LoopId> stack : head_stacks(graph)) {
    std::sort(stack.begin(), stack.end(), [](LoopId a, LoopId b) { return b < a; });
    const Rotation turn = layout.upper_turn(stack.front());
    double above = turn.transposed(layout.upper[stack.front().position()]).y;
    for (const LoopId id : stack) {
      if (graph.loop(id).kind != LoopKind::tuck) continue;
      Vec3 lower = turn.transposed(layout.lower[id.position()]);
      lower.y = std::min(lower.y, above - step * options.course_pitch);
      above = lower.y;
      layout.lower[id.position()] = turn * lower;
    }
  }
}

// How large the template is at every binding point.
void fit_templates(const YarnGraph& graph, const GeometryOptions& options, Nodes& nodes, Layout& layout) {
  // A binding point with little room above or below it gets a flatter template, the same for all that meet
  // there.
  const std::size_t n = graph.loops.size();
  std::vector<double> scale(2 * n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    if (graph.loops[i].kind == LoopKind::tuck) continue;
    const Vec3 step = layout.step(LoopId(i));
    const double room = std::hypot(step.x, step.y) / (0.75 * options.course_pitch);
    for (const std::size_t node : {nodes.lower(LoopId(i)), nodes.upper(LoopId(i))})
      scale[node] = std::clamp(room, 0.3, scale[node]);
  }
  // The loops of a bind-off's chain lie flat from one wale to the next and need room between the heads there.
  constexpr double narrow = 0.7, flat = 0.3;
  std::vector<double> width(2 * n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 step = layout.step(LoopId(i));
    if (step.y >= flat * std::hypot(step.x, step.y)) continue;
    width[nodes.lower(LoopId(i))] = width[nodes.upper(LoopId(i))] = narrow;
  }
  layout.y_scale_lower.clear(), layout.y_scale_upper.clear();
  layout.x_scale_lower.clear(), layout.x_scale_upper.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t low = nodes.lower(LoopId(i)), high = nodes.upper(LoopId(i));
    layout.y_scale_lower.push_back(scale[low]);
    layout.y_scale_upper.push_back(scale[high]);
    layout.x_scale_lower.push_back(width[low]);
    layout.x_scale_upper.push_back(width[high]);
  }
}

// Where legs go through the thickness of the cloth (garter at rest, folds), a crossing that lies in the
// cloth's plane would have the leg go straight down through the foot that it crosses. Half way between the
// plane and the leg, yarns pass each other on both sides of the binding point.
constexpr double tilt_share = 0.5;

void tilt_crossings(const YarnGraph& graph, Nodes& nodes, Layout& layout) {
  const std::size_t n = graph.loops.size();
  struct Steps {
    Vec3 below, above, tucks_below;
  };
  std::vector<Steps> at_node(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const LoopId id(i);
    const Vec3 step = layout.upper[i] - layout.lower[i];
    Steps& high = at_node[nodes.upper(id)];
    if (graph.loops[i].kind == LoopKind::tuck) {
      high.tucks_below += layout.upper_turn(id).transposed(step);
      continue;
    }
    high.below += layout.upper_turn(id).transposed(step);
    at_node[nodes.lower(id)].above += layout.lower_turn(id).transposed(step);
  }
  for (Steps& steps : at_node)
    if (norm(steps.below) == 0) steps.below = steps.tucks_below;
  const auto tilt = [](const Vec3& step) {
    const double along = std::hypot(step.x, step.y);
    return along > 0 || step.z != 0 ? tilt_share * std::atan2(step.z, along) : 0;
  };
  layout.tilt_lower.clear(), layout.tilt_upper.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const Steps &low = at_node[nodes.lower(LoopId(i))], &high = at_node[nodes.upper(LoopId(i))];
    layout.tilt_lower.push_back({tilt(low.below), tilt(low.above)});
    layout.tilt_upper.push_back({tilt(high.below), tilt(high.above)});
  }
}

// Turned about x by the tilt below or above; between them where it is less than `reach` away.
Vec3 tilted(const CrossingTilt& tilt, const Vec3& offset, double reach) {
  const double share = std::clamp(0.5 + 0.5 * offset.y / reach, 0.0, 1.0);
  // Sinkers hang farther down among the legs and are tilted more.
  const double more = offset.y < 0 ? std::clamp(-offset.y / reach, 1.0, 1.5) : 1;
  const double angle = (tilt.below + (tilt.above - tilt.below) * share) * more;
  const double c = std::cos(angle), s = std::sin(angle);
  // What lies deep in a stack goes up and down with the rest of the crossing, else heads and feet would
  // change places.
  const double layer = std::clamp(offset.z, -1.3 * reach, 1.3 * reach);
  return {offset.x, c * offset.y - s * layer, s * offset.y + c * offset.z};
}

}  // namespace

Vec3 Layout::from_lower(LoopId id, const Vec3& offset, double reach) const {
  const std::size_t i = id.position();
  const Vec3 here = tilt_lower.empty() ? offset : tilted(tilt_lower[i], offset, reach);
  return lower[i] + lower_turn(id) * here;
}

Vec3 Layout::from_upper(LoopId id, const Vec3& offset, double reach) const {
  const std::size_t i = id.position();
  const Vec3 here = tilt_upper.empty() ? offset : tilted(tilt_upper[i], offset, reach);
  return upper[i] + upper_turn(id) * here;
}

Rotation Layout::turn(LoopId id) const {
  if (is_flat()) return {};
  const Rotation &low = turn_lower[id.position()], &high = turn_upper[id.position()];
  return mean_rotation({low.x + high.x, low.y + high.y, low.z + high.z}, low);
}

double slots_per_wale(const YarnGraph& graph) {
  std::set<double> slots[2];
  for (const Loop& loop : graph.loops) slots[is_front(loop.bed) ? 0 : 1].insert(loop.slot);
  std::vector<double> gaps;
  for (const std::set<double>& bed : slots)
    for (auto slot = bed.begin(); slot != bed.end() && std::next(slot) != bed.end(); ++slot)
      gaps.push_back(*std::next(slot) - *slot);
  std::vector<double> steps;
  for (const GraphYarn& yarn : graph.yarns)
    for (std::size_t k = 0; k + 1 < yarn.loops.size(); ++k) {
      const Loop& from = graph.loop(yarn.loops[k]);
      const Loop& to = graph.loop(yarn.loops[k + 1]);
      if (from.direction == to.direction) steps.push_back(std::abs(to.slot - from.slot));
    }
  if (steps.empty()) return 1;
  // A full rib steps 0 and 1 in turn, or 1/2 and 1/2: its mean says 1/2 either way, where most steps are
  // small.
  std::vector<double> small;
  for (const double step : steps)
    if (step < 1.25) small.push_back(step);
  const double mean =
      small.empty() ? 1
                    : std::accumulate(small.begin(), small.end(), 0.0) / static_cast<double>(small.size());
  const double step = small.size() * 2 > steps.size() ? std::max(0.5, mean) : median(steps);
  const double gap = gaps.empty() ? 1 : median(gaps);
  return std::clamp(step < 0.75 ? 0.5 : std::min(step, std::max(gap, 1.0)), 0.5, 3.0);
}

Layout lay_out(const YarnGraph& graph, const GeometryOptions& options) {
  Layout layout;
  if (graph.loops.empty()) return layout;
  Nodes nodes = binding_nodes(graph);
  const HeldEvents events = held_events(graph);
  stop_if_told();
  const Eigen::VectorXd y = levels(graph, options, nodes, events);
  stop_if_told();
  bool front = false, back = false;
  for (const Loop& loop : graph.loops) (is_front(loop.bed) ? front : back) = true;
  layout.two_beds = front && back;
  mark_faced(graph, layout);
  const std::vector<double> z = layout.two_beds ? node_heights(graph, options, nodes, layout.faced)
                                                : std::vector<double>(2 * graph.loops.size(), 0);
  layout.slot_pitch = options.wale_pitch / slots_per_wale(graph);

  const std::size_t n = graph.loops.size();
  // x of a node: where the feet of its children stand; a head without children lies where its needle was.
  std::vector<double> slot(2 * n), feet(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    slot[nodes.lower(LoopId(i))] += graph.loops[i].slot;
    feet[nodes.lower(LoopId(i))] += 1;
  }
  for (std::size_t i = 0; i < n; ++i)
    if (const std::size_t node = nodes.upper(LoopId(i)); feet[node] == 0)
      slot[node] = graph.loops[i].head_slot;
  for (std::size_t i = 0; i < 2 * n; ++i)
    if (feet[i] > 0) slot[i] /= feet[i];
  layout.lower.resize(n);
  layout.upper.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t low = nodes.lower(LoopId(i)), high = nodes.upper(LoopId(i));
    layout.lower[i] = {slot[low] * layout.slot_pitch, y[static_cast<Eigen::Index>(low)], z[low]};
    layout.upper[i] = {slot[high] * layout.slot_pitch, y[static_cast<Eigen::Index>(high)], z[high]};
  }
  lower_tucks(graph, options, layout);
  fit_templates(graph, options, nodes, layout);
  return layout;
}

Layout moved_layout(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                    MovedPlaces places) {
  Layout layout = flat;
  layout.lower = std::move(places.lower);
  layout.upper = std::move(places.upper);
  layout.turn_lower = std::move(places.turn_lower);
  layout.turn_upper = std::move(places.turn_upper);
  layout.wall = std::move(places.wall);
  lower_tucks(graph, options, layout);
  Nodes nodes = binding_nodes(graph);
  fit_templates(graph, options, nodes, layout);
  tilt_crossings(graph, nodes, layout);
  return layout;
}

}  // namespace loopwright
