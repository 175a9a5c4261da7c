#include "notation/parse_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "notation/scan.hpp"

namespace loopwright {

namespace {
bool holds(const std::vector<Cell>& cells, bool (*wanted)(char)) {
  return std::any_of(cells.begin(), cells.end(), [&](const Cell& cell) { return wanted(cell.letter); });
}
bool is_one_of(char letter, std::string_view letters) { return letters.find(letter) != letters.npos; }
}  // namespace

bool forms_loop(char letter) { return is_one_of(letter, "gevnsS"); }
bool moves_loops(char letter) { return is_one_of(letter, "tTdD"); }
bool is_rear_letter(char letter) { return is_one_of(letter, "enSTD"); }

bool Pass::knits() const { return holds(cells, forms_loop) || holds(rear, forms_loop); }
bool Pass::transfers() const { return holds(cells, moves_loops) || holds(rear, moves_loops); }
bool Pass::carries_yarn() const {
  return knits() || ((!yarns.empty() || direction != Direction::none) && !transfers());
}
bool CourseLine::knits() const {
  return std::any_of(passes.begin(), passes.end(), [](const Pass& pass) { return pass.knits(); });
}

std::size_t read_times(std::string_view text, std::size_t& at, int line, Diagnostics& diagnostics) {
  const auto skip_blanks = [&] {
    while (at < text.size() && is_blank(text[at])) ++at;
  };
  const auto error = [&](std::size_t index, std::string message) {
    diagnostics.error({line, static_cast<int>(index) + 1}, std::move(message));
  };
  skip_blanks();
  const std::size_t begin = at;
  if (at < text.size() && text[at] == '*') ++at;
  skip_blanks();
  const std::size_t digits = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  const auto times = parsed_integer(text.substr(digits, at - digits));
  if (digits == begin || digits == at) {
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

namespace {

constexpr std::size_t most_passes = 1000;  // of one line
constexpr int deepest_group = 32;
constexpr int most_unknown_letters = 20;  // of one line, then the line is no course at all
constexpr double largest_racking = 8;     // what a Shima converter accepts

// The cells and rackings of one row (one side of '/').
struct Row {
  std::vector<Cell> cells;
  std::vector<RackMark> racks;
};

class CourseParser {
 public:
  CourseParser(std::string_view text, int line, std::span<const VermiculationYarn> yarns,
               Diagnostics& diagnostics)
      : text_(text), line_(line), yarns_(yarns), diagnostics_(diagnostics) {}

  CourseLine course_line() {
    CourseLine line;
    if (const std::string_view word = knitout_word(); !word.empty()) {
      error(text_.find(word), quoted(word) +
                                  " is knitout; a fabric file has a letter for each needle, e.g. 'gge'. A "
                                  "knitout file starts with ';!knitout-2'");
      return line;
    }
    while (true) {
      line.passes.push_back(read_pass());
      if (at_ == text_.size()) return line;
      if (line.passes.size() == most_passes) {
        give_up(at_, "more than " + std::to_string(most_passes) +
                         " passes in one line; write them on several lines");
        return line;
      }
      ++at_;  // the '&'
    }
  }

 private:
  SourceLocation here(std::size_t index) const { return {line_, static_cast<int>(index) + 1}; }
  void error(std::size_t index, std::string message) { diagnostics_.error(here(index), std::move(message)); }

  const VermiculationYarn* find_yarn(std::string_view name) const {
    const auto found =
        std::find_if(yarns_.begin(), yarns_.end(), [&](const auto& yarn) { return yarn.name == name; });
    return found == yarns_.end() ? nullptr : &*found;
  }

  // The word that starts the line if it is an operation of knitout.
  std::string_view knitout_word() const {
    static constexpr std::array<std::string_view, 14> words{
        "knit", "tuck", "split",  "miss",        "drop", "amiss",   "xfer",
        "rack", "in",   "inhook", "releasehook", "out",  "outhook", "pause"};
    Word first;
    if (!WordReader(text_).next(first)) return {};
    return std::find(words.begin(), words.end(), first.text) == words.end() ? std::string_view() : first.text;
  }

  // Up to '&' or the end of the line.
  Pass read_pass() {
    Pass pass;
    skip_blanks();
    pass.at = here(at_);
    const std::size_t begin = at_;
    const std::size_t errors_before = static_cast<std::size_t>(diagnostics_.errors());
    const std::string_view rest = text_.substr(at_);
    const std::size_t head_end = rest.substr(0, rest.find('&')).find_first_of(":<>");
    if (head_end != std::string_view::npos) read_head(pass, at_ + head_end);
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
        const int place = static_cast<int>(yarn - yarns_.data());
        if (std::find(pass.yarns.begin(), pass.yarns.end(), place) != pass.yarns.end()) {
          error(name_at, "yarn " + quoted(name) + " is named twice; name it once");
        } else {
          pass.yarns.push_back(place);
        }
      } else if (!name.empty() && name.find_first_not_of("gevnsStTdDRr.-()*/ ") == name.npos) {
        error(end, std::string("'") + text_[end] + "' stands before the letters of a pass, not after them");
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
        if (!moves_loops(cell.letter)) continue;
        if (pass.knits()) {
          diagnostics_.error(
              cell.at, "transfers or drops and stitches in one pass; put '&' or a new line between them");
          return;
        }
      }
    }
    if (!pass.yarns.empty() || pass.direction != Direction::none) {
      if (pass.transfers())
        error(begin, "a pass of transfers or drops carries no yarn; remove what stands before the letters");
      if (pass.cells.empty())
        error(begin, "a pass that carries yarn names its needles; write '.' for those that it goes past");
    }
    if (!pass.both_beds) return;
    check_row(pass.cells, "gvstd.-", "left of '/' stand the front needles: g v s t d . -");
    check_row(pass.rear, "enSTD.-", "right of '/' stand the rear needles: e n S T D . -");
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
      } else if (forms_loop(c) || moves_loops(c) || c == '.' || c == '-') {
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

  std::size_t read_times_if_any() {
    return at_ < text_.size() && text_[at_] == '*' ? read_times(text_, at_, line_, diagnostics_) : 1;
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
        "letters are g e (stitch on the front, rear bed) v n (tuck) s S (split) t T (transfer) d D (drop) "
        "R r (racking) . (missed) - (inactive)";
    const char small = letter.size() == 1 ? lower_case(letter).front() : ' ';
    if (letter == "G" || letter == "E" || letter == "V" || letter == "N")
      hint = std::string("letters of stitches and tucks are small: '") + small + "'";
    else if (letter == "_")
      hint = "a missed needle is '.', an inactive one '-'";
    else if (letter == "," || letter == "|")
      hint = "letters stand side by side, blanks mean nothing; remove it";
    else if (is_digit(letter.front()))
      hint = "repeat a letter or a group by '*n' after it, e.g. 'g*2' or '(ge)*2'";
    else if (letter == "#")
      return give_up(index, "unknown letter '#'; a comment starts with ';'");
    else if (letter == "k" || letter == "K")
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

  std::string_view text_;
  int line_ = 0;
  std::span<const VermiculationYarn> yarns_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;  // place in text_
  int unknown_letters_ = 0;
};

}  // namespace

CourseLine parse_course(std::string_view text, int line, std::span<const VermiculationYarn> yarns,
                        Diagnostics& diagnostics) {
  return CourseParser(text, line, yarns, diagnostics).course_line();
}

}  // namespace loopwright
