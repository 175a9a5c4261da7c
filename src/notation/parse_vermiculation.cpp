// A fabric file as a whole: magic line, headers, brackets. Course lines are parse_course's; grammar in
// docs/notation.md.
#include <algorithm>

#include "notation/fabric_headers.hpp"
#include "notation/material.hpp"
#include "notation/parse_course.hpp"
#include "notation/scan.hpp"
#include "notation/vermiculation.hpp"

namespace loopwright {

namespace {

constexpr std::string_view magic = ";!vermiculation-";
constexpr std::size_t most_lines = 100'000;            // the same in lines
constexpr std::size_t most_written_lines = 1'000'000;  // kept as they stand; beyond, layout is not kept
constexpr std::size_t most_yarns = 26;
constexpr std::size_t deepest_bracket = 32;

class VermiculationParser {
 public:
  VermiculationParser(std::string_view text, Diagnostics& diagnostics)
      : whole_(text), lines_(text), diagnostics_(diagnostics) {
    result_.file = diagnostics.file();
  }

  Vermiculation vermiculation() {
    TextLine line;
    while (!full_ && lines_.next(line)) {
      line_ = line.number;
      text_ = line.text;
      if (line.carriage_return && !said_carriage_return_) {
        said_carriage_return_ = true;
        diagnostics_.warning(here(text_.size()), "the line ends with CR LF; convert the line ends to LF");
      }
      written_ = {};
      read_line();
      written_.text = written_.kind == WrittenLine::Kind::magic ? text_ : line.text;
      written_.end = end_of(line);
      if (result_.written.size() < most_written_lines) result_.written.push_back(std::move(written_));
    }
    if (line_ == 0)
      diagnostics_.error({}, "the file is empty; a fabric file starts with ';!vermiculation-1'");
    if (!open_brackets_.empty()) {
      diagnostics_.error(open_brackets_.back().at,
                         "this '[' is never closed; add a line ']*2' where the repeat ends");
    }
    if (result_.written.size() == most_written_lines) result_.written.clear();
    end_headers();
    return std::move(result_);
  }

 private:
  SourceLocation here(std::size_t index) const { return {line_, static_cast<int>(index) + 1}; }
  void error(std::size_t index, std::string message) { diagnostics_.error(here(index), std::move(message)); }

  // Line feed and carriage returns that follow the line's text.
  std::string_view end_of(const TextLine& line) const {
    const auto end = static_cast<std::size_t>(line.text.data() + line.text.size() - whole_.data());
    const std::size_t feed = whole_.find('\n', end);
    return whole_.substr(end, feed == std::string_view::npos ? feed : feed + 1 - end);
  }

  void read_line() {
    if (line_ == 1 && read_magic()) {
      written_.kind = WrittenLine::Kind::magic;
    } else if (text_.starts_with(";;") && read_header()) {
      // after the first course it has no effect: a comment
      if (!headers_ended_) written_.kind = WrittenLine::Kind::header;
    } else {
      text_ = text_.substr(0, text_.find(';'));
      if (!trimmed(text_).empty()) read_course_or_bracket();
    }
  }

  // Whether the first line was the magic line; anything else is read as what it is, after saying so.
  bool read_magic() {
    if (text_.starts_with("\xef\xbb\xbf")) {
      diagnostics_.warning(here(0), "the file starts with a byte-order mark; save it as UTF-8 without one");
      result_.byte_order_mark = true;
      text_.remove_prefix(3);
    }
    if (!text_.starts_with(magic)) {
      error(0, "the first line is not ';!vermiculation-1' but " + quoted(text_) +
                   "; put ';!vermiculation-1' before everything");
      return false;
    }
    const auto version = parsed_integer(trimmed(text_.substr(magic.size())));
    if (!version || *version < 1) {
      error(magic.size(), "expected a version number, not " + quoted(text_.substr(magic.size())) +
                              "; write ';!vermiculation-1'");
    } else {
      result_.version = *version;
      if (*version > 1)
        diagnostics_.warning(here(magic.size()), "this version is newer than 1, the newest known");
    }
    return true;
  }

