// The notation as text: line numbers, colours, errors underlined where they are, find. What is typed goes to
// the document; what others change in the document comes here as the smallest edit, so that cursor and view
// stay.
#pragma once
#include <QPlainTextEdit>

#include "session.hpp"

class QLineEdit;

namespace loopwright {

class NotationHighlighter;

class NotationEditor : public QPlainTextEdit {
  Q_OBJECT
 public:
  explicit NotationEditor(Session& session, QWidget* parent = nullptr);

  void go_to(SourceLocation at);
  bool find_next(const QString& what, bool backwards);
  void set_dark(bool dark);

  int number_width() const;
  void paint_numbers(QPaintEvent* event);

 protected:
  bool event(QEvent* event) override;
  bool viewportEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;

 private:
  void take_typing();
  void take_change(qsizetype begin, qsizetype removed, qsizetype inserted, bool whole);
  void mark();
  void choose_at_cursor();
  bool show_message(const QPoint& at, const QPoint& global);
  // Byte columns of the notation and characters of the editor.
  QTextCursor cursor_at(SourceLocation at) const;
  SourceLocation location_of(const QTextCursor& cursor) const;

  Session& session_;
  NotationHighlighter* highlighter_;
  QWidget* numbers_;
  bool taking_ = false, dark_ = false;
};

}  // namespace loopwright
