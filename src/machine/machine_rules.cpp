#include "machine/machine_rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "machine/needle_table.hpp"
#include "machine/racking.hpp"
#include "notation/scan.hpp"

namespace loopwright {
namespace {

class RuleChecker {
 public:
  RuleChecker(const Program& program, MachineKind machine, Diagnostics& diagnostics)
      : program_(program), limits_(limits_of(machine)), diagnostics_(diagnostics) {}

  void run() {
    check_carriers_header();
    for (now_ = 0; now_ < program_.instructions.size(); ++now_) check(program_.instructions[now_]);
    if (!split_to_.empty()) error(last_split_, "loops split to sliders are never brought back" + to_needle());
    check_width();
    if (mixed_passes_ > 0)
      diagnostics_.warning(first_mixed_,
                           "a pass knits and tucks on one bed " + std::to_string(mixed_passes_) +
                               (mixed_passes_ == 1 ? " time" : " times") + ", first here: the " +
                               std::string(limits_.name) + " takes a pass for each");
  }

 private:
  void error(SourceLocation at, const std::string& message) {
    diagnostics_.error(at, std::string(limits_.name) + ": " + message);
  }
  std::string to_needle() const { return " from " + to_string(*split_to_.begin()); }

  void check(const Instruction& instruction);
  void check_carriers_header();
  void check_racking(const Instruction& instruction);
  void check_carrier_set(const Instruction& instruction);
  void check_sliders(const Instruction& instruction);
  void check_setting(const Instruction& instruction);
  void check_stitch_values(const Instruction& instruction);
  void check_table_number(const Instruction& instruction, const std::string& value, int first, int last,
                          const std::string& name);
  void check_width();
  void count_mixed_pass(const Instruction& instruction);