  // `;;Name: value ; comment`. Whether the line was a header; other lines with `;;` are comments.
  bool read_header() {
    std::size_t end = 2;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '-')) ++end;
    const std::string_view name = text_.substr(2, end - 2);
    if (end == 2 || end == text_.size() || text_[end] != ':') {
      if (!headers_ended_ && is_known(name))
        diagnostics_.warning(here(end), "there is no ':' after " + quoted(name) +
                                            ", so the line counts as a comment; write ';;" +
                                            std::string(name) + ": ...'");
      return false;
    }
    std::size_t begin = end + 1;
    while (begin < text_.size() && is_blank(text_[begin])) ++begin;
    const std::string_view rest = text_.substr(begin);
    const std::string_view value = trimmed(rest.substr(0, rest.find(';')));
    const bool is_yarn = name.starts_with("Yarn-");
    if (headers_ended_) {
      if (is_known(name)) {
        diagnostics_.warning(here(2),
                             "header " + quoted(name) + " after the first course has no effect; move it up");
      }
      return true;
    }
    const auto same = [&](const auto& header) { return header.first == name; };
    if (std::any_of(result_.headers.begin(), result_.headers.end(), same)) {
      diagnostics_.warning(here(2),
                           "header " + quoted(name) + " is given a second time; the last one counts");
    }
    if (result_.headers.size() < 1000) result_.headers.emplace_back(name, value);
    if (value.empty() && !is_yarn && is_known(name)) {
      error(begin, "header " + quoted(name) + " has no value; write one after the colon or remove the line");
    } else if (is_fabric_header(name)) {
      read_fabric_header(name, value, here(begin), result_.settings, diagnostics_);
    } else if (is_yarn) {
      read_yarn_header(name.substr(5), value, begin);
    } else if (name == "Carriers") {
      read_carriers(value, begin);
    } else if (name == "Gating") {
      if (value == "opposite")
        result_.gating = Gating::opposite;
      else if (value == "half-pitch")
        result_.gating = Gating::half_pitch;
      else
        error(begin, "gating is opposite or half-pitch, not " + quoted(value));
    } else if (!name.starts_with("X-")) {
      std::vector<std::string_view> known(fabric_headers().begin(), fabric_headers().end());
      known.insert(known.end(), {"Carriers", "Gating"});
      const std::string_view meant =
          lower_case(name).starts_with("yarn-") ? "Yarn-" : word_meant(name, known);
      diagnostics_.warning(here(2), "unknown header " + quoted(name) + " has no effect; " +
                                        (meant.empty() ? "own headers start with 'X-'"
                                                       : "write '" + std::string(meant) + "'"));
    }
    return true;
  }

  static bool is_known(std::string_view name) {
    return name.starts_with("Yarn-") || name == "Carriers" || name == "Gating" || is_fabric_header(name);
  }

  void read_yarn_header(std::string_view name, std::string_view value, std::size_t value_index) {
    if (name.empty() || !is_letter(name.front()) || name.size() > 20 || name.find('-') != name.npos) {
      return error(7, "a yarn's name is a letter, then letters or digits, e.g. ';;Yarn-A: wool 2/28 Nm'");
    }
    VermiculationYarn* yarn = find_yarn(name);
    if (!yarn) {
      if (result_.yarns.size() == most_yarns) {
        return error(7, "more than " + std::to_string(most_yarns) + " yarns; remove those that are not used");
      }
      yarn = &result_.yarns.emplace_back();
      yarn->name = name;
    }
    yarn->at = here(7);
    yarn->data = {};
    read_yarn(value, here(value_index), yarn->data, diagnostics_);
  }

  void read_carriers(std::string_view value, std::size_t value_index) {
    result_.carriers.clear();
    WordReader words(value, static_cast<int>(value_index) + 1);
    Word word;
    while (words.next(word)) {
      if (word.text.find_first_of(",;") != std::string_view::npos) {
        diagnostics_.error({line_, word.column}, "separate the carriers by blanks alone");
      } else if (std::find(result_.carriers.begin(), result_.carriers.end(), word.text) !=
                 result_.carriers.end()) {
        diagnostics_.error({line_, word.column}, "carrier " + quoted(word.text) + " is named twice");
      } else if (result_.carriers.size() < most_yarns) {
        result_.carriers.emplace_back(word.text);
      }
    }
    carriers_at_ = here(value_index);
  }

