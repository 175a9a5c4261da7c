// From the text of a fabric file to its passes; the grammar stands in docs/notation.md.
#include <algorithm>
#include <cmath>

#include "notation/fabric_headers.hpp"
#include "notation/material.hpp"
#include "notation/scan.hpp"
#include "notation/vermiculation.hpp"

namespace loopwright {

namespace {
bool is_yarn_letter(char c) { return c == 'g' || c == 'e' || c == 'v' || c == 'n'; }
bool is_transfer_letter(char c) { return c == 'T' || c == 't'; }
bool holds(const std::vector<Cell>& cells, bool (*wanted)(char)) {
  return std::any_of(cells.begin(), cells.end(), [&](const Cell& cell) { return wanted(cell.letter); });
}
}  // namespace

bool Pass::knits() const { return holds(cells, is_yarn_letter) || holds(rear, is_yarn_letter); }
bool Pass::transfers() const { return holds(cells, is_transfer_letter) || holds(rear, is_transfer_letter); }
bool CourseLine::knits() const {
  return std::any_of(passes.begin(), passes.end(), [](const Pass& pass) { return pass.knits(); });
}

namespace {

constexpr std::string_view magic = ";!vermiculation-";
constexpr std::size_t most_wales = 10'000;       // of one written pass
constexpr std::size_t most_letters = 5'000'000;  // of the whole notation, repeats written out
constexpr std::size_t most_lines = 100'000;      // the same in lines
constexpr std::size_t most_passes = 1000;        // of one line
constexpr std::size_t most_yarns = 26;
constexpr int deepest_group = 32;
constexpr int most_unknown_letters = 20;  // of one line, then the line is no course at all
constexpr double largest_racking = 8;     // what a Shima converter accepts

// The letters, cells and rackings of one row (one side of '/').
struct Row {
  std::vector<Cell> cells;
  std::vector<RackMark> racks;
};

class VermiculationParser {
 public:
  VermiculationParser(std::string_view text, Diagnostics& diagnostics)
      : lines_(text), diagnostics_(diagnostics) {
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
      if (line_ == 1 && read_magic()) continue;
      if (text_.starts_with(";;") && read_header()) continue;
      text_ = text_.substr(0, text_.find(';'));
      if (!trimmed(text_).empty()) read_course_or_bracket();
    }
    if (line_ == 0)
      diagnostics_.error({}, "the file is empty; a fabric file starts with ';!vermiculation-1'");
    if (!open_brackets_.empty()) {
      diagnostics_.error(open_brackets_.back().at,
                         "this '[' is never closed; add a line ']*2' where the repeat ends");
    }
    end_headers();
    return std::move(result_);
  }

 private:
  SourceLocation here(std::size_t index) const { return {line_, static_cast<int>(index) + 1}; }
  void error(std::size_t index, std::string message) { diagnostics_.error(here(index), std::move(message)); }

