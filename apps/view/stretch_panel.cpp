// The stretch test by hand.
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSlider>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <cmath>

#include "outputs/write_csv.hpp"
#include "panels.hpp"
#include "plot_widget.hpp"

namespace loopwright {

StretchPanel::StretchPanel(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* box = new QVBoxLayout(this);
  auto* row = new QHBoxLayout;
  directions_ = new QComboBox(this);
  directions_->setObjectName(QStringLiteral("stretch direction"));
  directions_->addItems({tr("Course"), tr("Wale"), tr("Both ways"), tr("Shear")});
  row->addWidget(directions_);
  slider_ = new QSlider(Qt::Horizontal, this);
  slider_->setObjectName(QStringLiteral("stretch"));
  slider_->setRange(-20, 80);  // percent
  slider_->setPageStep(5);
  slider_->setToolTip(
      tr("Strain of the cloth at rest, or its shear (what the upper edge moves along the courses over the "
         "height); the frame goes there in steps of 2 %"));
  row->addWidget(slider_, 1);
  value_ = new QLabel(QStringLiteral("0 %"), this);
  value_->setMinimumWidth(48);
  row->addWidget(value_);
  auto* reset = new QPushButton(tr("Let go"), this);
  reset->setToolTip(tr("Shows the cloth at rest again and forgets the curve"));
  row->addWidget(reset);
  box->addLayout(row);
  plot_ = new PlotWidget(this);
  box->addWidget(plot_, 1);
  connect(slider_, &QSlider::valueChanged, this, [this](int percent) {
    value_->setText(QStringLiteral("%1 %").arg(percent));
    ask();
  });
  connect(directions_, &QComboBox::activated, this, [this] {
    session_.forget_stretch();
    ask();
  });
  connect(reset, &QPushButton::clicked, this, [this] {
    session_.forget_stretch();
    const QSignalBlocker quiet(slider_);
    slider_->setValue(0);
    value_->setText(QStringLiteral("0 %"));
  });
  connect(&session_, &Session::stretch_changed, this, &StretchPanel::show_points);
  connect(&session_, &Session::moment_changed, this, [this] {
    slider_->setEnabled(session_.moment().relaxed != nullptr);
    directions_->setEnabled(slider_->isEnabled());
  });
  slider_->setEnabled(false);
  show_points();
}

StretchDirection StretchPanel::direction() const {
  constexpr std::array in_order{StretchDirection::course, StretchDirection::wale, StretchDirection::both,
                                StretchDirection::shear};
  return in_order[static_cast<std::size_t>(std::clamp(directions_->currentIndex(), 0, 3))];
}

void StretchPanel::ask() { session_.stretch_to(direction(), slider_->value() / 100.0); }

void StretchPanel::set_strain(StretchDirection way, double strain) {
  const int index = way == StretchDirection::course ? 0
                    : way == StretchDirection::wale ? 1
                    : way == StretchDirection::both ? 2
                                                    : 3;
  if (index != directions_->currentIndex()) {
    directions_->setCurrentIndex(index);
    session_.forget_stretch();
  }
  slider_->setValue(static_cast<int>(std::lround(100 * strain)));
}

void StretchPanel::show_points() {
  const auto& points = session_.stretch_points();
  // a new cloth begins with a slider at rest
  if (points.empty() && !session_.working()) {
    const QSignalBlocker quiet(slider_);
    slider_->setValue(0);
    value_->setText(QStringLiteral("0 %"));
  }
  const bool shears = direction() == StretchDirection::shear;
  Plot plot{"", shears ? "shear, %" : "strain, %", "force per length, N/m", {}};
  if (shears) {
    PlotCurve shear{"shear", {}, {}};
    for (const StretchPoint& p : points) {
      shear.x.push_back(100 * p.shear);
      shear.y.push_back(p.shear_force);
    }
    plot.curves.push_back(std::move(shear));
    plot_->set_plot(std::move(plot));
    return;
  }
  PlotCurve course{"along the courses", {}, {}}, wale{"along the wales", {}, {}};
  for (const StretchPoint& p : points) {
    course.x.push_back(100 * (direction() == StretchDirection::wale ? p.wale_strain : p.course_strain));
    course.y.push_back(p.course_force);
    wale.x.push_back(100 * (direction() == StretchDirection::course ? p.course_strain : p.wale_strain));
    wale.y.push_back(p.wale_force);
  }
  if (direction() != StretchDirection::wale) plot.curves.push_back(course);
  if (direction() != StretchDirection::course) plot.curves.push_back(wale);
  plot_->set_plot(std::move(plot));
}

void StretchPanel::write_curve(const QString& path) const {
  if (path.endsWith(QLatin1String(".svg"))) {
    write_plot_svg(path.toStdString(), plot_->plot());
    return;
  }
  Table table;
  table.columns = {"course_strain",      "wale_strain",         "shear",        "course_force_N_per_m",
                   "wale_force_N_per_m", "shear_force_N_per_m", "interlacings", "interlacings_intact"};
  for (const StretchPoint& p : session_.stretch_points())
    table.rows.push_back({p.course_strain, p.wale_strain, p.shear, p.course_force, p.wale_force,
                          p.shear_force, static_cast<double>(p.interlacings),
                          static_cast<double>(p.interlacings_intact)});
  write_csv(path.toStdString(), table);
}

}  // namespace loopwright
