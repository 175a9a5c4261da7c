#include "main_window.hpp"

#include <QApplication>
#include <QDockWidget>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPalette>
#include <QProgressBar>
#include <QPushButton>
#include <QSettings>
#include <QStatusBar>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

namespace loopwright {

MainWindow::MainWindow(const QString& autosave_folder, QWidget* parent)
    : QMainWindow(parent), autosave_(autosave_folder) {
  setObjectName(QStringLiteral("main"));
  setAcceptDrops(true);
  setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks);
  cloth_ = new ClothView(session_, this);
  setCentralWidget(cloth_);
  build_docks();
  build_status();
  build_file_menu();
  build_edit_menu();
  build_view_menu();
  build_cloth_menu();
  build_diagram_bar();
  build_help_menu();
  connect(&session_, &Session::moment_changed, this, &MainWindow::show_status);
  connect(&session_, &Session::text_changed, this, &MainWindow::show_title);
  connect(&session_, &Session::refused, this, &MainWindow::say);
  connect(cloth_, &ClothView::edge_pulled, stretch_, &StretchPanel::set_strain);
  // kept a second after the last change
  autosave_timer_.setSingleShot(true);
  autosave_timer_.setInterval(1000);
  connect(&autosave_timer_, &QTimer::timeout, this, [this] { autosave_.keep(session_.document()); });
  connect(&session_, &Session::text_changed, &autosave_timer_, qOverload<>(&QTimer::start));
  // another editor's changes of the open file are taken at once, unless there are own ones
  connect(&watcher_, &QFileSystemWatcher::fileChanged, this,
          [this] { QTimer::singleShot(100, this, &MainWindow::take_changed_file); });
  resize(1280, 800);
  const QSettings settings;
  restoreGeometry(settings.value(QStringLiteral("geometry")).toByteArray());
  restoreState(settings.value(QStringLiteral("docks")).toByteArray());
  show_title();
  session_.make_cloth_anew();
  show_status();
}

QDockWidget* MainWindow::add_dock(const QString& title, const char* name, QWidget* widget,
                                  Qt::DockWidgetArea area) {
  auto* dock = new QDockWidget(title, this);
  dock->setObjectName(QLatin1String(name));
  dock->setWidget(widget);
  addDockWidget(area, dock);
  return dock;
}

