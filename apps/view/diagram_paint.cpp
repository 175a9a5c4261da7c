// How the diagram is drawn.
#include <QPaintEvent>
#include <QPainter>
#include <QPainterPath>
#include <QScrollBar>
#include <algorithm>
#include <array>
#include <cmath>

#include "diagram_view.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

// In needle pitches.
constexpr double loop_half = 0.3, loop_depth = 0.34, dot_radius = 0.07;

struct Stop {
  double slot = 0;
  NeedleOperation operation = NeedleOperation::missed;
  bool front = true;
};

// Needles in the order in which the yarn meets them from the left; of two that face each other the one that
// misses is passed in silence.
std::vector<Stop> stops_of(const DiagramPass& pass) {
  std::vector<Stop> stops;
  for (const bool front : {true, false})
    for (const DiagramNeedle& needle : front ? pass.front : pass.rear) switch (needle.operation) {
        case NeedleOperation::stitch:
        case NeedleOperation::tuck:
        case NeedleOperation::split:
        case NeedleOperation::missed:
          stops.push_back({needle.slot, needle.operation, front});
          break;
        default:
          break;
      }
  std::stable_sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.slot < b.slot; });
  std::vector<Stop> met;
  for (const Stop& stop : stops) {
    const bool same = !met.empty() && met.back().slot == stop.slot;
    if (same && stop.operation == NeedleOperation::missed) continue;
    if (same && met.back().operation == NeedleOperation::missed)
      met.back() = stop;
    else
      met.push_back(stop);
  }
  return met;
}

void draw_dot(QPainter& painter, const QPointF& at, double pitch, const QColor& colour) {
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour);
  painter.drawEllipse(at, dot_radius * pitch, dot_radius * pitch);
}

}  // namespace

QColor DiagramView::yarn_colour(int yarn) const {
  constexpr std::array usual{0x1f3a5f, 0xb03020, 0x2e7d4f, 0x8a5a00, 0x6a3d8a, 0x00707a};
  const auto& yarns = session_.diagram().yarns;
  const auto place = static_cast<std::size_t>(yarn);
  if (place < yarns.size() && !yarns[place].colour.empty())
    return QColor(QString::fromStdString(yarns[place].colour));
  return QColor(static_cast<QRgb>(usual[place % usual.size()]));
}

void DiagramView::paintEvent(QPaintEvent* event) {
  QPainter painter(viewport());
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(event->rect(), QColor(255, 255, 255));
  const NeedleDiagram& diagram = session_.diagram();
  if (rows_.empty()) {
    painter.setPen(QColor(120, 120, 120));
    painter.drawText(viewport()->rect(), Qt::AlignCenter | Qt::TextWordWrap,
                     session_.document().kind() == DocumentKind::cloth
                         ? tr("This file holds cloth: it has no needle diagram.")
                         : tr("The diagram is drawn as soon as the text can be read."));
    return;
  }
  if (!session_.diagram_is_current()) painter.setOpacity(0.4);
  // one repeat on a faint ground
  const int repeat = diagram.repeat_wales > 0 ? diagram.repeat_wales : diagram.wales;
  const QPointF corner = dot(diagram.first_needle - 0.5, 0);
  painter.fillRect(QRectF(corner.x(), 0, repeat * pitch_, viewport()->height()), QColor(247, 245, 238));
  const auto [first, last] = passes_between(event->rect().top(), event->rect().bottom());
  for (std::size_t p = first; p < last; ++p) paint_pass(painter, p);
}

