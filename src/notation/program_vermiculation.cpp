// A programme as vermiculation: its passes become lines, runs of equal lines brackets. What comes out is
// knitted again and compared, so that whatever was not said is told.
#include <algorithm>
#include <optional>

#include "notation/keep_layout.hpp"
#include "notation/needle_acts.hpp"
#include "notation/parse_course.hpp"
#include "notation/program_passes.hpp"
#include "notation/read_vermiculation.hpp"
#include "notation/write_vermiculation.hpp"

namespace loopwright {
namespace {

Extent whole_of(const Program& program) {
  Extent extent{0, program.instructions.size(), 0, 0, false, {}};
  bool any = false;
  int last = 0;
  const auto meet = [&](Needle needle) {
    extent.first = any ? std::min(extent.first, needle.index) : needle.index;
    last = any ? std::max(last, needle.index) : needle.index;
    any = true;
  };
  for (const Instruction& each : program.instructions) {
    if (each.op < Op::knit) continue;
    if (carries_yarn(each) || each.op == Op::xfer) meet(each.needle);
    if (each.op == Op::xfer || each.op == Op::split) meet(each.target);
  }
  extent.wales = any ? last - extent.first + 1 : 0;
  return extent;
}

// All of it as its fabric file has it: from the first needle of the piece on, without what is done when the
// piece is off the notation (bind-off, carriers out).
std::optional<Extent> piece_of(const Program& program, const Extent& whole) {
  const auto piece = program.notation ? needles_of_notation(program) : std::nullopt;
  if (!piece || whole.wales == 0) return std::nullopt;
  Extent extent = whole;
  // rows repeat from the first needle on
  const int repeat = std::max(program.settings.repeat_wales, 1);
  extent.first = piece->first - (std::max(piece->first - whole.first, 0) + repeat - 1) / repeat * repeat;
  extent.wales = std::max(whole.first + whole.wales, piece->first + piece->wales) - extent.first;
  extent.end = piece->end;
  return extent;
}

// One repeat of a fabric file, the second one if it is there: the first starts on empty needles.
std::optional<Extent> repeat_of(const Program& program) {
  const std::vector<int>& starts = program.repeat_starts;
  if (program.settings.repeat_wales <= 0 || starts.size() < 2) return std::nullopt;
  const std::size_t taken = starts.size() > 3 ? 1 : 0;
  return Extent{static_cast<std::size_t>(starts[taken]),
                static_cast<std::size_t>(starts[taken + 1]),
                0,
                program.settings.repeat_wales,
                true,
                {}};
}

// Whether the fabric file makes the programme, its needles counted from `first`.
bool makes(const std::string& text, const Program& program, int first) {
  Diagnostics diagnostics;
  const Program copy = read_vermiculation(text, diagnostics);
  return diagnostics.ok() && needle_acts(copy, 0) == needle_acts(program, first);
}

// With the comments and the layout of the file that the programme came from.
std::optional<std::string> text_with_layout(const Program& program, const Extent& extent) {
  const auto notation = program.notation ? notation_with_changes(program, extent) : std::nullopt;
  if (!notation) return std::nullopt;
  std::string text = write_vermiculation(*notation);
  return makes(text, program, extent.repeat ? 0 : extent.first) ? std::optional(std::move(text))
                                                                : std::nullopt;
}

}  // namespace

std::string write_vermiculation(const Program& program, Diagnostics& diagnostics) {
  if (program.notation) {
    const std::string text = write_vermiculation(notation_with_settings(program));
    Diagnostics again;
    if (same_instructions(read_vermiculation(text, again), program) && again.ok()) return text;
  }
  if (const auto repeat = repeat_of(program)) {
    if (auto text = text_with_layout(program, *repeat)) return *text;
    Diagnostics lost;
    const std::string text = write_vermiculation(decompile(program, *repeat, lost).notation);
    if (lost.list().empty() && makes(text, program, 0)) return text;
    // a piece smaller than its repeat, say, or one of whose repeats is changed: it is written whole
  }
  const Extent whole = whole_of(program);
  if (whole.wales == 0) {
    diagnostics.error({}, "the programme knits nothing; a fabric file needs a course");
    return {};
  }
  if (static_cast<std::size_t>(whole.wales) > most_wales) {
    diagnostics.error({}, "the programme is " + std::to_string(whole.wales) +
                              " needles wide; a fabric file writes at most " + std::to_string(most_wales));
    return {};
  }
  std::size_t letters = 0;
  for (const ProgramPass& pass : passes_of(program))
    letters += (pass.yarn ? 1u : 2u) * static_cast<std::size_t>(whole.wales);
  if (letters > most_letters) {
    diagnostics.error({}, "the programme takes " + std::to_string(letters) +
                              " letters; a fabric file has at most " + std::to_string(most_letters));
    return {};
  }
  const int warnings = diagnostics.warnings();
  if (const auto piece = piece_of(program, whole))
    if (auto text = text_with_layout(program, *piece)) return *text;
  std::string text = write_vermiculation(decompile(program, whole, diagnostics).notation);
  Diagnostics again;
  const Program copy = read_vermiculation(text, again);
  for (const Diagnostic& each : again.list())
    if (each.severity == Severity::error)
      diagnostics.error({}, "the fabric file cannot be knitted as it is, at its line " +
                                std::to_string(each.at.line) + ": " + each.message);
  if (!again.ok() || diagnostics.warnings() > warnings) return text;
  const std::vector<NeedleAct> wanted = needle_acts(program, whole.first), made = needle_acts(copy, 0);
  const auto differs = std::mismatch(wanted.begin(), wanted.end(), made.begin(), made.end());
  if (differs.first != wanted.end() || differs.second != made.end())
    diagnostics.warning(differs.first != wanted.end() ? differs.first->at : SourceLocation{},
                        "from here on the fabric file knits something else");
  return text;
}

}  // namespace loopwright
