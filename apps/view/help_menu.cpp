// What helps a newcomer: the tour, keys and mouse.
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QVBoxLayout>
#include <QWizard>

#include "main_window.hpp"

namespace loopwright {

void MainWindow::build_help_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Help"));
  connect(menu->addAction(tr("&Tour")), &QAction::triggered, this, &MainWindow::start_tour);
  connect(menu->addAction(tr("&Keys and mouse")), &QAction::triggered, this, [this] {
    QMessageBox::information(
        this, tr("Keys and mouse"),
        tr("<b>Cloth</b>: left click chooses a loop, left drag turns; wheel zooms; the middle button pans "
           "(FreeCAD) or "
           "turns (Blender); right drag turns. 1 front, 2 left, 3 top, 4 corner, 5 back, 0 or double click "
           "fits. "
           "Drag an edge of cloth at rest to stretch it, Ctrl+drag a yarn to pull it; in the structure style "
           "drag a binding point.<br><br>"
           "<b>Diagram</b>: arrows move, letters (g e v n . - t T s S d D) work the needle, Shift+arrows "
           "select, "
           "Ctrl+C, Ctrl+V, Ctrl+R repeat, Insert a course, Shift+Insert a wale.<br><br>"
           "<b>Text</b>: Ctrl+F finds; in knitout Ctrl+. folds a pass, Ctrl+Shift+[ and ] all of "
           "them.<br><br>"
           "<b>Cloth menu</b>: F5 knits anew, F6 relaxes a large piece, Esc cancels."));
  });
  connect(menu->addAction(tr("&About")), &QAction::triggered, this, [this] {
    QMessageBox::about(this, tr("Loopwright"),
                       tr("Loopwright " LOOPWRIGHT_VERSION
                          ": from a knitting notation to relaxed cloth.\nApache License 2.0."));
  });
}

void MainWindow::start_tour() {
  // beside the work, not before it: what a step says can be tried while it stands there
  auto* tour = new QWizard(this);
  tour->setAttribute(Qt::WA_DeleteOnClose);
  tour->setWindowTitle(tr("Loopwright in five steps"));
  tour->setOption(QWizard::NoBackButtonOnStartPage);
  const std::vector<std::pair<QString, QString>> steps{
      {tr("1. Write"),
       tr("Left above is the notation: g is a front stitch, e a rear stitch, one line per course. Change "
          "a letter and watch the cloth.")},
      {tr("2. Draw"),
       tr("Left below is the same as a needle diagram. Take the tool Stitch or Tuck and click a needle; "
          "the text follows, and Ctrl+Z takes it back.")},
      {tr("3. Look"),
       tr("The cloth in the middle is the yarn in equilibrium. Turn it with the mouse, press 1 to 4 for "
          "views, colour it by tension in the View menu.")},
      {tr("4. Choose"),
       tr("Click a loop: its letter and needle are marked, and the Loop panel tells what it is.")},
      {tr("5. Pull"),
       tr("Move the slider under Stretch, or drag an edge of the cloth. The status line always says "
          "whether all interlacings are whole.")}};
  for (const auto& [title, text] : steps) {
    auto* page = new QWizardPage;
    page->setTitle(title);
    auto* label = new QLabel(text, page);
    label->setWordWrap(true);
    (new QVBoxLayout(page))->addWidget(label);
    tour->addPage(page);
  }
  tour->setMinimumSize(360, 200);
  tour->resize(440, 210);
  const QPoint corner = cloth_->mapToGlobal(QPoint(12, cloth_->height() - 240));
  tour->move(corner);
  tour->show();
}

}  // namespace loopwright
