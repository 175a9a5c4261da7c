#include "machine/run_machine.hpp"

#include <algorithm>
#include <cmath>

#include "machine/carriage.hpp"
#include "machine/carriers.hpp"
#include "machine/crossings.hpp"
#include "machine/needle_table.hpp"
#include "machine/racking.hpp"

namespace loopwright {
namespace {

constexpr double most_racking = 1e6;  // beyond any bed; keeps needle arithmetic exact

class Machine {
 public:
  Machine(const Program& program, Diagnostics& diagnostics)
      : program_(program),
        diagnostics_(diagnostics),
        needles_(program),
        stacks_(static_cast<std::size_t>(needles_.size())),
        carriers_(program, diagnostics),
        carriage_(program),
        crossings_(needles_, stacks_) {}

  KnittingRecord run();

 private:
  void make_room();
  void rack(const Instruction& instruction);
  void form_loops(const Instruction& instruction);
  void miss(const Instruction& instruction);
  void transfer(const Instruction& instruction);
  void drop(const Instruction& instruction);

  std::vector<LoopId>& stack(Needle needle) {
    return stacks_[static_cast<std::size_t>(needles_.position(needle))];
  }
  LoopRecord& loop(LoopId id) { return record_.loops[id.position()]; }
  // Whether loops can move between two needles now; says why not.
  bool can_transfer(const Instruction& instruction);
  void move_stack(Needle from, Needle to);
  void end_stack(Needle needle, LoopFate fate,
                 int fate_instruction);  // records how the loops lay; does not remove them
  void count_pass(const Instruction& instruction, const std::vector<CarrierId>& set);
  void lay_yarn(const Instruction& instruction, CarrierId id, LoopId formed);
  bool is_twisted(const Instruction& instruction, CarrierId id);
  void count(Acts& acts, Needle needle) const;
  void count_tall_stack(Needle needle, std::size_t before);
  void count_caught_yarns(const Instruction& instruction, const std::vector<CarrierId>& set);
  void watch_hook(const Instruction& instruction, const std::vector<CarrierId>& set);

  const Program& program_;
  Diagnostics& diagnostics_;
  NeedleTable needles_;
  std::vector<std::vector<LoopId>> stacks_;  // by needle position
  Racking racking_;
  Carriers carriers_;
  Carriage carriage_;
  CrossingTracker crossings_;
  KnittingRecord record_;
  std::vector<LoopId> last_loop_;    // by yarn
  int now_ = 0;                      // index of the instruction that runs
  std::optional<double> hook_slot_;  // of the first needle of what the hook holds, once there is one
  std::string stitch_setting_;       // the last x- operation: settings such as x-stitch-number end a pass

