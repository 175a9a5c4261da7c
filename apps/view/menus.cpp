// Menus and tool bars of the window.
#include <QActionGroup>
#include <QComboBox>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QSettings>
#include <QSlider>
#include <QSpinBox>
#include <QStatusBar>
#include <QToolBar>
#include <QVBoxLayout>
#include <algorithm>

#include "main_window.hpp"

namespace loopwright {
namespace {

QAction* add(QMenu* menu, const QString& text, const QKeySequence& key, const QString& tip = {}) {
  QAction* action = menu->addAction(text);
  action->setShortcut(key);
  if (!tip.isEmpty()) action->setToolTip(tip), action->setStatusTip(tip);
  return action;
}

// One of several, in a menu.
template <class Value, class Apply>
void add_choices(QMenu* menu, QObject* parent,
                 const std::vector<std::tuple<QString, QKeySequence, Value>>& choices, Value now,
                 const Apply& apply) {
  auto* group = new QActionGroup(parent);
  for (const auto& [name, key, value] : choices) {
    QAction* action = add(menu, name, key);
    action->setCheckable(true);
    action->setChecked(value == now);
    group->addAction(action);
    QObject::connect(action, &QAction::triggered, parent, [apply, chosen = value] { apply(chosen); });
  }
}

}  // namespace

void MainWindow::build_file_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&File"));
  QMenu* fresh = menu->addMenu(tr("&New from a structure"));
  connect(fresh, &QMenu::aboutToShow, this,
          [this, fresh] { add_built_in(fresh, QStringLiteral(":/structures")); });
  QMenu* examples = menu->addMenu(tr("E&xamples"));
  connect(examples, &QMenu::aboutToShow, this,
          [this, examples] { add_built_in(examples, QStringLiteral(":/examples")); });
  connect(add(menu, tr("New &plain"), QKeySequence::New), &QAction::triggered, this, [this] {
    if (may_leave())
      session_.document().open_text(std::string(Document::empty_fabric), ".verm"), show_title();
  });
  connect(add(menu, tr("&Open \u2026"), QKeySequence::Open), &QAction::triggered, this, [this] {
    if (!may_leave()) return;
    const QString path = QFileDialog::getOpenFileName(
        this, tr("Open"), QString(),
        tr("Notations and cloth (*.verm *.k *.knitout *.h5 *.bcc *.yarns *.obj);;"
           "Notations (*.verm *.k *.knitout);;Saved states (*.h5);;"
           "Curves (*.bcc *.yarns *.obj);;All files (*)"));
    if (!path.isEmpty()) open(path);
  });
  QAction* from_state = add(menu, tr("New from this &notation"), {},
                            tr("The notation of a saved state as a fabric file of its own"));
  from_state->setObjectName(QStringLiteral("new from state"));
  from_state->setEnabled(false);
  connect(&session_, &Session::text_changed, from_state, [this, from_state] {
    const Document& document = session_.document();
    from_state->setEnabled(document.kind() == DocumentKind::cloth && document.has_fabric_text());
  });
  connect(from_state, &QAction::triggered, this, [this] {
    session_.document().open_text(session_.document().text(), ".verm");
    show_title();
  });
  QMenu* recent = menu->addMenu(tr("&Recent"));
  connect(recent, &QMenu::aboutToShow, this, [this, recent] { show_recent(recent); });
  menu->addSeparator();
  connect(add(menu, tr("&Save"), QKeySequence::Save), &QAction::triggered, this, [this] { save(); });
  connect(add(menu, tr("Save &as \u2026"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_S)),
          &QAction::triggered, this, [this] { save_as(); });
  connect(add(menu, tr("&Export \u2026"), QKeySequence(Qt::CTRL | Qt::Key_E),
              tr("Picture, diagram, measurements, or the cloth in the format of another program")),
          &QAction::triggered, this, [this] { ask_export(); });
  connect(add(menu, tr("Export stress-strain &curve \u2026"), {}), &QAction::triggered, this, [this] {
    const QString path = QFileDialog::getSaveFileName(this, tr("Export curve"), QString(),
                                                      tr("Table (*.csv);;Drawing (*.svg)"));
    if (path.isEmpty()) return;
    try {
      stretch_->write_curve(path);
    } catch (const std::exception& fault) {
      QMessageBox::warning(this, tr("Cannot export"), QString::fromUtf8(fault.what()));
    }
  });
  menu->addSeparator();
  connect(add(menu, tr("&Quit"), QKeySequence::Quit), &QAction::triggered, this, &QWidget::close);
}