void MainWindow::build_docks() {
  // the text with its find line
  text_side_ = new QWidget(this);
  auto* box = new QVBoxLayout(text_side_);
  box->setContentsMargins(0, 0, 0, 0);
  box->setSpacing(2);
  editor_ = new NotationEditor(session_, text_side_);
  box->addWidget(editor_, 1);
  auto* find = new QLineEdit(text_side_);
  find->setObjectName(QStringLiteral("find"));
  find->setPlaceholderText(tr("Find (Enter: next, Shift+Enter: back, Esc: close)"));
  find->setClearButtonEnabled(true);
  find->hide();
  box->addWidget(find);
  connect(find, &QLineEdit::returnPressed, this, [this, find] {
    const bool back = QApplication::keyboardModifiers().testFlag(Qt::ShiftModifier);
    if (!editor_->find_next(find->text(), back))
      say(tr("\u201c%1\u201d is not in the text").arg(find->text()));
  });
  auto* close_find = new QAction(find);
  close_find->setShortcut(Qt::Key_Escape);
  close_find->setShortcutContext(Qt::WidgetShortcut);
  find->addAction(close_find);
  connect(close_find, &QAction::triggered, this, [this, find] {
    find->hide();
    editor_->setFocus();
  });

  QDockWidget* text = add_dock(tr("Notation"), "dock notation", text_side_, Qt::LeftDockWidgetArea);
  auto* paper = new QWidget(this);
  paper->setObjectName(QStringLiteral("point paper"));
  (new QVBoxLayout(paper))->setContentsMargins(0, 0, 0, 0);
  diagram_ = new DiagramView(session_, paper);
  QDockWidget* diagram = add_dock(tr("Needle diagram"), "dock diagram", paper, Qt::LeftDockWidgetArea);
  splitDockWidget(text, diagram, Qt::Vertical);

  auto* fabric = new FabricPanel(session_, this);
  auto* loop = new LoopPanel(session_, this);
  auto* measures = new MeasuresPanel(session_, this);
  stretch_ = new StretchPanel(session_, this);
  auto* messages = new MessagesPanel(session_, this);
  QDockWidget* fabric_dock = add_dock(tr("Yarn and machine"), "dock fabric", fabric, Qt::RightDockWidgetArea);
  QDockWidget* loop_dock = add_dock(tr("Loop"), "dock loop", loop, Qt::RightDockWidgetArea);
  tabifyDockWidget(fabric_dock, loop_dock);
  QDockWidget* measure_dock =
      add_dock(tr("Measurements"), "dock measures", measures, Qt::RightDockWidgetArea);
  add_dock(tr("Stretch"), "dock stretch", stretch_, Qt::RightDockWidgetArea);
  fabric_dock->raise();
  // what is clicked is told at once
  connect(&session_, &Session::selection_changed, loop_dock, [this, loop_dock] {
    if (session_.selection().at.line > 0) loop_dock->raise();
  });
  QDockWidget* messages_dock = add_dock(tr("Messages"), "dock messages", messages, Qt::BottomDockWidgetArea);
  // the sides keep the corners
  setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  resizeDocks({text, fabric_dock}, {340, 300}, Qt::Horizontal);
  resizeDocks({text, diagram}, {300, 420}, Qt::Vertical);
  resizeDocks({messages_dock}, {100}, Qt::Vertical);
  resizeDocks({fabric_dock, measure_dock}, {330, 200}, Qt::Vertical);
  connect(messages, &MessagesPanel::go_to, this, [this](SourceLocation at) {
    editor_->setFocus();
    editor_->go_to(at);
  });
}

void MainWindow::build_status() {
  stage_ = new QLabel(this);
  stage_->setObjectName(QStringLiteral("stage"));
  interlacings_ = new QLabel(this);
  interlacings_->setObjectName(QStringLiteral("interlacings"));
  interlacings_->setToolTip(tr("Loops that still pass through the loops that the machine drew them through"));
  progress_ = new QProgressBar(this);
  progress_->setRange(0, 1000);
  progress_->setFixedWidth(160);
  progress_->setTextVisible(false);
  cancel_ = new QPushButton(tr("Cancel"), this);
  cancel_->setToolTip(tr("Stops the relaxation; what was reached is shown (Esc)"));
  cancel_->setShortcut(Qt::Key_Escape);
  connect(cancel_, &QPushButton::clicked, &session_, &Session::cancel);
  statusBar()->addWidget(stage_, 1);
  statusBar()->addPermanentWidget(progress_);
  statusBar()->addPermanentWidget(cancel_);
  statusBar()->addPermanentWidget(interlacings_);
  // progress and cancel appear after half a second of work
  auto* look = new QTimer(this);
  look->setInterval(250);
  connect(look, &QTimer::timeout, this, &MainWindow::show_status);
  look->start();
}

QString MainWindow::interlacings_text() const {
  const ClothMoment& moment = session_.moment();
  if (!session_.fabric()) return tr("no cloth");
  if (moment.interlacings.expected == 0) return tr("no interlacings known");
  if (!session_.fabric_is_current()) return tr("last cloth");
  if (moment.interlacings.expected < 0) return tr("interlacings not counted yet");
  return tr("interlacings %1 of %2").arg(moment.interlacings.intact).arg(moment.interlacings.expected);
}

