#include "machine/knittable.hpp"

#include <algorithm>
#include <cmath>

#include "machine/cast_on.hpp"
#include "machine/needle_table.hpp"
#include "machine/run_machine.hpp"

namespace loopwright {
namespace {

constexpr int tuck_in_distance = 4;  // needles between the tucks that hold a further yarn's end
constexpr int tail_stitches = 6;     // on the last loop of a bind-off, so that it does not run

class KnittableBuilder {
 public:
  KnittableBuilder(const Program& fabric, MachineKind machine, Diagnostics& diagnostics)
      : fabric_(fabric), limits_(limits_of(machine)), diagnostics_(diagnostics) {}

  KnittableProgram build() {
    if (!name_carriers()) return std::move(result_);
    Diagnostics unsaid;  // the fabric has been run and checked before
    const KnittingRecord record = run_machine(fabric_, unsaid);
    cast_on_ = cast_on_of(fabric_, record);
    result_.cast_on_needles = static_cast<int>(cast_on_.needles.size());
    cast_on();
    pattern();
    end();
    return std::move(result_);
  }

 private:
  bool name_carriers();
  void cast_on();
  CastOnPass needles_of_one_pass(const CastOnPass& first, Direction direction) const;
  void bring_in(CarrierId id);
  void release(CarrierId id);
  void tuck_in(CarrierId id);
  std::vector<Needle> tuck_needles(bool front, bool out, Direction first) const;
  void pattern();
  void end();
  void take_out_and_drop();

  Instruction& add(Op op) {
    Instruction& instruction = result_.program.instructions.emplace_back();
    instruction.op = op;
    return instruction;
  }
  void add_pass(const CastOnPass& pass, Op op, CarrierId id);
  void add_rack(double racking);
  double racking_for_machine(double racking) const;
  // The way that a yarn goes first in the pattern; none: it is not used.
  Direction first_direction(CarrierId id) const;
  std::vector<CarrierId> renamed(const std::vector<CarrierId>& carriers) const;

