#include "notation/read_knitout.hpp"

#include <algorithm>

#include "notation/knitout_headers.hpp"
#include "notation/knitout_operation.hpp"
#include "notation/scan.hpp"

namespace loopwright {
namespace {

class KnitoutReader {
 public:
  KnitoutReader(std::string_view text, Diagnostics& diagnostics)
      : text_(text), report_{diagnostics}, headers_(program_, report_), operations_(program_, report_) {
    program_.file = diagnostics.file();
  }

  Program program() {
    warn_of_other_encodings();
    program_.instructions.reserve(
        std::min(most_instructions, std::size_t(1 + std::count(text_.begin(), text_.end(), '\n'))));
    LineReader lines(text_);
    TextLine line;
    while (!full_ && lines.next(line)) {
      report_.line = line.number;
      if (line.carriage_return) warn_of_carriage_return(line);
      if (line.number == 1 && headers_.read_magic(line.text)) continue;
      if (in_headers_ && is_knitout_header(line.text)) {
        headers_.read(line.text);
      } else {
        end_headers();
        read_line(line.text);
      }
    }
    if (report_.line == 0) report_.error(0, "the file is empty; a knitout file starts with ';!knitout-2'");
    end_headers();
    program_.yarns.resize(program_.carriers.size());
    return std::move(program_);
  }

 private:
  // knitout is UTF-8; another encoding does no harm in comments, but shows the file came from elsewhere.
  void warn_of_other_encodings() {
    const std::size_t bad = first_byte_not_utf8(text_);
    if (bad == std::string_view::npos) return;
    const std::string_view before = text_.substr(0, bad);
    report_.line = 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
    report_.warning(static_cast<int>(bad - (before.rfind('\n') + 1)) + 1,
                    "the text is not UTF-8 from here on; save it as UTF-8");
    report_.line = 0;
  }

  void warn_of_carriage_return(const TextLine& line) {
    if (said_carriage_return_) return;
    said_carriage_return_ = true;
    report_.warning(static_cast<int>(line.text.size()) + 1,
                    "the line ends with CR LF; knitout wants LF alone, convert the line ends");
  }

  void end_headers() {
    if (!in_headers_) return;
    in_headers_ = false;
    headers_.end();
    if (headers_.list_carriers()) operations_.list_carriers();
  }

  void read_line(std::string_view text) {
    const std::size_t semicolon = text.find(';');
    std::string_view source;  // what the line was made from
    if (semicolon == 0) headers_.meet_late(text);
    if (semicolon != std::string_view::npos) {
      const std::string_view comment = text.substr(semicolon + 1);
      constexpr std::string_view mark = "!source:";
      if (comment.starts_with(mark)) source = trimmed(comment.substr(mark.size()));
      if (!source.empty()) report_.diagnostics.source_of(report_.line, source);
      text = text.substr(0, semicolon);
    }
    if (trimmed(text).empty()) return;
    if (program_.instructions.size() == most_instructions) {
      report_.error(0,
                    "more than " + std::to_string(most_instructions) + " operations; the rest is not read");
      full_ = true;
      return;
    }
    Instruction instruction;
    if (!operations_.read(text, instruction)) return;
    if (!source.empty())
      program_.source_marks.emplace_back(static_cast<int>(program_.instructions.size()), source);
    program_.instructions.push_back(std::move(instruction));
  }

  std::string_view text_;
  Program program_;
  KnitoutReport report_;
  KnitoutHeaders headers_;
  KnitoutOperations operations_;
  bool in_headers_ = true, said_carriage_return_ = false, full_ = false;
};

}  // namespace

Program read_knitout(std::string_view text, Diagnostics& diagnostics) {
  return KnitoutReader(text, diagnostics).program();
}

}  // namespace loopwright
