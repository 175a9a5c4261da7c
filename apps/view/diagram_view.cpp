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
  const std::vector<Row> before = std::exchange(rows_, std::vector<Row>(session_.passes()));
  least_slot_ = diagram.first_needle;
  double most_slot = diagram.first_needle + diagram.wales;
  const auto widen = [&](double racking) {
    least_slot_ = std::min(least_slot_, diagram.first_needle + racking);
    most_slot = std::max(most_slot, diagram.first_needle + diagram.wales + racking);
  };
  if (session_.knitout())
    for (const ProgramPass& run : session_.knitout()->diagram().runs()) widen(run.racking);
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
    if (session_.knitout()) continue;
    const DiagramPass& pass = diagram.passes[p];
    if (pass.line && !pass.implied) rows_[p].line = static_cast<int>(*pass.line), rows_[p].pass = pass.pass;
  }
  keep_in_place(cursor_, before);
  keep_in_place(anchor_, before);
  list_acts();
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
  const DiagramPass& of = session_.pass(pass);
  const auto& row = rear ? of.rear : of.front;
  const auto w = static_cast<std::size_t>(wale);
  const double slot = w < row.size() ? row[w].slot : session_.diagram().first_needle + wale;
  return dot(slot, rear ? rows_[pass].rear : rows_[pass].front);
}

// Passes whose line lies between two heights of the viewport, the first and the one after the last.
std::pair<std::size_t, std::size_t> DiagramView::passes_between(double top, double bottom) const {
  const double count = static_cast<double>(rows_.size());
  const auto pass_at = [&](double y) {
    const double height = (y - dot(0, 0).y()) / pitch_;
    return (height_ - 0.8 - bed_distance / 2 - height) / line_height;
  };
  const double first = std::clamp(std::floor(pass_at(bottom)) - 1, 0.0, count),
               last = std::clamp(std::ceil(pass_at(top)) + 2, 0.0, count);
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(last)};
}

std::optional<DiagramView::Place> DiagramView::place_at(const QPointF& at) const {
  const NeedleDiagram& diagram = session_.diagram();
  std::optional<Place> best;
  double nearest = 0.55 * pitch_;
  const auto [first, last] = passes_between(at.y() - line_height * pitch_, at.y() + line_height * pitch_);
  for (std::size_t p = first; p < last; ++p) {
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
  const DiagramPass& pass = session_.pass(place.pass);
  const auto& row = place.rear ? pass.rear : pass.front;
  static const DiagramNeedle none;
  const auto w = static_cast<std::size_t>(place.wale);
  return w < row.size() ? row[w] : none;
}

void DiagramView::set_tool(DiagramTool tool) {
  tool_ = tool;
  emit tool_changed();
}

// Needles in the order in which the carriage meets them.
void DiagramView::list_acts() {
  acts_.clear();
  shown_acts_ = -1;
  if (session_.knitout()) return;  // it knows its own
  const NeedleDiagram& diagram = session_.diagram();
  for (std::size_t p = 0; p < diagram.passes.size(); ++p) {
    const DiagramPass& pass = diagram.passes[p];
    const auto first = static_cast<std::ptrdiff_t>(acts_.size());
    for (const auto* row : {&pass.front, &pass.rear})
      for (const DiagramNeedle& here : *row)
        if (here.operation != NeedleOperation::unused && here.operation != NeedleOperation::inactive)
          acts_.push_back({p, here.slot, here.at.line > 0 ? here.at : pass.at});
    const double way = pass.direction == Direction::left ? -1 : 1;
    std::stable_sort(acts_.begin() + first, acts_.end(),
                     [way](const Act& a, const Act& b) { return way * a.slot < way * b.slot; });
  }
}

int DiagramView::acts() const {
  return session_.knitout() ? session_.knitout()->acts() : static_cast<int>(acts_.size());
}

SourceLocation DiagramView::act_place(int k) const { return act(k).at; }

DiagramView::Act DiagramView::act(int k) const {
  if (const auto& knitout = session_.knitout())
    return {knitout->pass_of(k), knitout->slot(k), knitout->place(k)};
  return acts_[static_cast<std::size_t>(k)];
}

void DiagramView::show_acts(int count) {
  shown_acts_ = count >= acts() ? -1 : count;
  // the cloth as far as it is knitted: a knitout programme is knitted once, from its first line to its last
  if (const auto& knitout = session_.knitout())
    session_.knit_until(shown_acts_ < 0 ? -1 : shown_acts_ == 0 ? 0 : knitout->instruction(shown_acts_ - 1));
  if (count > 0 && count <= acts()) show_pass(act(count - 1).pass);
  viewport()->update();
}

void DiagramView::show_pass(std::size_t p) {
  const double top = dot(0, rows_[p].rear - 0.6).y(), bottom = dot(0, rows_[p].front + 0.6).y();
  QScrollBar* bar = verticalScrollBar();
  if (top < 0) bar->setValue(bar->value() + static_cast<int>(std::floor(top)));
  if (bottom > viewport()->height())
    bar->setValue(bar->value() + static_cast<int>(std::ceil(bottom - viewport()->height())));
}

bool DiagramView::begun(std::size_t pass) const {
  if (shown_acts_ < 0) return true;
  return shown_acts_ > 0 && pass <= act(shown_acts_ - 1).pass;
}

bool DiagramView::done(std::size_t pass, double slot) const {
  if (shown_acts_ < 0) return true;
  if (!begun(pass)) return false;
  const Act last = act(shown_acts_ - 1);
  const double way = session_.pass(pass).direction == Direction::left ? -1 : 1;
  return pass < last.pass || way * slot <= way * last.slot;
}

void DiagramView::choose(const Place& place) {
  const DiagramNeedle& here = needle(place);
  const bool loop = here.operation == NeedleOperation::stitch || here.operation == NeedleOperation::tuck ||
                    here.operation == NeedleOperation::split;
  if (loop) session_.select_at(here.at);
}

void DiagramView::operate(const Place& place, NeedleOperation operation) {
  const NeedleDiagram& diagram = session_.diagram();
  const DiagramPass& pass = session_.pass(place.pass);
  if (session_.knitout()) {
    session_.edit_notation({}, {});  // says why not
    return;
  }
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
                             .arg(session_.pass(place->pass).course)
                             .arg(here.at.line)
                             .arg(QLatin1String(name_of(here.operation))),
                         this);
    }
    return true;
  }
  return QAbstractScrollArea::viewportEvent(event);
}

}  // namespace loopwright
