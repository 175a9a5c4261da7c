// The panels beside the cloth: each shows one side of what the session holds.
#pragma once
#include <QWidget>

#include "session.hpp"

class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QLineEdit;
class QPushButton;
class QSlider;
class QTreeWidget;

namespace loopwright {

class PlotWidget;

// The loop that is chosen, in the words of the glossary.
class LoopPanel : public QWidget {
  Q_OBJECT
 public:
  explicit LoopPanel(Session& session, QWidget* parent = nullptr);

 private:
  void show_selection();
  QString described() const;
  Session& session_;
  QLabel* text_;
};

// Size, density, weight and Munden's constants of cloth at rest.
class MeasuresPanel : public QWidget {
  Q_OBJECT
 public:
  explicit MeasuresPanel(Session& session, QWidget* parent = nullptr);

 private:
  void show_measures();
  Session& session_;
  QLabel* text_;
  std::shared_ptr<const Measurements> measured_;
};

// What is wrong or doubtful; a click goes to the line.
class MessagesPanel : public QWidget {
  Q_OBJECT
 public:
  explicit MessagesPanel(Session& session, QWidget* parent = nullptr);

 signals:
  void go_to(SourceLocation at);

 private:
  void show_messages();
  Session& session_;
  QTreeWidget* list_;
};

// Yarns and loop lengths of a fabric file: changes go into its header lines.
class FabricPanel : public QWidget {
  Q_OBJECT
 public:
  explicit FabricPanel(Session& session, QWidget* parent = nullptr);

 private:
  void show_settings();
  void build_yarns();
  void add_yarn_fields(std::size_t yarn);
  void show_yarn_fields(std::size_t yarn);
  // Reads a yarn's header, lets `change` change its data, writes it back.
  void change_yarn(std::size_t yarn, const std::function<void(YarnData&)>& change);
  void set_header(const QString& name, const QString& value);
  QDoubleSpinBox* number_row(QFormLayout* form, const QString& label, const char* header, double low,
                             double high, double step, const QString& unit, const QString& tip);
  Session& session_;
  bool filling_ = false;
  QWidget* form_;
  QLabel* facts_;  // in the place of the form, for what is not edited here
  QFormLayout* yarn_form_;
  std::vector<std::pair<const char*, QDoubleSpinBox*>> numbers_;
  QComboBox *edges_, *gating_;
  QLineEdit *name_, *size_;
  std::vector<std::string> yarn_names_;
  std::vector<QLineEdit*> yarn_edits_;
  struct YarnFields {
    std::vector<QDoubleSpinBox*> numbers;  // in the order of the fields of yarn_fields()
    QPushButton* colour = nullptr;
  };
  std::vector<YarnFields> yarn_fields_;
};

// A stretch test by hand: a slider, and the curve as it comes.
class StretchPanel : public QWidget {
  Q_OBJECT
 public:
  explicit StretchPanel(Session& session, QWidget* parent = nullptr);
  void set_strain(StretchDirection direction, double strain);  // as if the slider was moved
  PlotWidget* plot() { return plot_; }
  void write_curve(const QString& path) const;  // CSV or SVG by its suffix; throws FileError

 private:
  void ask();
  void show_points();
  StretchDirection direction() const;
  Session& session_;
  QComboBox* directions_;
  QSlider* slider_;
  QLabel* value_;
  PlotWidget* plot_;
};

}  // namespace loopwright
