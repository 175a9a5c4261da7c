// A parsed fabric file as text. What was written stays as it stands where it still says what the data say.
#include "notation/write_vermiculation.hpp"

#include <algorithm>
#include <map>

#include "notation/fabric_headers.hpp"
#include "notation/material.hpp"
#include "notation/parse_course.hpp"
#include "notation/scan.hpp"

namespace loopwright {
namespace {

using Kind = WrittenLine::Kind;

bool same_row(const std::vector<Cell>& a, const std::vector<Cell>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Cell& x, const Cell& y) { return x.letter == y.letter; });
}

bool same_pass(const Pass& a, const Pass& b) {
  return a.yarns == b.yarns && a.direction == b.direction && a.both_beds == b.both_beds &&
         same_row(a.cells, b.cells) && same_row(a.rear, b.rear) &&
         std::equal(a.racks.begin(), a.racks.end(), b.racks.begin(), b.racks.end(),
                    [](const RackMark& x, const RackMark& y) {
                      return x.before == y.before && x.racking == y.racking;
                    });
}

// The shortest unit of which letters [begin, end) are whole repeats.
std::size_t unit_of(const std::vector<Cell>& cells, std::size_t begin, std::size_t end) {
  const std::size_t size = end - begin;
  for (std::size_t unit = 1; unit <= size / 2; ++unit) {
    if (size % unit != 0) continue;
    bool repeats = true;
    for (std::size_t i = begin + unit; i < end && repeats; ++i)
      repeats = cells[i].letter == cells[i - unit].letter;
    if (repeats) return unit;
  }
  return size;
}

// Letters without rackings between them: `gggg`, `g*12`, `(ge)*6`, or with long runs of one letter folded.
void append_letters(std::string& text, const std::vector<Cell>& cells, std::size_t begin, std::size_t end) {
  constexpr std::size_t longest_plain = 8;
  const auto letters = [&](std::size_t from, std::size_t count) {
    for (std::size_t i = from; i < from + count; ++i) text += cells[i].letter;
  };
  const auto times = [&](std::size_t count) { text += '*' + std::to_string(count); };
  const std::size_t size = end - begin;
  if (size <= longest_plain) return letters(begin, size);
  const std::size_t unit = unit_of(cells, begin, end);
  if (unit > 1 && unit < size) {
    text += '(';
    append_letters(text, cells, begin, begin + unit);
    text += ')';
    return times(size / unit);
  }
  bool blank = false;  // a folded run stands apart from what is beside it
  for (std::size_t i = begin; i < end;) {
    std::size_t run = i;
    while (run < end && cells[run].letter == cells[i].letter) ++run;
    const bool folded = run - i > longest_plain;
    if (i > begin && (folded || blank)) text += ' ';
    letters(i, folded ? 1 : run - i);
    if (folded) times(run - i);
    blank = folded;
    i = run;
  }
}

void append_racking(std::string& text, const RackMark& mark) {
  if (!text.empty() && text.back() != ' ') text += ' ';
  text += 'R' + written_number(mark.racking + 0.0);
}

void append_row(std::string& text, const std::vector<Cell>& cells, const std::vector<RackMark>& racks) {
  std::size_t begin = 0;
  for (const RackMark& mark : racks) {
    if (mark.before >= cells.size() && !cells.empty()) break;
    if (mark.before > begin) {
      if (!text.empty() && text.back() != ' ') text += ' ';
      append_letters(text, cells, begin, mark.before);
    }
    begin = mark.before;
    append_racking(text, mark);
  }
  if (begin == cells.size()) return;
  if (!text.empty() && text.back() != ' ') text += ' ';
  append_letters(text, cells, begin, cells.size());
}

std::string written_pass(const Pass& pass, const std::vector<VermiculationYarn>& yarns) {
  std::string text;
  for (const int yarn : pass.yarns)
    text += (text.empty() ? "" : "+") + yarns[static_cast<std::size_t>(yarn)].name;
  if (pass.direction != Direction::none)
    text += pass.direction == Direction::right ? "> " : "< ";
  else if (!text.empty())
    text += ": ";
  append_row(text, pass.cells, pass.racks);
  if (pass.both_beds) {
    text += " / ";
    append_row(text, pass.rear, {});
  }
  for (const RackMark& mark : pass.racks)
    if (!pass.cells.empty() && mark.before == pass.cells.size()) append_racking(text, mark);
  return text;
}

