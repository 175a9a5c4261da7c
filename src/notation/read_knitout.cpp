#include "notation/read_knitout.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "notation/fabric_headers.hpp"
#include "notation/material.hpp"
#include "notation/scan.hpp"

namespace loopwright {
namespace {

constexpr std::string_view magic = ";!knitout-";
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
                                                            "x-add-roller-advance",
                                                            "x-carrier-spacing",
                                                            "x-xfer-style",
                                                            "x-end-pass",
                                                            "x-carrier-stopping-distance",
                                                            "x-vis-color",
                                                            "x-yarn-in",
                                                            "x-yarn-out",
                                                            "x-loop-in",
                                                            "x-loop-out",
                                                            "x-end"};

constexpr std::array<std::string_view, 6> known_headers{"Carriers", "Machine", "Gauge",
                                                        "Position", "Width",   "Presser"};

class KnitoutReader {
 public:
  KnitoutReader(std::string_view text, Diagnostics& diagnostics) : lines_(text), diagnostics_(diagnostics) {
    program_.file = diagnostics.file();
    program_.instructions.reserve(std::min(most_instructions, text.size() / 10));
  }

  Program program() {
    TextLine line;
    while (!full_ && lines_.next(line)) {
      line_ = line.number;
      if (line.carriage_return && !said_carriage_return_) {
        said_carriage_return_ = true;
        warning(static_cast<int>(line.text.size()) + 1,
                "the line ends with CR LF; knitout wants LF alone, convert the line ends");
      }
      if (line_ == 1) {
        read_magic(line.text);
      } else if (in_headers_ && is_header(line.text)) {
        read_header(line.text);
      } else {
        end_headers();
        read_line(line.text);
      }
    }
    if (line_ == 0) error(0, "the file is empty; a knitout file starts with ';!knitout-2'");
    end_headers();
    program_.yarns.resize(program_.carriers.size());
    return std::move(program_);
  }

 private:
  void error(int column, std::string message) { say(Severity::error, column, std::move(message)); }
  void warning(int column, std::string message) { say(Severity::warning, column, std::move(message)); }
  void say(Severity severity, int column, std::string message) {
    if (!source_mark_.empty()) message += " [source: " + printable(source_mark_.substr(0, 200)) + "]";
    diagnostics_.add({severity, {line_, column}, std::move(message)});
  }

  void read_magic(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) {
      warning(1, "the file starts with a byte-order mark; save it as UTF-8 without one");
      text.remove_prefix(3);
    }
    if (!text.starts_with(magic)) {
      error(1, "the first line is not ';!knitout-2' but " + quoted(text) +
                   "; put ';!knitout-2' before everything");
      if (is_header(text)) {
        read_header(text);
      } else {
        end_headers();
        read_line(text);
      }
      return;
    }
    const auto version = parsed_integer(trimmed(text.substr(magic.size())));
    if (!version || *version < 0) {
      error(static_cast<int>(magic.size()) + 1, "expected a whole number as version, not " +
                                                    quoted(text.substr(magic.size())) +
                                                    "; write ';!knitout-2'");
      return;
    }
    program_.version = *version;
    if (*version > 2) {
      warning(static_cast<int>(magic.size()) + 1,
              "version " + std::to_string(*version) +
                  " is newer than 2, the newest known; it is read as version 2");
    }
  }

  // `;;Name: value`; a `;;` line without `: ` is a comment and ends the headers.
  static bool is_header(std::string_view text) {
    return text.starts_with(";;") && text.find(": ") != std::string_view::npos && text.find(": ") > 2;
  }

