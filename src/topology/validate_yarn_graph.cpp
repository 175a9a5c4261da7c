#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

class Checker {
 public:
  explicit Checker(const YarnGraph& graph) : graph_(graph) {}
  std::vector<std::string> faults();

 private:
  void say(LoopId id, const std::string& what) {
    const bool known = holds(id);
    faults_.push_back("loop " + std::to_string(id.value) +
                      (known ? " of line " + std::to_string(graph_.loop(id).at.line) : "") + " " + what);
  }
  bool holds(LoopId id) const { return id.valid() && id.position() < graph_.loops.size(); }

  void check_yarns();
  void check_interlacings();
  void check_heads();
  void check_fates();

  const YarnGraph& graph_;
  std::vector<std::string> faults_;
};

bool has(const std::vector<LoopId>& list, LoopId id) {
  return std::find(list.begin(), list.end(), id) != list.end();
}

// Every loop is once in its yarn, in time order, and floats join neighbours.
void Checker::check_yarns() {
  std::vector<int> seen(graph_.loops.size());
  for (std::size_t y = 0; y < graph_.yarns.size(); ++y) {
    const GraphYarn& yarn = graph_.yarns[y];
    const std::string name = "yarn " + std::to_string(y);
    for (std::size_t k = 0; k < yarn.loops.size(); ++k) {
      const LoopId id = yarn.loops[k];
      if (!holds(id)) {
        faults_.push_back(name + " lists a loop that is not there");
        continue;
      }
      ++seen[id.position()];
      if (graph_.loop(id).yarn != YarnId(y)) say(id, "is listed in a yarn that it does not belong to");
      if (graph_.loop(id).order != static_cast<int>(k))
        say(id, "has another place in its yarn than its order says");
      if (k > 0 && holds(yarn.loops[k - 1]) &&
          graph_.loop(yarn.loops[k - 1]).instruction >= graph_.loop(id).instruction)
        say(id, "was formed no later than the loop before it in its yarn");
    }
    if (yarn.floats.size() + 1 != std::max<std::size_t>(yarn.loops.size(), 1)) {
      faults_.push_back(name + " has " + std::to_string(yarn.floats.size()) + " floats for " +
                        std::to_string(yarn.loops.size()) + " loops");
      continue;
    }
    for (std::size_t k = 0; k < yarn.floats.size(); ++k) {
      const Float& f = yarn.floats[k];
      if (f.from != yarn.loops[k] || f.to != yarn.loops[k + 1])
        faults_.push_back(name + ": float " + std::to_string(k) + " does not join its neighbours");
      for (const PassedLoop& passed : f.passed) {
        if (!holds(passed.loop) || passed.loop == f.from || passed.loop == f.to)
          faults_.push_back(name + ": float " + std::to_string(k) + " passes a loop that it cannot pass");
        else if (holds(f.to) && graph_.loop(passed.loop).instruction >= graph_.loop(f.to).instruction)
          say(passed.loop, "is passed by a float that is older than it");
      }
    }
  }
  for (std::size_t k = 0; k < seen.size(); ++k)
    if (seen[k] != 1) say(LoopId(k), "is in its yarn " + std::to_string(seen[k]) + " times");
}

// Parents, children and interlacings say the same; the sign is that of the child's bed.
void Checker::check_interlacings() {
  std::set<std::pair<LoopId, LoopId>> pairs;
  for (const Interlacing& i : graph_.interlacings) {
    if (!holds(i.parent) || !holds(i.child)) {
      faults_.push_back("an interlacing names a loop that is not there");
      continue;
    }
    if (!pairs.insert({i.parent, i.child}).second) say(i.child, "is interlaced twice with one parent");
    if (!has(graph_.loop(i.child).parents, i.parent))
      say(i.child, "is interlaced with a loop that is not its parent");
    if (!has(graph_.loop(i.parent).children, i.child))
      say(i.parent, "is interlaced with a loop that is not its child");
    if (i.sign != static_cast<int>(graph_.loop(i.child).side))
      say(i.child, "has an interlacing of the wrong sign");
    if (graph_.loop(i.parent).instruction >= graph_.loop(i.child).instruction)
      say(i.child, "is drawn through a loop that is not older");
  }
  std::size_t parents = 0, children = 0;
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    const Loop& loop = graph_.loops[k];
    parents += loop.parents.size();
    children += loop.children.size();
    const bool draws = loop.kind == LoopKind::knit || loop.kind == LoopKind::split;
    if (draws != !loop.parents.empty()) say(LoopId(k), "has parents that do not suit its kind");
    if (loop.side != (is_front(loop.bed) ? StitchSide::front : StitchSide::rear))
      say(LoopId(k), "is of another side than the bed on which it was formed");
  }
  if (parents != graph_.interlacings.size() || children != graph_.interlacings.size())
    faults_.push_back("there are " + std::to_string(graph_.interlacings.size()) + " interlacings, " +
                      std::to_string(parents) + " parents and " + std::to_string(children) + " children");
}

// Heads that left a needle together have ranks 0, 1, ... of their count; still held ones are counted by
// needle.
void Checker::check_heads() {
  std::map<std::tuple<int, Bed, double>, std::vector<LoopId>> stacks;
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    const Loop& loop = graph_.loops[k];
    stacks[{loop.head_instruction, loop.head_bed, loop.head_slot}].push_back(LoopId(k));
  }
  for (const auto& [where, heads] : stacks) {
    std::vector<bool> taken(heads.size());
    for (LoopId id : heads) {
      const Loop& loop = graph_.loop(id);
      const bool fits = loop.head_count == static_cast<int>(heads.size()) && loop.head_rank >= 0 &&
                        loop.head_rank < loop.head_count && !taken[static_cast<std::size_t>(loop.head_rank)];
      if (!fits)
        say(id, "has head rank " + std::to_string(loop.head_rank) + " of " + std::to_string(loop.head_count) +
                    " in a stack of " + std::to_string(heads.size()));
      else
        taken[static_cast<std::size_t>(loop.head_rank)] = true;
    }
  }
}

// Every loop is cast off by its children, dropped, or still held; lists agree.
void Checker::check_fates() {
  std::size_t unheld = 0, held = 0;
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    const Loop& loop = graph_.loops[k];
    const LoopId id(k);
    if (loop.fate == LoopFate::cast_off && loop.children.empty())
      say(id, "is cast off but nothing is drawn through it");
    if ((loop.fate == LoopFate::held) != (loop.head_instruction < 0))
      say(id, "has a fate without its instruction");
    if (loop.fate == LoopFate::held) {
      ++held;
      if (!has(graph_.left_on_needles, id)) say(id, "is held but not among the loops left on needles");
    }
    if (loop.fate == LoopFate::dropped && loop.children.empty()) {
      ++unheld;
      if (!has(graph_.unheld, id)) say(id, "will run but is not among the unheld");
    }
  }
  if (unheld != graph_.unheld.size()) faults_.push_back("the list of unheld loops holds others too");
  if (held != graph_.left_on_needles.size())
    faults_.push_back("the list of loops left on needles holds others too");
  for (const LegCrossing& crossing : graph_.leg_crossings)
    if (!holds(crossing.front) || !holds(crossing.back) || crossing.front == crossing.back)
      faults_.push_back("a leg crossing needs two loops");
}

std::vector<std::string> Checker::faults() {
  check_yarns();
  check_interlacings();
  check_heads();
  check_fates();
  return std::move(faults_);
}

}  // namespace

std::vector<std::string> validate_yarn_graph(const YarnGraph& graph) { return Checker(graph).faults(); }

}  // namespace loopwright
