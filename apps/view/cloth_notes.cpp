// What is written over the picture of the cloth: legend, scale, and whether it may be believed.
#include <QPainter>
#include <algorithm>

#include "cloth_view.hpp"

namespace loopwright {
namespace {

void banner(QPainter& painter, QSize size, const QString& text, const QColor& ground) {
  QFont font = painter.font();
  font.setBold(true);
  painter.setFont(font);
  const QRect box(0, 0, size.width(), painter.fontMetrics().height() + 14);
  painter.fillRect(box, ground);
  painter.setPen(Qt::white);
  painter.drawText(box, Qt::AlignCenter, text);
  font.setBold(false);
  painter.setFont(font);
}

}  // namespace

void ClothView::paint_notes(QPainter& painter, QSize size) {
  if (!no_gl_.isEmpty()) {
    painter.fillRect(rect(), QColor(90, 30, 30));
    painter.setPen(Qt::white);
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, no_gl_);
    return;
  }
  const QColor ink = dark_ ? QColor(225, 225, 225) : QColor(50, 50, 50);
  paint_legend(painter, size);
  if (scene_ || (style_ != ClothStyle::yarn && motion_)) {
    const double mm = drawn_ ? drawn_->diameter_mm : motion_ ? motion_->model().geometry.diameter_mm : 1;
    const ScaleBar bar = scale_bar(camera_, mm, size.width(), size.height());
    const double right = size.width() - 18.0, y = size.height() - 18.0;
    // on a ground of its own, as cloth may lie behind it
    const auto ground = background();
    painter.fillRect(
        QRectF(right - std::max(bar.pixels, 130.0) - 8, y - 30, std::max(bar.pixels, 130.0) + 16, 40),
        QColor(ground[0], ground[1], ground[2], 190));
    painter.setPen(QPen(ink, 2));
    painter.drawLine(QPointF(right - bar.pixels, y), QPointF(right, y));
    painter.drawLine(QPointF(right - bar.pixels, y - 4), QPointF(right - bar.pixels, y + 4));
    painter.drawLine(QPointF(right, y - 4), QPointF(right, y + 4));
    QString note = tr("%1 mm").arg(bar.length_mm);
    if (floor_) note += tr("   floor %1 mm").arg(floor_grid(bounds(), mm, {}).square_mm);
    painter.drawText(QRectF(right - 260, y - 26, 260, 18), Qt::AlignRight, note);
  } else {
    painter.setPen(ink);
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap,
                     session_.working() ? tr("Knitting \u2026")
                     : style_ != ClothStyle::yarn && session_.document().kind() == DocumentKind::cloth
                         ? tr("Masses and springs are made from a notation; this file holds cloth (F2 shows "
                              "its yarn)")
                         : tr("No cloth yet"));
  }
  // a broken cloth is never shown as good
  const ClothMoment& moment = session_.moment();
  if (style_ == ClothStyle::yarn && session_.broken())
    banner(painter, size, broken_text(), QColor(190, 30, 30));
  else if (moment.stage == ClothStage::unusable && scene_)
    banner(painter, size, tr("The last good cloth; the text has errors"), QColor(150, 100, 20));
  else if (!session_.fabric_is_current() && scene_ && moment.stage == ClothStage::stopped)
    banner(painter, size, tr("The last cloth; the new one was stopped (F5 knits it)"), QColor(80, 100, 130));
  else if (!session_.fabric_is_current() && scene_)
    banner(painter, size, tr("The last cloth; the new one is being knitted"), QColor(80, 100, 130));
  else if (moment.stage == ClothStage::not_at_rest && style_ == ClothStyle::yarn)
    banner(painter, size, tr("Not at rest: %1").arg(QString::fromStdString(moment.message)),
           QColor(150, 100, 20));
}

QString ClothView::broken_text() const {
  const ClothMoment& moment = session_.moment();
  const InterlacingCheck& check = moment.interlacings;
  if (moment.linked_anew) return tr("BROKEN: rings hang in each other otherwise than in the file.");
  if (check.intact < check.expected)
    return tr("BROKEN: %1 of %2 interlacings. This is not what the notation knits.")
        .arg(check.intact)
        .arg(check.expected);
  return tr("BROKEN: yarn went through yarn on the way here. This is not what the notation knits.");
}

void ClothView::paint_legend(QPainter& painter, QSize) {
  if (style_ != ClothStyle::yarn || colour_by_ == ColourBy::yarn || colours_.legend.empty()) return;
  const QColor ink = dark_ ? QColor(225, 225, 225) : QColor(50, 50, 50);
  const int x = 14, line = painter.fontMetrics().height() + 3;
  int y = 44;
  painter.setPen(ink);
  painter.drawText(x, y, QString::fromStdString(colours_.title));
  y += 8;
  const auto colour = [](const Rgb& c) { return QColor(c[0], c[1], c[2]); };
  if (colours_.scale) {
    const auto entries = static_cast<int>(colours_.legend.size());
    const int height = (entries - 1) * line;
    for (int k = 0; k < height; ++k)
      painter.fillRect(x, y + 8 + height - 1 - k, 16, 1,
                       colour(scale_colour(k / static_cast<double>(height))));
    for (int k = 0; k < entries; ++k)
      painter.drawText(x + 24, y + 8 + height - k * line + line / 3,
                       QString::fromStdString(colours_.legend[static_cast<std::size_t>(k)].text));
    return;
  }
  for (const LegendEntry& entry : colours_.legend) {
    painter.fillRect(x, y + 4, 14, 14, colour(entry.colour));
    painter.drawText(x + 22, y + 16, QString::fromStdString(entry.text));
    y += line;
  }
}

}  // namespace loopwright
