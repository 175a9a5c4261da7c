// What mouse, keys and menu do to the diagram.
#include <QKeyEvent>
#include <QMouseEvent>
#include <algorithm>

#include "diagram_view.hpp"

namespace loopwright {

void DiagramView::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  const auto place = place_at(event->position());
  anchor_ = tool_ == DiagramTool::select ? place : std::nullopt;
  painted_ = place;
  if (place) apply_tool(*place);
  viewport()->update();
}

void DiagramView::mouseMoveEvent(QMouseEvent* event) {
  if (!(event->buttons() & Qt::LeftButton)) return;
  const auto place = place_at(event->position());
  if (!place || place == painted_) return;
  painted_ = place;
  if (tool_ == DiagramTool::select) {
    cursor_ = place;
    viewport()->update();
  } else {
    apply_tool(*place);
  }
}

void DiagramView::mouseReleaseEvent(QMouseEvent*) {
  painted_.reset();
  if (anchor_ && cursor_ && *anchor_ == *cursor_) anchor_.reset();
}

// What is selected: the rectangle that was dragged, or the needle under the cursor.
std::optional<DiagramArea> DiagramView::area() const {
  if (!anchor_ || !cursor_) return std::nullopt;
  const NeedleDiagram& diagram = session_.diagram();
  const auto line_of = [&](const Place& place) { return session_.pass(place.pass).line; };
  if (!line_of(*anchor_) || !line_of(*cursor_)) return std::nullopt;
  const int repeat = std::max(diagram.repeat_wales, 1);
  const auto [l0, l1] = std::minmax({*line_of(*anchor_), *line_of(*cursor_)});
  const auto [w0, w1] = std::minmax({anchor_->wale, cursor_->wale});
  if (w0 >= repeat) return std::nullopt;
  return DiagramArea{l0, l1, w0, std::min(w1, repeat - 1)};
}

void DiagramView::copy() {
  if (!session_.notation() || !cursor_) return;
  if (!anchor_) anchor_ = cursor_;
  if (const auto what = area()) copied_ = copied(*session_.notation(), *what);
}

void DiagramView::paste_copied() {
  if (!cursor_ || copied_.lines.empty()) return;
  // at the lower left corner of what is selected
  const auto where = area();
  const auto line = where ? std::optional(where->first_line) : session_.pass(cursor_->pass).line;
  const int repeat = std::max(session_.diagram().repeat_wales, 1);
  const int wale = where ? where->first_wale : cursor_->wale % repeat;
  if (!line) return;
  session_.edit_notation(tr("Paste needles"),
                         [&](Vermiculation& notation) { return paste(notation, copied_, *line, wale); });
}

void DiagramView::repeat_selected() {
  if (!line_at_cursor()) return;
  if (!anchor_) anchor_ = cursor_;
  if (const auto what = area())
    session_.edit_notation(tr("Repeat courses"), [&](Vermiculation& notation) {
      return repeat_lines(notation, what->first_line, what->last_line, 1);
    });
}

void DiagramView::insert_course() {
  const auto line = line_at_cursor();
  if (!line) return;
  session_.edit_notation(tr("Insert course"), [&](Vermiculation& notation) {
    return insert_line(notation, *line + 1, notation.lines[*line]);
  });
}

void DiagramView::remove_courses() {
  if (!line_at_cursor()) return;
  const bool single = !anchor_;
  if (single) anchor_ = cursor_;
  const auto what = area();
  if (single) anchor_.reset();
  if (what)
    session_.edit_notation(tr("Remove courses"), [&](Vermiculation& notation) {
      return remove_lines(notation, what->first_line, what->last_line);
    });
}

void DiagramView::insert_wale_here() {
  if (!cursor_) return;
  const int wale = cursor_->wale % std::max(session_.diagram().repeat_wales, 1);
  session_.edit_notation(tr("Insert wale"), [&](Vermiculation& n) { return insert_wale(n, wale); });
}

void DiagramView::remove_wale_here() {
  if (!cursor_) return;
  const int wale = cursor_->wale % std::max(session_.diagram().repeat_wales, 1);
  session_.edit_notation(tr("Remove wale"), [&](Vermiculation& n) { return remove_wale(n, wale); });
}

void DiagramView::keyPressEvent(QKeyEvent* event) {
  if (!rows_.empty() && !cursor_) {
    cursor_ = Place{};
    while (cursor_->pass + 1 < rows_.size() && rows_[cursor_->pass].line < 0) ++cursor_->pass;
  }
  if (!cursor_) return;
  const auto moved = [&](int passes, int wales) {
    if (event->modifiers() & Qt::ShiftModifier) {
      if (!anchor_) anchor_ = cursor_;
    } else {
      anchor_.reset();
    }
    const auto most = static_cast<int>(session_.passes()) - 1;
    cursor_->pass = static_cast<std::size_t>(std::clamp(static_cast<int>(cursor_->pass) + passes, 0, most));
    cursor_->wale = std::clamp(cursor_->wale + wales, 0, session_.diagram().wales - 1);
    choose(*cursor_);
  };
  const QString typed = event->text();
  const char letter = typed.size() == 1 ? typed[0].toLatin1() : '\0';
  const LetterMeaning meaning = meaning_of(letter, cursor_->rear);
  const bool plain = !(event->modifiers() & Qt::ControlModifier);
  switch (event->key()) {
    case Qt::Key_Up:
      // from the front bed to the rear bed of a pass, then to the next pass
      if (plain && !cursor_->rear && !(event->modifiers() & Qt::ShiftModifier))
        cursor_->rear = true;
      else
        cursor_->rear = false, moved(1, 0);
      break;
    case Qt::Key_Down:
      if (plain && cursor_->rear && !(event->modifiers() & Qt::ShiftModifier))
        cursor_->rear = false;
      else
        cursor_->rear = cursor_->pass > 0, moved(-1, 0);
      break;
    case Qt::Key_Left:
      moved(0, -1);
      break;
    case Qt::Key_Right:
      moved(0, 1);
      break;
    case Qt::Key_Delete:
      operate(*cursor_, NeedleOperation::missed);
      break;
    default:
      if (!plain || meaning.operation == NeedleOperation::unused) {
        QAbstractScrollArea::keyPressEvent(event);
        return;
      }
      // a letter says its bed
      cursor_->rear = meaning.bed == Bed::back;
      operate(*cursor_, meaning.operation);
  }
  viewport()->update();
}

}  // namespace loopwright
