// The document: the text that is open, where it lies on the disk, and every change that was made to it. All
// editors of the window (text, diagram, yarns) change the text, so one history undoes them all.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright {

// Knitout is shown, not edited. cloth: a saved state or curves of another program; its text is what the file
// says of itself, and is not written.
enum class DocumentKind { fabric, knitout, cloth };

class Document {
 public:
  static constexpr std::string_view empty_fabric =
      ";!vermiculation-1\n;;Name: plain\n;;Gauge: 12\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n"
      ";;Size: 8 wales x 8 courses\n;;Edges: held\ng\n";

  Document();

  const std::string& text() const { return text_; }
  const std::filesystem::path& path() const { return path_; }  // empty: not saved yet
  std::string name() const;                                    // for titles and messages
  std::string suffix() const;                                  // ".verm" or ".k"
  DocumentKind kind() const { return kind_; }
  bool read_only() const { return kind_ != DocumentKind::fabric; }
  bool has_fabric_text() const;  // letters of a fabric file, whatever the document is
  bool changed() const { return place_ != saved_place_; }

  // Replaces what is open; nothing of that can be undone. open() throws FileError.
  void open(const std::filesystem::path& path);
  void open_text(std::string text, std::string_view suffix, const std::filesystem::path& path = {});
  void save(const std::filesystem::path& path);  // throws FileError; the document has that path then
  void mark_saved() { saved_place_ = place_; }   // the disk has this text already
  // What a file of cloth says of itself, once it was read; no change of the document.
  void describe(std::string text);
  // Text that was found after a crash: as open_text, but the document counts as changed.
  void recover(std::string text, const std::filesystem::path& path);

  // The whole text as it is to be. `what` names the change for the menu ("Typing"); changes of the same name
  // that follow one another at neighbouring places are undone together if `joined`.
  void change_to(std::string_view text, const std::string& what, bool joined = false);
  bool can_undo() const { return place_ > 0; }
  bool can_redo() const { return place_ < history_.size(); }
  std::string undo_name() const { return can_undo() ? history_[place_ - 1].what : std::string(); }
  std::string redo_name() const { return can_redo() ? history_[place_].what : std::string(); }
  void undo();
  void redo();

  // What was changed last, in bytes: [begin, begin + removed) became [begin, begin + inserted).
  struct Change {
    std::size_t begin = 0, removed = 0, inserted = 0;
    bool whole = false;  // another text was opened
  };
  std::function<void(const Change&)> on_change;

 private:
  struct Step {
    std::size_t begin = 0;
    std::string before, after;
    std::string what;
    bool joined = false;
  };
  void take(std::string text, DocumentKind kind, const std::filesystem::path& path);
  void apply(std::size_t begin, std::string_view before, std::string_view after);
  bool joins(const Step& step) const;

  std::string text_;
  std::filesystem::path path_;
  DocumentKind kind_ = DocumentKind::fabric;
  std::vector<Step> history_;
  std::size_t place_ = 0;        // steps that are done
  std::size_t saved_place_ = 0;  // steps that were done when it was saved; npos: none of those in reach
};

}  // namespace loopwright
