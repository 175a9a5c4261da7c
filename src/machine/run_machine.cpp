#include "machine/run_machine.hpp"

#include <algorithm>
#include <cmath>

#include "base/stop.hpp"
#include "machine/machine.hpp"

namespace loopwright {
namespace {

constexpr double most_racking = 1e6;  // beyond any bed; keeps needle arithmetic exact

}  // namespace

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
    stop_if_told();
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

KnittingRecord run_machine(const Program& program, Diagnostics& diagnostics) {
  return Machine(program, diagnostics).run();
}

}  // namespace loopwright
