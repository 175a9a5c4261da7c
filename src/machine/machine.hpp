// The machine while it runs a programme: needles with their loops, carriers, racking. Only run_machine makes
// one.
#pragma once
#include <optional>

#include "machine/carriage.hpp"
#include "machine/carriers.hpp"
#include "machine/crossings.hpp"
#include "machine/needle_table.hpp"
#include "machine/racking.hpp"

namespace loopwright {

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

inline Direction direction_of(const Instruction& instruction) {
  return instruction.direction == Direction::left ? Direction::left : Direction::right;
}

}  // namespace loopwright