  // Whether the first line was the magic line; anything else is read as what it is, after saying so.
  bool read_magic() {
    if (text_.starts_with("\xef\xbb\xbf")) {
      diagnostics_.warning(here(0), "the file starts with a byte-order mark; save it as UTF-8 without one");
      text_.remove_prefix(3);
    }
    if (!text_.starts_with(magic)) {
      error(0,
            "the first line is not ';!vermiculation-1' but " + quoted(text_) + "; put it before everything");
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
    if (end == 2 || end == text_.size() || text_[end] != ':') return false;
    const std::string_view name = text_.substr(2, end - 2);
    std::size_t begin = end + 1;
    while (begin < text_.size() && is_blank(text_[begin])) ++begin;
    const std::string_view rest = text_.substr(begin);
    const std::string_view value = trimmed(rest.substr(0, rest.find(';')));
    const bool is_yarn = name.starts_with("Yarn-");
    const bool is_own = is_yarn || name == "Carriers" || name == "Gating";
    if (headers_ended_) {
      if (is_own || is_fabric_header(name)) {
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
    if (value.empty() && !is_yarn && (is_own || is_fabric_header(name))) {
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
      diagnostics_.warning(here(2),
                           "unknown header " + quoted(name) + " has no effect; own headers start with 'X-'");
    }
    return true;
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
      diagnostics_.error(carriers_at_,
                         "there are " + std::to_string(result_.yarns.size()) + " yarns and only " +
                             std::to_string(result_.carriers.size()) +
                             " carriers; name one carrier for each yarn, in the order of the yarns");
    }
  }

  void read_course_or_bracket() {
    end_headers();
    const std::size_t begin = text_.find_first_not_of(" \t");
    if (text_[begin] == '[') {
      if (trimmed(text_).size() > 1)
        error(begin + 1, "'[' stands on a line of its own; put the course on the next");
      if (open_brackets_.size() == deepest_group) return error(begin, "brackets are nested too deep");
      open_brackets_.push_back({here(begin), result_.lines.size(), letters_});
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
    at_ = index + 1;
    const std::size_t times = read_times();
    skip_blanks();
    if (at_ < text_.size()) error(at_, "']*n' stands on a line of its own; put what follows on the next");
    const std::size_t lines = result_.lines.size() - open.first_line;
    const std::size_t letters = letters_ - open.letters;
    if (times == 0) return;
    if ((times - 1) * lines + result_.lines.size() > most_lines ||
        (times - 1) * letters + letters_ > most_letters) {
      return error(index,
                   "the notation becomes too long when this is written out; let ;;Size repeat it instead");
    }
    letters_ += (times - 1) * letters;
    result_.lines.reserve(result_.lines.size() + (times - 1) * lines);
    for (std::size_t i = 0; i < (times - 1) * lines; ++i) {
      const CourseLine copy = result_.lines[open.first_line + i];
      result_.lines.push_back(copy);
    }
  }

  void read_course() {
    CourseLine line;
    at_ = 0;
    unknown_letters_ = 0;
    while (true) {
      line.passes.push_back(read_pass());
      if (at_ == text_.size()) break;
      if (line.passes.size() == most_passes) {
        give_up(at_, "more than " + std::to_string(most_passes) +
                         " passes in one line; write them on several lines");
        break;
      }
      ++at_;  // the '&'
    }
    for (const Pass& pass : line.passes) letters_ += pass.cells.size() + pass.rear.size() + pass.racks.size();
    if (letters_ > most_letters || result_.lines.size() == most_lines) {
      error(0, "the notation is too long; at most " + std::to_string(most_lines) + " lines and " +
                   std::to_string(most_letters) + " letters are read");
      full_ = true;
      return;
    }
    result_.lines.push_back(std::move(line));
  }

  // Up to '&' or the end of the line.
  Pass read_pass() {
    Pass pass;
    skip_blanks();
    pass.at = here(at_);
    const std::size_t begin = at_;
    const std::string_view rest = text_.substr(at_);
    const std::size_t head_end = rest.substr(0, rest.find('&')).find_first_of(":<>");
    if (head_end != std::string_view::npos) read_head(pass, at_ + head_end);
    const std::size_t errors_before = static_cast<std::size_t>(diagnostics_.errors());
    Row front = read_row();
    Row rear;
    if (at_ < text_.size() && text_[at_] == '/') {
      pass.both_beds = true;
      ++at_;
      rear = read_row();
      while (at_ < text_.size() && text_[at_] == '/') {
        error(at_, "a pass has two rows, front / rear; remove this '/' or join a second pass with '&'");
        ++at_;
        read_row();
      }
    }
    const std::size_t wales = front.cells.size();
    pass.cells = std::move(front.cells);
    pass.rear = std::move(rear.cells);
    pass.racks = std::move(front.racks);
    for (RackMark mark : rear.racks) {
      if (mark.before < pass.rear.size()) {
        diagnostics_.error(mark.at,
                           "racking among the rear needles; write it among the front needles, left of '/'");
      }
      mark.before = wales;
      pass.racks.push_back(mark);
    }
    if (static_cast<std::size_t>(diagnostics_.errors()) == errors_before) check_pass(pass, begin);
    return pass;
  }

  // `A+B>`: yarns, then '>' (to the right), '<' (to the left) or ':' (back from where the carrier is).
  void read_head(Pass& pass, std::size_t end) {
    pass.direction = text_[end] == '>'   ? Direction::right
                     : text_[end] == '<' ? Direction::left
                                         : Direction::none;
    std::size_t begin = at_;
    const bool names = !trimmed(text_.substr(at_, end - at_)).empty();
    while (names && begin <= end) {
      const std::size_t stop = std::min(text_.find('+', begin), end);
      const std::string_view name = trimmed(text_.substr(begin, stop - begin));
      const std::size_t name_at = begin + text_.substr(begin).find_first_not_of(" \t");
      if (const VermiculationYarn* yarn = find_yarn(name)) {
        const int place = static_cast<int>(yarn - result_.yarns.data());
        if (std::find(pass.yarns.begin(), pass.yarns.end(), place) != pass.yarns.end()) {
          error(name_at, "yarn " + quoted(name) + " is named twice; name it once");
        } else {
          pass.yarns.push_back(place);
        }
      } else if (name.empty()) {
        error(std::min(begin, end), "expected the name of a yarn before '+', ':', '<' or '>'");
      } else {
        error(name_at, "no yarn is called " + quoted(name) + "; give it a Yarn- header or name another");
      }
      begin = stop + 1;
    }
    at_ = end + 1;
  }

  void check_pass(const Pass& pass, std::size_t begin) {
    if (pass.cells.empty() && pass.racks.empty()) {
      return error(begin, "a pass of zero wales; write a letter for each needle, or remove it");
    }
    if (pass.both_beds && (pass.rear.empty() || pass.cells.empty())) {
      return error(begin,
                   "a pass on both beds names needles on both sides of '/'; write '.' or '-' for idle ones");
    }
    for (const auto* row : {&pass.cells, &pass.rear}) {
      for (const Cell& cell : *row) {
        if (!is_transfer_letter(cell.letter)) continue;
        if (pass.knits()) {
          diagnostics_.error(cell.at,
                             "transfers and stitches in one pass; put '&' or a new line between them");
          return;
        }
      }
    }
    if (!pass.knits() && (!pass.yarns.empty() || pass.direction != Direction::none)) {
      error(begin, "a pass without stitches or tucks carries no yarn; remove what stands before the letters");
    }
    if (!pass.both_beds) return;
    check_row(pass.cells, "gvt.-", "left of '/' stand the front needles: g v t . -");
    check_row(pass.rear, "enT.-", "right of '/' stand the rear needles: e n T . -");
  }

  void check_row(const std::vector<Cell>& cells, std::string_view letters, const std::string& what) {
    const auto wrong = std::find_if(cells.begin(), cells.end(), [&](const Cell& cell) {
      return letters.find(cell.letter) == letters.npos;
    });
    if (wrong != cells.end()) {
      diagnostics_.error(wrong->at, std::string("'") + wrong->letter + "' belongs to the other bed; " + what);
    }
  }

  // Letters, groups and rackings up to '/', '&' or the end of the line.
  Row read_row() {
    Row row;
    read_items(row, 0);
    return row;
  }

  void read_items(Row& row, int depth) {
    while (true) {
      skip_blanks();
      if (at_ == text_.size() || text_[at_] == '/' || text_[at_] == '&') return;
      const std::size_t begin = at_;
      const char c = text_[at_];
      if (c == ')' && depth > 0) return;
      ++at_;
      if (c == 'R' || c == 'r') {
        read_racking(row, c, begin);
        if (row.racks.size() > most_wales) return give_up(begin, "too many rackings in one pass");
        continue;
      }
      const std::size_t first_cell = row.cells.size(), first_rack = row.racks.size();
      if (c == '(') {
        if (depth == deepest_group) return give_up(begin, "groups are nested too deep");
        read_items(row, depth + 1);
        if (at_ == text_.size() || text_[at_] != ')')
          return give_up(begin, "this '(' is never closed; add ')'");
        ++at_;
        if (row.cells.size() == first_cell)
          error(begin, "an empty group has zero wales; put letters into it");
      } else if (is_yarn_letter(c) || is_transfer_letter(c) || c == '.' || c == '-') {
        row.cells.push_back({c, here(begin)});
      } else {
        unknown_letter(begin);
        continue;
      }
      skip_blanks();
      const std::size_t times_at = at_;
      repeat(row, first_cell, first_rack, read_times_if_any(), times_at);
      if (row.cells.size() > most_wales || row.racks.size() > most_wales) {
        return give_up(begin, "more than " + std::to_string(most_wales) + " wales in one pass");
      }
    }
  }

  // Says it and leaves the rest of the line unread.
  void give_up(std::size_t index, std::string message) {
    error(index, std::move(message));
    at_ = text_.size();
  }

  void repeat(Row& row, std::size_t first_cell, std::size_t first_rack, std::size_t times,
              std::size_t index) {
    const std::size_t cells = row.cells.size() - first_cell, racks = row.racks.size() - first_rack;
    if (times > most_wales || cells * times > most_wales || racks * times > most_wales) {
      return error(index,
                   "this makes more than " + std::to_string(most_wales) + " wales; repeat it fewer times");
    }
    for (std::size_t i = 0; times > 1 && i < (times - 1) * cells; ++i) {
      const Cell cell = row.cells[first_cell + i];
      row.cells.push_back(cell);
    }
    for (std::size_t i = 0; times > 1 && i < (times - 1) * racks; ++i) {
      RackMark mark = row.racks[first_rack + i];
      mark.before += cells;
      row.racks.push_back(mark);
    }
  }

  std::size_t read_times_if_any() { return at_ < text_.size() && text_[at_] == '*' ? read_times() : 1; }

  // `*n`, n from 1; answers 0 after saying what is wrong.
  std::size_t read_times() {
    skip_blanks();
    const std::size_t begin = at_;
    if (at_ < text_.size() && text_[at_] == '*') ++at_;
    skip_blanks();
    const std::size_t digits = at_;
    while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
    const auto times = parsed_integer(text_.substr(digits, at_ - digits));
    if (digits == begin || digits == at_) {
      error(digits, "expected how many times, e.g. '*2'");
      return 0;
    }
    if (!times || *times > static_cast<int>(most_wales)) {
      error(digits,
            "at most " + std::to_string(most_wales) + " repeats; let ;;Size repeat the notation instead");
      return 0;
    }
    if (*times == 0) error(digits, "repeated zero times; remove it or write a number from 1");
    return static_cast<std::size_t>(*times);
  }

  // The number after R or r. A '.' belongs to it only before a digit, so that `R1.` is R1 and a missed
  // needle.
  void read_racking(Row& row, char letter, std::size_t begin) {
    const std::size_t number_at = at_;
    if (at_ < text_.size() && (text_[at_] == '-' || text_[at_] == '+')) ++at_;
    while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
    if (at_ + 1 < text_.size() && text_[at_] == '.' && is_digit(text_[at_ + 1])) {
      ++at_;
      while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
    }
    const std::string_view number = text_.substr(number_at, at_ - number_at);
    const auto needles = parsed_number(number);
    if (!needles) {
      return error(number_at,
                   std::string("expected a number of needles after '") + letter + "', e.g. 'R1' or 'R-1'");
    }
    if (std::abs(*needles) > largest_racking || std::floor(*needles * 4) != *needles * 4) {
      return error(number_at,
                   "racking is counted in needles, from -8 to 8 in quarters, not " + quoted(number));
    }
    row.racks.push_back({row.cells.size(), letter == 'R' ? *needles + 0.0 : 0.0 - *needles, here(begin)});
  }

  void unknown_letter(std::size_t index) {
    if (++unknown_letters_ > most_unknown_letters)
      return give_up(index, "too many unknown letters; the rest of the line is not read");
    // the bytes of one UTF-8 character go together, so that it is reported once
    while (at_ < text_.size() && (static_cast<unsigned char>(text_[at_]) & 0xc0) == 0x80) ++at_;
    const std::string_view letter = text_.substr(index, at_ - index);
    std::string hint =
        "letters are g e (stitch on the front, rear bed) v n (tuck) T t (transfer) R r (racking) "
        ". (missed) - (inactive)";
    if (letter == "k" || letter == "K")
      hint = "a stitch on the front bed is 'g'";
    else if (letter == "p" || letter == "P")
      hint = "a stitch on the rear bed is 'e'";
    else if (letter == "X" || letter == "x")
      hint = "an inactive needle is '-'";
    else if (letter == "*")
      hint = "put the letter or group that is repeated before it";
    else if (letter == ")")
      hint = "there is no '(' before it";
    else if (letter == "[" || letter == "]")
      hint = "courses are repeated by '[' and ']*n' on lines of their own; needles by '( )*n'";
    else if (letter == ":" || letter == "<" || letter == ">")
      hint = "it stands once, before the letters of a pass";
    error(index, "unknown letter " + quoted(letter) + "; " + hint);
  }

  void skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }

  struct Bracket {
    SourceLocation at;
    std::size_t first_line = 0, letters = 0;
  };

  LineReader lines_;
  Diagnostics& diagnostics_;
  Vermiculation result_;
  int line_ = 0;
  std::string_view text_;  // the line being read, without its comment
  std::size_t at_ = 0;     // place in text_
  bool headers_ended_ = false, said_carriage_return_ = false, full_ = false;
  SourceLocation carriers_at_;
  std::vector<Bracket> open_brackets_;
  std::size_t letters_ = 0;
  int unknown_letters_ = 0;  // of the line
};

}  // namespace

Vermiculation parse_vermiculation(std::string_view text, Diagnostics& diagnostics) {
  return VermiculationParser(text, diagnostics).vermiculation();
}

}  // namespace loopwright