// The library of structures and the project's examples are built in; they open as new files.
void MainWindow::add_built_in(QMenu* menu, const QString& folder) {
  if (!menu->isEmpty()) return;
  for (const QFileInfo& file : QDir(folder).entryInfoList(QDir::Files, QDir::Name)) {
    QString name = file.completeBaseName();
    name.replace(QLatin1Char('_'), QLatin1Char(' '));
    if (file.suffix() != QLatin1String("verm")) name += QStringLiteral(" (%1)").arg(file.suffix());
    connect(menu->addAction(name), &QAction::triggered, this, [this, path = file.filePath()] {
      QFile source(path);
      if (!may_leave() || !source.open(QIODevice::ReadOnly)) return;
      session_.document().open_text(source.readAll().toStdString(),
                                    "." + QFileInfo(path).suffix().toStdString());
      show_title();
    });
  }
}

void MainWindow::show_recent(QMenu* menu) {
  menu->clear();
  for (const QString& path : QSettings().value(QStringLiteral("recent")).toStringList())
    connect(menu->addAction(path), &QAction::triggered, this, [this, path] {
      if (may_leave()) open(path);
    });
  if (menu->isEmpty()) menu->addAction(tr("none"))->setEnabled(false);
}

void MainWindow::build_edit_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  QAction* undo = add(menu, tr("&Undo"), QKeySequence::Undo);
  QAction* redo = add(menu, tr("&Redo"), QKeySequence::Redo);
  undo->setObjectName(QStringLiteral("undo"));
  redo->setObjectName(QStringLiteral("redo"));
  connect(undo, &QAction::triggered, &session_, &Session::undo);
  connect(redo, &QAction::triggered, &session_, &Session::redo);
  const auto name_them = [this, undo, redo] {
    const Document& document = session_.document();
    undo->setEnabled(document.can_undo());
    redo->setEnabled(document.can_redo());
    undo->setText(tr("&Undo %1").arg(QString::fromStdString(document.undo_name())));
    redo->setText(tr("&Redo %1").arg(QString::fromStdString(document.redo_name())));
  };
  connect(&session_, &Session::text_changed, this, name_them);
  name_them();
  menu->addSeparator();
  connect(add(menu, tr("&Find \u2026"), QKeySequence::Find), &QAction::triggered, this, [this] {
    auto* find = text_side_->findChild<QLineEdit*>(QStringLiteral("find"));
    find->show();
    find->setFocus();
    find->selectAll();
  });
  menu->addSeparator();
  connect(add(menu, tr("Fold or unfold this &pass"), QKeySequence(Qt::CTRL | Qt::Key_Period),
              tr("Knitout: shows the first line of the pass at the cursor")),
          &QAction::triggered, editor_, &NotationEditor::toggle_fold_at_cursor);
  connect(add(menu, tr("Fold &all passes"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_BracketLeft)),
          &QAction::triggered, this, [this] { editor_->fold_all(true); });
  connect(add(menu, tr("U&nfold all passes"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_BracketRight)),
          &QAction::triggered, this, [this] { editor_->fold_all(false); });
}