  void read_header(std::string_view text) {
    const std::size_t colon = text.find(": ");
    const std::string_view name = text.substr(2, colon - 2);
    const std::string_view value = trimmed(text.substr(colon + 2));
    const int column = static_cast<int>(colon) + 3;
    const auto same = [&](const auto& header) { return header.first == name; };
    if (program_.headers.size() < 1000) {
      if (std::any_of(program_.headers.begin(), program_.headers.end(), same)) {
        warning(3,
                "header " + quoted(name) + " is given a second time; the last one counts, remove the others");
      }
      program_.headers.emplace_back(name, value);
    }
    if (name == "Carriers") {
      read_carriers(value, column);
    } else if (name == "Gauge") {
      const Quantity gauge = parsed_quantity(value, Dimension::gauge);
      if (gauge.problem.empty() && gauge.value > 0)
        program_.settings.gauge_npi = gauge.value;
      else
        warning(column,
                "the gauge is not understood and left out: " + quoted(value) + "; write needles per inch");
    } else if (name.starts_with("X-")) {
      // our own settings travel in X- headers, so that a fabric file written as knitout keeps them
      if (is_fabric_header(name.substr(2))) {
        read_fabric_header(name.substr(2), value, {line_, column}, program_.settings, diagnostics_);
      }
    } else if (!name.starts_with("Yarn-") &&
               std::find(known_headers.begin(), known_headers.end(), name) == known_headers.end()) {
      warning(3, "unknown header " + quoted(name) + " is left out; own headers start with 'X-'");
    }
  }

  // Rails front to back, blank-separated; `L1,L2;R1,R2` names several carriers of one rail.
  void read_carriers(std::string_view value, int column) {
    has_carriers_header_ = true;
    program_.carriers.clear();
    std::size_t at = 0;
    while (at < value.size()) {
      const std::size_t end = std::min(value.find_first_of(" \t,;", at), value.size());
      if (end > at && !declare_carrier(value.substr(at, end - at), column + static_cast<int>(at))) return;
      at = end + 1;
    }
    if (program_.carriers.empty())
      error(column, "the Carriers header names no carrier; list them front to back");
  }

  bool declare_carrier(std::string_view name, int column) {
    if (carrier(name).valid()) {
      error(column, "carrier " + quoted(name) + " is listed twice; name each carrier once");
    } else if (program_.carriers.size() == most_carriers) {
      error(column, "more than " + std::to_string(most_carriers) + " carriers; the rest is left out");
      return false;
    } else {
      program_.carriers.emplace_back(name);
    }
    return true;
  }

  CarrierId carrier(std::string_view name) const {
    const auto found = std::find(program_.carriers.begin(), program_.carriers.end(), name);
    return found == program_.carriers.end() ? CarrierId()
                                            : CarrierId(std::size_t(found - program_.carriers.begin()));
  }

  // Once, when the body starts: a missing Carriers header, and what Yarn- headers say of the carriers.
  void end_headers() {
    if (!in_headers_) return;
    in_headers_ = false;
    if (!has_carriers_header_) {
      error(0, "the Carriers header is missing; add e.g. ';;Carriers: 1 2 3' after the first line");
    }
    program_.yarns.resize(program_.carriers.size());
    for (const auto& [name, value] : program_.headers) {
      if (!name.starts_with("Yarn-")) continue;
      const CarrierId id = carrier(std::string_view(name).substr(5));
      // the value is free text in knitout; it counts where it names a material of ours
      if (id.valid()) read_yarn_if_known(value, program_.yarns[id.position()]);
    }
  }

  void read_line(std::string_view text) {
    const std::size_t semicolon = text.find(';');
    if (semicolon != std::string_view::npos) {
      const std::string_view comment = text.substr(semicolon + 1);
      if (comment.starts_with("!source:")) source_mark_ = trimmed(comment.substr(8));
      text = text.substr(0, semicolon);
    }
    WordReader words(text);
    Word name;
    if (words.next(name)) {
      if (program_.instructions.size() == most_instructions) {
        error(0, "more than " + std::to_string(most_instructions) + " operations; the rest is not read");
        full_ = true;
        return;
      }
      Instruction instruction;
      instruction.at = {line_, name.column};
      if (read_operation(name, words, trimmed(text), instruction)) {
        if (!source_mark_.empty()) {
          program_.source_marks.emplace_back(static_cast<int>(program_.instructions.size()), source_mark_);
        }
        program_.instructions.push_back(std::move(instruction));
      }
    }
    source_mark_ = {};
  }

