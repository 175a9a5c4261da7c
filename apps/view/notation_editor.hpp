// The notation as text: line numbers, colours, errors underlined where they are, find. What is typed goes to
// the document; what others change in the document comes here as the smallest edit, so that cursor and view
// stay.
#pragma once
#include <QPlainTextEdit>
#include <optional>
#include <vector>

#include "session.hpp"

class QLineEdit;

namespace loopwright {

class NotationHighlighter;

class NotationEditor : public QPlainTextEdit {
  Q_OBJECT
 public:
  explicit NotationEditor(Session& session, QWidget* parent = nullptr);

  // A folded pass is opened, or with `opens` false its first line is gone to.
  void go_to(SourceLocation at, bool opens = true);
  // Passes of knitout: hides all lines of a pass but its first. By place in the session's list of folds.
  std::size_t folds() const { return folded_.size(); }
  bool folded(std::size_t fold) const { return folded_[fold]; }
  void set_folded(std::size_t fold, bool folded);
  void fold_all(bool folded);
  void toggle_fold_at_cursor();
  void toggle_fold_at(double y);  // in the margin
  bool find_next(const QString& what, bool backwards);
  void set_dark(bool dark);

  int number_width() const;
  void paint_numbers(QPaintEvent* event);

 protected:
  bool event(QEvent* event) override;
  bool viewportEvent(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;

 private:
  void take_typing();
  void take_change(qsizetype begin, qsizetype removed, qsizetype inserted, bool whole);
  void mark();
  void take_folds();
  const std::vector<Fold>& fold_lines() const;
  std::optional<std::size_t> fold_of(int line) const;  // that holds this line
  void hide_lines(const Fold& fold, bool hidden);
  void after_folding();
  void choose_at_cursor();
  bool show_message(const QPoint& at, const QPoint& global);
  // Byte columns of the notation and characters of the editor.
  QTextCursor cursor_at(SourceLocation at) const;
  SourceLocation location_of(const QTextCursor& cursor) const;

  Session& session_;
  NotationHighlighter* highlighter_;
  QWidget* numbers_;
  bool taking_ = false, dark_ = false;
  std::shared_ptr<const KnitoutPasses> folds_of_;
  std::vector<bool> folded_;
};

}  // namespace loopwright