void MainWindow::build_view_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&View"));
  const std::vector<std::tuple<QString, QKeySequence, View>> views{{tr("&Front"), Qt::Key_1, View::front},
                                                                   {tr("&Left"), Qt::Key_2, View::left},
                                                                   {tr("&Top"), Qt::Key_3, View::top},
                                                                   {tr("&Corner"), Qt::Key_4, View::corner},
                                                                   {tr("&Back"), Qt::Key_5, View::back}};
  for (const auto& [name, key, view] : views) {
    // keys of the cloth alone: in the text they are letters
    QAction* action = add(menu, name, key);
    action->setShortcutContext(Qt::WidgetShortcut);
    cloth_->addAction(action);
    connect(action, &QAction::triggered, this, [this, chosen = view] { cloth_->set_view(chosen); });
  }
  QAction* fit = add(menu, tr("Fit all"), Qt::Key_0, tr("The whole cloth in the window (double click)"));
  fit->setShortcutContext(Qt::WidgetShortcut);
  cloth_->addAction(fit);
  connect(fit, &QAction::triggered, cloth_, &ClothView::fit);
  menu->addSeparator();
  add_choices<ClothStyle>(menu, this,
                          {{tr("Yarn"), Qt::Key_F2, ClothStyle::yarn},
                           {tr("Structure: masses and springs"), Qt::Key_F3, ClothStyle::structure},
                           {tr("Front and rear loops"), Qt::Key_F4, ClothStyle::sides}},
                          ClothStyle::yarn, [this](ClothStyle style) { cloth_->set_style(style); });
  menu->addSeparator();
  QMenu* colours = menu->addMenu(tr("&Colours"));
  add_choices<ColourBy>(colours, this,
                        {{tr("Yarn"), {}, ColourBy::yarn},
                         {tr("Tension"), {}, ColourBy::tension},
                         {tr("Curvature"), {}, ColourBy::curvature},
                         {tr("Contact force"), {}, ColourBy::contact},
                         {tr("Kind of loop"), {}, ColourBy::loop_kind}},
                        ColourBy::yarn, [this](ColourBy by) { cloth_->set_colour_by(by); });
  QAction* perspective = add(menu, tr("&Perspective"), QKeySequence(Qt::CTRL | Qt::Key_P));
  perspective->setCheckable(true);
  connect(perspective, &QAction::triggered, cloth_, &ClothView::set_perspective);
  connect(cloth_, &ClothView::view_changed, perspective,
          [this, perspective] { perspective->setChecked(cloth_->camera().field_of_view_deg > 0); });
  QAction* floor = add(menu, tr("F&loor grid"), QKeySequence(Qt::CTRL | Qt::Key_G));
  floor->setCheckable(true);
  floor->setChecked(true);
  connect(floor, &QAction::toggled, cloth_, &ClothView::set_floor);
  QMenu* habits = menu->addMenu(tr("&Mouse"));
  const QSettings settings;
  const bool blender = settings.value(QStringLiteral("mouse")).toString() == QLatin1String("blender");
  const MouseHabit habit = blender ? MouseHabit::blender : MouseHabit::freecad;
  cloth_->set_habit(habit);
  add_choices<MouseHabit>(
      habits, this,
      {{tr("As in FreeCAD"), {}, MouseHabit::freecad}, {tr("As in Blender"), {}, MouseHabit::blender}}, habit,
      [this](MouseHabit chosen) {
        cloth_->set_habit(chosen);
        QSettings().setValue(QStringLiteral("mouse"), chosen == MouseHabit::blender
                                                          ? QStringLiteral("blender")
                                                          : QStringLiteral("freecad"));
      });
  QAction* dark = add(menu, tr("&Dark"), QKeySequence(Qt::CTRL | Qt::Key_D));
  dark->setCheckable(true);
  connect(dark, &QAction::toggled, this, &MainWindow::set_dark);
  dark->setChecked(settings.value(QStringLiteral("dark")).toBool());
  menu->addSeparator();
  QMenu* docks = menu->addMenu(tr("Panels"));
  connect(docks, &QMenu::aboutToShow, this, [this, docks] {
    docks->clear();
    if (QMenu* all = createPopupMenu()) docks->addActions(all->actions());
  });
}

void MainWindow::build_cloth_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Cloth"));
  connect(add(menu, tr("Knit &again"), Qt::Key_F5), &QAction::triggered, &session_,
          &Session::make_cloth_anew);
  connect(add(menu, tr("&Relax, whatever its size"), Qt::Key_F6), &QAction::triggered, &session_,
          &Session::relax_whole);
  QAction* automatic = add(menu, tr("After every &edit"), {});
  automatic->setCheckable(true);
  automatic->setChecked(true);
  connect(automatic, &QAction::toggled, &session_, &Session::set_automatic);
  menu->addSeparator();
  add_choices<PieceChoice>(menu, this,
                           {{tr("One repeat where there is one"), {}, PieceChoice::automatic},
                            {tr("Always one repeat"), {}, PieceChoice::repeat},
                            {tr("The whole piece"), {}, PieceChoice::whole}},
                           PieceChoice::automatic,
                           [this](PieceChoice piece) { session_.choose_piece(piece); });
  menu->addSeparator();
  QAction* play = add(menu, tr("&Play"), QKeySequence(Qt::CTRL | Qt::Key_Space),
                      tr("Structure style: let masses and springs move"));
  play->setCheckable(true);
  play->setChecked(true);
  connect(play, &QAction::triggered, cloth_, &ClothView::set_playing);
  connect(cloth_, &ClothView::motion_changed, play, [this, play] { play->setChecked(cloth_->playing()); });
  connect(add(menu, tr("&Step"), QKeySequence(Qt::CTRL | Qt::Key_Right)), &QAction::triggered, cloth_,
          &ClothView::step);
  connect(add(menu, tr("Re&set"), QKeySequence(Qt::CTRL | Qt::Key_Home)), &QAction::triggered, cloth_,
          &ClothView::reset_motion);
}