  VermiculationYarn* find_yarn(std::string_view name) {
    for (VermiculationYarn& yarn : result_.yarns) {
      if (yarn.name == name) return &yarn;
    }
    return nullptr;
  }

  void end_headers() {
    if (headers_ended_) return;
    headers_ended_ = true;
    if (result_.yarns.empty()) result_.yarns.push_back({"A", {}, {}});
    if (!result_.carriers.empty() && result_.carriers.size() < result_.yarns.size()) {
      diagnostics_.error(carriers_at_, "there are " + std::to_string(result_.yarns.size()) +
                                           " yarns and only " + std::to_string(result_.carriers.size()) +
                                           (result_.carriers.size() == 1 ? " carrier" : " carriers") +
                                           "; name one carrier for each yarn, in the order of the yarns");
    }
  }

  void read_course_or_bracket() {
    end_headers();
    const std::size_t begin = text_.find_first_not_of(" \t");
    if (text_[begin] == '[') {
      if (trimmed(text_).size() > 1)
        return error(
            begin + 1,
            "'[' stands on a line of its own, the courses that it repeats on the next; needles of one "
            "course are repeated by '( )*n'");
      if (open_brackets_.size() == deepest_bracket) return error(begin, "brackets are nested too deep");
      open_brackets_.push_back({here(begin), result_.lines.size(), letters_});
      written_.kind = WrittenLine::Kind::open;
    } else if (text_[begin] == ']') {
      close_bracket(begin);
    } else {
      read_course();
    }
  }

  // `]*n`: what stands since the matching '[' is knitted n times.
  void close_bracket(std::size_t index) {
    if (open_brackets_.empty()) return error(index, "this ']' has no '[' before it; remove it");
    const Bracket open = open_brackets_.back();
    open_brackets_.pop_back();
    std::size_t at = index + 1;
    const std::size_t times = read_times(text_, at, line_, diagnostics_);
    at = std::min(text_.find_first_not_of(" \t", at), text_.size());
    if (at < text_.size()) error(at, "']*n' stands on a line of its own; put what follows on the next");
    const std::size_t lines = result_.lines.size() - open.first_line;
    const std::size_t letters = letters_ - open.letters;
    if (times == 0) return;
    if ((times - 1) * lines + result_.lines.size() > most_lines ||
        (times - 1) * letters + letters_ > most_letters) {
      return error(index,
                   "the notation becomes too long when this is written out; let ;;Size repeat it instead");
    }
    written_.kind = WrittenLine::Kind::close;
    written_.times = times;
    letters_ += (times - 1) * letters;
    result_.lines.reserve(result_.lines.size() + (times - 1) * lines);
    for (std::size_t i = 0; i < (times - 1) * lines; ++i) {
      const CourseLine copy = result_.lines[open.first_line + i];
      result_.lines.push_back(copy);
    }
  }

  void read_course() {
    CourseLine line = parse_course(text_, line_, result_.yarns, diagnostics_);
    for (const Pass& pass : line.passes) letters_ += pass.cells.size() + pass.rear.size() + pass.racks.size();
    if (letters_ > most_letters || result_.lines.size() == most_lines) {
      error(0, "the notation is too long; at most " + std::to_string(most_lines) + " lines and " +
                   std::to_string(most_letters) + " letters are read");
      full_ = true;
      return;
    }
    result_.lines.push_back(std::move(line));
    written_.kind = WrittenLine::Kind::course;
  }

  struct Bracket {
    SourceLocation at;
    std::size_t first_line = 0, letters = 0;
  };

  std::string_view whole_;
  LineReader lines_;
  Diagnostics& diagnostics_;
  Vermiculation result_;
  int line_ = 0;
  std::string_view text_;  // the line being read, without its comment
  WrittenLine written_;    // the same line, as it stands
  bool headers_ended_ = false, said_carriage_return_ = false, full_ = false;
  SourceLocation carriers_at_;
  std::vector<Bracket> open_brackets_;
  std::size_t letters_ = 0;
};

}  // namespace

Vermiculation parse_vermiculation(std::string_view text, Diagnostics& diagnostics) {
  return VermiculationParser(text, diagnostics).vermiculation();
}

}  // namespace loopwright
