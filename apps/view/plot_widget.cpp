#include "plot_widget.hpp"

#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace loopwright {
namespace {

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v), high = std::max(high, v);
  }
  void make_sound() {
    if (!(low <= high)) low = 0, high = 1;
    if (high - low < 1e-9) high = low + 1;
  }
  double share(double v) const { return (v - low) / (high - low); }
};

constexpr std::array curve_colours{0x1f5fbf, 0xc0392b, 0x2e7d4f};

}  // namespace

PlotWidget::PlotWidget(QWidget* parent) : QWidget(parent) { setMinimumSize(180, 140); }

void PlotWidget::set_plot(Plot plot) {
  plot_ = std::move(plot);
  update();
}

void PlotWidget::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  Range x, y;
  for (const PlotCurve& curve : plot_.curves) {
    for (const double v : curve.x) x.take(v);
    for (const double v : curve.y) y.take(v);
  }
  x.make_sound(), y.make_sound();
  const int line = painter.fontMetrics().height();
  const QRectF area(58, line + 6.0, width() - 72.0, height() - 2.6 * line - 14.0);
  const auto at = [&](double px, double py) {
    return QPointF(area.left() + x.share(px) * area.width(), area.bottom() - y.share(py) * area.height());
  };
  // axes with round ticks
  painter.setPen(palette().color(QPalette::Mid));
  painter.drawRect(area);
  const QColor ink = palette().color(QPalette::Text);
  for (const double tick : round_ticks(x.low, x.high, 5)) {
    const QPointF there = at(tick, y.low);
    painter.setPen(palette().color(QPalette::Midlight));
    painter.drawLine(there, QPointF(there.x(), area.top()));
    painter.setPen(ink);
    painter.drawText(QRectF(there.x() - 30, area.bottom() + 2, 60, line), Qt::AlignCenter,
                     QString::number(tick));
  }
  for (const double tick : round_ticks(y.low, y.high, 5)) {
    const QPointF there = at(x.low, tick);
    painter.setPen(palette().color(QPalette::Midlight));
    painter.drawLine(there, QPointF(area.right(), there.y()));
    painter.setPen(ink);
    painter.drawText(QRectF(0, there.y() - line / 2.0, 54, line), Qt::AlignRight | Qt::AlignVCenter,
                     QString::number(tick));
  }
  painter.drawText(QRectF(area.left(), height() - line - 2.0, area.width(), line), Qt::AlignCenter,
                   QString::fromStdString(plot_.x_label));
  painter.drawText(QRectF(4, 1, width() - 8.0, line), Qt::AlignLeft, QString::fromStdString(plot_.y_label));
  // curves, each point a small mark
  double legend = area.top() + 4;
  for (std::size_t c = 0; c < plot_.curves.size(); ++c) {
    const PlotCurve& curve = plot_.curves[c];
    QColor colour(static_cast<QRgb>(curve_colours[c % curve_colours.size()]));
    if (palette().color(QPalette::Base).lightness() < 128) colour = colour.lighter(190);
    QPainterPath path;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const QPointF there = at(curve.x[i], curve.y[i]);
      if (i == 0)
        path.moveTo(there);
      else
        path.lineTo(there);
      painter.setPen(Qt::NoPen);
      painter.setBrush(colour);
      painter.drawEllipse(there, 2.5, 2.5);
    }
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(colour, 1.6));
    painter.drawPath(path);
    painter.drawText(QPointF(area.left() + 8, legend + line * 0.8), QString::fromStdString(curve.name));
    legend += line;
  }
}

}  // namespace loopwright
