#include "cloth_view.hpp"

#include <QElapsedTimer>
#include <QMetaObject>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "knitted_so_far.hpp"
#include "picking.hpp"
#include "scene_budget.hpp"

namespace loopwright {
namespace {

constexpr int frame_ms = 33;

}  // namespace

ClothView::ClothView(Session& session, QWidget* parent) : QOpenGLWidget(parent), session_(session) {
  setObjectName(QStringLiteral("cloth"));
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(240, 200);
  camera_ = fitted_camera(View::front, {{-5, -5, -1}, {5, 5, 1}}, 1);
  connect(&session_, &Session::fabric_changed, this, &ClothView::take_fabric);
  connect(&session_, &Session::moment_changed, this, qOverload<>(&QWidget::update));
  connect(&session_, &Session::moment_changed, this, &ClothView::ask_for_motion);
  connect(&session_, &Session::selection_changed, this, &ClothView::ask_for_scene);
  connect(&session_, &Session::knitted_changed, this, &ClothView::show_knitted);
  // after the last movement the picture gets its shadows back
  still_timer_.setSingleShot(true);
  still_timer_.setInterval(180);
  connect(&still_timer_, &QTimer::timeout, this, [this] {
    moving_ = false;
    if (wanted_detail() != detail_) ask_for_scene();
    redraw();
  });
  frame_timer_.setInterval(frame_ms);
  connect(&frame_timer_, &QTimer::timeout, this, &ClothView::tick);
}

ClothView::~ClothView() {
  *other_document_ = true;
  scene_builder_.cancel();
  motion_builder_.cancel();
  makeCurrent();
  buffer_.reset();
  yarns_.reset();
  moving_yarns_.reset();
  lines_.reset();
  doneCurrent();
}

std::array<std::uint8_t, 3> ClothView::background() const {
  return dark_ ? std::array<std::uint8_t, 3>{38, 40, 44} : std::array<std::uint8_t, 3>{246, 245, 242};
}

double ClothView::aspect() const { return static_cast<double>(width()) / std::max(1, height()); }

Bounds ClothView::bounds() const {
  if (style_ != ClothStyle::yarn && motion_) {
    StructureScene points;
    points.points = positions_of(motion_->state());
    return bounds_of(points);
  }
  if (scene_) return scene_->bounds;
  return {{-5, -5, -1}, {5, 5, 1}};
}

void ClothView::set_style(ClothStyle style) {
  if (style == style_) return;
  style_ = style;
  if (style_ == ClothStyle::yarn) {
    frame_timer_.stop();
    ask_for_scene();
    if (scene_) fit();
  } else {
    ask_for_motion();
    if (motion_) fit();
    if (playing_) frame_timer_.start();
  }
  emit view_changed();
  redraw();
}

void ClothView::set_colour_by(ColourBy by) {
  colour_by_ = by;
  ask_for_scene();
  emit view_changed();
}

void ClothView::set_view(View view) {
  const double field = camera_.field_of_view_deg;
  const bool corner = view == View::corner || view == View::left_corner;
  camera_ = fitted_camera(view, bounds(), aspect());
  if (!corner) camera_.field_of_view_deg = field > 0 ? field : 0;
  fit();
  emit view_changed();
}

void ClothView::set_perspective(bool perspective) {
  camera_ = with_projection(camera_, perspective);
  emit view_changed();
  redraw();
}

void ClothView::set_floor(bool shown) {
  floor_ = shown;
  redraw();
}

void ClothView::set_dark(bool dark) {
  dark_ = dark;
  redraw();
}

void ClothView::fit() {
  follows_ = true;
  follow();
  if (style_ == ClothStyle::yarn && wanted_detail() != detail_ && scene_) ask_for_scene();
  redraw();
}

void ClothView::follow() {
  if (follows_) camera_ = fitted(camera_, bounds(), aspect());
}

void ClothView::moved_by_hand() {
  follows_ = false;
  moving_ = true;
  still_timer_.start();
  redraw();
}

// --- the loop model in motion

void ClothView::tick() {
  if (!motion_ || style_ == ClothStyle::yarn) {
    frame_timer_.stop();
    return;
  }
  QElapsedTimer clock;
  clock.start();
  bool moves = true;
  // as much as fits half a frame
  while (moves && clock.elapsed() < frame_ms / 2) moves = motion_->advance(10);
  if (!moves && !motion_->grabbed()) frame_timer_.stop();
  emit motion_changed();
  redraw();
}

void ClothView::set_playing(bool playing) {
  playing_ = playing;
  if (playing && style_ != ClothStyle::yarn)
    frame_timer_.start();
  else
    frame_timer_.stop();
  emit motion_changed();
}

void ClothView::step() {
  set_playing(false);
  if (motion_) motion_->advance(10);
  emit motion_changed();
  redraw();
}

void ClothView::reset_motion() {
  if (motion_) motion_->reset();
  if (playing_ && style_ != ClothStyle::yarn) frame_timer_.start();
  emit motion_changed();
  redraw();
}

// --- drawing

void ClothView::initializeGL() {
  try {
    // a context of its own after the widget was put into another window
    yarns_ = std::make_unique<YarnRenderer>();
    moving_yarns_ = std::make_unique<YarnRenderer>();
    lines_ = std::make_unique<StructurePainter>();
    // Mesa's names for a processor that draws
    const QByteArray drawn_by(
        reinterpret_cast<const char*>(context()->functions()->glGetString(GL_RENDERER)));
    without_gpu_ = drawn_by.contains("llvmpipe") || drawn_by.contains("softpipe");
    uploaded_ = false;
    buffer_.reset();
  } catch (const std::runtime_error& fault) {
    no_gl_ = QString::fromUtf8(fault.what());
  }
}

void ClothView::resizeGL(int, int) {
  follow();
  buffer_is_current_ = false;
}

void ClothView::redraw() {
  buffer_is_current_ = false;
  update();
}

void ClothView::draw_scene(int width, int height, double line_pixels) {
  if (style_ == ClothStyle::yarn) {
    if (scene_ && !uploaded_) {
      yarns_->upload(*scene_);
      if (moving_scene_) moving_yarns_->upload(*moving_scene_);
      uploaded_ = true;
    }
    if (scene_ && drawn_) {
      yarns_->show_only(runs_until(*scene_, *drawn_, fed_));
      if (moving_scene_) moving_yarns_->show_only(runs_until(*moving_scene_, *drawn_, fed_, moving_every_));
    }
    DrawStyle style;
    style.background = background();
    style.shadows = !moving_ && !coarse_ && scene_ && affords_shadows(*scene_, without_gpu_);
    style.table = false;
    if (scene_)
      (moving_ && moving_scene_ ? moving_yarns_ : yarns_)->draw(camera_, style, width, height);
    else
      lines_->clear(background(), width, height);
  } else {
    lines_->clear(background(), width, height);
    if (motion_) {
      const StructureStyle structure =
          style_ == ClothStyle::structure ? StructureStyle::net : StructureStyle::sides;
      lines_->draw(motion_->scene(structure), camera_, width, height, line_pixels);
    }
  }
  if (floor_ && (scene_ || motion_)) {
    const double mm = drawn_ ? drawn_->diameter_mm : 1;
    const std::array<std::uint8_t, 3> colour =
        dark_ ? std::array<std::uint8_t, 3>{74, 78, 84} : std::array<std::uint8_t, 3>{206, 210, 214};
    lines_->draw(floor_grid(bounds(), mm, colour).scene, camera_, width, height, line_pixels);
  }
}

void ClothView::draw_into_buffer(QSize pixels) {
  // a picture that takes longer than this moves in jerks
  constexpr double smooth_ms = 50;
  const bool half = moving_ && moving_frame_ms_ > smooth_ms;
  const QSize size = half ? QSize(std::max(1, pixels.width() / 2), std::max(1, pixels.height() / 2)) : pixels;
  const int samples = moving_ || coarse_ ? 0 : 4;
  if (!buffer_ || buffer_->size() != size || buffer_->format().samples() != samples) {
    QOpenGLFramebufferObjectFormat format;
    format.setAttachment(QOpenGLFramebufferObject::CombinedDepthStencil);
    format.setSamples(samples);
    buffer_ = std::make_unique<QOpenGLFramebufferObject>(size, format);
  }
  buffer_->bind();
  QElapsedTimer clock;
  clock.start();
  draw_scene(size.width(), size.height(), std::max(1.0, size.height() / 700.0));
  QOpenGLFramebufferObject::bindDefault();
  // the buffer's last pixel is waited for by the blit below, so the time is taken there
  QOpenGLFramebufferObject::blitFramebuffer(nullptr, QRect(QPoint(), pixels), buffer_.get(),
                                            QRect(QPoint(), size), GL_COLOR_BUFFER_BIT,
                                            half ? GL_LINEAR : GL_NEAREST);
  context()->functions()->glFinish();
  last_frame_ms_ = static_cast<double>(clock.nsecsElapsed()) * 1e-6;
  // of the full size, so that a half-size frame does not talk itself back to the full one
  if (moving_) moving_frame_ms_ = half ? 3 * last_frame_ms_ : last_frame_ms_;
  buffer_is_current_ = true;
  ++frames_drawn_;
}

void ClothView::paintGL() {
  const QSize pixels = size() * devicePixelRatioF();
  if (no_gl_.isEmpty()) {
    if (buffer_ && buffer_is_current_)
      QOpenGLFramebufferObject::blitFramebuffer(nullptr, QRect(QPoint(), pixels), buffer_.get(),
                                                QRect(QPoint(), buffer_->size()), GL_COLOR_BUFFER_BIT,
                                                buffer_->size() == pixels ? GL_NEAREST : GL_LINEAR);
    else
      draw_into_buffer(pixels);
  }
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  paint_notes(painter, size());
}

QImage ClothView::picture(QSize size) {
  makeCurrent();
  QOpenGLFramebufferObjectFormat format;
  format.setAttachment(QOpenGLFramebufferObject::CombinedDepthStencil);
  format.setSamples(4);
  QOpenGLFramebufferObject buffer(size, format);
  buffer.bind();
  draw_scene(size.width(), size.height(), std::max(1.0, size.height() / 700.0));
  buffer.release();
  QImage image = buffer.toImage();
  doneCurrent();
  return image.convertToFormat(QImage::Format_RGB32);
}

QPointF ClothView::on_screen(const Vec3& place) const {
  const Matrix4 m = camera_.projection(aspect()) * camera_.view();
  std::array<double, 4> p{};
  for (std::size_t row = 0; row < 4; ++row)
    p[row] = m[row] * place.x + m[4 + row] * place.y + m[8 + row] * place.z + m[12 + row];
  return {(p[0] / p[3] + 1) / 2 * width(), (1 - p[1] / p[3]) / 2 * height()};
}

}  // namespace loopwright
