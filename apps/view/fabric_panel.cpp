// Yarns, lengths and machine of a fabric file, changed in its header lines.
#include <QColorDialog>
#include <QComboBox>
#include <QCompleter>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "header_edits.hpp"
#include "notation/fabric_headers.hpp"
#include "notation/material.hpp"
#include "notation/scan.hpp"
#include "panels.hpp"
#include "yarn_facts.hpp"

namespace loopwright {
namespace {

// The number that a header's value begins with, e.g. 5.9 of "5.9 mm"; nothing if it has another unit.
std::optional<double> leading_number(const std::string& value, const QString& unit) {
  const QString text = QString::fromStdString(value).trimmed();
  const QString digits = text.section(QLatin1Char(' '), 0, 0),
                rest = text.section(QLatin1Char(' '), 1).trimmed();
  bool good = false;
  const double number = digits.toDouble(&good);
  if (!good || (!rest.isEmpty() && rest != unit)) return std::nullopt;
  return number;
}

// A number of a yarn in the unit of the trade, with a range that no knitting yarn leaves.
struct YarnField {
  const char* name;
  const char* unit;
  double low, high, step;
  std::optional<double> YarnData::*value;
  const char* tip;
};
constexpr std::array<YarnField, 7> fields{
    {{"Linear density", "tex", 1, 20000, 5, &YarnData::linear_density_tex, "Mass per length: 1 tex = 1 g/km"},
     {"Diameter", "mm", 0.05, 20, 0.05, &YarnData::diameter_mm, "Outer diameter of the soft yarn"},
     {"Bending", "mN mm\u00b2", 0.01, 10000, 1, &YarnData::bend_stiffness_mN_mm2, "Bending stiffness"},
     {"Stretching", "cN", 1, 1e6, 100, &YarnData::stretch_stiffness_cN, "Force that would double its length"},
     {"Friction", "", 0, 2, 0.05, &YarnData::friction_coefficient, "Coefficient of yarn on yarn"},
     {"Liveliness", "tpm", -2000, 2000, 50, &YarnData::liveliness_per_m,
      "Turns per metre by which free yarn would turn back: Z twist positive, S twist negative"},
     {"Twisting", "mN mm\u00b2", 0, 10000, 1, &YarnData::twist_stiffness_mN_mm2,
      "Twist stiffness; of lively yarn three tenths of the bending stiffness where it is not stated"}}};

}  // namespace

FabricPanel::FabricPanel(Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(0, 0, 0, 0);
  auto* scroll = new QScrollArea(this);
  form_ = scroll;
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  outer->addWidget(scroll);
  facts_ = new QLabel(this);
  facts_->setObjectName(QStringLiteral("yarn facts"));
  facts_->setWordWrap(true);
  facts_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  facts_->setContentsMargins(6, 4, 6, 4);
  facts_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  outer->addWidget(facts_);
  auto* content = new QWidget(scroll);
  auto* box = new QVBoxLayout(content);
  scroll->setWidget(content);

  auto* yarns = new QGroupBox(tr("Yarns"), content);
  yarn_form_ = new QFormLayout(yarns);
  yarns->setToolTip(
      tr("A material such as wool 2/28 Nm, then what differs from it: friction=0.2 colour=#b03020 "
         "diameter=0.5mm linear-density=70tex"));
  box->addWidget(yarns);

  auto* fabric = new QGroupBox(tr("Fabric"), content);
  auto* form = new QFormLayout(fabric);
  name_ = new QLineEdit(fabric);
  form->addRow(tr("Name"), name_);
  connect(name_, &QLineEdit::editingFinished, this,
          [this] { set_header(QStringLiteral("Name"), name_->text()); });
  number_row(form, tr("Loop length"), "Loop-Length", 0.5, 60, 0.1, QStringLiteral("mm"),
             tr("Yarn in one knitted loop"));
  number_row(form, tr("Tuck length"), "Tuck-Length", 0, 60, 0.1, QStringLiteral("mm"),
             tr("Yarn in one tuck; 0: as the loop length gives it"));
  number_row(form, tr("Set"), "Set", 0, 1, 0.05, QString(),
             tr("Share of the knitted curvature that the yarn keeps"));
  size_ = new QLineEdit(fabric);
  size_->setToolTip(tr("Wales x courses to which the notation is repeated, such as 16 wales x 16 courses"));
  form->addRow(tr("Size"), size_);
  connect(size_, &QLineEdit::editingFinished, this,
          [this] { set_header(QStringLiteral("Size"), size_->text()); });
  edges_ = new QComboBox(fabric);
  edges_->addItems({QString(), QStringLiteral("held"), QStringLiteral("bound-off"), QStringLiteral("free"),
                    QStringLiteral("periodic")});
  form->addRow(tr("Edges"), edges_);
  connect(edges_, &QComboBox::activated, this,
          [this] { set_header(QStringLiteral("Edges"), edges_->currentText()); });
  box->addWidget(fabric);

  auto* machine = new QGroupBox(tr("Machine"), content);
  auto* machine_form = new QFormLayout(machine);
  number_row(machine_form, tr("Gauge"), "Gauge", 1, 40, 1, QString(), tr("Needles per inch"));
  number_row(machine_form, tr("Bed gap"), "Bed-Gap", 0, 20, 0.25, QStringLiteral("mm"),
             tr("Distance of the needle beds"));
  gating_ = new QComboBox(machine);
  gating_->addItems({QString(), QStringLiteral("opposite"), QStringLiteral("half-pitch")});
  gating_->setToolTip(tr("How the beds stand when not racked"));
  machine_form->addRow(tr("Gating"), gating_);
  connect(gating_, &QComboBox::activated, this,
          [this] { set_header(QStringLiteral("Gating"), gating_->currentText()); });
  box->addWidget(machine);
  box->addStretch();

  connect(&session_, &Session::reading_changed, this, &FabricPanel::show_settings);
  connect(&session_, &Session::fabric_changed, facts_, [this] {
    if (!session_.document().read_only()) return;
    const QString facts = yarn_facts(session_.moment(), session_.document().kind());
    if (facts != facts_->text()) facts_->setText(facts);
  });
  show_settings();
}

QDoubleSpinBox* FabricPanel::number_row(QFormLayout* form, const QString& label, const char* header,
                                        double low, double high, double step, const QString& unit,
                                        const QString& tip) {
  auto* box = new QDoubleSpinBox(this);
  box->setRange(low, high);
  box->setSingleStep(step);
  box->setDecimals(2);
  box->setObjectName(QLatin1String(header));
  if (!unit.isEmpty()) box->setSuffix(QStringLiteral(" ") + unit);
  box->setToolTip(tip);
  box->setKeyboardTracking(false);
  form->addRow(label, box);
  numbers_.emplace_back(header, box);
  connect(box, &QDoubleSpinBox::valueChanged, this, [this, header, unit](double value) {
    if (filling_) return;
    QString text = QString::fromStdString(written_number(std::round(value * 1e4) / 1e4));
    if (!unit.isEmpty()) text += QStringLiteral(" ") + unit;
    if (value == 0 && qstrcmp(header, "Set") != 0 && qstrcmp(header, "Bed-Gap") != 0) text.clear();
    set_header(QLatin1String(header), text);
  });
  return box;
}

void FabricPanel::set_header(const QString& name, const QString& value) {
  if (filling_) return;
  const std::string& text = session_.document().text();
  session_.change_text(with_header(text, name.toStdString(), value.trimmed().toStdString()),
                       tr("Change %1").arg(name));
}

void FabricPanel::build_yarns() {
  while (yarn_form_->rowCount() > 0) yarn_form_->removeRow(0);
  yarn_edits_.clear();
  yarn_fields_.clear();
  QStringList names;
  for (const Material& material : materials()) names << QString::fromStdString(material.name);
  for (const std::string& yarn : yarn_names_) {
    auto* edit = new QLineEdit(this);
    edit->setObjectName(QStringLiteral("yarn ") + QString::fromStdString(yarn));
    edit->setCompleter(new QCompleter(names, edit));
    yarn_form_->addRow(QString::fromStdString(yarn), edit);
    yarn_edits_.push_back(edit);
    connect(edit, &QLineEdit::editingFinished, this, [this, edit, yarn] {
      // a value that cannot be read stays in its field and says why; the text is left alone
      Diagnostics diagnostics;
      YarnData yarn_data;
      read_yarn(edit->text().trimmed().toStdString(), {}, yarn_data, diagnostics);
      if (!diagnostics.ok()) {
        emit session_.refused(QString::fromStdString(diagnostics.list().front().message));
        return;
      }
      set_header(QStringLiteral("Yarn-") + QString::fromStdString(yarn), edit->text());
    });
    add_yarn_fields(yarn_edits_.size() - 1);
  }
}

void FabricPanel::add_yarn_fields(std::size_t yarn) {
  YarnFields row;
  for (const YarnField& field : fields) {
    auto* box = new QDoubleSpinBox(this);
    box->setObjectName(QLatin1String(field.name) + QLatin1Char(' ') +
                       QString::fromStdString(yarn_names_[yarn]));
    box->setRange(field.low, field.high);
    box->setSingleStep(field.step);
    box->setDecimals(field.step < 1 ? 3 : 2);
    if (field.unit[0] != '\0') box->setSuffix(QLatin1Char(' ') + QString::fromUtf8(field.unit));
    box->setToolTip(tr(field.tip));
    box->setKeyboardTracking(false);
    yarn_form_->addRow(tr(field.name), box);
    row.numbers.push_back(box);
    connect(box, &QDoubleSpinBox::valueChanged, this, [this, yarn, value = field.value](double number) {
      change_yarn(yarn, [value, number](YarnData& of) { of.*value = std::round(number * 1e4) / 1e4; });
    });
  }
  row.colour = new QPushButton(tr("Colour \u2026"), this);
  yarn_form_->addRow(tr("Colour"), row.colour);
  connect(row.colour, &QPushButton::clicked, this, [this, yarn] {
    const QColor chosen = QColorDialog::getColor(
        Qt::white, this, tr("Colour of yarn %1").arg(QString::fromStdString(yarn_names_[yarn])));
    if (chosen.isValid())
      change_yarn(yarn, [&chosen](YarnData& of) { of.colour = chosen.name().toStdString(); });
  });
  yarn_fields_.push_back(std::move(row));
}

void FabricPanel::change_yarn(std::size_t yarn, const std::function<void(YarnData&)>& change) {
  if (filling_) return;
  const std::string header = "Yarn-" + yarn_names_[yarn];
  Diagnostics diagnostics;
  YarnData of;
  read_yarn(header_value(session_.document().text(), header), {}, of, diagnostics);
  if (!diagnostics.ok()) return;  // the text says what is wrong
  change(of);
  set_header(QString::fromStdString(header), QString::fromStdString(yarn_value(of)));
}

// Unstated numbers stand at the low end, or at zero, and are not written until they are changed.
void FabricPanel::show_yarn_fields(std::size_t yarn) {
  const YarnData& of = session_.notation()->yarns[yarn].data;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    QDoubleSpinBox* box = yarn_fields_[yarn].numbers[k];
    if (!box->hasFocus()) box->setValue((of.*fields[k].value).value_or(std::max(box->minimum(), 0.0)));
  }
  if (!of.colour.empty())
    yarn_fields_[yarn].colour->setStyleSheet(
        QStringLiteral("background: %1; color: %2")
            .arg(QString::fromStdString(of.colour),
                 QColor(QString::fromStdString(of.colour)).lightness() > 128 ? QStringLiteral("black")
                                                                             : QStringLiteral("white")));
}

