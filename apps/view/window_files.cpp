// Files of the window: open, save, export, watch, recover.
#include <QCloseEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QMimeData>
#include <QSettings>

#include "cloth_file_job.hpp"
#include "main_window.hpp"
#include "notation/read_program.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/write_diagram_svg.hpp"
#include "outputs/write_fabric.hpp"
#include "outputs/write_json.hpp"

namespace loopwright {

bool MainWindow::open(const QString& path) {
  try {
    session_.document().open(path.toStdString());
  } catch (const FileError& fault) {
    QMessageBox::warning(this, tr("Cannot open"), QString::fromUtf8(fault.what()));
    return false;
  }
  remember(path);
  watch();
  show_title();
  return true;
}

void MainWindow::watch() {
  if (!watcher_.files().isEmpty()) watcher_.removePaths(watcher_.files());
  const auto& path = session_.document().path();
  if (!path.empty()) watcher_.addPath(QString::fromStdString(path.string()));
}

void MainWindow::take_changed_file() {
  watch();  // a file that was replaced is a new one to the watcher
  Document& document = session_.document();
  if (document.kind() == DocumentKind::cloth) {
    // half-written files are told by their reader, and come again
    if (QFileInfo::exists(QString::fromStdString(document.path().string()))) document.open(document.path());
    return;
  }
  Diagnostics unread;
  const auto text = read_text(document.path(), unread);
  if (!text || *text == document.text()) return;
  if (document.changed()) {
    say(tr("The file was changed by another program; saving here would replace that."));
    return;
  }
  try {
    if (document.read_only()) {
      document.open(document.path());
    } else {
      // as a change, so that it can be undone and views stay where they are
      document.change_to(*text, tr("Changes of another editor").toStdString());
      document.mark_saved();
    }
  } catch (const FileError& fault) {
    say(QString::fromUtf8(fault.what()));
  }
  show_title();
}

bool MainWindow::save_to(const QString& path) {
  try {
    session_.document().save(path.toStdString());
  } catch (const FileError& fault) {
    QMessageBox::warning(this, tr("Cannot save"), QString::fromUtf8(fault.what()));
    return false;
  }
  autosave_.forget();
  remember(path);
  watch();
  show_title();
  return true;
}

bool MainWindow::save() {
  if (session_.document().kind() == DocumentKind::cloth) {
    say(tr(
        "A file of cloth is shown as it is: File > Export writes a state anew, File > New from this notation "
        "opens its notation."));
    return false;
  }
  const auto& path = session_.document().path();
  return path.empty() ? save_as() : save_to(QString::fromStdString(path.string()));
}

bool MainWindow::save_as() {
  if (session_.document().kind() == DocumentKind::cloth) {
    ask_export();
    return false;
  }
  const bool fabric = session_.document().kind() == DocumentKind::fabric;
  const QString path =
      QFileDialog::getSaveFileName(this, tr("Save as"), QString::fromStdString(session_.document().name()),
                                   fabric ? tr("Fabric files (*.verm)") : tr("Knitout (*.k *.knitout)"));
  return !path.isEmpty() && save_to(path);
}

bool MainWindow::may_leave() {
  if (!session_.document().changed()) return true;
  const auto answer = QMessageBox::question(
      this, tr("Not saved"),
      tr("%1 has changes that are not saved.").arg(QString::fromStdString(session_.document().name())),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel);
  if (answer == QMessageBox::Save) return save();
  return answer == QMessageBox::Discard;
}

void MainWindow::export_to(const QString& path) {
  const std::filesystem::path file = path.toStdString();
  const QString suffix = QFileInfo(path).suffix().toLower();
  if (suffix == QLatin1String("png")) {
    if (!cloth_->picture(cloth_->size() * 2).save(path))
      throw FileError(file.string() + ": cannot be written");
    return;
  }
  if (suffix == QLatin1String("svg")) {
    const auto& knitting = session_.moment().knitting;
    write_diagram_svg(
        file, session_.knitout() && knitting ? needle_diagram(knitting->program) : session_.diagram());
    return;
  }
  if (!session_.fabric()) throw std::invalid_argument("there is no cloth to export yet");
  if (session_.broken())
    throw std::invalid_argument(
        "the cloth is broken: it is not what the notation knits, and is not exported");
  if (suffix == QLatin1String("json")) {
    const ClothMoment& moment = session_.moment();
    if (moment.relaxed)
      write_json(file, results(assess(moment.relaxed->fabric), *moment.relaxed));
    else if (moment.stage == ClothStage::as_saved)
      write_json(file, results(assess(*session_.fabric())));
    else
      throw std::invalid_argument("only cloth at rest is measured");
    return;
  }
  const auto& moment = session_.moment();
  State state{*session_.fabric(), {}, {}};
  if (moment.relaxed && moment.options && session_.fabric() == moment.fabric)
    state = saved_state(*moment.relaxed, *moment.options, 1);
  // a state is opened again with the notation that it was knitted from
  const Document& document = session_.document();
  if (document.kind() != DocumentKind::cloth || document.has_fabric_text()) {
    state.texts[state_notation] = document.text();
    state.texts[state_notation_suffix] = document.suffix();
  }
  write_fabric(file, state);
}

void MainWindow::ask_export() {
  const QString path = QFileDialog::getSaveFileName(
      this, tr("Export"), QString(),
      tr("Picture of the cloth (*.png);;Needle diagram (*.svg);;Measurements (*.json);;State (*.h5);;"
         "glTF (*.glb);;OBJ (*.obj);;VTK (*.vtp);;STEP (*.step);;Yarn curves (*.bcc *.yarns)"));
  if (path.isEmpty()) return;
  try {
    export_to(path);
    say(tr("Written: %1").arg(path));
  } catch (const std::exception& fault) {
    QMessageBox::warning(this, tr("Cannot export"), QString::fromUtf8(fault.what()));
  }
}

void MainWindow::offer_recovery() {
  while (const auto left = autosave_.left_behind()) {
    const QString name = left->path.empty() ? tr("a new file") : QString::fromStdString(left->path.string());
    const auto answer = QMessageBox::question(
        this, tr("Recover"), tr("Changes to %1 were not saved when the program ended. Open them?").arg(name));
    if (answer == QMessageBox::Yes) {
      session_.document().recover(left->text, left->path);
      show_title();
      autosave_.keep(session_.document());
    }
    Autosave::discard(*left);
    if (answer == QMessageBox::Yes) return;
  }
}

void MainWindow::remember(const QString& path) {
  QSettings settings;
  QStringList recent = settings.value(QStringLiteral("recent")).toStringList();
  const QString full = QFileInfo(path).absoluteFilePath();
  recent.removeAll(full);
  recent.prepend(full);
  while (recent.size() > 10) recent.removeLast();
  settings.setValue(QStringLiteral("recent"), recent);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!may_leave()) {
    event->ignore();
    return;
  }
  QSettings settings;
  settings.setValue(QStringLiteral("geometry"), saveGeometry());
  settings.setValue(QStringLiteral("docks"), saveState());
  autosave_timer_.stop();
  autosave_.forget();
  session_.cancel();
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls.front().isLocalFile()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  if (may_leave()) open(event->mimeData()->urls().front().toLocalFile());
}

}  // namespace loopwright