void MainWindow::show_status() {
  const ClothMoment& moment = session_.moment();
  QString text;
  switch (moment.stage) {
    case ClothStage::reading:
      text = session_.working() ? tr("Reading") : tr("Ready");
      break;
    case ClothStage::unusable:
      text = QString::fromStdString(moment.message);
      break;
    case ClothStage::as_knitted:
      text = session_.working() ? tr("As knitted; relaxing \u2026")
                                : tr("As knitted, not relaxed: Cloth > Relax (F6) relaxes this piece");
      break;
    case ClothStage::as_saved:
      text = moment.options || session_.document().kind() != DocumentKind::cloth
                 ? tr("As the file holds it: Cloth > Relax (F6) goes on from there")
                 : tr("As the file holds it");
      break;
    case ClothStage::growing:
      text = tr("Yarn grows in: %1 %").arg(qRound(100 * moment.radius));
      break;
    case ClothStage::relaxing:
      text = tr("Relaxing: step %1, largest force %2 B/d\u00b2")
                 .arg(moment.iterations)
                 .arg(moment.residual, 0, 'g', 2);
      break;
    case ClothStage::at_rest:
      text = tr("At rest: %1 steps, %2 s").arg(moment.iterations).arg(moment.seconds, 0, 'f', 2);
      if (moment.went_on) text += tr(", on from the cloth at hand (F5 knits anew)");
      break;
    case ClothStage::not_at_rest:
      text = tr("Not at rest: %1").arg(QString::fromStdString(moment.message));
      break;
    case ClothStage::stopped:
      text = moment.fabric ? tr("Stopped after %n step(s); F5 knits anew", "", moment.iterations)
                                 .replace(QStringLiteral("(s)"),
                                          moment.iterations == 1 ? QString() : QStringLiteral("s"))
                           : tr("Stopped before there was cloth; F5 knits it");
      break;
  }
  stage_->setText(text);
  interlacings_->setText(interlacings_text());
  interlacings_->setStyleSheet(moment.broken()
                                   ? QStringLiteral("color: white; background: #be1e1e; padding: 2px 6px")
                                   : QStringLiteral("padding: 2px 6px"));
  const bool long_work = session_.working() && session_.working_seconds() > 0.5;
  progress_->setVisible(long_work);
  cancel_->setVisible(long_work);
  if (!long_work) return;
  // growth is half of the bar; then the force falls, by powers of ten, to its tolerance
  const double tolerance = RelaxOptions().tolerance;
  double share = 0.5 * moment.radius;
  if (moment.stage == ClothStage::relaxing && moment.residual > 0)
    share = 0.5 + 0.5 * std::clamp(1 - std::log10(moment.residual / tolerance) / 5, 0.0, 1.0);
  progress_->setValue(static_cast<int>(1000 * share));
}

void MainWindow::show_title() {
  Document& document = session_.document();
  setWindowTitle(QStringLiteral("%1[*] \u2013 Loopwright").arg(QString::fromStdString(document.name())));
  setWindowModified(document.changed());
  if (auto* dock = findChild<QDockWidget*>(QStringLiteral("dock notation")))
    dock->setWindowTitle(document.read_only() ? tr("Notation (shown, not edited)") : tr("Notation"));
}

void MainWindow::say(const QString& what) {
  hint_->setText(what);
  hint_->show();
  QTimer::singleShot(8000, hint_, [label = hint_, what] {
    if (label->text() == what) label->hide();
  });
}

void MainWindow::set_dark(bool dark) {
  QPalette palette = QApplication::style()->standardPalette();
  if (dark) {
    palette = QPalette(QColor(50, 52, 56), QColor(42, 44, 48));
    palette.setColor(QPalette::Base, QColor(34, 36, 40));
    palette.setColor(QPalette::AlternateBase, QColor(44, 46, 50));
    palette.setColor(QPalette::Text, QColor(225, 225, 225));
    palette.setColor(QPalette::WindowText, QColor(225, 225, 225));
    palette.setColor(QPalette::ButtonText, QColor(225, 225, 225));
    palette.setColor(QPalette::ToolTipBase, QColor(60, 62, 66));
    palette.setColor(QPalette::ToolTipText, QColor(235, 235, 235));
    palette.setColor(QPalette::Highlight, QColor(60, 110, 190));
    palette.setColor(QPalette::PlaceholderText, QColor(150, 150, 150));
  }
  QApplication::setPalette(palette);
  editor_->set_dark(dark);
  cloth_->set_dark(dark);
  QSettings().setValue(QStringLiteral("dark"), dark);
}

}  // namespace loopwright