void DiagramView::paint_pass(QPainter& painter, std::size_t p) {
  const NeedleDiagram& diagram = session_.diagram();
  DiagramPass pass = session_.pass(p);
  // what the carriage has not come to yet
  for (auto* row : {&pass.front, &pass.rear})
    for (DiagramNeedle& needle : *row)
      if (begun(p) && !done(p, needle.slot)) needle.operation = NeedleOperation::unused;
  const double usual = painter.opacity();
  if (!begun(p)) painter.setOpacity(0.18);
  const double left = dot(diagram.first_needle - 0.6, 0).x(),
               right = dot(diagram.first_needle + diagram.wales - 0.4, 0).x();
  painter.setPen(QPen(QColor(228, 226, 218), 1));
  const double base = dot(0, rows_[p].front + 0.46).y();
  painter.drawLine(QPointF(left, base), QPointF(right, base));
  if (const auto chosen = area(); chosen && pass.line && !pass.implied)
    if (*pass.line >= chosen->first_line && *pass.line <= chosen->last_line) {
      const QPointF a = dot(diagram.first_needle + chosen->first_wale - 0.5, rows_[p].rear - 0.42);
      const QPointF b = dot(diagram.first_needle + chosen->last_wale + 0.5, rows_[p].front + 0.42);
      painter.fillRect(QRectF(a, b), QColor(90, 150, 240, 60));
    }
  paint_needles(painter, pass, rows_[p]);
  if (pass.carries_yarn) paint_yarn(painter, pass, rows_[p]);
  paint_labels(painter, p);
  if (cursor_ && cursor_->pass == p) {
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(QColor(40, 110, 230), 1.5));
    const QPointF at = needle_place(p, cursor_->rear, cursor_->wale);
    painter.drawRect(QRectF(at.x() - 0.4 * pitch_, at.y() - 0.4 * pitch_, 0.8 * pitch_, 0.8 * pitch_));
  }
  painter.setOpacity(usual);
}

void DiagramView::paint_needles(QPainter& painter, const DiagramPass& pass, const Row& row) {
  const double arm = 0.13 * pitch_;
  const SourceLocation chosen = session_.selection().at;
  for (const bool front : {true, false})
    for (const DiagramNeedle& needle : front ? pass.front : pass.rear) {
      const QPointF at = dot(needle.slot, front ? row.front : row.rear);
      const bool works = needle.operation != NeedleOperation::unused &&
                         needle.operation != NeedleOperation::missed &&
                         needle.operation != NeedleOperation::inactive;
      if (works && chosen.line > 0 && needle.at == chosen) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(QColor(235, 60, 40, 90));
        painter.drawEllipse(at, 0.42 * pitch_, 0.42 * pitch_);
      }
      painter.setPen(QPen(QColor(34, 34, 34), 1.2));
      painter.setBrush(Qt::NoBrush);
      switch (needle.operation) {
        case NeedleOperation::inactive:
          if (pass.carries_yarn) {
            painter.drawLine(at + QPointF(-arm, -arm), at + QPointF(arm, arm));
            painter.drawLine(at + QPointF(-arm, arm), at + QPointF(arm, -arm));
          } else {
            draw_dot(painter, at, pitch_, QColor(190, 190, 190));
          }
          break;
        case NeedleOperation::drop:
          painter.drawEllipse(at, arm, arm);
          break;
        case NeedleOperation::unused:
          draw_dot(painter, at, pitch_ * 0.8, QColor(200, 200, 200));
          break;
        default:
          draw_dot(painter, at, pitch_, QColor(34, 34, 34));
      }
      if (needle.operation == NeedleOperation::transfer || needle.operation == NeedleOperation::split) {
        const double to = front ? row.rear : row.front, up = front ? -1 : 1;
        painter.setPen(QPen(QColor(160, 74, 0), 1.6, pass.implied ? Qt::DotLine : Qt::SolidLine));
        const QPointF tip = dot(needle.slot, to) - QPointF(0, up * 0.16 * pitch_);
        painter.drawLine(at + QPointF(0, up * 0.16 * pitch_), tip);
        painter.drawLine(tip, tip + QPointF(-0.1 * pitch_, -up * 0.18 * pitch_));
        painter.drawLine(tip, tip + QPointF(0.1 * pitch_, -up * 0.18 * pitch_));
      }
    }
}