// Tools above the point paper.
void MainWindow::build_diagram_bar() {
  QWidget* paper = diagram_->parentWidget();
  auto* box = qobject_cast<QVBoxLayout*>(paper->layout());
  auto* bar = new QToolBar(paper);
  bar->setObjectName(QStringLiteral("diagram tools"));
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  auto* tools = new QActionGroup(this);
  const std::vector<std::tuple<QString, DiagramTool, QString>> kinds{
      {tr("Select"), DiagramTool::select, tr("Choose a loop; drag a rectangle of needles")},
      {tr("Stitch"), DiagramTool::stitch, tr("g on the front bed, e on the rear bed")},
      {tr("Tuck"), DiagramTool::tuck, tr("v on the front bed, n on the rear bed")},
      {tr("Miss"), DiagramTool::miss, tr(". the yarn floats past")},
      {tr("Move"), DiagramTool::transfer, tr("t from the front bed, T from the rear bed")},
      {tr("Off"), DiagramTool::inactive, tr("- inactive needle")}};
  for (const auto& [name, tool, tip] : kinds) {
    QAction* action = bar->addAction(name);
    action->setCheckable(true);
    action->setChecked(tool == diagram_->tool());
    action->setToolTip(tip);
    tools->addAction(action);
    connect(action, &QAction::triggered, this, [this, chosen = tool] { diagram_->set_tool(chosen); });
  }
  box->addWidget(bar);
  box->addWidget(diagram_, 1);

  QMenu* menu = menuBar()->addMenu(tr("&Diagram"));
  const auto entry = [&](const QString& text, const QKeySequence& key, void (DiagramView::*act)()) {
    QAction* action = add(menu, text, key);
    // the text has the same keys for itself
    action->setShortcutContext(Qt::WidgetShortcut);
    diagram_->addAction(action);
    connect(action, &QAction::triggered, diagram_, act);
  };
  entry(tr("&Copy needles"), QKeySequence::Copy, &DiagramView::copy);
  entry(tr("&Paste needles"), QKeySequence::Paste, &DiagramView::paste_copied);
  entry(tr("&Repeat courses"), QKeySequence(Qt::CTRL | Qt::Key_R), &DiagramView::repeat_selected);
  menu->addSeparator();
  entry(tr("&Insert course"), Qt::Key_Insert, &DiagramView::insert_course);
  entry(tr("Remove c&ourses"), QKeySequence(Qt::CTRL | Qt::Key_Delete), &DiagramView::remove_courses);
  entry(tr("Insert &wale"), QKeySequence(Qt::SHIFT | Qt::Key_Insert), &DiagramView::insert_wale_here);
  entry(tr("Remove w&ale"), QKeySequence(Qt::SHIFT | Qt::Key_Delete), &DiagramView::remove_wale_here);
  menu->addSeparator();
  for (const auto& [text, factor, key] :
       {std::tuple{tr("Zoom in"), 1.25, QKeySequence(QKeySequence::ZoomIn)},
        std::tuple{tr("Zoom out"), 0.8, QKeySequence(QKeySequence::ZoomOut)}}) {
    QAction* action = add(menu, text, key);
    action->setShortcutContext(Qt::WidgetShortcut);
    diagram_->addAction(action);
    connect(action, &QAction::triggered, diagram_, [this, by = factor] { diagram_->zoom(by); });
  }

  // knitting needle by needle
  auto* slider = new QSlider(Qt::Horizontal, paper);
  slider->setObjectName(QStringLiteral("acts"));
  slider->setToolTip(tr("Knits the piece needle by needle; Page Up and Page Down take a course"));
  box->addWidget(slider);
  hint_ = new QLabel(paper);
  hint_->setObjectName(QStringLiteral("hint"));
  hint_->setWordWrap(true);
  hint_->setStyleSheet(QStringLiteral("background: #fff4c2; color: #333; padding: 4px"));
  hint_->hide();
  box->addWidget(hint_);
  connect(&session_, &Session::reading_changed, slider, [this, slider] {
    const QSignalBlocker quiet(slider);
    slider->setRange(0, diagram_->acts());
    slider->setPageStep(std::max(1, session_.diagram().wales));
    slider->setValue(diagram_->acts());
  });
  connect(slider, &QSlider::valueChanged, this, [this](int count) {
    diagram_->show_acts(count);
    if (count > 0 && count <= diagram_->acts()) editor_->go_to(diagram_->act_place(count - 1), false);
  });
}

}  // namespace loopwright
