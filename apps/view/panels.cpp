// The panels that only show: loop, measures, messages.
#include "panels.hpp"

#include <QLabel>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "experiments/measure.hpp"
#include "mechanics/yarn_forces.hpp"

namespace loopwright {
namespace {

QLabel* text_label(QWidget* parent) {
  auto* label = new QLabel(parent);
  label->setTextFormat(Qt::RichText);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  label->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  label->setWordWrap(true);
  label->setContentsMargins(6, 4, 6, 4);
  auto* box = new QVBoxLayout(parent);
  box->setContentsMargins(0, 0, 0, 0);
  box->addWidget(label);
  return label;
}

class Rows {
 public:
  void add(const QString& name, const QString& value) {
    text_ +=
        QStringLiteral("<tr><td style='padding-right:10px'>%1</td><td><b>%2</b></td></tr>").arg(name, value);
  }
  QString html() const { return QStringLiteral("<table>") + text_ + QStringLiteral("</table>"); }

 private:
  QString text_;
};

QString number(double value, int digits, const char* unit) {
  return QString::number(value, 'g', digits) +
         (unit[0] ? QStringLiteral(" ") + QString::fromUtf8(unit) : QString());
}

QString kind_name(const LoopSpan& span) {
  const QString side = span.side == StitchSide::front ? QObject::tr("front") : QObject::tr("rear");
  switch (span.kind) {
    case LoopKind::tuck:
      return QObject::tr("%1 tuck").arg(side);
    case LoopKind::split:
      return QObject::tr("%1 split").arg(side);
    case LoopKind::cast_on:
      return QObject::tr("%1 loop on an empty needle").arg(side);
    default:
      return QObject::tr("%1 stitch").arg(side);
  }
}

// Mean tension of a loop's segments, B/d^2.
double mean_tension(const Fabric& fabric, const LoopSpan& span, const ModelOptions& options) {
  const YarnForces forces = yarn_forces(fabric, options);
  std::size_t first = 0;
  for (int y = 0; y < span.yarn; ++y)
    first += static_cast<std::size_t>(fabric.yarns[static_cast<std::size_t>(y)].segments());
  const int segments = fabric.yarns[static_cast<std::size_t>(span.yarn)].segments();
  double sum = 0;
  int count = 0;
  for (int e = static_cast<int>(std::floor(span.begin)); e < span.end; ++e, ++count)
    sum += forces.tension[first + static_cast<std::size_t>((e % segments + segments) % segments)];
  return count > 0 ? sum / count : 0;
}

}  // namespace

LoopPanel::LoopPanel(Session& session, QWidget* parent)
    : QWidget(parent), session_(session), text_(text_label(this)) {
  connect(&session_, &Session::selection_changed, this, &LoopPanel::show_selection);
  connect(&session_, &Session::fabric_changed, this, &LoopPanel::show_selection);
  show_selection();
}

void LoopPanel::show_selection() { text_->setText(described()); }

QString LoopPanel::described() const {
  const Selection& chosen = session_.selection();
  const auto& fabric = session_.fabric();
  if (chosen.at.line == 0 || !fabric) return tr("Click a loop in the cloth, the diagram or the text.");
  Rows rows;
  rows.add(tr("Line, column"), QStringLiteral("%1, %2").arg(chosen.at.line).arg(chosen.at.column));
  if (chosen.span < 0 || chosen.span >= static_cast<int>(fabric->loops.size())) return rows.html();
  const LoopSpan& span = fabric->loops[static_cast<std::size_t>(chosen.span)];
  const FabricYarn& yarn = fabric->yarns[static_cast<std::size_t>(span.yarn)];
  rows.add(tr("Kind"), kind_name(span));
  rows.add(tr("Needle"),
           QStringLiteral("%1 %2").arg(is_front(span.bed) ? tr("front") : tr("rear")).arg(span.slot));
  if (span.course >= 0) rows.add(tr("Course"), QString::number(span.course + 1));
  const auto& knitting = session_.moment().knitting;
  if (knitting && yarn.carrier.valid() && yarn.carrier.position() < knitting->program.carriers.size())
    rows.add(tr("Yarn"), QString::fromStdString(knitting->program.carriers[yarn.carrier.position()]));
  rows.add(tr("Length"),
           number(arc_length(*fabric, yarn, span.begin, span.end) * fabric->diameter_mm, 4, "mm"));
  if (const auto& options = session_.moment().options; options && fabric->loops.size() < 5000) {
    const double tension = mean_tension(*fabric, span, options->model);
    const double d = fabric->diameter_mm * 1e-3, bend = options->model.material.reference_bend_N_m2;
    rows.add(tr("Mean tension"),
             bend > 0 ? number(tension * bend / (d * d) * 100, 3, "cN") : number(tension, 3, "B/d\u00b2"));
  }
  if (knitting && span.loop.position() < knitting->graph.loops.size()) {
    const Loop& loop = knitting->graph.loop(span.loop);
    const auto named = [&](const std::vector<LoopId>& loops) {
      QStringList names;
      for (const LoopId id : loops) {
        const Loop& of = knitting->graph.loop(id);
        names << tr("needle %1 of line %2").arg(of.slot).arg(of.at.line);
      }
      return names.isEmpty() ? tr("none") : names.join(QStringLiteral("<br>"));
    };
    rows.add(tr("Drawn through"), named(loop.parents));
    rows.add(tr("Held by"), named(loop.children));
  }
  const auto kin = session_.spans_at(chosen.at).size();
  if (kin > 1) rows.add(tr("Loops of this letter"), QString::number(kin));
  return rows.html();
}

MeasuresPanel::MeasuresPanel(Session& session, QWidget* parent)
    : QWidget(parent), session_(session), text_(text_label(this)) {
  connect(&session_, &Session::moment_changed, this, &MeasuresPanel::show_measures);
  show_measures();
}

void MeasuresPanel::show_measures() {
  const ClothMoment& moment = session_.moment();
  if (moment.broken()) {
    measured_ = nullptr;
    text_->setText(tr("Nothing is measured: the cloth is broken."));
    return;
  }
  if (moment.measured == measured_ && measured_) return;
  measured_ = moment.measured;
  if (!moment.measured) {
    text_->setText(tr("Sizes are measured when the cloth is at rest."));
    return;
  }
  const Measurements& m = *moment.measured;
  Rows rows;
  if (m.loops == 0) {  // curves
    rows.add(tr("Yarns"), QString::number(m.yarns));
    rows.add(tr("Length of yarn"), number(m.yarn_m, 4, "m"));
    rows.add(tr("Width \u00d7 height"),
             number(m.width_mm, 4, "") + QStringLiteral(" \u00d7 ") + number(m.height_mm, 4, "mm"));
    rows.add(tr("Thickness"), number(m.thickness_mm, 3, "mm"));
    text_->setText(rows.html());
    return;
  }
  rows.add(tr("Wales \u00d7 courses"), QStringLiteral("%1 \u00d7 %2").arg(m.wales).arg(m.courses));
  rows.add(tr("Width \u00d7 height"),
           number(m.width_mm, 4, "") + QStringLiteral(" \u00d7 ") + number(m.height_mm, 4, "mm"));
  rows.add(tr("Thickness"), number(m.thickness_mm, 3, "mm"));
  rows.add(tr("Wales per cm"), number(m.wales_per_cm, 3, ""));
  rows.add(tr("Courses per cm"), number(m.courses_per_cm, 3, ""));
  rows.add(tr("Loop length"), number(m.loop_length_mm, 4, "mm"));
  if (m.areal_density_g_m2) rows.add(tr("Weight"), number(*m.areal_density_g_m2, 4, "g/m\u00b2"));
  rows.add(tr("Cover factor"), number(m.cover_factor, 3, ""));
  if (m.tightness_factor) rows.add(tr("Tightness factor"), number(*m.tightness_factor, 3, "\u221atex/cm"));
  rows.add(QStringLiteral("Kc, Kw, Ks"),
           QStringLiteral("%1, %2, %3").arg(m.Kc, 0, 'f', 2).arg(m.Kw, 0, 'f', 2).arg(m.Ks, 0, 'f', 1));
  if (moment.stage != ClothStage::at_rest) rows.add(tr("Note"), tr("not at rest"));
  text_->setText(rows.html());
}

MessagesPanel::MessagesPanel(Session& session, QWidget* parent)
    : QWidget(parent), session_(session), list_(new QTreeWidget(this)) {
  auto* box = new QVBoxLayout(this);
  box->setContentsMargins(0, 0, 0, 0);
  box->addWidget(list_);
  list_->setObjectName(QStringLiteral("messages"));
  list_->setRootIsDecorated(false);
  list_->setHeaderLabels({tr("Line"), tr("Kind"), tr("Message")});
  list_->setColumnWidth(0, 60);
  list_->setColumnWidth(1, 80);
  connect(&session_, &Session::reading_changed, this, &MessagesPanel::show_messages);
  connect(list_, &QTreeWidget::itemActivated, this, [this](QTreeWidgetItem* item) {
    emit go_to({item->data(0, Qt::UserRole).toInt(), item->data(0, Qt::UserRole + 1).toInt()});
  });
  connect(list_, &QTreeWidget::itemClicked, list_, &QTreeWidget::itemActivated);
}

void MessagesPanel::show_messages() {
  list_->clear();
  QList<QTreeWidgetItem*> items;
  for (const Diagnostic& message : session_.diagnostics().list()) {
    auto* item = new QTreeWidgetItem({message.at.line > 0 ? QString::number(message.at.line) : QString(),
                                      QString::fromUtf8(to_string(message.severity).data()),
                                      QString::fromStdString(message.message)});
    item->setData(0, Qt::UserRole, message.at.line);
    item->setData(0, Qt::UserRole + 1, message.at.column);
    item->setToolTip(2, QString::fromStdString(message.message));
    items << item;
  }
  list_->addTopLevelItems(items);
}

}  // namespace loopwright