// The yarn from left to right: round a needle that knits, into the hook of one that tucks, past one that
// misses.
void DiagramView::paint_yarn(QPainter& painter, const DiagramPass& pass, const Row& row) {
  const std::vector<Stop> stops = stops_of(pass);
  if (stops.empty()) return;
  for (std::size_t strand = 0; strand < pass.yarns.size(); ++strand) {
    const double shift = 0.11 * static_cast<double>(strand), way = (row.front + row.rear) / 2 + shift;
    QPainterPath path(dot(stops.front().slot - 0.75, way));
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const Stop& stop = stops[i];
      const double s = stop.slot, needle = stop.front ? row.front : row.rear, out = stop.front ? 1 : -1;
      // half-way to the neighbours, which stand half a pitch apart where the beds are gated so
      const double before = i == 0 ? 0.5 : std::min(0.5, (s - stops[i - 1].slot) / 2);
      const double after = i + 1 == stops.size() ? 0.5 : std::min(0.5, (stops[i + 1].slot - s) / 2);
      path.lineTo(dot(s - before, way));
      if (stop.operation != NeedleOperation::missed) {
        const double half = loop_half - 0.9 * shift, end = needle + out * (loop_depth - 0.9 * shift);
        // a stitch's legs cross below the needle, those of a tuck stand apart
        const double a = stop.operation == NeedleOperation::tuck ? -half : half, neck = needle - out * 0.24;
        const double leg = needle + out * 0.04, belly = needle + out * 0.22;
        path.cubicTo(dot(s - 0.1 * before, way), dot(s + a, neck), dot(s + a, leg));
        path.cubicTo(dot(s + a, belly), dot(s + 0.55 * a, end), dot(s, end));
        path.cubicTo(dot(s - 0.55 * a, end), dot(s - a, belly), dot(s - a, leg));
        path.cubicTo(dot(s - a, neck), dot(s + 0.1 * after, way), dot(s + after, way));
      }
      path.lineTo(dot(s + after, way));
    }
    path.lineTo(dot(stops.back().slot + 0.75, way));
    const QColor colour = yarn_colour(pass.yarns[strand]);
    painter.setBrush(Qt::NoBrush);
    if (colour.lightness() > 175) {
      painter.setPen(QPen(QColor(90, 90, 90), 0.13 * pitch_, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
      painter.drawPath(path);
    }
    painter.setPen(QPen(colour, 0.085 * pitch_, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.drawPath(path);
  }
}

void DiagramView::paint_labels(QPainter& painter, std::size_t p) {
  const NeedleDiagram& diagram = session_.diagram();
  const DiagramPass& pass = session_.pass(p);
  const double middle = dot(0, (rows_[p].front + rows_[p].rear) / 2).y();
  QFont font = painter.font();
  font.setPixelSize(std::max(9, static_cast<int>(0.42 * pitch_)));
  painter.setFont(font);
  painter.setPen(QColor(60, 60, 60));
  const bool first = p == 0 || session_.pass(p - 1).course != pass.course;
  const double left = dot(least_slot_, 0).x();
  // the course stands apart from the yarn, whose name may be a number as well
  if (first) {
    painter.setPen(QColor(150, 146, 134));
    painter.drawText(QRectF(left - 3.3 * pitch_, middle - pitch_ / 2, 1.2 * pitch_, pitch_),
                     Qt::AlignRight | Qt::AlignVCenter, QString::number(pass.course));
    painter.setPen(QColor(60, 60, 60));
  }
  QString who;
  for (const int yarn : pass.yarns)
    who += (who.isEmpty() ? QString() : QStringLiteral("+")) +
           QString::fromStdString(diagram.yarns[static_cast<std::size_t>(yarn)].name);
  if (pass.carries_yarn)
    who += pass.direction == Direction::left ? QStringLiteral(" \u2190") : QStringLiteral(" \u2192");
  painter.drawText(QRectF(left - 1.7 * pitch_, middle - pitch_ / 2, 1.5 * pitch_, pitch_),
                   Qt::AlignLeft | Qt::AlignVCenter, who);
  const double shown = pass.racking - (pass.carries_yarn ? diagram.gating : 0);
  if (shown != 0)
    painter.drawText(
        QRectF(dot(diagram.first_needle + diagram.wales, 0).x(), middle - pitch_ / 2, 3 * pitch_, pitch_),
        Qt::AlignLeft | Qt::AlignVCenter, QStringLiteral("R%1").arg(shown));
}

}  // namespace loopwright