  bool read_operation(const Word& name, WordReader& words, std::string_view text, Instruction& instruction) {
    if (name.text.starts_with("x-")) return read_extension(name, words, text, instruction);
    const auto known = std::find_if(operations.begin(), operations.end(),
                                    [&](const Operation& operation) { return operation.name == name.text; });
    if (known == operations.end()) {
      error(name.column,
            "unknown operation " + quoted(name.text) +
                "; knitout knows knit, tuck, split, miss, drop, "
                "amiss, xfer, rack, stitch, pause, in, inhook, releasehook, out, outhook and x-...");
      return false;
    }
    instruction.op = known->op;
    switch (known->op) {
      case Op::knit:
      case Op::tuck:
      case Op::miss:
        return read_direction(words, instruction) && read_needle(words, instruction.needle) &&
               read_carrier_set(words, instruction, false);
      case Op::split:
        return read_direction(words, instruction) && read_needle(words, instruction.needle) &&
               read_needle(words, instruction.target) && read_carrier_set(words, instruction, false);
      case Op::xfer:
        return read_needle(words, instruction.needle) && read_needle(words, instruction.target) &&
               read_end(words);
      case Op::drop:
      case Op::amiss:
        return read_needle(words, instruction.needle) && read_end(words);
      case Op::rack:
        return read_racking(words, instruction) && read_end(words);
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

  bool expected(const WordReader& words, std::string_view what) {
    error(words.column(), "the line ends where " + std::string(what) + " was expected; add it");
    return false;
  }

  bool read_direction(WordReader& words, Instruction& instruction) {
    Word word;
    if (!words.next(word)) return expected(words, "a direction (+ or -)");
    if (word.text == "+") {
      instruction.direction = Direction::right;
    } else if (word.text == "-") {
      instruction.direction = Direction::left;
    } else {
      const bool typographic = word.text == "\xe2\x88\x92" || word.text == "\xe2\x80\x93";
      error(word.column, "expected a direction, + or -, not " + quoted(word.text) +
                             (typographic ? "; this is a typographic minus, type the plain '-'" : ""));
      return false;
    }
    return true;
  }

  bool read_needle(WordReader& words, Needle& needle) {
    Word word;
    if (!words.next(word)) return expected(words, "a needle such as f3 or bs-2");
    std::string_view rest = word.text;
    const bool front = rest.starts_with('f');
    const bool known_bed = front || rest.starts_with('b');
    if (known_bed) rest.remove_prefix(1);
    const bool slider = known_bed && rest.starts_with('s');
    if (slider) rest.remove_prefix(1);
    const bool has_digits = rest.find_first_of("0123456789") != std::string_view::npos;
    const auto index = parsed_integer(rest);
    // all digits, yet no index: it does not fit into an int
    const bool huge = known_bed && !index && has_digits &&
                      rest.find_first_not_of("+-0123456789") == rest.npos &&
                      rest.find_last_of("+-") == (rest.find_first_of("+-") == 0 ? 0 : rest.npos);
    if ((known_bed && index && (*index > largest_needle || *index < -largest_needle)) || huge) {
      error(word.column, "needle " + quoted(word.text) + " is out of range; needles run from -" +
                             std::to_string(largest_needle) + " to " + std::to_string(largest_needle));
      return false;
    }
    if (!known_bed || !index) {
      error(word.column,
            "expected a needle (f, fs, b or bs and a number, e.g. f3), not " + quoted(word.text));
      return false;
    }
    needle.bed = front ? (slider ? Bed::front_slider : Bed::front) : (slider ? Bed::back_slider : Bed::back);
    needle.index = *index;
    return true;
  }

  bool read_number(WordReader& words, std::string_view what, double& value) {
    Word word;
    if (!words.next(word)) return expected(words, "a " + std::string(what));
    const auto number = parsed_number(word.text);
    if (!number) {
      error(word.column,
            "expected a " + std::string(what) + " (a number such as -0.25), not " + quoted(word.text));
      return false;
    }
    value = *number;
    return true;
  }

  bool read_racking(WordReader& words, Instruction& instruction) {
    if (!read_number(words, "racking", instruction.value)) return false;
    if (instruction.value > largest_racking || instruction.value < -largest_racking) {
      error(instruction.at.column,
            "racking is out of range; it is counted in needles, at most " + std::to_string(largest_needle));
      return false;
    }
    instruction.value += 0.0;  // -0 becomes 0
    return true;
  }

  bool read_carrier_set(WordReader& words, Instruction& instruction, bool needed) {
    Word word;
    while (words.next(word)) {
      CarrierId id = carrier(word.text);
      if (!id.valid()) {
        if (word.text.find(',') != std::string_view::npos) {
          error(word.column,
                "carrier name " + quoted(word.text) + " holds a comma; separate carriers by blanks");
          return false;
        }
        // reported at its first use; from then on the carrier counts as listed, so that reading goes on
        if (has_carriers_header_) {
          error(word.column, "carrier " + quoted(word.text) + " is not in the Carriers header; add it there");
        }
        if (program_.carriers.size() == most_carriers) {
          if (!has_carriers_header_)
            error(word.column, "more than " + std::to_string(most_carriers) + " carriers");
          return false;
        }
        id = CarrierId(program_.carriers.size());
        program_.carriers.emplace_back(word.text);
      }
      if (std::find(instruction.carriers.begin(), instruction.carriers.end(), id) !=
          instruction.carriers.end()) {
        error(word.column, "carrier " + quoted(word.text) + " is named twice in one set; name it once");
        return false;
      }
      instruction.carriers.push_back(id);
    }
    return !needed || !instruction.carriers.empty() || expected(words, "a carrier");
  }

  bool read_end(WordReader& words) {
    Word word;
    if (!words.next(word)) return true;
    error(word.column, quoted(word.text) + " is too much here; remove it, or put ';' before a comment");
    return false;
  }

  bool read_extension(const Word& name, WordReader& words, std::string_view text, Instruction& instruction) {
    constexpr std::size_t longest = 1000;
    if (std::find(known_extensions.begin(), known_extensions.end(), name.text) == known_extensions.end() &&
        warned_extensions_.size() < 1000 && warned_extensions_.emplace(name.text.substr(0, longest)).second) {
      warning(name.column, "unknown extension " + quoted(name.text) + " is left without effect");
    }
    instruction.op = Op::extension;
    instruction.text = text.substr(0, longest);
    Word argument;
    if (!words.next(argument)) return true;
    if (const auto number = parsed_number(argument.text)) instruction.value = *number;
    if (name.text == "x-vis-color" && is_colour(argument.text)) {
      Word word;
      while (words.next(word)) {
        const CarrierId id = carrier(word.text);
        if (!id.valid()) continue;
        instruction.carriers.push_back(id);
        if (id.position() < program_.yarns.size()) program_.yarns[id.position()].colour = argument.text;
      }
    }
    return true;
  }

  LineReader lines_;
  Diagnostics& diagnostics_;
  Program program_;
  int line_ = 0;
  bool in_headers_ = true, has_carriers_header_ = false, said_carriage_return_ = false, full_ = false;
  std::string_view source_mark_;
  std::set<std::string, std::less<>> warned_extensions_;
};

}  // namespace

Program read_knitout(std::string_view text, Diagnostics& diagnostics) {
  return KnitoutReader(text, diagnostics).program();
}

}  // namespace loopwright
