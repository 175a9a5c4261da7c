#include "loop_scale/tube_walls.hpp"

#include <algorithm>
#include <deque>
#include <map>

#include "loop_scale/correlation.hpp"

namespace loopwright {
namespace {

class RoundFinder {
 public:
  explicit RoundFinder(const YarnGraph& graph) : graph_(graph), mark_(graph.loops.size(), 0) {}

  // Whether the yarn that goes from `one` over to `other` closes a round.
  bool is_round(const Run& one, const Run& other, bool& one_in_front) {
    const std::vector<LoopId>& loops = graph_.yarns[one.yarn].loops;
    if (graph_.loop(loops[one.first]).direction == graph_.loop(loops[other.first]).direction) return false;
    if (is_above(one, other)) return false;
    // a row on every other needle and one on those between, both knitted on by the next: no tube
    const int next = next_pass(one);
    if (next >= 0 && next == next_pass(other)) return false;
    const int one_bed = bed_of(one), other_bed = bed_of(other);
    if (one_bed != 0 && other_bed != 0 && one_bed != other_bed) {
      one_in_front = one_bed > 0;
      return true;
    }
    // What the floats of each pass of the other: it lies in front of the yarn on the front bed, behind it on
    // the rear bed.
    seen_ = 0;
    const double votes = front_votes(one, other), counter_votes = front_votes(other, one);
    constexpr double nearly_all = 0.9;
    if (seen_ == 0 || std::abs(votes - counter_votes) < nearly_all * seen_) return false;
    one_in_front = counter_votes > votes;
    return true;
  }

 private:
  LoopId loop_of(const Run& run, std::size_t i) const { return graph_.yarns[run.yarn].loops[i]; }

  // 1: all formed on the front bed, -1: on the rear bed, 0: on both.
  int bed_of(const Run& run) const {
    const StitchSide side = graph_.loop(loop_of(run, run.first)).side;
    for (std::size_t i = run.first; i <= run.last; ++i)
      if (graph_.loop(loop_of(run, i)).side != side) return 0;
    return static_cast<int>(side);
  }

  // The pass that most loops of a run are knitted on by; -1: none.
  int next_pass(const Run& run) const {
    std::map<int, int> counts;
    for (std::size_t i = run.first; i <= run.last; ++i)
      for (const LoopId child : graph_.loop(loop_of(run, i)).children) ++counts[graph_.loop(child).pass];
    int best = -1, most = 0;
    for (const auto& [pass, count] : counts)
      if (count > most) best = pass, most = count;
    return best;
  }

  void mark(const Run& run) {
    ++stamp_;
    for (std::size_t i = run.first; i <= run.last; ++i) mark_[loop_of(run, i).position()] = stamp_;
  }
  bool is_marked(LoopId id) const { return mark_[id.position()] == stamp_; }

  // More than a tenth of the loops of `upper` continue wales of `lower`.
  bool is_above(const Run& lower, const Run& upper) {
    mark(lower);
    const int oldest = graph_.loop(loop_of(lower, lower.first)).instruction;
    std::size_t above = 0;
    std::vector<LoopId> open;
    for (std::size_t i = upper.first; i <= upper.last; ++i) {
      open.assign(1, loop_of(upper, i));
      bool found = false;
      while (!open.empty() && !found) {
        const LoopId id = open.back();
        open.pop_back();
        found = is_marked(id);
        for (const LoopId parent : graph_.loop(id).parents)
          if (graph_.loop(parent).instruction >= oldest) open.push_back(parent);
      }
      if (found) ++above;
    }
    return 10 * above > upper.size();
  }

  // Loops of `held`, or that it is drawn through, that floats of `run` pass: those on the front bed less
  // those on the rear bed. All that is passed is added to seen_.
  double front_votes(const Run& run, const Run& held) {
    mark(held);
    double votes = 0;
    for (std::size_t i = run.first; i < run.last; ++i)
      for (const PassedLoop& passed : graph_.yarns[run.yarn].floats[i].passed) {
        const std::vector<LoopId>& children = graph_.loop(passed.loop).children;
        const bool counts = is_marked(passed.loop) || std::any_of(children.begin(), children.end(),
                                                                  [&](LoopId id) { return is_marked(id); });
        if (!counts) continue;
        votes += is_front(passed.bed) ? 1 : -1;
        seen_ += 1;
      }
    return votes;
  }

