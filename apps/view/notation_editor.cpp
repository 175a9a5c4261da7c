#include "notation_editor.hpp"

#include <QHelpEvent>
#include <QPainter>
#include <QTextBlock>
#include <QToolTip>
#include <algorithm>

#include "notation_highlighter.hpp"

namespace loopwright {
namespace {

// The editor knows line feeds alone; a file that ends its lines with CR LF keeps doing so.
bool has_carriage_returns(const std::string& text) { return text.find("\r\n") != std::string::npos; }

QString shown_text(const std::string& text) {
  QString shown = QString::fromUtf8(text.data(), static_cast<qsizetype>(text.size()));
  shown.remove(QLatin1Char('\r'));
  return shown;
}

constexpr int fold_mark = 14;  // pixels

class LineNumbers : public QWidget {
 public:
  explicit LineNumbers(NotationEditor* editor) : QWidget(editor), editor_(editor) {}
  QSize sizeHint() const override { return {editor_->number_width(), 0}; }

 protected:
  void paintEvent(QPaintEvent* event) override { editor_->paint_numbers(event); }
  void mousePressEvent(QMouseEvent* event) override { editor_->toggle_fold_at(event->position().y()); }

 private:
  NotationEditor* editor_;
};

DocumentKind kind_of_text(const Document& document) {
  return document.has_fabric_text() ? DocumentKind::fabric : DocumentKind::knitout;
}

QColor severity_colour(Severity severity) {
  return severity == Severity::error     ? QColor(210, 50, 40)
         : severity == Severity::warning ? QColor(200, 130, 0)
                                         : QColor(90, 130, 200);
}

}  // namespace

NotationEditor::NotationEditor(Session& session, QWidget* parent)
    : QPlainTextEdit(parent),
      session_(session),
      highlighter_(new NotationHighlighter(document())),
      numbers_(new LineNumbers(this)) {
  setObjectName(QStringLiteral("notation"));
  setUndoRedoEnabled(false);  // the document's own history undoes everything
  setLineWrapMode(NoWrap);
  QFont font(QStringLiteral("DejaVu Sans Mono"));
  font.setStyleHint(QFont::Monospace);
  setFont(font);
  setTabStopDistance(4 * fontMetrics().horizontalAdvance(QLatin1Char(' ')));
  connect(this, &QPlainTextEdit::textChanged, this, &NotationEditor::take_typing);
  connect(this, &QPlainTextEdit::blockCountChanged, this,
          [this] { setViewportMargins(number_width(), 0, 0, 0); });
  connect(this, &QPlainTextEdit::updateRequest, this, [this](const QRect& rect, int dy) {
    if (dy != 0)
      numbers_->scroll(0, dy);
    else
      numbers_->update(0, rect.y(), numbers_->width(), rect.height());
  });
  connect(&session_, &Session::text_changed, this, &NotationEditor::take_change);
  connect(&session_, &Session::reading_changed, this, &NotationEditor::take_folds);
  connect(&session_, &Session::reading_changed, this, &NotationEditor::mark);
  connect(&session_, &Session::selection_changed, this, [this] {
    mark();
    const Selection& chosen = session_.selection();
    if (chosen.at.line > 0 && !hasFocus()) go_to(chosen.at);
  });
  setViewportMargins(number_width(), 0, 0, 0);
  take_change(0, 0, 0, true);
}

int NotationEditor::number_width() const {
  const int digits = std::max(2, static_cast<int>(QString::number(blockCount()).size()));
  return 12 + digits * fontMetrics().horizontalAdvance(QLatin1Char('9')) + (folded_.empty() ? 0 : fold_mark);
}

void NotationEditor::resizeEvent(QResizeEvent* event) {
  QPlainTextEdit::resizeEvent(event);
  const QRect area = contentsRect();
  numbers_->setGeometry(area.left(), area.top(), number_width(), area.height());
}

void NotationEditor::paint_numbers(QPaintEvent* event) {
  QPainter painter(numbers_);
  painter.fillRect(event->rect(), palette().color(QPalette::AlternateBase));
  QTextBlock block = firstVisibleBlock();
  int top = qRound(blockBoundingGeometry(block).translated(contentOffset()).top());
  const std::vector<Fold>& folds = fold_lines();
  while (block.isValid() && top <= event->rect().bottom()) {
    if (!block.isVisible()) {
      block = block.next();
      continue;
    }
    const int line = block.blockNumber() + 1, height = qRound(blockBoundingRect(block).height());
    // a dot stands beside lines that have a message
    for (const Diagnostic& message : session_.diagnostics().list())
      if (message.at.line == line) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(severity_colour(message.severity));
        painter.drawEllipse(QPointF(5, top + height / 2.0), 3, 3);
        break;
      }
    painter.setPen(palette().color(QPalette::PlaceholderText));
    const int room = numbers_->width() - 4 - (folded_.empty() ? 0 : fold_mark);
    painter.drawText(0, top, room, height, Qt::AlignRight, QString::number(line));
    if (const auto fold = fold_of(line); fold && folds[*fold].first_line == line) {
      const double x = numbers_->width() - fold_mark / 2.0 - 1, y = top + height / 2.0;
      painter.setPen(Qt::NoPen);
      painter.setBrush(palette().color(QPalette::PlaceholderText));
      if (folded_[*fold])
        painter.drawPolygon(QPolygonF({{x - 2.5, y - 4}, {x + 3.5, y}, {x - 2.5, y + 4}}));
      else
        painter.drawPolygon(QPolygonF({{x - 4, y - 2.5}, {x + 4, y - 2.5}, {x, y + 3.5}}));
    }
    top += height;
    block = block.next();
  }
}

