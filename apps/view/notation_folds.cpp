// Passes of knitout that are folded to their first line.
#include <QPainter>
#include <QPlainTextDocumentLayout>
#include <QTextBlock>
#include <algorithm>

#include "notation_editor.hpp"

namespace loopwright {

const std::vector<Fold>& NotationEditor::fold_lines() const {
  static const std::vector<Fold> none;
  return folds_of_ ? folds_of_->folds() : none;
}

void NotationEditor::take_folds() {
  if (session_.knitout() == folds_of_) return;
  folds_of_ = session_.knitout();
  folded_.assign(fold_lines().size(), false);
  setViewportMargins(number_width(), 0, 0, 0);
  numbers_->setGeometry(contentsRect().left(), contentsRect().top(), number_width(), contentsRect().height());
}

std::optional<std::size_t> NotationEditor::fold_of(int line) const {
  const std::vector<Fold>& folds = fold_lines();
  const auto after = std::upper_bound(folds.begin(), folds.end(), line,
                                      [](int wanted, const Fold& fold) { return wanted < fold.first_line; });
  if (after == folds.begin() || line > (after - 1)->last_line) return std::nullopt;
  return static_cast<std::size_t>(after - folds.begin()) - 1;
}

// A hidden block takes no line of the view.
void NotationEditor::hide_lines(const Fold& fold, bool hidden) {
  QTextBlock block = document()->findBlockByNumber(fold.first_line);
  for (int line = fold.first_line + 1; line <= fold.last_line && block.isValid(); ++line) {
    block.setVisible(!hidden);
    block.setLineCount(hidden ? 0 : 1);
    block = block.next();
  }
}

void NotationEditor::after_folding() {
  auto* layout = qobject_cast<QPlainTextDocumentLayout*>(document()->documentLayout());
  layout->requestUpdate();
  emit layout->documentSizeChanged(layout->documentSize());
  // the cursor does not stay where nobody sees it
  if (!textCursor().block().isVisible())
    if (const auto fold = fold_of(textCursor().blockNumber() + 1))
      setTextCursor(QTextCursor(document()->findBlockByNumber(fold_lines()[*fold].first_line - 1)));
  viewport()->update();
  numbers_->update();
}

void NotationEditor::set_folded(std::size_t fold, bool folded) {
  if (fold >= folded_.size() || folded_[fold] == folded) return;
  folded_[fold] = folded;
  hide_lines(fold_lines()[fold], folded);
  after_folding();
}

void NotationEditor::fold_all(bool folded) {
  for (std::size_t k = 0; k < folded_.size(); ++k)
    if (folded_[k] != folded) {
      folded_[k] = folded;
      hide_lines(fold_lines()[k], folded);
    }
  after_folding();
  ensureCursorVisible();
}

void NotationEditor::toggle_fold_at_cursor() {
  if (const auto fold = fold_of(textCursor().blockNumber() + 1)) set_folded(*fold, !folded_[*fold]);
}

void NotationEditor::toggle_fold_at(double y) {
  const int line = cursorForPosition(QPoint(0, static_cast<int>(y))).blockNumber() + 1;
  const auto fold = fold_of(line);
  if (fold && fold_lines()[*fold].first_line == line) set_folded(*fold, !folded_[*fold]);
}

// What a folded pass does stands behind its first line.
void NotationEditor::paintEvent(QPaintEvent* event) {
  QPlainTextEdit::paintEvent(event);
  if (folded_.empty()) return;
  QPainter painter(viewport());
  painter.setPen(palette().color(QPalette::PlaceholderText));
  for (QTextBlock block = firstVisibleBlock(); block.isValid(); block = block.next()) {
    if (!block.isVisible()) continue;
    const QRectF place = blockBoundingGeometry(block).translated(contentOffset());
    if (place.top() > event->rect().bottom()) break;
    const auto fold = fold_of(block.blockNumber() + 1);
    if (!fold || !folded_[*fold]) continue;
    const Fold& of = fold_lines()[*fold];
    const double text = fontMetrics().horizontalAdvance(block.text());
    painter.drawText(QRectF(place.left() + text + 16, place.top(), 600, place.height()), Qt::AlignVCenter,
                     tr("\u2026 %1 (%2 lines)")
                         .arg(QString::fromStdString(of.label))
                         .arg(of.last_line - of.first_line + 1));
  }
}

}  // namespace loopwright