// A header's value stands on one line and ends at `;`.
std::string one_line(std::string value) {
  for (char& c : value) c = c == '\n' || c == '\r' ? ' ' : c == ';' ? ',' : c;
  return std::string(trimmed(value));
}

class Writer {
 public:
  explicit Writer(const Vermiculation& notation) : notation_(notation) {}

  std::string text() {
    if (notation_.byte_order_mark) text_ = "\xef\xbb\xbf";
    if (!notation_.written.empty() && !notation_.written.front().end.empty())
      line_end_ = notation_.written.front().end;
    find_blocks();
    find_headers();
    write_headers();
    const std::vector<WrittenLine>& written = notation_.written;
    if (courses_in(first_course_, written.size()) == notation_.lines.size()) {
      write_items(first_course_, written.size(), 0, true);
    } else {
      // lines were put in or taken out without their layout: only the data are known
      for (const CourseLine& line : notation_.lines) put(write_course(line, notation_.yarns));
    }
    return std::move(text_);
  }

 private:
  // A new line ends as the file's first line does.
  void put(std::string_view line) { put(line, line_end_); }
  void put(std::string_view line, const std::string& end) {
    const std::size_t begin = notation_.byte_order_mark ? 3 : 0;
    if (text_.size() > begin && text_.back() != '\n') text_ += line_end_;  // the file's last line, once
    text_ += line;
    text_ += end;
  }

  // A blank or commented line. A header that came too late to count does not come in time because the courses
  // before it are gone: it stays a comment.
  void put_text(const WrittenLine& written) {
    const std::string& line = written.text;
    std::size_t end = 2;
    while (end < line.size() && (is_letter(line[end]) || is_digit(line[end]) || line[end] == '-')) ++end;
    const bool late_header =
        !begun_ && line.starts_with(";;") && end > 2 && end < line.size() && line[end] == ':';
    put(late_header ? "; " + line : line, written.end);
  }

  // Where each bracket closes, and where the headers end.
  void find_blocks() {
    const std::vector<WrittenLine>& written = notation_.written;
    close_.assign(written.size(), 0);
    std::vector<std::size_t> open;
    first_course_ = written.size();
    for (std::size_t i = 0; i < written.size(); ++i) {
      const Kind kind = written[i].kind;
      if (kind != Kind::magic && kind != Kind::header && kind != Kind::text)
        first_course_ = std::min(first_course_, i);
      if (kind == Kind::open) open.push_back(i);
      if (kind == Kind::close && !open.empty()) {
        close_[open.back()] = i;
        open.pop_back();
      }
    }
  }