void NotationEditor::take_typing() {
  if (taking_) return;
  std::string text = toPlainText().toStdString();
  if (has_carriage_returns(session_.document().text())) {
    std::string with_returns;
    for (const char c : text) {
      if (c == '\n') with_returns += '\r';
      with_returns += c;
    }
    text = std::move(with_returns);
  }
  taking_ = true;
  session_.change_text(text, tr("Typing"), true);
  taking_ = false;
}

void NotationEditor::take_change(qsizetype, qsizetype, qsizetype, bool whole) {
  if (taking_) return;
  taking_ = true;
  const QString wanted = shown_text(session_.document().text());
  if (whole) {
    highlighter_->set_kind(kind_of_text(session_.document()));
    setReadOnly(session_.document().read_only());
    setPlainText(wanted);
  } else {
    // the smallest piece that differs
    if (session_.document().read_only()) highlighter_->set_kind(kind_of_text(session_.document()));
    const QString shown = toPlainText();
    const qsizetype shorter = std::min(shown.size(), wanted.size());
    qsizetype head = 0, tail = 0;
    while (head < shorter && shown[head] == wanted[head]) ++head;
    while (tail < shorter - head && shown[shown.size() - 1 - tail] == wanted[wanted.size() - 1 - tail])
      ++tail;
    QTextCursor cursor(document());
    cursor.setPosition(static_cast<int>(head));
    cursor.setPosition(static_cast<int>(shown.size() - tail), QTextCursor::KeepAnchor);
    cursor.insertText(wanted.mid(head, wanted.size() - head - tail));
  }
  taking_ = false;
}

QTextCursor NotationEditor::cursor_at(SourceLocation at) const {
  QTextCursor cursor(document()->findBlockByNumber(std::max(at.line, 1) - 1));
  const QByteArray bytes = cursor.block().text().toUtf8();
  const int column = std::clamp(at.column - 1, 0, static_cast<int>(bytes.size()));
  cursor.setPosition(cursor.block().position() +
                     static_cast<int>(QString::fromUtf8(bytes.left(column)).size()));
  return cursor;
}

SourceLocation NotationEditor::location_of(const QTextCursor& cursor) const {
  const QString before = cursor.block().text().left(cursor.positionInBlock());
  return {cursor.blockNumber() + 1, static_cast<int>(before.toUtf8().size()) + 1};
}

void NotationEditor::go_to(SourceLocation at, bool opens) {
  if (at.line <= 0) return;
  if (const auto fold = fold_of(at.line);
      fold && folded_[*fold] && at.line > fold_lines()[*fold].first_line) {
    if (opens)
      set_folded(*fold, false);
    else
      at = {fold_lines()[*fold].first_line, 0};
  }
  setTextCursor(cursor_at(at));
  ensureCursorVisible();
}

