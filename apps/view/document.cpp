#include "document.hpp"

#include <algorithm>
#include <fstream>
#include <utility>

#include "cloth_file_job.hpp"
#include "notation/read_program.hpp"
#include "notation/scan.hpp"
#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

bool continues_a_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

Document::Document() { open_text(std::string(empty_fabric), ".verm"); }

std::string Document::name() const {
  return path_.empty() ? "untitled" + suffix() : path_.filename().string();
}

std::string Document::suffix() const { return kind_ == DocumentKind::knitout ? ".k" : ".verm"; }

bool Document::has_fabric_text() const { return is_fabric_text(text_, suffix()); }

void Document::open(const std::filesystem::path& path) {
  if (names_cloth(path)) {
    // what is in it takes a while: whoever shows it reads it
    if (!std::ifstream(path)) throw FileError(path.string() + ": cannot be read");
    take({}, DocumentKind::cloth, path);
    return;
  }
  Diagnostics diagnostics(path.string());
  std::optional<std::string> text = read_text(path, diagnostics);
  if (!text)
    throw FileError(path.string() + ": " +
                    (diagnostics.list().empty() ? "cannot be read" : diagnostics.list().front().message));
  if (first_byte_not_utf8(*text) != std::string_view::npos)
    throw FileError(path.string() +
                    ": this is no text in UTF-8; open a fabric file (.verm), knitout (.k), a "
                    "saved state (.h5) or curves (.bcc, .yarns, .obj)");
  open_text(std::move(*text), path.extension().string(), path);
}

void Document::open_text(std::string text, std::string_view suffix, const std::filesystem::path& path) {
  const DocumentKind kind = is_fabric_text(text, suffix) ? DocumentKind::fabric : DocumentKind::knitout;
  take(std::move(text), kind, path);
}

void Document::take(std::string text, DocumentKind kind, const std::filesystem::path& path) {
  kind_ = kind;
  text_ = std::move(text);
  path_ = path;
  history_.clear();
  place_ = saved_place_ = 0;
  if (on_change) on_change({0, 0, text_.size(), true});
}

void Document::recover(std::string text, const std::filesystem::path& path) {
  open_text(std::move(text), path.empty() ? ".verm" : path.extension().string(), path);
  saved_place_ = nowhere;
}

void Document::describe(std::string text) {
  if (kind_ != DocumentKind::cloth || text == text_) return;
  const std::size_t removed = std::exchange(text_, std::move(text)).size();
  if (on_change) on_change({0, removed, text_.size(), false});
}

void Document::save(const std::filesystem::path& path) {
  if (kind_ == DocumentKind::cloth)
    throw FileError(path.string() + ": a file of cloth is written by File > Export, not saved as text");
  AtomicFile file(path);
  file.stream() << text_;
  file.commit();
  path_ = path;
  saved_place_ = place_;
  if (place_ > 0) history_[place_ - 1].joined = false;
}

// Whether the step goes on where the last one ended, so that both are undone together.
bool Document::joins(const Step& step) const {
  if (!step.joined || place_ == 0 || place_ == saved_place_) return false;
  const Step& last = history_[place_ - 1];
  if (!last.joined || last.what != step.what) return false;
  const bool new_line = step.after.find('\n') != std::string::npos;
  return !new_line && step.before.empty() && step.begin == last.begin + last.after.size();
}

void Document::change_to(std::string_view text, const std::string& what, bool joined) {
  if (read_only() || text == text_) return;
  // what is the same before and behind the change
  const std::string_view old = text_;
  const std::size_t shorter = std::min(old.size(), text.size());
  std::size_t head = 0, tail = 0;
  while (head < shorter && old[head] == text[head]) ++head;
  while (head > 0 && head < old.size() && continues_a_character(old[head])) --head;
  while (tail < shorter - head && old[old.size() - 1 - tail] == text[text.size() - 1 - tail]) ++tail;
  while (tail > 0 && continues_a_character(old[old.size() - tail])) --tail;
  Step step{head, std::string(old.substr(head, old.size() - head - tail)),
            std::string(text.substr(head, text.size() - head - tail)), what, joined};

  history_.resize(place_);
  if (saved_place_ != nowhere && saved_place_ > place_) saved_place_ = nowhere;
  const Step done = step;
  if (joins(step)) {
    history_.back().after += step.after;
  } else {
    history_.push_back(std::move(step));
    ++place_;
  }
  apply(done.begin, done.before, done.after);
}

void Document::undo() {
  if (!can_undo()) return;
  const Step& step = history_[--place_];
  apply(step.begin, step.after, step.before);
}

void Document::redo() {
  if (!can_redo()) return;
  const Step& step = history_[place_++];
  apply(step.begin, step.before, step.after);
}

void Document::apply(std::size_t begin, std::string_view before, std::string_view after) {
  text_.replace(begin, before.size(), after);
  if (on_change) on_change({begin, before.size(), after.size(), false});
}

}  // namespace loopwright