  const Program& program_;
  MachineLimits limits_;
  Diagnostics& diagnostics_;
  std::size_t now_ = 0;
  Racking racking_;
  long long leftmost_ = std::numeric_limits<long long>::max();  // slots that are used
  long long rightmost_ = std::numeric_limits<long long>::min();
  std::map<CarrierId, std::vector<CarrierId>> came_in_;  // the set that each carrier came in with
  std::vector<CarrierId> hook_;
  // Splits to sliders are one act with their way back (Shima).
  std::set<Needle> split_to_;
  std::optional<double> split_racking_, return_racking_;
  SourceLocation last_split_;
  // The pass under way, for machines that do one thing per bed and pass.
  std::vector<CarrierId> pass_set_;
  Direction pass_direction_ = Direction::none;
  long long pass_order_ = 0;
  std::optional<Op> on_bed_[2];
  int mixed_passes_ = 0;
  std::set<std::string> told_tables_;  // numbers beyond a table, by the extension's name
  SourceLocation first_mixed_;
};

void RuleChecker::check_carriers_header() {
  std::string wanted, given;
  for (int k = 1; k <= limits_.carriers; ++k) wanted += (k > 1 ? " " : "") + std::to_string(k);
  bool listed = false;
  for (const auto& [name, value] : program_.headers) {
    if (name != "Carriers") continue;
    listed = true;
    given = value;
  }
  if (!listed) return error({}, "the Carriers header is required: ';;Carriers: " + wanted + "'");
  std::string names;
  for (const std::string& name : program_.carriers) names += (names.empty() ? "" : " ") + name;
  if (names != wanted || given.find_first_of(",;") != std::string::npos)
    error({}, "the Carriers header must be '" + wanted + "'");
}

void RuleChecker::check(const Instruction& instruction) {
  check_carrier_set(instruction);
  check_sliders(instruction);
  if (names_needle(instruction) && instruction.op != Op::miss) count_mixed_pass(instruction);
  if (names_needle(instruction)) {
    const long long slot = is_front(instruction.needle.bed) ? instruction.needle.index
                                                            : racking_.front_index(instruction.needle.index);
    leftmost_ = std::min(leftmost_, slot);
    rightmost_ = std::max(rightmost_, slot);
  }
  switch (instruction.op) {
    case Op::rack:
      check_racking(instruction);
      break;
    case Op::inhook:
    case Op::releasehook:
    case Op::outhook:
      if (!limits_.has_hook)
        error(instruction.at, "the machine has no yarn inserting hook; write 'in' and 'out'");
      break;
    case Op::extension:
      check_setting(instruction);
      break;
    case Op::stitch:
      check_stitch_values(instruction);
      break;
    default:
      break;
  }
}

void RuleChecker::check_racking(const Instruction& instruction) {
  if (!std::isfinite(instruction.value) || std::abs(instruction.value) > 1e6) return;  // run_machine says so
  racking_ = Racking(instruction.value);
  const double fraction = instruction.value - std::floor(instruction.value);
  if (fraction != 0 && fraction != limits_.all_needle && !(limits_.all_needle == 0.5 && fraction == 0.25))
    error(instruction.at, "a racking is a whole number or one and " + to_string(Racking(limits_.all_needle)) +
                              ", not " + to_string(racking_));
  if (limits_.farthest_racking &&
      std::abs(instruction.value) > *limits_.farthest_racking + limits_.all_needle)
    error(instruction.at, "the bed goes " + to_string(Racking(*limits_.farthest_racking)) +
                              " needles to each side, not " + to_string(racking_));
}

void RuleChecker::check_carrier_set(const Instruction& instruction) {
  const std::vector<CarrierId>& set = instruction.carriers;
  switch (instruction.op) {
    case Op::in:
    case Op::inhook:
      for (CarrierId id : set) came_in_[id] = set;
      if (instruction.op == Op::inhook) hook_ = set;
      break;
    case Op::knit:
    case Op::tuck:
    case Op::miss:
    case Op::split:
      if (static_cast<int>(set.size()) > limits_.yarns_in_a_stitch)
        error(instruction.at, "a stitch takes at most " + std::to_string(limits_.yarns_in_a_stitch) +
                                  (limits_.yarns_in_a_stitch == 1 ? " yarn" : " yarns") + ", not " +
                                  std::to_string(set.size()));
      for (CarrierId id : set) {
        const auto found = came_in_.find(id);
        if (found == came_in_.end()) continue;
        // run_machine tells other sets; here the order counts too
        if (found->second != set &&
            std::is_permutation(set.begin(), set.end(), found->second.begin(), found->second.end()))
          error(instruction.at, "the first use must name the carriers in the order in which they came in");
        for (CarrierId other : std::vector<CarrierId>(found->second)) came_in_.erase(other);
      }
      break;
    case Op::releasehook:
      if (set != hook_ && std::is_permutation(set.begin(), set.end(), hook_.begin(), hook_.end()))
        error(instruction.at, "'releasehook' must name the carriers in the order in which they came in");
      hook_.clear();
      break;
    default:
      break;
  }
}

// On a Shima `split` to a slider and `xfer` from there are one act: all loops come back at one racking, one,
// two or four needles away, before anything else is done.
void RuleChecker::check_sliders(const Instruction& instruction) {
  const bool from = names_needle(instruction) && is_slider(instruction.needle.bed);
  const bool to = names_target(instruction) && is_slider(instruction.target.bed);
  if (!limits_.has_sliders) {
    if (from || to) error(instruction.at, "the machine has no sliders; use the needles of the other bed");
    return;
  }
  if (instruction.op == Op::split && to && !instruction.carriers.empty()) {
    if (return_racking_) error(instruction.at, "no loop can be split to a slider while others come back");
    if (split_racking_ && *split_racking_ != racking_.value())
      error(instruction.at, "loops that are split to sliders in one act need one racking");
    split_racking_ = racking_.value();
    if (!split_to_.insert(instruction.target).second)
      error(instruction.at, to_string(instruction.target) + " already holds a split loop");
    last_split_ = instruction.at;
    return;
  }
  if (split_to_.empty() || instruction.op == Op::rack) return;
  const bool moves =
      instruction.op == Op::xfer || (instruction.op == Op::split && instruction.carriers.empty());
  if (!moves || split_to_.erase(instruction.needle) == 0) {
    error(instruction.at,
          "loops that are split to sliders must come back before anything else" + to_needle());
    split_to_.clear();
  } else {
    const double way = std::abs(racking_.value() - split_racking_.value_or(0));
    if (return_racking_ && *return_racking_ != racking_.value())
      error(instruction.at, "loops that are split to sliders come back at one racking");
    if (!return_racking_ && way != 1 && way != 2 && way != 4)
      error(instruction.at, "loops that are split to sliders come back 1, 2 or 4 needles away, not " +
                                to_string(Racking(way)));
    return_racking_ = racking_.value();
  }
  if (split_to_.empty()) split_racking_.reset(), return_racking_.reset();
}

// Settings are numbers, on the Kniterate a digit or a letter.
// A Shima keeps leading and stitch values in a table of its own; the converter finds in it, by its place,
// what `stitch L T` asks for: whole numbers, of these pairs.
void RuleChecker::check_stitch_values(const Instruction& instruction) {
  if (!limits_.has_stitch_table) return;
  const double leading = instruction.value, stitch = instruction.value2;
  if (leading != std::floor(leading) || stitch != std::floor(stitch))
    return error(instruction.at, "the values of 'stitch' are whole numbers");
  const auto is_one_of = [&](std::initializer_list<double> values) {
    return std::find(values.begin(), values.end(), leading) != values.end();
  };
  const bool known = stitch == 10   ? is_one_of({-10, 0, 10})
                     : stitch == 15 ? is_one_of({5, 10, 15})
                     : stitch == 20 ? is_one_of({10, 15, 20})
                     : stitch == 25
                         ? is_one_of({15, 20, 25})
                         : std::fmod(stitch, 5) == 0 && stitch >= 30 && stitch <= 65 && leading == 25;
  if (!known)
    error(instruction.at, "its stitch table has no entry for 'stitch " + written_number(leading) + " " +
                              written_number(stitch) +
                              "'; take one that it has, e.g. 'stitch 25 35', or 'x-stitch-number'");
}

void RuleChecker::check_setting(const Instruction& instruction) {
  const std::string& text = instruction.text;
  const std::size_t blank = text.find_first_of(" \t");
  const std::string name = text.substr(0, blank);
  const std::size_t begin = blank == std::string::npos ? blank : text.find_first_not_of(" \t", blank);
  const std::string value = begin == std::string::npos ? "" : text.substr(begin);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (name == "x-speed-number" && limits_.has_stitch_table)
    check_table_number(instruction, value, 0, 15, name);
  if (name != "x-stitch-number" && name != "x-presser-mode") return;
  if (!limits_.has_hook && name == "x-stitch-number") {
    const bool good = value.size() == 1 && (is_digit(value[0]) || (value[0] >= 'A' && value[0] <= 'Z'));
    if (!good) error(instruction.at, "x-stitch-number is a digit or a capital letter");
  } else if (name == "x-stitch-number") {
    check_table_number(instruction, value, 1, 120, name);
  } else if (limits_.has_hook && value != "on" && value != "off" && value != "auto") {
    error(instruction.at, "x-presser-mode is on, off or auto");
  }
}

// A whole number; beyond the machine's table it is told, since the converter writes it all the same.
void RuleChecker::check_table_number(const Instruction& instruction, const std::string& value, int first,
                                     int last, const std::string& name) {
  const std::string digits = value.starts_with('+') ? value.substr(1) : value;
  const bool whole = !digits.empty() &&
                     std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!whole) return error(instruction.at, name + " is a whole number, not '" + value + "'");
  if (!limits_.has_stitch_table) return;
  const bool inside = digits.size() < 6 && std::stoi(digits) >= first && std::stoi(digits) <= last;
  if (inside || !told_tables_.insert(name).second) return;
  diagnostics_.warning(instruction.at, std::string(limits_.name) + ": " + name +
                                           " is a place in a table from " + std::to_string(first) + " to " +
                                           std::to_string(last) + ", not " + digits.substr(0, 20));
}

void RuleChecker::check_width() {
  int width = limits_.width;
  for (const auto& [name, value] : program_.headers)
    if (name == "Width" && !value.empty() && value.size() < 6 &&
        std::all_of(value.begin(), value.end(), [](char c) { return c >= '0' && c <= '9'; }))
      width = std::stoi(value);
  if (leftmost_ > rightmost_ || rightmost_ - leftmost_ < width) return;
  error({}, "the piece takes " + std::to_string(rightmost_ - leftmost_ + 1) + " needles, the bed has " +
                std::to_string(width));
}

// A Kniterate knits or tucks on a bed in one pass, and does not tuck on both.
void RuleChecker::count_mixed_pass(const Instruction& instruction) {
  if (limits_.has_hook) return;
  const long long order = racking_.order(instruction.needle);
  const bool advances = pass_direction_ == Direction::right ? order > pass_order_ : order < pass_order_;
  if (instruction.carriers.empty() || instruction.carriers != pass_set_ ||
      instruction.direction != pass_direction_ || !advances)
    on_bed_[0].reset(), on_bed_[1].reset();
  pass_set_ = instruction.carriers;
  pass_direction_ = instruction.direction;
  pass_order_ = order;
  if (pass_set_.empty() || (instruction.op != Op::knit && instruction.op != Op::tuck)) return;
  std::optional<Op>& own = on_bed_[is_front(instruction.needle.bed) ? 0 : 1];
  const std::optional<Op>& other = on_bed_[is_front(instruction.needle.bed) ? 1 : 0];
  const bool both_tuck = instruction.op == Op::tuck && other == Op::tuck;
  if (own.value_or(instruction.op) != instruction.op || both_tuck) {
    if (mixed_passes_++ == 0) first_mixed_ = instruction.at;
    on_bed_[0].reset(), on_bed_[1].reset();
  }
  own = instruction.op;
}

}  // namespace

MachineLimits limits_of(MachineKind machine) {
  if (machine == MachineKind::kniterate)
    return {.name = "Kniterate", .carriers = 6, .width = 252, .all_needle = 0.5, .farthest_racking = {}};
  return {.name = "Shima",
          .carriers = 10,
          .width = 540,
          .all_needle = 0.25,
          .farthest_racking = 8,
          .yarns_in_a_stitch = 2,
          .has_hook = true,
          .has_sliders = true,
          .has_stitch_table = true};
}

std::optional<MachineKind> machine_named(std::string_view name) {
  if (name == "shima") return MachineKind::shima;
  if (name == "kniterate") return MachineKind::kniterate;
  return std::nullopt;
}

void check_machine_rules(const Program& program, MachineKind machine, Diagnostics& diagnostics) {
  RuleChecker(program, machine, diagnostics).run();
}

}  // namespace loopwright