  const YarnGraph& graph_;
  std::vector<int> mark_;
  int stamp_ = 0;
  double seen_ = 0;
};

}  // namespace

std::vector<Run> runs_of(const YarnGraph& graph, const BindingPoints& points) {
  std::vector<Run> runs;
  for (std::size_t y = 0; y < graph.yarns.size(); ++y) {
    const std::vector<LoopId>& loops = graph.yarns[y].loops;
    for (std::size_t first = 0; first < loops.size();) {
      std::size_t last = first;
      while (last + 1 < loops.size() && joined_by_weft(points, loops[last], loops[last + 1]) &&
             graph.loop(loops[last]).direction == graph.loop(loops[last + 1]).direction)
        ++last;
      runs.push_back({y, first, last});
      first = last + 1;
    }
  }
  return runs;
}

std::vector<Round> rounds_of(const YarnGraph& graph, const BindingPoints& points) {
  std::vector<Round> rounds;
  const std::vector<Run> runs = runs_of(graph, points);
  RoundFinder finder(graph);
  for (std::size_t k = 0; k + 1 < runs.size(); ++k) {
    Round round{runs[k], runs[k + 1]};
    if (round.one.yarn != round.other.yarn || round.one.size() < 2 || round.other.size() < 2) continue;
    const std::vector<LoopId>& loops = graph.yarns[round.one.yarn].loops;
    if (!joined_by_weft(points, loops[round.one.last], loops[round.other.first])) continue;
    if (!finder.is_round(round.one, round.other, round.one_in_front)) continue;
    rounds.push_back(round);
    ++k;
  }
  return rounds;
}

namespace {

// A course that is knitted to and fro between the walls (waste in interlock) joins them: there is no tube.
void lay_flat_between_walls(const YarnGraph& graph, const std::vector<bool>& in_round,
                            std::vector<std::int8_t>& walls) {
  std::vector<std::size_t> between;
  const auto is_loose = [&](LoopId id) { return !in_round[id.position()]; };
  for (const GraphYarn& yarn : graph.yarns)
    for (std::size_t i = 0; i + 1 < yarn.loops.size(); ++i) {
      const LoopId one = yarn.loops[i], other = yarn.loops[i + 1];
      const bool goes_on = graph.loop(one).direction == graph.loop(other).direction;
      if (!goes_on || walls[one.position()] * walls[other.position()] >= 0) continue;
      for (const LoopId id : {one, other})
        if (is_loose(id)) between.push_back(id.position());
    }
  for (const std::size_t k : between) walls[k] = 0;
}

}  // namespace

std::vector<std::int8_t> tube_walls(const YarnGraph& graph, const std::vector<Round>& rounds) {
  std::vector<std::int8_t> walls(graph.loops.size(), 0);
  std::vector<bool> in_round(graph.loops.size(), false);
  std::deque<LoopId> reached;
  for (const Round& round : rounds)
    for (const bool is_one : {true, false}) {
      const Run& run = is_one ? round.one : round.other;
      for (std::size_t i = run.first; i <= run.last; ++i) {
        const LoopId id = graph.yarns[run.yarn].loops[i];
        walls[id.position()] = is_one == round.one_in_front ? 1 : -1;
        in_round[id.position()] = true;
        reached.push_back(id);
      }
    }
  while (!reached.empty()) {
    const LoopId id = reached.front();
    reached.pop_front();
    for (const std::vector<LoopId>* list : {&graph.loop(id).parents, &graph.loop(id).children})
      for (const LoopId next : *list)
        if (walls[next.position()] == 0) {
          walls[next.position()] = walls[id.position()];
          reached.push_back(next);
        }
  }
  lay_flat_between_walls(graph, in_round, walls);
  return walls;
}

std::vector<std::int8_t> walls_of_points(const BindingPoints& points, const std::vector<std::int8_t>& walls) {
  std::vector<std::int8_t> result;
  for (const BindingPoint& point : points.points) {
    int sum = 0;
    for (const std::vector<LoopId>* list : {&point.lower_of, &point.upper_of})
      for (const LoopId id : *list) sum += walls[id.position()];
    result.push_back(static_cast<std::int8_t>(sum > 0 ? 1 : sum < 0 ? -1 : 0));
  }
  return result;
}

}  // namespace loopwright
