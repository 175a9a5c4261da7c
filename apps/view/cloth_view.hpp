// The cloth in space: the same OpenGL code that renders without a screen, in a window. Draws only when
// something changed; while the mouse turns it, shadows wait.
#pragma once
#include <QOpenGLWidget>
#include <QTimer>
#include <memory>

class QOpenGLFramebufferObject;

#include "loop_motion.hpp"
#include "orbit.hpp"
#include "outputs/yarn_renderer.hpp"
#include "picking.hpp"
#include "session.hpp"

namespace loopwright {

enum class ClothStyle { yarn, structure, sides };

class ClothView : public QOpenGLWidget {
  Q_OBJECT
 public:
  explicit ClothView(Session& session, QWidget* parent = nullptr);
  ~ClothView() override;

  ClothStyle style() const { return style_; }
  void set_style(ClothStyle style);
  ColourBy colour_by() const { return colour_by_; }
  void set_colour_by(ColourBy by);
  void set_view(View view);
  void set_perspective(bool perspective);
  void set_floor(bool shown);
  void set_habit(MouseHabit habit) { habit_ = habit; }
  void set_dark(bool dark);
  void fit();
  const Camera& camera() const { return camera_; }
  // Where a place of the fabric is drawn, in the widget; for tests as well.
  QPointF on_screen(const Vec3& place) const;
  bool scene_is_current() const { return scenes_taken_ == scenes_asked_; }
  double last_frame_ms() const { return last_frame_ms_; }
  int frames_drawn() const { return frames_drawn_; }
  // The picture as it is, at a size of one's own.
  QImage picture(QSize size);

  // The loop model in motion.
  LoopMotion* motion() { return motion_.get(); }
  bool playing() const { return playing_; }
  void set_playing(bool playing);
  void step();
  void reset_motion();

 signals:
  void view_changed();  // style, colours, projection
  void motion_changed();
  void edge_pulled(StretchDirection direction, double strain);  // yarn style: an edge was dragged

 protected:
  void initializeGL() override;
  void paintGL() override;
  void resizeGL(int width, int height) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  struct Drag {
    MouseAct act = MouseAct::none;
    QPointF start, last;
    bool moved = false, pulls = false, pulls_edge = false, pulls_yarn = false;
    StretchDirection edge = StretchDirection::course;
    double edge_side = 1;      // +1: right or top edge
    bool edge_chosen = false;  // whether its first way said what it is
    Vec3 held;                 // place that is pulled
  };
  void follow();
  void moved_by_hand();
  void take_fabric();
  void ask_for_scene();
  struct BuiltScene {
    std::shared_ptr<const YarnScene> scene, moving;
    ClothColours colours;
    std::array<int, 2> repeats{1, 1};
    bool coarse = false;
    int every = 1;  // control point in the moving scene
  };
  void take_scene(BuiltScene built);
  void ask_for_motion();
  void tick();
  // Knitting needle by needle: how far each yarn has been fed, in its parameter; empty: all of it.
  void show_knitted();
  void draw_scene(int width, int height, double line_pixels);
  void draw_into_buffer(QSize pixels);
  void redraw();  // the picture is out of date, not only what is written over it
  void paint_notes(QPainter& painter, QSize size);
  QString broken_text() const;
  void paint_legend(QPainter& painter, QSize size);
  void choose_at(const QPointF& at);
  void begin_pull(const QPointF& at, bool at_yarn);
  void begin_yarn_pull(const QPointF& at);
  void pull(const QPointF& at);
  void end_pull();
  double aspect() const;
  Bounds bounds() const;
  Sight sight_at(const QPointF& at) const;
  double wanted_detail() const;
  std::array<std::uint8_t, 3> background() const;

  Session& session_;
  ClothStyle style_ = ClothStyle::yarn;
  ColourBy colour_by_ = ColourBy::yarn;
  MouseHabit habit_ = MouseHabit::freecad;
  bool floor_ = true, dark_ = false, playing_ = true, moving_ = false;
  bool follows_ = true;  // the camera fits the cloth until somebody moves it
  Camera camera_;
  Drag drag_;
  QTimer still_timer_, frame_timer_;

  // The picture without notes: drawn anew only when something in space changed, at half size while it moves
  // where that is too slow.
  std::unique_ptr<QOpenGLFramebufferObject> buffer_;
  bool buffer_is_current_ = false;
  double moving_frame_ms_ = 0;
  std::unique_ptr<YarnRenderer> yarns_, moving_yarns_;
  std::unique_ptr<StructurePainter> lines_;
  std::shared_ptr<const YarnScene> scene_,
      moving_scene_;  // of a coarser mesh, for while it moves; may be none
  bool uploaded_ = false, coarse_ = false;
  bool without_gpu_ = false;
  int moving_every_ = 1;
  std::vector<double> fed_;
  int scenes_asked_ = 0, scenes_taken_ = 0;
  std::shared_ptr<std::atomic<bool>> other_document_ = std::make_shared<std::atomic<bool>>(false);
  ClothColours colours_;
  std::array<int, 2> repeats_{1, 1};
  double detail_ = 0;
  std::shared_ptr<const Fabric> drawn_;
  std::shared_ptr<LoopMotion> motion_;
  std::shared_ptr<const Knitting> motion_of_;
  double last_frame_ms_ = 0;
  int frames_drawn_ = 0;
  QString no_gl_;
  LatestOnly scene_builder_, motion_builder_;
};

}  // namespace loopwright
