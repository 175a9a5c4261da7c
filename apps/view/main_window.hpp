// The window: menus, docks and status around the cloth.
#pragma once
#include <QFileSystemWatcher>
#include <QMainWindow>
#include <QTimer>

#include "autosave.hpp"
#include "cloth_view.hpp"
#include "diagram_view.hpp"
#include "notation_editor.hpp"
#include "panels.hpp"
#include "session.hpp"

class QActionGroup;
class QDockWidget;
class QLabel;
class QProgressBar;
class QPushButton;
class QToolBar;

namespace loopwright {

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  // `folder`: for what is not saved.
  explicit MainWindow(const QString& autosave_folder, QWidget* parent = nullptr);

  bool open(const QString& path);  // says what is wrong in a message; false then
  bool save_to(const QString& path);
  void export_to(const QString& path);  // by the suffix; throws what the writers throw
  void offer_recovery();
  void start_tour();

  Session& session() { return session_; }
  ClothView& cloth() { return *cloth_; }
  DiagramView& diagram() { return *diagram_; }
  NotationEditor& editor() { return *editor_; }
  StretchPanel& stretch() { return *stretch_; }
  QString interlacings_text() const;

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  QDockWidget* add_dock(const QString& title, const char* name, QWidget* widget, Qt::DockWidgetArea area);
  void build_docks();
  void build_file_menu();
  void build_edit_menu();
  void build_view_menu();
  void build_cloth_menu();
  void build_diagram_bar();
  void build_help_menu();
  void build_status();
  void add_built_in(QMenu* menu, const QString& folder);
  void show_recent(QMenu* menu);
  void remember(const QString& path);
  void show_title();
  void show_status();
  void set_dark(bool dark);
  bool may_leave();  // asks to save what was changed
  bool save();
  bool save_as();
  void ask_export();
  void say(const QString& what);
  void watch();
  void take_changed_file();

  Session session_;
  Autosave autosave_;
  QTimer autosave_timer_;
  QFileSystemWatcher watcher_;
  ClothView* cloth_ = nullptr;
  NotationEditor* editor_ = nullptr;
  DiagramView* diagram_ = nullptr;
  StretchPanel* stretch_ = nullptr;
  QWidget* text_side_ = nullptr;
  QLabel *stage_ = nullptr, *interlacings_ = nullptr, *hint_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* cancel_ = nullptr;
};

}  // namespace loopwright