  const Program& fabric_;
  MachineLimits limits_;
  Diagnostics& diagnostics_;
  KnittableProgram result_;
  std::vector<CarrierId> carrier_of_;  // the machine's, by the fabric's
  CastOn cast_on_;
  double racking_ = 0;
};

// The fabric's own names where the machine has such carriers, else 1, 2, 3 in the order of its yarns.
bool KnittableBuilder::name_carriers() {
  Program& program = result_.program;
  program.file = fabric_.file;
  program.settings = fabric_.settings;
  program.headers = fabric_.headers;
  if (limits_.name == "Kniterate") program.headers.emplace_back("Machine", "Kniterate");
  program.headers.emplace_back("Position", "Center");
  for (int k = 1; k <= limits_.carriers; ++k) program.carriers.push_back(std::to_string(k));
  program.yarns.resize(program.carriers.size());
  if (fabric_.carriers.size() > program.carriers.size()) {
    diagnostics_.error({}, std::string(limits_.name) + ": the machine has " +
                               std::to_string(limits_.carriers) + " carriers, the fabric takes " +
                               std::to_string(fabric_.carriers.size()) + " yarns");
    return false;
  }
  const auto place = [&](const std::string& name) {
    return std::find(program.carriers.begin(), program.carriers.end(), name) - program.carriers.begin();
  };
  const bool known = std::all_of(fabric_.carriers.begin(), fabric_.carriers.end(), [&](const auto& name) {
    return place(name) < static_cast<std::ptrdiff_t>(program.carriers.size());
  });
  for (std::size_t k = 0; k < fabric_.carriers.size(); ++k) {
    carrier_of_.emplace_back(known ? static_cast<std::size_t>(place(fabric_.carriers[k])) : k);
    if (k < fabric_.yarns.size()) program.yarns[carrier_of_[k].position()] = fabric_.yarns[k];
  }
  return true;
}

std::vector<CarrierId> KnittableBuilder::renamed(const std::vector<CarrierId>& carriers) const {
  std::vector<CarrierId> named;
  for (CarrierId id : carriers) named.push_back(carrier_of_[id.position()]);
  return named;
}

Direction KnittableBuilder::first_direction(CarrierId id) const {
  Direction missing = Direction::none;  // of a yarn that only goes past needles
  for (const Instruction& instruction : fabric_.instructions) {
    if (!names_needle(instruction) ||
        std::find(instruction.carriers.begin(), instruction.carriers.end(), id) == instruction.carriers.end())
      continue;
    if (instruction.op != Op::miss) return instruction.direction;
    if (missing == Direction::none) missing = instruction.direction;
  }
  return missing;
}

// All machines put the all-needle position between the same needles; each has its own fraction for it.
double KnittableBuilder::racking_for_machine(double racking) const {
  const double whole = std::floor(racking);
  return racking == whole ? racking : whole + limits_.all_needle;
}

void KnittableBuilder::add_rack(double racking) {
  racking = racking_for_machine(racking);
  if (racking == racking_) return;
  racking_ = racking;
  add(Op::rack).value = racking;
}

void KnittableBuilder::add_pass(const CastOnPass& pass, Op op, CarrierId id) {
  std::vector<Needle> needles = pass.needles;
  if (pass.direction == Direction::left) std::reverse(needles.begin(), needles.end());
  for (const Needle& needle : needles) {
    Instruction& instruction = add(op);
    instruction.direction = pass.direction;
    instruction.needle = needle;
    instruction.carriers = {carrier_of_[id.position()]};
  }
}

void KnittableBuilder::bring_in(CarrierId id) {
  add(limits_.has_hook ? Op::inhook : Op::in).carriers = renamed({id});
}

void KnittableBuilder::release(CarrierId id) {
  if (limits_.has_hook) add(Op::releasehook).carriers = renamed({id});
}

void KnittableBuilder::cast_on() {
  if (cast_on_.needles.empty()) return;
  // The hook brings yarn from the right; carriers without one stand at the left.
  const Direction first = limits_.has_hook ? Direction::left : Direction::right;
  CarrierId leading;
  for (std::size_t k = 0; k < fabric_.carriers.size() && !leading.valid(); ++k)
    if (first_direction(CarrierId(k)) != Direction::none) leading = CarrierId(k);
  if (!leading.valid()) return;

  add_rack(cast_on_.racking.value());
  bring_in(leading);
  const std::vector<CastOnPass> passes = cast_on_passes(cast_on_, first);
  Direction last = Direction::none;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    // A Kniterate cannot tuck on both beds in one pass; on an empty needle a stitch is a tuck.
    const auto on_front = [](const Needle& needle) { return is_front(needle.bed); };
    const bool on_both = std::any_of(passes[k].needles.begin(), passes[k].needles.end(), on_front) &&
                         !std::all_of(passes[k].needles.begin(), passes[k].needles.end(), on_front);
    add_pass(passes[k], on_both && !limits_.has_hook ? Op::knit : Op::tuck, leading);
    last = passes[k].direction;
    if (k == 1 || passes.size() == 1) release(leading);
  }
  // The yarn must stand where the pattern takes it up: one more pass brings it there.
  if (last == first_direction(leading)) {
    const Direction direction = last == Direction::right ? Direction::left : Direction::right;
    add_pass(needles_of_one_pass(passes.front(), direction), Op::knit, leading);
  }
  for (std::size_t k = 0; k < fabric_.carriers.size(); ++k) tuck_in(CarrierId(k));
  // The pattern counts on beds at home, unless it racks before anything else.
  const auto starts = std::find_if(fabric_.instructions.begin(), fabric_.instructions.end(),
                                   [](const Instruction& each) { return each.op != Op::in; });
  if (starts == fabric_.instructions.end() || starts->op != Op::rack) add_rack(0);
}

// As many of the needles as one pass can knit: of a tube those of one bed, of needles that face each other
// those of the first pass.
CastOnPass KnittableBuilder::needles_of_one_pass(const CastOnPass& first, Direction direction) const {
  CastOnPass pass{cast_on_.needles, direction};
  const auto face = [&](const Needle& a, const Needle& b) {
    return cast_on_.racking.order(a) == cast_on_.racking.order(b);
  };
  if (cast_on_.beds_apart) {
    std::erase_if(pass.needles, [&](const Needle& needle) {
      return is_front(needle.bed) != (direction == Direction::right);
    });
  } else if (std::adjacent_find(pass.needles.begin(), pass.needles.end(), face) != pass.needles.end()) {
    pass.needles = first.needles;
  }
  return pass;
}

// A further yarn: tucked over some of the loops that are cast on, all of one bed in a pass.
void KnittableBuilder::tuck_in(CarrierId id) {
  const Direction wanted = first_direction(id);
  const std::vector<CarrierId> own = renamed({id});
  const bool is_in =
      std::any_of(result_.program.instructions.begin(), result_.program.instructions.end(),
                  [&](const Instruction& each) { return names_needle(each) && each.carriers == own; });
  if (wanted == Direction::none || is_in) return;
  const Direction first = limits_.has_hook ? Direction::left : Direction::right;
  bring_in(id);
  CastOnPass pass{{}, first};
  while (true) {
    // in a tube the front goes to the right and the rear to the left
    const bool front =
        cast_on_.beds_apart ? pass.direction == Direction::right : is_front(cast_on_.needles.front().bed);
    pass.needles = tuck_needles(front, pass.direction == first, first);
    add_pass(pass, Op::tuck, id);
    if (pass.direction == first) release(id);
    if (pass.direction != wanted) return;
    pass.direction = pass.direction == Direction::right ? Direction::left : Direction::right;
  }
}

// Every fourth needle of a bed from where the first pass starts; on the way back those half-way between, none
// beyond the turn.
std::vector<Needle> KnittableBuilder::tuck_needles(bool front, bool out, Direction first) const {
  std::vector<Needle> bed;
  for (const Needle& needle : cast_on_.needles)
    if (is_front(needle.bed) == front) bed.push_back(needle);
  if (first == Direction::left) std::reverse(bed.begin(), bed.end());
  const std::size_t turn = (bed.size() - 1) / tuck_in_distance * tuck_in_distance;
  std::vector<Needle> needles;
  for (std::size_t k = out ? 0 : tuck_in_distance / 2; k <= turn; k += tuck_in_distance)
    needles.push_back(bed[k]);
  if (needles.empty()) needles.push_back(bed[turn]);
  if (first == Direction::left) std::reverse(needles.begin(), needles.end());
  return needles;
}

// The fabric's instructions as they stand, each with its place in the fabric file.
void KnittableBuilder::pattern() {
  const auto end = static_cast<std::size_t>(fabric_.repeat_starts.empty() ? 0 : fabric_.repeat_starts.back());
  result_.pattern_begin = static_cast<int>(result_.program.instructions.size());
  for (std::size_t k = 0; k < end; ++k) {
    const Instruction& from = fabric_.instructions[k];
    if (from.op == Op::in) continue;
    if (from.op == Op::rack) {
      add_rack(from.value);
      continue;
    }
    add(from.op) = from;
    result_.program.instructions.back().carriers = renamed(from.carriers);
    result_.program.source_marks.emplace_back(
        static_cast<int>(result_.program.instructions.size()) - 1,
        fabric_.file + ":" + std::to_string(from.at.line) + ":" + std::to_string(from.at.column));
  }
  result_.pattern_end = static_cast<int>(result_.program.instructions.size());
}

// The fabric's bind-off, if it has one, and some stitches on its last loop.
void KnittableBuilder::end() {
  const auto begin =
      static_cast<std::size_t>(fabric_.repeat_starts.empty() ? 0 : fabric_.repeat_starts.back());
  Instruction last;
  for (std::size_t k = begin; k < fabric_.instructions.size(); ++k) {
    const Instruction& from = fabric_.instructions[k];
    if (from.op == Op::out) continue;
    if (from.op == Op::rack) {
      add_rack(from.value);
      continue;
    }
    add(from.op) = from;
    result_.program.instructions.back().carriers = renamed(from.carriers);
    if (from.op == Op::knit) last = result_.program.instructions.back();
  }
  for (int k = 0; last.op == Op::knit && k < tail_stitches; ++k) {
    last.direction = last.direction == Direction::right ? Direction::left : Direction::right;
    add(Op::knit) = last;
  }
  add_rack(0);
  take_out_and_drop();
}

void KnittableBuilder::take_out_and_drop() {
  std::vector<CarrierId> used;
  for (const Instruction& instruction : result_.program.instructions)
    for (CarrierId id : instruction.carriers)
      if (std::find(used.begin(), used.end(), id) == used.end()) used.push_back(id);
  for (CarrierId id : used) add(limits_.has_hook ? Op::outhook : Op::out).carriers = {id};
  Diagnostics unsaid;  // whoever asked for the programme checks it
  for (const NeedleStack& stack : run_machine(result_.program, unsaid).held)
    add(Op::drop).needle = stack.needle;
}

}  // namespace

KnittableProgram make_knittable(const Program& fabric, MachineKind machine, Diagnostics& diagnostics) {
  return KnittableBuilder(fabric, machine, diagnostics).build();
}

}  // namespace loopwright