  std::size_t courses_in(std::size_t begin, std::size_t end) const {
    std::size_t courses = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (notation_.written[i].kind == Kind::course) ++courses;
      if (notation_.written[i].kind != Kind::open || close_[i] == 0) continue;
      courses += notation_.written[close_[i]].times * courses_in(i + 1, close_[i]);
      i = close_[i];
    }
    return courses;
  }

  // --- headers

  void write_headers() {
    const std::vector<WrittenLine>& written = notation_.written;
    std::size_t end = 0;  // past the last header: where new ones go
    for (std::size_t i = 0; i < first_course_; ++i)
      if (written[i].kind != Kind::text) end = i + 1;
    const std::string magic = ";!vermiculation-" + std::to_string(notation_.version);
    if (first_course_ == 0 || written.front().kind != Kind::magic) put(magic);
    std::vector<std::string> said;
    for (std::size_t i = 0; i < end; ++i) write_header_line(i, said);
    for (const std::string& name : canonical_names()) {
      if (std::find(said.begin(), said.end(), name) == said.end() && must_be_said(name))
        put_header(name, value_of(name), "", line_end_);
    }
    for (std::size_t i = end; i < first_course_; ++i) put_text(written[i]);
  }

  void write_header_line(std::size_t index, std::vector<std::string>& said) {
    const WrittenLine& line = notation_.written[index];
    if (line.kind == Kind::magic) {
      const auto version = parsed_integer(trimmed(std::string_view(line.text).substr(16)));
      return put(
          version == notation_.version ? line.text : ";!vermiculation-" + std::to_string(notation_.version),
          line.end);
    }
    if (line.kind == Kind::text) return put_text(line);
    const std::string name = name_of_header(line.text);
    // of a header that is given twice the last one counts
    if (last_of_name_.at(name) != index) return put(line.text, line.end);
    const std::size_t comment = std::min(line.text.find(';', 2), line.text.size());
    const std::string_view value =
        trimmed(std::string_view(line.text).substr(name.size() + 3, comment - name.size() - 3));
    const std::string wanted = value_of(name);
    // yarns whose order has changed are all written anew
    if (!exists(name) || (name.starts_with("Yarn-") && !yarns_in_order_)) return;
    said.push_back(name);
    if (same_value(name, value, wanted)) return put(line.text, line.end);
    put_header(name, wanted, line.text.substr(comment), line.end);
  }

  static std::string name_of_header(const std::string& text) { return text.substr(2, text.find(':') - 2); }

  void put_header(const std::string& name, const std::string& value, const std::string& comment,
                  const std::string& end) {
    std::string line = ";;" + name + ':';
    if (!value.empty()) line += ' ' + one_line(value);
    if (!comment.empty()) line += "  " + comment;
    put(line, end);
  }

  const VermiculationYarn* yarn_of(const std::string& header) const {
    for (const VermiculationYarn& yarn : notation_.yarns)
      if (header == "Yarn-" + yarn.name) return &yarn;
    return nullptr;
  }

  // Which line counts of each header, and whether the yarns stand in their order: the first one knits where
  // none is named.
  void find_headers() {
    std::size_t yarns = 0;
    for (std::size_t i = 0; i < first_course_; ++i) {
      if (notation_.written[i].kind != Kind::header) continue;
      const std::string name = name_of_header(notation_.written[i].text);
      if (!last_of_name_.insert_or_assign(name, i).second || !yarn_of(name)) continue;
      if (name != "Yarn-" + notation_.yarns[yarns++].name) yarns_in_order_ = false;
    }
  }

  std::vector<std::string> canonical_names() const {
    std::vector<std::string> names;
    for (const std::string_view name : fabric_headers()) {
      names.emplace_back(name);
      if (name != "Bed-Gap") continue;
      for (const VermiculationYarn& yarn : notation_.yarns) names.push_back("Yarn-" + yarn.name);
      names.emplace_back("Carriers");
      names.emplace_back("Gating");
    }
    for (const auto& header : notation_.headers)
      if (is_own(header.first) && std::find(names.begin(), names.end(), header.first) == names.end())
        names.push_back(header.first);
    return names;
  }

  // Headers that mean nothing to us: they live in Vermiculation::headers alone.
  static bool is_own(const std::string& name) {
    return !is_fabric_header(name) && !name.starts_with("Yarn-") && name != "Carriers" && name != "Gating";
  }

  std::string value_of(const std::string& name) const {
    if (is_fabric_header(name)) return fabric_header_value(name, notation_.settings);
    if (const VermiculationYarn* yarn = yarn_of(name)) return yarn_value(yarn->data);
    std::string value;
    if (name == "Carriers") {
      for (const std::string& carrier : notation_.carriers) value += (value.empty() ? "" : " ") + carrier;
    } else if (name == "Gating") {
      if (notation_.gating) value = *notation_.gating == Gating::opposite ? "opposite" : "half-pitch";
    } else {
      for (const auto& header : notation_.headers)
        if (header.first == name) value = header.second;
    }
    return value;
  }

  // Whether the data still have what the header tells.
  bool exists(const std::string& name) const {
    if (name == "Set") return true;  // always has a value
    if (name.starts_with("Yarn-")) return yarn_of(name) != nullptr;
    if (!is_own(name)) return !value_of(name).empty();
    return std::any_of(notation_.headers.begin(), notation_.headers.end(),
                       [&](const auto& header) { return header.first == name; });
  }

  // Whether it must be written though the file had no such header; yarn A without data is there by itself.
  bool must_be_said(const std::string& name) const {
    if (name == "Set") return notation_.settings.set != 0;
    if (name == "Yarn-A" && notation_.yarns.size() == 1) return !value_of(name).empty();
    return exists(name);
  }

  // Whether the text of a header means what is wanted.
  static bool same_value(const std::string& name, std::string_view text, const std::string& wanted) {
    Diagnostics diagnostics;
    if (is_fabric_header(name)) {
      FabricSettings settings;
      read_fabric_header(name, text, {}, settings, diagnostics);
      return fabric_header_value(name, settings) == wanted;
    }
    if (name.starts_with("Yarn-")) {
      YarnData yarn;
      read_yarn(text, {}, yarn, diagnostics);
      return yarn_value(yarn) == wanted;
    }
    if (name == "Carriers") {
      WordReader words(text);
      Word word;
      std::string joined;
      while (words.next(word)) joined += (joined.empty() ? "" : " ") + std::string(word.text);
      return joined == wanted;
    }
    return text == wanted;
  }

  // --- courses

  const CourseLine& line(std::size_t index) const { return notation_.lines[index]; }

  // Lines of the file from `begin` to `end`, whose first course is line `at`. Comments of their own stand
  // only with the first copy of an opened bracket. Answers the line that comes next.
  std::size_t write_items(std::size_t begin, std::size_t end, std::size_t at, bool comments) {
    for (std::size_t i = begin; i < end; ++i) {
      const WrittenLine& written = notation_.written[i];
      if (written.kind == Kind::course) {
        put_course(written, line(at++));
        begun_ = true;
      } else if (written.kind == Kind::open && close_[i] > 0) {
        at = write_block(i, at, comments);
        i = close_[i];
      } else if (comments) {
        put_text(written);
      }
    }
    return at;
  }

  std::size_t write_block(std::size_t open, std::size_t at, bool comments) {
    const WrittenLine& close = notation_.written[close_[open]];
    const std::size_t length = courses_in(open + 1, close_[open]);
    for (std::size_t copy = 0; copy < close.times;) {
      // copies that still agree stay in one bracket
      std::size_t next = copy + 1;
      while (next < close.times && same_lines(at, at + (next - copy) * length, length)) ++next;
      const bool first = comments && copy == 0;
      if (next - copy == 1 && close.times > 1) {
        write_items(open + 1, close_[open], at, first);
      } else {
        put(first ? notation_.written[open].text : "[", notation_.written[open].end);
        begun_ = true;
        write_items(open + 1, close_[open], at, first);
        put(next - copy == close.times ? close.text : "]*" + std::to_string(next - copy), close.end);
      }
      at += (next - copy) * length;
      copy = next;
    }
    return at;
  }

  bool same_lines(std::size_t a, std::size_t b, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i)
      if (!same_course(line(a + i), line(b + i))) return false;
    return true;
  }

  void put_course(const WrittenLine& line, const CourseLine& wanted) {
    const std::string& written = line.text;
    const std::size_t comment = std::min(written.find(';'), written.size());
    Diagnostics diagnostics;
    const CourseLine read =
        parse_course(std::string_view(written).substr(0, comment), 1, notation_.yarns, diagnostics);
    if (diagnostics.ok() && same_course(read, wanted)) return put(written, line.end);
    std::string text = write_course(wanted, notation_.yarns);
    if (comment < written.size()) {
      text.resize(std::max(text.size() + 1, comment), ' ');
      text += written.substr(comment);
    }
    put(text, line.end);
  }

  const Vermiculation& notation_;
  std::string text_, line_end_ = "\n";
  std::vector<std::size_t> close_;  // of each `[` in notation_.written, its `]`; 0 elsewhere
  std::map<std::string, std::size_t> last_of_name_;
  bool yarns_in_order_ = true;
  bool begun_ = false;            // a course or bracket is written
  std::size_t first_course_ = 0;  // first line of the file that is no header or comment
};

}  // namespace