  // The carriage pass that is under way.
  std::vector<CarrierId> pass_set_;
  Direction pass_direction_ = Direction::none;
  long long pass_order_ = 0;
};

Direction direction_of(const Instruction& instruction) {
  return instruction.direction == Direction::left ? Direction::left : Direction::right;
}

// Room for all loops at once: a long programme would else copy them again and again.
void Machine::make_room() {
  std::size_t loops = 0;
  for (const Instruction& instruction : program_.instructions)
    if (instruction.op == Op::knit || instruction.op == Op::tuck || instruction.op == Op::split)
      loops += instruction.carriers.size();
  record_.loops.reserve(loops);
  crossings_.reserve(loops);
  record_.stack_rank.reserve(loops);
  record_.stack_height.reserve(loops);
}

KnittingRecord Machine::run() {
  make_room();
  for (const Instruction& instruction : program_.instructions) {
    const bool has_yarn = !instruction.carriers.empty();
    switch (instruction.op) {
      case Op::in:
      case Op::inhook:
        carriers_.bring_in(instruction, now_);
        break;
      case Op::releasehook:
        carriers_.release_hook(instruction);
        carriage_.end_pass();
        hook_slot_.reset();
        break;
      case Op::out:
      case Op::outhook:
        carriers_.take_out(instruction, now_, record_.yarns);
        carriage_.end_pass();
        break;
      case Op::rack:
        rack(instruction);
        break;
      // Without a carrier, knit drops, tuck does nothing and split transfers.
      case Op::knit:
        has_yarn ? form_loops(instruction) : drop(instruction);
        break;
      case Op::tuck:
        has_yarn ? form_loops(instruction) : carriage_.act(instruction, now_, {}, racking_, carriers_);
        break;
      case Op::split:
        has_yarn ? form_loops(instruction) : transfer(instruction);
        break;
      case Op::miss:
        miss(instruction);
        break;
      case Op::drop:
        drop(instruction);
        break;
      case Op::xfer:
        transfer(instruction);
        break;
      case Op::amiss:
        carriage_.act(instruction, now_, {}, racking_, carriers_);
        break;
      case Op::stitch:
      case Op::pause:
        carriage_.end_pass();
        break;
      case Op::extension:
        if (instruction.text != stitch_setting_) carriage_.end_pass();
        stitch_setting_ = instruction.text;
        break;
    }
    ++now_;
  }

  // What is left: loops on needles, carriers that are still in.
  record_.stack_rank.resize(record_.loops.size());
  record_.stack_height.resize(record_.loops.size());
  for (int position = 0; position < needles_.size(); ++position) {
    const std::vector<LoopId>& held = stacks_[static_cast<std::size_t>(position)];
    if (held.empty()) continue;
    record_.held.push_back({needles_.needle(position), held});
    end_stack(needles_.needle(position), LoopFate::held, -1);
  }
  record_.crossings = crossings_.net_crossings(now_ - 1);
  carriers_.finish();
  record_.carriers = carriers_.places();
  record_.carriage_passes = carriage_.passes();
  record_.kick_backs = std::move(carriage_.kick_backs());
  return std::move(record_);
}

void Machine::rack(const Instruction& instruction) {
  if (!(std::abs(instruction.value) <= most_racking)) {
    diagnostics_.error(instruction.at,
                       "no bed can be racked so far: write the racking in needle pitches, such as 'rack 1'");
    return;
  }
  const Racking racking(instruction.value);
  if (racking == racking_) return;  // restated before nearly every transfer by some writers
  racking_ = racking;
  crossings_.rack(racking);
  record_.rackings.push_back({now_, racking.value()});
}

void Machine::form_loops(const Instruction& instruction) {
  const Needle needle = instruction.needle;
  if (is_slider(needle.bed)) {
    diagnostics_.error(instruction.at, "no loop can be made on the slider " + to_string(needle) +
                                           ": make it on a needle and transfer it");
    return;
  }
  const std::vector<CarrierId>& set = carriers_.use(instruction, record_.yarns);
  if (set.empty()) return;
  carriage_.act(instruction, now_, set, racking_, carriers_);
  count_pass(instruction, set);
  watch_hook(instruction, set);
  count_caught_yarns(instruction, set);
  last_loop_.resize(record_.yarns.size());

  // The loops that the new ones are drawn through leave the needle: cast off, or to the opposite needle.
  std::vector<LoopId>& hook = stack(needle);
  const std::size_t before = hook.size();
  const bool draws = instruction.op != Op::tuck;
  std::vector<LoopId> parents;
  if (draws) parents = hook;
  const bool splits = instruction.op == Op::split && can_transfer(instruction);
  if (splits) {
    move_stack(needle, instruction.target);
    carriers_.follow(needle, instruction.target, set);
  } else if (draws) {
    end_stack(needle, LoopFate::cast_off, now_);
    for (LoopId parent : parents) crossings_.leave(parent, needle, now_);
    hook.clear();
  }

  // One loop a yarn, in the order of the carrier set.
  LoopKind kind = LoopKind::tuck;
  if (draws) kind = parents.empty() ? LoopKind::cast_on : splits ? LoopKind::split : LoopKind::knit;
  for (CarrierId id : set) {
    const LoopId formed(record_.loops.size());
    LoopRecord loop_record;
    loop_record.yarn = carriers_[id].yarn;
    loop_record.kind = kind;
    loop_record.direction = direction_of(instruction);
    loop_record.instruction = now_;
    loop_record.pass = record_.passes - 1;
    loop_record.racking = racking_.value();
    loop_record.on_empty_needle = before == 0;
    loop_record.twisted = kind == LoopKind::tuck && is_twisted(instruction, id);
    loop_record.placements.push_back({now_, needle, racking_.slot(needle)});
    loop_record.parents = parents;
    record_.loops.push_back(std::move(loop_record));
    hook.push_back(formed);
    crossings_.arrive(formed);
    lay_yarn(instruction, id, formed);
  }
  if (!draws) count_tall_stack(needle, before);
}

void Machine::miss(const Instruction& instruction) {
  if (instruction.carriers.empty()) {
    diagnostics_.error(instruction.at,
                       "a miss without a carrier moves nothing: name the carrier that passes " +
                           to_string(instruction.needle) + " or leave it out");
    return;
  }
  const std::vector<CarrierId>& set = carriers_.use(instruction, record_.yarns);
  if (set.empty()) return;
  carriage_.act(instruction, now_, set, racking_, carriers_);
  count_pass(instruction, set);
  watch_hook(instruction, set);
  last_loop_.resize(record_.yarns.size());
  for (CarrierId id : set) lay_yarn(instruction, id, LoopId());
}

void Machine::transfer(const Instruction& instruction) {
  if (!can_transfer(instruction)) return;
  carriage_.act(instruction, now_, {}, racking_, carriers_);
  if (stack(instruction.needle).empty()) count(record_.transfers_of_empty, instruction.needle);
  move_stack(instruction.needle, instruction.target);
  carriers_.follow(instruction.needle, instruction.target, {});
}

void Machine::drop(const Instruction& instruction) {
  carriage_.act(instruction, now_, {}, racking_, carriers_);
  std::vector<LoopId>& hook = stack(instruction.needle);
  if (hook.empty()) count(record_.drops_of_empty, instruction.needle);
  end_stack(instruction.needle, LoopFate::dropped, now_);
  for (LoopId id : hook) crossings_.leave(id, instruction.needle, now_);
  hook.clear();
}

bool Machine::can_transfer(const Instruction& instruction) {
  const Needle from = instruction.needle, to = instruction.target;
  const std::string both = to_string(from) + " and " + to_string(to);
  if (is_front(from.bed) == is_front(to.bed)) {
    diagnostics_.error(instruction.at, both + " are on the same bed: loops move only between opposite beds");
  } else if (is_slider(from.bed) && is_slider(to.bed)) {
    diagnostics_.error(instruction.at, both + " are both sliders: loops move between a slider and a needle");
  } else if (racking_.between()) {
    diagnostics_.error(instruction.at,
                       "at the all-needle racking " + to_string(racking_) +
                           " no two needles face each other: rack to a whole number before the transfer");
  } else if (!racking_.face(from, to)) {
    // At racking R the back needle B faces the front needle B + R.
    const long long needed = is_front(from.bed) ? 0LL + from.index - to.index : 0LL + to.index - from.index;
    diagnostics_.error(instruction.at, both + " do not face each other at racking " + to_string(racking_) +
                                           ": write 'rack " + std::to_string(needed) +
                                           "' before the transfer");
  } else {
    return true;
  }
  return false;
}

void Machine::move_stack(Needle from, Needle to) {
  std::vector<LoopId>& source = stack(from);
  std::vector<LoopId>& target = stack(to);
  for (LoopId id : source) crossings_.leave(id, from, now_);
  // The loop that lay nearest to the other bed comes first there: the stack arrives turned round.
  const std::size_t before = target.size();
  target.insert(target.end(), source.rbegin(), source.rend());
  for (LoopId id : source) {
    loop(id).placements.push_back({now_, to, racking_.slot(to)});
    crossings_.arrive(id);
  }
  source.clear();
  count_tall_stack(to, before);
}

void Machine::end_stack(Needle needle, LoopFate fate, int fate_instruction) {
  if (record_.stack_rank.size() < record_.loops.size()) {
    record_.stack_rank.resize(record_.loops.size());
    record_.stack_height.resize(record_.loops.size());
  }
  // On the front bed the first loop in the hook is in front, on the back bed the last: moving a stack keeps
  // that.
  const std::vector<LoopId>& hook = stack(needle);
  const int height = static_cast<int>(hook.size());
  for (int k = 0; k < height; ++k) {
    const LoopId id = hook[static_cast<std::size_t>(k)];
    loop(id).fate = fate;
    loop(id).fate_instruction = fate_instruction;
    record_.stack_rank[id.position()] = is_front(needle.bed) ? k : height - 1 - k;
    record_.stack_height[id.position()] = height;
  }
}

void Machine::count_pass(const Instruction& instruction, const std::vector<CarrierId>& set) {
  const Direction direction = direction_of(instruction);
  const long long order = racking_.order(instruction.needle);
  const bool advances = direction == Direction::right ? order > pass_order_ : order < pass_order_;
  if (record_.passes == 0 || set != pass_set_ || direction != pass_direction_ || !advances) {
    ++record_.passes;
    pass_set_ = set;
    pass_direction_ = direction;
  }
  pass_order_ = order;
}

void Machine::lay_yarn(const Instruction& instruction, CarrierId id, LoopId formed) {
  Carrier& carrier = carriers_[id];
  YarnRecord& yarn = record_.yarns[carrier.yarn.position()];
  YarnStep step;
  step.loop = formed;
  step.needle = instruction.needle;
  step.slot = racking_.slot(instruction.needle);
  step.direction = direction_of(instruction);
  step.instruction = now_;
  step.from = carrier.at.value_or(instruction.needle);
  if (formed.valid()) last_loop_[carrier.yarn.position()] = formed;
  carrier.missed = !formed.valid();
  yarn.steps.push_back(step);
  carrier.at = instruction.needle;
  carrier.side = step.direction;
}

// The yarn comes from beside the needle where the carrier stands; it is laid the wrong way round if the
// carrier must first go past the needle to come back over it.
bool Machine::is_twisted(const Instruction& instruction, CarrierId id) {
  const Carrier& carrier = carriers_[id];
  if (!carrier.at) return false;
  const long long from = 2 * racking_.order(*carrier.at) + static_cast<int>(carrier.side);
  const long long to = 2 * racking_.order(instruction.needle);
  return direction_of(instruction) == Direction::right ? from > to : from < to;
}

void Machine::count(Acts& acts, Needle needle) const {
  if (acts.count++ > 0) return;
  acts.first = now_;
  acts.needle = needle;
}

void Machine::count_tall_stack(Needle needle, std::size_t before) {
  const std::size_t loops = stack(needle).size();
  if (loops <= most_loops_on_needle) return;
  if (before <= most_loops_on_needle) count(record_.tall_stacks, needle);
  record_.tall_stacks.highest = std::max(record_.tall_stacks.highest, static_cast<int>(loops));
}

// A carrier that went past needles without a loop leaves its yarn across them: a loop made there catches it.
void Machine::count_caught_yarns(const Instruction& instruction, const std::vector<CarrierId>& set) {
  for (CarrierId id : carriers_.active()) {
    const Carrier& carrier = carriers_[id];
    if (!carrier.missed || std::find(set.begin(), set.end(), id) != set.end()) continue;
    const LoopId last = last_loop_[carrier.yarn.position()];
    if (!last.valid()) continue;
    const long long here = 2 * racking_.order(instruction.needle);
    const long long begin = 2 * racking_.order(loop(last).last().needle);
    const long long end = 2 * racking_.order(*carrier.at) + static_cast<int>(carrier.side);
    if (std::abs(end - begin) <= 4 * most_needles_passed) continue;
    if (std::min(begin, end) >= here || here >= std::max(begin, end)) continue;
    if (record_.caught_yarns.count == 0) record_.caught_yarns.carrier = id;
    count(record_.caught_yarns, instruction.needle);
  }
}

// The hook is parked to the right of the first needle of what it holds, and hides the needles there.
void Machine::watch_hook(const Instruction& instruction, const std::vector<CarrierId>& set) {
  const std::vector<CarrierId>& holds = carriers_.hook();
  if (holds.empty()) {
    hook_slot_.reset();
    return;
  }
  const double slot = racking_.slot(instruction.needle);
  const bool holds_this = std::find(set.begin(), set.end(), holds.front()) != set.end();
  if (!hook_slot_) {
    if (!holds_this) return;  // it comes with its first use
    hook_slot_ = slot;
    if (direction_of(instruction) == Direction::right) count(record_.hook_to_right, instruction.needle);
  } else if (slot > *hook_slot_ && slot <= *hook_slot_ + needles_behind_hook) {
    count(record_.hook_blocked, instruction.needle);
  }
}

}  // namespace

KnittingRecord run_machine(const Program& program, Diagnostics& diagnostics) {
  return Machine(program, diagnostics).run();
}

}  // namespace loopwright
