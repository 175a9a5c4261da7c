#include "notation/knitout_operation.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "notation/knitout_headers.hpp"
#include "notation/material.hpp"
#include "notation/read_knitout.hpp"

namespace loopwright {
namespace {

constexpr double largest_racking = 10'000;

struct Operation {
  std::string_view name;
  Op op;
};
constexpr std::array operations{
    Operation{"knit", Op::knit},       Operation{"rack", Op::rack},
    Operation{"xfer", Op::xfer},       Operation{"drop", Op::drop},
    Operation{"miss", Op::miss},       Operation{"tuck", Op::tuck},
    Operation{"split", Op::split},     Operation{"in", Op::in},
    Operation{"out", Op::out},         Operation{"inhook", Op::inhook},
    Operation{"outhook", Op::outhook}, Operation{"releasehook", Op::releasehook},
    Operation{"stitch", Op::stitch},   Operation{"pause", Op::pause},
    Operation{"amiss", Op::amiss},
};

// Extensions that converters know (extensions.html of the specification, the Kniterate converter, the
// visualizer).
constexpr std::array<std::string_view, 17> known_extensions{"x-stitch-number",
                                                            "x-xfer-stitch-number",
                                                            "x-speed-number",
                                                            "x-sub-roller-number",
                                                            "x-presser-mode",
                                                            "x-roller-advance",
                                                            "x-carrier-spacing",
                                                            "x-add-roller-advance",
                                                            "x-xfer-style",
                                                            "x-end-pass",
                                                            "x-vis-color",
                                                            "x-carrier-stopping-distance",
                                                            "x-yarn-in",
                                                            "x-yarn-out",
                                                            "x-loop-in",
                                                            "x-loop-out",
                                                            "x-end"};

// What the word of a needle says: a bed, then an index, which may not fit into an int.
struct NeedleWord {
  bool bed_known = false, whole_number = false;
  Bed bed = Bed::front;
  std::optional<int> index;
};

NeedleWord needle_word(std::string_view word) {
  NeedleWord said;
  const bool front = word.starts_with('f');
  said.bed_known = front || word.starts_with('b');
  if (!said.bed_known) return said;
  word.remove_prefix(1);
  const bool slider = word.starts_with('s');
  if (slider) word.remove_prefix(1);
  said.bed = front ? (slider ? Bed::front_slider : Bed::front) : (slider ? Bed::back_slider : Bed::back);
  said.index = parsed_integer(word);
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  said.whole_number = !word.empty() && std::all_of(word.begin(), word.end(), is_digit);
  return said;
}

std::string hint_of_needle(std::string_view word) {
  const std::string small = lower_case(word.substr(0, 20));
  if (small != word && needle_word(small).index) return "; beds are written small, '" + small + "'";
  if (small == "f" || small == "b" || small == "fs" || small == "bs")
    return "; its number follows without a blank, e.g. '" + small + "3'";
  return {};
}

}  // namespace

bool KnitoutOperations::read(std::string_view text, Instruction& instruction) {
  WordReader words(text);
  Word name;
  if (!words.next(name)) return false;
  instruction.at = {report_.line, name.column};
  if (name.text.starts_with("x-")) return read_extension(name, words, trimmed(text), instruction);
  const auto known = std::find_if(operations.begin(), operations.end(),
                                  [&](const Operation& operation) { return operation.name == name.text; });
  if (known == operations.end()) {
    std::vector<std::string_view> names;
    for (const Operation& each : operations) names.push_back(each.name);
    const std::string_view meant = word_meant(name.text, names);
    report_.error(name.column, "unknown operation " + quoted(name.text) +
                                   (meant.empty() ? "" : "; write '" + std::string(meant) + "'") +
                                   "; knitout knows knit, tuck, split, miss, drop, amiss, xfer, rack, "
                                   "stitch, pause, in, inhook, releasehook, out, outhook and x-...");
    return false;
  }
  instruction.op = known->op;
  return read_arguments(words, instruction);
}

bool KnitoutOperations::read_arguments(WordReader& words, Instruction& instruction) {
  switch (instruction.op) {
    case Op::knit:
    case Op::tuck:
    case Op::miss:
      return read_direction(words, instruction.direction) && read_needle(words, instruction.needle) &&
             read_carrier_set(words, instruction, false);
    case Op::split:
      return read_direction(words, instruction.direction) && read_needle(words, instruction.needle) &&
             read_needle(words, instruction.target) && read_carrier_set(words, instruction, false);
    case Op::xfer:
      return read_needle(words, instruction.needle) && read_needle(words, instruction.target) &&
             read_end(words);
    case Op::drop:
    case Op::amiss:
      return read_needle(words, instruction.needle) && read_end(words);
    case Op::rack:
      return read_racking(words, instruction.value) && read_end(words);
    case Op::stitch:
      return read_number(words, "leading stitch value", instruction.value) &&
             read_number(words, "trailing stitch value", instruction.value2) && read_end(words);
    case Op::pause:
      return read_end(words);
    case Op::in:
    case Op::inhook:
    case Op::releasehook:
    case Op::out:
    case Op::outhook:
      return read_carrier_set(words, instruction, true);
    case Op::extension:
      break;
  }
  return false;
}

bool KnitoutOperations::expected(const WordReader& words, std::string_view what) {
  report_.error(words.column(), "the line ends where " + std::string(what) + " was expected; add it");
  return false;
}

bool KnitoutOperations::read_direction(WordReader& words, Direction& direction) {
  Word word;
  if (!words.next(word)) return expected(words, "a direction (+ or -)");
  if (word.text == "+") {
    direction = Direction::right;
  } else if (word.text == "-") {
    direction = Direction::left;
  } else {
    const bool typographic = word.text == "\xe2\x88\x92" || word.text == "\xe2\x80\x93";
    report_.error(word.column,
                  "expected a direction, + or -, not " + quoted(word.text) +
                      (typographic                    ? "; this is a typographic minus, type the plain '-'"
                       : needle_word(word.text).index ? "; the direction stands before the needle, e.g. '+ " +
                                                            std::string(word.text) + "'"
                                                      : ""));
    return false;
  }
  return true;
}

bool KnitoutOperations::read_needle(WordReader& words, Needle& needle) {
  Word word;
  if (!words.next(word)) return expected(words, "a needle such as f3 or bs-2");
  const NeedleWord said = needle_word(word.text);
  if (said.index && *said.index <= largest_needle && *said.index >= -largest_needle) {
    needle = {said.bed, *said.index};
    const std::size_t plus = word.text.find('+');
    if (plus != std::string_view::npos)
      report_.error(word.column + static_cast<int>(plus),
                    "a needle's number has no '+'; write '" + to_string(needle) + "'");
    return true;
  }
  report_.error(word.column, said.whole_number
                                 ? "needle " + quoted(word.text) + " is out of range; needles run from -" +
                                       std::to_string(largest_needle) + " to " +
                                       std::to_string(largest_needle)
                                 : "expected a needle (f, fs, b or bs and a number, e.g. f3), not " +
                                       quoted(word.text) + hint_of_needle(word.text));
  return false;
}

bool KnitoutOperations::read_number(WordReader& words, std::string_view what, double& value) {
  Word word;
  if (!words.next(word)) return expected(words, "a " + std::string(what));
  const auto number = parsed_number(word.text);
  if (!number) {
    report_.error(word.column,
                  "expected a " + std::string(what) + " (a number such as -0.25), not " + quoted(word.text) +
                      (word.text.find(',') != std::string_view::npos ? "; write a point for the comma" : ""));
    return false;
  }
  value = *number;
  return true;
}

bool KnitoutOperations::read_racking(WordReader& words, double& racking) {
  if (!read_number(words, "racking", racking)) return false;
  if (racking > largest_racking || racking < -largest_racking) {
    report_.error(words.column(), "racking is out of range; it is counted in needles, at most " +
                                      std::to_string(largest_needle));
    return false;
  }
  racking += 0.0;  // -0 becomes 0
  return true;
}

bool KnitoutOperations::read_carrier_set(WordReader& words, Instruction& instruction, bool needed) {
  Word word;
  while (words.next(word)) {
    CarrierId id = carrier_named(program_, word.text);
    if (!id.valid()) id = carrier_met(word);
    if (!id.valid()) return false;
    if (std::find(instruction.carriers.begin(), instruction.carriers.end(), id) !=
        instruction.carriers.end()) {
      report_.error(word.column, "carrier " + quoted(word.text) + " is named twice in one set; name it once");
      return false;
    }
    instruction.carriers.push_back(id);
  }
  return !needed || !instruction.carriers.empty() || expected(words, "a carrier");
}

// A carrier that no header lists: said at its first use; from then on it counts as listed, so that reading
// goes on. Not valid if it cannot be a carrier.
CarrierId KnitoutOperations::carrier_met(const Word& word) {
  if (word.text.starts_with('#') || word.text.starts_with("//")) {
    report_.error(word.column, quoted(word.text) + " starts no comment in knitout; write ';'");
    return {};
  }
  if (word.text.find(',') != std::string_view::npos) {
    report_.error(word.column,
                  "carrier name " + quoted(word.text) + " holds a comma; separate carriers by blanks");
    return {};
  }
  if (holds_control_byte(word.text)) {
    report_.error(word.column, "carrier name " + quoted(word.text) + " holds a control character; remove it");
    return {};
  }
  if (list_carriers_)
    report_.error(word.column,
                  "carrier " + quoted(word.text) + " is not in the Carriers header; add it there");
  if (program_.carriers.size() == most_carriers) {
    if (!list_carriers_)
      report_.error(word.column, "more than " + std::to_string(most_carriers) + " carriers");
    return {};
  }
  program_.carriers.emplace_back(word.text);
  return CarrierId(program_.carriers.size() - 1);
}

bool KnitoutOperations::read_end(WordReader& words) {
  Word word;
  if (!words.next(word)) return true;
  report_.error(word.column, quoted(word.text) + " is too much here; remove it, or put ';' before a comment");
  return false;
}

bool KnitoutOperations::read_extension(const Word& name, WordReader& words, std::string_view text,
                                       Instruction& instruction) {
  constexpr std::size_t longest = 1000;
  if (std::find(known_extensions.begin(), known_extensions.end(), name.text) == known_extensions.end() &&
      warned_extensions_.size() < 1000 && warned_extensions_.emplace(name.text.substr(0, longest)).second) {
    report_.warning(name.column, "unknown extension " + quoted(name.text) + " is left without effect");
  }
  instruction.op = Op::extension;
  instruction.text = text.substr(0, longest);
  Word argument;
  if (!words.next(argument)) return true;
  if (const auto number = parsed_number(argument.text)) instruction.value = *number;
  if (name.text == "x-vis-color" && is_colour(argument.text)) {
    Word word;
    while (words.next(word)) {
      const CarrierId id = carrier_named(program_, word.text);
      if (!id.valid()) continue;
      instruction.carriers.push_back(id);
      if (id.position() < program_.yarns.size()) program_.yarns[id.position()].colour = argument.text;
    }
  }
  return true;
}

}  // namespace loopwright