void FabricPanel::show_settings() {
  // knitout's headers are the text's own
  form_->setVisible(!session_.document().read_only());
  facts_->setVisible(session_.document().read_only());
  if (session_.document().read_only()) return;
  const auto& notation = session_.notation();
  if (!notation) return;  // errors: fields keep what they had
  filling_ = true;
  std::vector<std::string> names;
  for (const VermiculationYarn& yarn : notation->yarns) names.push_back(yarn.name);
  if (names != yarn_names_) {
    yarn_names_ = names;
    build_yarns();
  }
  const std::string& text = session_.document().text();
  const auto value = [&](const std::string& name) {
    return QString::fromStdString(header_value(text, name));
  };
  for (std::size_t y = 0; y < yarn_names_.size(); ++y)
    if (!yarn_edits_[y]->hasFocus()) yarn_edits_[y]->setText(value("Yarn-" + yarn_names_[y]));
  for (std::size_t y = 0; y < yarn_names_.size(); ++y) show_yarn_fields(y);
  for (const auto& [header, box] : numbers_) {
    const std::string written = header_value(text, header);
    const auto number = leading_number(written, box->suffix().trimmed());
    box->setEnabled(written.empty() ||
                    number.has_value());  // another unit: the text is the place to change it
    if (!box->hasFocus()) box->setValue(number.value_or(box->minimum()));
  }
  if (!name_->hasFocus()) name_->setText(value("Name"));
  if (!size_->hasFocus()) size_->setText(value("Size"));
  edges_->setCurrentText(value("Edges"));
  gating_->setCurrentText(value("Gating"));
  filling_ = false;
}

}  // namespace loopwright
