#include "machine/run_machine.hpp"

#include <algorithm>
#include <cmath>

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
        crossings_(needles_, stacks_) {}

  KnittingRecord run();

 private:
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
  void warn_of_long_float(const Instruction& instruction, YarnId yarn);
  void warn_of_many_loops(const Instruction& instruction, Needle needle, std::size_t before);

  const Program& program_;
  Diagnostics& diagnostics_;
  NeedleTable needles_;
  std::vector<std::vector<LoopId>> stacks_;  // by needle position
  Racking racking_;
  Carriers carriers_;
  CrossingTracker crossings_;
  KnittingRecord record_;
  std::vector<LoopId> last_loop_;  // by yarn
  int now_ = 0;                    // index of the instruction that runs

  // The carriage pass that is under way.
  std::vector<CarrierId> pass_set_;
  Direction pass_direction_ = Direction::none;
  long long pass_order_ = 0;
};

Direction direction_of(const Instruction& instruction) {
  return instruction.direction == Direction::left ? Direction::left : Direction::right;
}

KnittingRecord Machine::run() {
  for (const Instruction& instruction : program_.instructions) {
    const bool has_yarn = !instruction.carriers.empty();
    switch (instruction.op) {
      case Op::in:
      case Op::inhook:
        carriers_.bring_in(instruction, now_);
        break;
      case Op::releasehook:
        carriers_.release_hook(instruction);
        break;
      case Op::out:
      case Op::outhook:
        carriers_.take_out(instruction, now_, record_.yarns);
        break;
      case Op::rack:
        rack(instruction);
        break;
      // Without a carrier, knit drops, tuck does nothing and split transfers.
      case Op::knit:
        has_yarn ? form_loops(instruction) : drop(instruction);
        break;
      case Op::tuck:
        if (has_yarn) form_loops(instruction);
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
      case Op::stitch:
      case Op::pause:
      case Op::extension:
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
  carriers_.warn_of_carriers_left_in();
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
  count_pass(instruction, set);
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
    loop_record.placements.push_back({now_, needle, racking_.slot(needle)});
    loop_record.parents = parents;
    record_.loops.push_back(std::move(loop_record));
    hook.push_back(formed);
    crossings_.arrive(formed);
    lay_yarn(instruction, id, formed);
  }
  if (!draws) warn_of_many_loops(instruction, needle, before);
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
  count_pass(instruction, set);
  last_loop_.resize(record_.yarns.size());
  for (CarrierId id : set) lay_yarn(instruction, id, LoopId());
}

void Machine::transfer(const Instruction& instruction) {
  if (!can_transfer(instruction)) return;
  move_stack(instruction.needle, instruction.target);
  carriers_.follow(instruction.needle, instruction.target, {});
}

void Machine::drop(const Instruction& instruction) {
  std::vector<LoopId>& hook = stack(instruction.needle);
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
  warn_of_many_loops(program_.instructions[static_cast<std::size_t>(now_)], to, before);
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
  if (formed.valid()) {
    warn_of_long_float(instruction, carrier.yarn);
    last_loop_[carrier.yarn.position()] = formed;
  }
  yarn.steps.push_back(step);
  carrier.at = instruction.needle;
  carrier.side = step.direction;
}

void Machine::warn_of_long_float(const Instruction& instruction, YarnId yarn) {
  const LoopId last = last_loop_[yarn.position()];
  if (!last.valid()) return;
  const Needle from = loop(last).last().needle;
  const double length = std::abs(racking_.slot(instruction.needle) - racking_.slot(from));
  if (length <= longest_float) return;
  const int line = program_.instructions[static_cast<std::size_t>(loop(last).instruction)].at.line;
  diagnostics_.warning(instruction.at, "the yarn floats over " + std::to_string(static_cast<int>(length)) +
                                           " needles, from " + to_string(from) + " (line " +
                                           std::to_string(line) + ") to " + to_string(instruction.needle) +
                                           ": tuck it on the way if it must not hang loose");
}

void Machine::warn_of_many_loops(const Instruction& instruction, Needle needle, std::size_t before) {
  const std::size_t loops = stack(needle).size();
  if (loops <= most_loops_on_needle || before > most_loops_on_needle) return;
  diagnostics_.warning(instruction.at, "needle " + to_string(needle) + " now holds " + std::to_string(loops) +
                                           " loops, more than a hook takes: knit them off earlier");
}

}  // namespace

KnittingRecord run_machine(const Program& program, Diagnostics& diagnostics) {
  return Machine(program, diagnostics).run();
}

}  // namespace loopwright