bool same_course(const CourseLine& a, const CourseLine& b) {
  return std::equal(a.passes.begin(), a.passes.end(), b.passes.begin(), b.passes.end(), same_pass);
}

bool same_notation(const Vermiculation& a, const Vermiculation& b) {
  const auto same_headers = [&] {
    for (const std::string_view name : fabric_headers())
      if (fabric_header_value(name, a.settings) != fabric_header_value(name, b.settings)) return false;
    return true;
  };
  const auto same_yarn = [](const VermiculationYarn& x, const VermiculationYarn& y) {
    return x.name == y.name && yarn_value(x.data) == yarn_value(y.data);
  };
  return a.version == b.version && same_headers() &&
         std::equal(a.yarns.begin(), a.yarns.end(), b.yarns.begin(), b.yarns.end(), same_yarn) &&
         a.carriers == b.carriers && a.gating == b.gating &&
         std::equal(a.lines.begin(), a.lines.end(), b.lines.begin(), b.lines.end(), same_course);
}

std::string write_course(const CourseLine& line, const std::vector<VermiculationYarn>& yarns) {
  std::string text;
  for (const Pass& pass : line.passes) text += (text.empty() ? "" : "  &  ") + written_pass(pass, yarns);
  return text;
}

std::string write_vermiculation(const Vermiculation& notation) { return Writer(notation).text(); }

}  // namespace loopwright
