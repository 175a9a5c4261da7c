#include "diagram_view.hpp"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QScrollBar>
#include <QToolTip>
#include <algorithm>
#include <cmath>
#include <utility>

namespace loopwright {
namespace {

constexpr double bed_distance = 0.9, line_height = 2.1, left_margin = 3.4, right_margin = 2.2;

std::optional<NeedleOperation> operation_of(DiagramTool tool) {
  switch (tool) {
    case DiagramTool::stitch:
      return NeedleOperation::stitch;
    case DiagramTool::tuck:
      return NeedleOperation::tuck;
    case DiagramTool::miss:
      return NeedleOperation::missed;
    case DiagramTool::transfer:
      return NeedleOperation::transfer;
    case DiagramTool::split:
      return NeedleOperation::split;
    case DiagramTool::drop:
      return NeedleOperation::drop;
    case DiagramTool::inactive:
      return NeedleOperation::inactive;
    default:
      return std::nullopt;
  }
}

const char* name_of(NeedleOperation operation) {
  switch (operation) {
    case NeedleOperation::stitch:
      return "stitch";
    case NeedleOperation::tuck:
      return "tuck";
    case NeedleOperation::missed:
      return "missed";
    case NeedleOperation::transfer:
      return "transfer";
    case NeedleOperation::split:
      return "split";
    case NeedleOperation::drop:
      return "drop";
    case NeedleOperation::inactive:
      return "inactive";
    default:
      return "not used";
  }
}

}  // namespace

DiagramView::DiagramView(Session& session, QWidget* parent) : QAbstractScrollArea(parent), session_(session) {
  setObjectName(QStringLiteral("diagram"));
  viewport()->setMouseTracking(false);
  setFocusPolicy(Qt::StrongFocus);
  connect(&session_, &Session::reading_changed, this, [this] {
    lay_out();
    viewport()->update();
  });
  connect(&session_, &Session::selection_changed, viewport(), qOverload<>(&QWidget::update));
  lay_out();
}

void DiagramView::lay_out() {
  const NeedleDiagram& diagram = session_.diagram();
  const std::vector<Row> before = std::exchange(rows_, std::vector<Row>(diagram.passes.size()));
  least_slot_ = diagram.first_needle;
  double most_slot = diagram.first_needle + diagram.wales;
  for (const DiagramPass& pass : diagram.passes)
    for (const DiagramNeedle& needle : pass.rear) {
      least_slot_ = std::min(least_slot_, needle.slot);
      most_slot = std::max(most_slot, needle.slot);
    }
  // the first pass at the bottom
  const double lines = static_cast<double>(rows_.size());
  height_ = lines * line_height + 0.6;
  width_ = most_slot - least_slot_ + left_margin + right_margin;
  for (std::size_t p = 0; p < rows_.size(); ++p) {
    rows_[p].front = height_ - 0.8 - line_height * static_cast<double>(p);
    rows_[p].rear = rows_[p].front - bed_distance;
    const DiagramPass& pass = diagram.passes[p];
    if (pass.line && !pass.implied) rows_[p].line = static_cast<int>(*pass.line), rows_[p].pass = pass.pass;
  }
  keep_in_place(cursor_, before);
  keep_in_place(anchor_, before);
  bars();
}

// A change may put transfers before a pass or take them away: the cursor stays with what is written.
void DiagramView::keep_in_place(std::optional<Place>& place, const std::vector<Row>& before) const {
  if (!place) return;
  if (place->pass < before.size() && before[place->pass].line >= 0) {
    const Row& was = before[place->pass];
    for (std::size_t p = 0; p < rows_.size(); ++p)
      if (rows_[p].line == was.line && rows_[p].pass == was.pass) {
        place->pass = p;
        return;
      }
  }
  if (place->pass >= rows_.size()) place.reset();
}

std::optional<std::size_t> DiagramView::line_at_cursor() {
  if (!cursor_) {
    emit session_.refused(tr("Choose a needle of the diagram first."));
    return std::nullopt;
  }
  const int line = rows_[cursor_->pass].line;
  if (line < 0) {
    emit session_.refused(tr("These transfers follow from the letters: choose a course that is written."));
    return std::nullopt;
  }
  return static_cast<std::size_t>(line);
}

void DiagramView::bars() {
  const QSize room = viewport()->size();
  const bool at_bottom = verticalScrollBar()->value() >= verticalScrollBar()->maximum();
  verticalScrollBar()->setPageStep(room.height());
  verticalScrollBar()->setRange(0, std::max(0, static_cast<int>(height_ * pitch_) - room.height()));
  horizontalScrollBar()->setPageStep(room.width());
  horizontalScrollBar()->setRange(0, std::max(0, static_cast<int>(width_ * pitch_) - room.width()));
  if (at_bottom) verticalScrollBar()->setValue(verticalScrollBar()->maximum());
}

// A short diagram stands on the floor of its window.
QPointF DiagramView::dot(double slot, double height) const {
  const double spare = std::max(0.0, viewport()->height() - height_ * pitch_);
  return {(slot - least_slot_ + left_margin) * pitch_ - horizontalScrollBar()->value(),
          height * pitch_ + spare - verticalScrollBar()->value()};
}

QPointF DiagramView::needle_place(std::size_t pass, bool rear, int wale) const {
  const DiagramPass& of = session_.diagram().passes[pass];
  const auto& row = rear ? of.rear : of.front;
  const auto w = static_cast<std::size_t>(wale);
  const double slot = w < row.size() ? row[w].slot : session_.diagram().first_needle + wale;
  return dot(slot, rear ? rows_[pass].rear : rows_[pass].front);
}

std::optional<DiagramView::Place> DiagramView::place_at(const QPointF& at) const {
  const NeedleDiagram& diagram = session_.diagram();
  std::optional<Place> best;
  double nearest = 0.55 * pitch_;
  for (std::size_t p = 0; p < diagram.passes.size(); ++p) {
    if (std::abs(dot(0, rows_[p].front - bed_distance / 2).y() - at.y()) > line_height * pitch_) continue;
    for (const bool rear : {false, true})
      for (int w = 0; w < diagram.wales; ++w) {
        const QPointF there = needle_place(p, rear, w) - at;
        const double away = std::hypot(there.x(), there.y());
        if (away >= nearest) continue;
        nearest = away;
        best = Place{p, rear, w};
      }
  }
  return best;
}

const DiagramNeedle& DiagramView::needle(const Place& place) const {
  const DiagramPass& pass = session_.diagram().passes[place.pass];
  const auto& row = place.rear ? pass.rear : pass.front;
  static const DiagramNeedle none;
  const auto w = static_cast<std::size_t>(place.wale);
  return w < row.size() ? row[w] : none;
}

void DiagramView::set_tool(DiagramTool tool) {
  tool_ = tool;
  emit tool_changed();
}

void DiagramView::set_last_pass(int pass) {
  last_pass_ = pass;
  viewport()->update();
}

void DiagramView::choose(const Place& place) {
  const DiagramNeedle& here = needle(place);
  const bool loop = here.operation == NeedleOperation::stitch || here.operation == NeedleOperation::tuck ||
                    here.operation == NeedleOperation::split;
  if (loop) session_.select_at(here.at);
}

void DiagramView::operate(const Place& place, NeedleOperation operation) {
  const NeedleDiagram& diagram = session_.diagram();
  const DiagramPass& pass = diagram.passes[place.pass];
  if (!pass.line || pass.implied) {
    emit session_.refused(tr("These transfers follow from the letters: change the stitches instead."));
    return;
  }
  const int repeat = std::max(diagram.repeat_wales, 1);
  const NeedlePlace where{*pass.line, pass.pass, place.rear ? Bed::back : Bed::front, place.wale % repeat};
  session_.edit_notation(
      tr("Needle: %1").arg(QLatin1String(name_of(operation))),
      [&](Vermiculation& notation) { return change_operation(notation, where, operation); });
}

void DiagramView::apply_tool(const Place& place) {
  cursor_ = place;
  if (const auto operation = operation_of(tool_))
    operate(place, *operation);
  else
    choose(place);
  viewport()->update();
}

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
  const auto line_of = [&](const Place& place) { return diagram.passes[place.pass].line; };
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
  const auto& passes = session_.diagram().passes;
  // at the lower left corner of what is selected
  const auto where = area();
  const auto line = where ? std::optional(where->first_line) : passes[cursor_->pass].line;
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
    const auto most = static_cast<int>(session_.diagram().passes.size()) - 1;
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

void DiagramView::resizeEvent(QResizeEvent* event) {
  QAbstractScrollArea::resizeEvent(event);
  bars();
}

void DiagramView::zoom(double factor) {
  pitch_ = std::clamp(pitch_ * factor, 6.0, 120.0);
  bars();
  viewport()->update();
}

void DiagramView::wheelEvent(QWheelEvent* event) {
  if (event->modifiers() & Qt::ControlModifier) {
    zoom(std::pow(1.15, event->angleDelta().y() / 120.0));
    event->accept();
  } else {
    QAbstractScrollArea::wheelEvent(event);
  }
}

bool DiagramView::viewportEvent(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    const auto* help = static_cast<QHelpEvent*>(event);
    if (const auto place = place_at(help->pos())) {
      const DiagramNeedle& here = needle(*place);
      QToolTip::showText(help->globalPos(),
                         tr("%1 needle %2, course %3, line %4: %5")
                             .arg(place->rear ? tr("rear") : tr("front"))
                             .arg(session_.diagram().first_needle + place->wale)
                             .arg(session_.diagram().passes[place->pass].course)
                             .arg(here.at.line)
                             .arg(QLatin1String(name_of(here.operation))),
                         this);
    }
    return true;
  }
  return QAbstractScrollArea::viewportEvent(event);
}

}  // namespace loopwright
