// The needle diagram on point paper, to be looked at and changed: a dot is a needle, a line of graph a pass,
// the first at the bottom; the rear bed stands above the front bed. A click or drag does what the tool says;
// the text follows.
#pragma once
#include <QAbstractScrollArea>
#include <optional>
#include <utility>

#include "diagram_edits.hpp"
#include "session.hpp"

namespace loopwright {

enum class DiagramTool { select, stitch, tuck, miss, transfer, split, drop, inactive };

class DiagramView : public QAbstractScrollArea {
  Q_OBJECT
 public:
  explicit DiagramView(Session& session, QWidget* parent = nullptr);

  void set_tool(DiagramTool tool);
  DiagramTool tool() const { return tool_; }
  // Where a needle is drawn, in the viewport; for tests as well.
  QPointF needle_place(std::size_t pass, bool rear, int wale) const;
  // Knitting needle by needle: how many acts there are, where the k-th is written, and drawing so many of
  // them in full and the rest faintly (-1: all).
  int acts() const;
  SourceLocation act_place(int k) const;
  void show_acts(int count);

 public slots:
  void zoom(double factor);
  void copy();
  void paste_copied();
  void repeat_selected();
  void insert_course();
  void remove_courses();
  void insert_wale_here();
  void remove_wale_here();

 signals:
  void tool_changed();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  bool viewportEvent(QEvent* event) override;

 private:
  struct Row {
    double front = 0, rear = 0;  // heights of the rows of dots, in pitches from the top
    int line = -1;               // of the notation; -1: follows from it
    std::size_t pass = 0;        // of that line
  };
  struct Act {
    std::size_t pass = 0;
    double slot = 0;
    SourceLocation at;
  };
  struct Place {
    std::size_t pass = 0;
    bool rear = false;
    int wale = 0;
    friend bool operator==(const Place&, const Place&) = default;
  };
  void lay_out();
  void keep_in_place(std::optional<Place>& place, const std::vector<Row>& before) const;
  std::optional<std::size_t> line_at_cursor();  // says why there is none
  void bars();
  void list_acts();
  Act act(int k) const;
  void show_pass(std::size_t p);
  std::pair<std::size_t, std::size_t> passes_between(double top, double bottom) const;
  bool begun(std::size_t pass) const;
  bool done(std::size_t pass, double slot) const;
  std::optional<Place> place_at(const QPointF& at) const;
  const DiagramNeedle& needle(const Place& place) const;
  void apply_tool(const Place& place);
  void operate(const Place& place, NeedleOperation operation);
  void choose(const Place& place);
  std::optional<DiagramArea> area() const;
  QPointF dot(double slot, double height) const;
  void paint_pass(QPainter& painter, std::size_t pass);
  void paint_yarn(QPainter& painter, const DiagramPass& pass, const Row& row);
  void paint_needles(QPainter& painter, const DiagramPass& pass, const Row& row);
  void paint_labels(QPainter& painter, std::size_t pass);
  QColor yarn_colour(int yarn) const;

  Session& session_;
  DiagramTool tool_ = DiagramTool::select;
  double pitch_ = 26;  // pixels
  std::vector<Row> rows_;
  double height_ = 0, width_ = 0;  // in pitches
  double least_slot_ = 0;
  std::vector<Act> acts_;  // of a fabric file, in knitting order
  int shown_acts_ = -1;
  std::optional<Place> cursor_, anchor_, painted_;
  CopiedNeedles copied_;
};

}  // namespace loopwright