bool NotationEditor::find_next(const QString& what, bool backwards) {
  if (what.isEmpty()) return false;
  const QTextDocument::FindFlags flags = backwards ? QTextDocument::FindBackward : QTextDocument::FindFlags();
  // what was found may lie in a folded pass
  const auto found = [this] {
    if (const auto fold = fold_of(textCursor().blockNumber() + 1)) set_folded(*fold, false);
    ensureCursorVisible();
    return true;
  };
  if (find(what, flags)) return found();
  // round the end
  QTextCursor cursor = textCursor();
  cursor.movePosition(backwards ? QTextCursor::End : QTextCursor::Start);
  const QTextCursor kept = textCursor();
  setTextCursor(cursor);
  if (find(what, flags)) return found();
  setTextCursor(kept);
  return false;
}

void NotationEditor::set_dark(bool dark) {
  dark_ = dark;
  highlighter_->set_dark(dark);
  mark();
}

// Errors underlined, the chosen letter on a coloured ground.
void NotationEditor::mark() {
  QList<QTextEdit::ExtraSelection> marks;
  for (const Diagnostic& message : session_.diagnostics().list()) {
    if (message.at.line <= 0) continue;
    QTextEdit::ExtraSelection mark;
    mark.cursor = cursor_at(message.at);
    if (message.at.column > 0 && !mark.cursor.atBlockEnd())
      mark.cursor.movePosition(QTextCursor::NextCharacter, QTextCursor::KeepAnchor);
    else
      mark.cursor.select(QTextCursor::LineUnderCursor);
    mark.format.setUnderlineStyle(QTextCharFormat::WaveUnderline);
    mark.format.setUnderlineColor(severity_colour(message.severity));
    if (message.severity == Severity::error)
      mark.format.setBackground(dark_ ? QColor(110, 30, 30) : QColor(255, 220, 215));
    marks.append(mark);
  }
  const Selection& chosen = session_.selection();
  if (chosen.at.line > 0) {
    QTextEdit::ExtraSelection mark;
    mark.cursor = cursor_at(chosen.at);
    if (session_.document().kind() == DocumentKind::fabric)
      mark.cursor.movePosition(QTextCursor::NextCharacter, QTextCursor::KeepAnchor);
    else
      mark.cursor.select(QTextCursor::LineUnderCursor);
    mark.format.setBackground(dark_ ? QColor(150, 60, 40) : QColor(255, 205, 170));
    marks.append(mark);
  }
  setExtraSelections(marks);
  numbers_->update();
}

void NotationEditor::choose_at_cursor() {
  SourceLocation at = location_of(textCursor());
  if (session_.document().kind() == DocumentKind::knitout) at.column = 0;
  const auto& fabric = session_.fabric();
  if (!fabric) return;
  // the loop of this letter, or of this line where the notation has no columns
  for (const LoopSpan& span : fabric->loops)
    if (span.at.line == at.line && (at.column == 0 || span.at.column == at.column)) {
      if (!(session_.selection().at == span.at)) session_.select_at(span.at);
      return;
    }
}

void NotationEditor::mouseReleaseEvent(QMouseEvent* event) {
  QPlainTextEdit::mouseReleaseEvent(event);
  choose_at_cursor();
}

void NotationEditor::keyReleaseEvent(QKeyEvent* event) {
  QPlainTextEdit::keyReleaseEvent(event);
  if (event->key() >= Qt::Key_Left && event->key() <= Qt::Key_Down) choose_at_cursor();
}

bool NotationEditor::show_message(const QPoint& at, const QPoint& global) {
  const SourceLocation here = location_of(cursorForPosition(at));
  const Diagnostic* nearest = nullptr;
  for (const Diagnostic& message : session_.diagnostics().list())
    if (message.at.line == here.line &&
        (!nearest || std::abs(message.at.column - here.column) < std::abs(nearest->at.column - here.column)))
      nearest = &message;
  if (!nearest) return false;
  QToolTip::showText(global, QString::fromStdString(nearest->message), this);
  return true;
}

bool NotationEditor::event(QEvent* event) {
  // undo and redo are the window's: they undo the diagram's changes as well
  if (event->type() == QEvent::ShortcutOverride) {
    auto* key = static_cast<QKeyEvent*>(event);
    if (key->matches(QKeySequence::Undo) || key->matches(QKeySequence::Redo)) {
      event->ignore();
      return false;
    }
  }
  return QPlainTextEdit::event(event);
}

bool NotationEditor::viewportEvent(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    auto* help = static_cast<QHelpEvent*>(event);
    if (!show_message(help->pos(), help->globalPos())) QToolTip::hideText();
    return true;
  }
  return QPlainTextEdit::viewportEvent(event);
}

}  // namespace loopwright
