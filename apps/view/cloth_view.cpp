#include "cloth_view.hpp"

#include <QElapsedTimer>
#include <QMetaObject>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "picking.hpp"

namespace loopwright {
namespace {

constexpr int frame_ms = 33;

// Whole repeats that make about the size that the file asks for, and no more than can be drawn quickly.
std::array<int, 2> repeats_for(const Fabric& fabric, const Knitting* knitting) {
  if (!fabric.periodic) return {1, 1};
  const auto enough = [](int wanted, double per_cell) {
    return std::clamp(static_cast<int>(std::lround(wanted / std::max(per_cell, 0.5))), 1, 24);
  };
  int wales = 8, courses = 8;
  if (knitting) {
    const FabricSettings& settings = knitting->program.settings;
    if (settings.size_wales > 0) wales = std::min(settings.size_wales, 16);
    if (settings.size_courses > 0) courses = std::min(settings.size_courses, 16);
  }
  return {enough(wales, fabric.wales), enough(courses, fabric.courses)};
}

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
  scene_builder_.cancel();
  motion_builder_.cancel();
  makeCurrent();
  buffer_.reset();
  yarns_.reset();
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

// --- what is shown

void ClothView::take_fabric() {
  if (!session_.fabric()) {
    drawn_ = nullptr;
    scene_ = nullptr;
    motion_ = nullptr;
    motion_of_ = nullptr;
    follows_ = true;
    redraw();
    return;
  }
  ask_for_scene();
}

// Pixels of a yarn's diameter, in steps: finer meshes are made when the camera comes nearer.
double ClothView::wanted_detail() const {
  const double pixels = height() * devicePixelRatioF() / std::max(camera_.height, 1e-6);
  return std::clamp(std::exp2(std::round(std::log2(std::max(pixels, 1.0)))), 4.0, 32.0);
}

void ClothView::ask_for_scene() {
  const std::shared_ptr<const Fabric> fabric = session_.fabric();
  if (!fabric || style_ != ClothStyle::yarn) {
    redraw();
    return;
  }
  const bool at_work = session_.working();
  SceneOptions options;
  const Knitting* knitting = session_.moment().knitting.get();
  repeats_ = options.repeats = repeats_for(*fabric, knitting);
  detail_ = wanted_detail();
  options.pixels_per_diameter = at_work ? std::min(detail_, 8.0) : detail_;
  options.look.occlusion = !at_work;
  options.look.fuzz = 0;
  const Selection& chosen = session_.selection();
  const std::vector<int> kin = session_.spans_at(chosen.at);
  const std::vector<int> spans = chosen.span >= 0 ? std::vector<int>{chosen.span} : std::vector<int>{};
  const auto relax = session_.moment().options;
  const ModelOptions model = relax ? relax->model : ModelOptions();
  // forces have a meaning in cloth that the yarn model holds
  const bool forces_known = relax != nullptr;
  const ColourBy by = !forces_known && (colour_by_ == ColourBy::tension || colour_by_ == ColourBy::contact)
                          ? ColourBy::yarn
                          : colour_by_;
  const int serial = ++scenes_asked_;
  scene_builder_.start([this, serial, fabric, options, spans, kin, model, by, at_work,
                        repeats = repeats_](const std::atomic<bool>& cancelled) mutable {
    std::shared_ptr<const YarnScene> scene;
    ClothColours colours;
    try {
      colours = cloth_colours(*fabric, model, by, spans, kin);
      options.colours = colours.segments;
      if (!cancelled) scene = std::make_shared<const YarnScene>(yarn_scene(*fabric, options));
    } catch (const std::exception&) {
      scene = nullptr;  // the message of the moment says what is wrong with the fabric
    }
    QMetaObject::invokeMethod(
        this,
        [this, serial, fabric, scene, repeats, at_work, colours = std::move(colours)]() mutable {
          scenes_taken_ = serial;
          drawn_ = fabric;
          take_scene(scene, std::move(colours), repeats, at_work);
        },
        Qt::QueuedConnection);
  });
}

void ClothView::take_scene(std::shared_ptr<const YarnScene> scene, ClothColours colours,
                           std::array<int, 2> repeats, bool coarse) {
  if (!scene) return;
  scene_ = std::move(scene);
  colours_ = std::move(colours);
  repeats_ = repeats;
  coarse_ = coarse;
  uploaded_ = false;
  follow();
  // the work ended meanwhile, or the camera is nearer now
  if ((coarse_ && !session_.working()) || (!coarse_ && wanted_detail() != detail_)) ask_for_scene();
  redraw();
}

// The loop model of the knitting that is shown, built aside.
void ClothView::ask_for_motion() {
  if (!session_.working() && coarse_ && scene_ && style_ == ClothStyle::yarn) ask_for_scene();
  const auto knitting = session_.moment().knitting;
  if (style_ == ClothStyle::yarn || !knitting || knitting == motion_of_) return;
  motion_of_ = knitting;
  motion_builder_.start([this, knitting, text = session_.document().text(),
                         suffix = session_.document().suffix()](const std::atomic<bool>&) {
    std::shared_ptr<LoopMotion> motion;
    QString problem;
    try {
      // the piece as the file says it, as `render --style structure` draws it
      Diagnostics diagnostics;
      ClothRequest request;
      request.text = text, request.suffix = suffix;
      motion = std::make_shared<LoopMotion>(knit_text(request, {}, diagnostics), std::vector<PiecePlace>{});
    } catch (const std::exception& fault) {
      problem = QString::fromUtf8(fault.what());
    }
    QMetaObject::invokeMethod(
        this,
        [this, motion, problem] {
          if (!problem.isEmpty()) emit session_.refused(problem);
          motion_ = motion;
          if (motion_ && style_ != ClothStyle::yarn) fit();
          if (playing_) frame_timer_.start();
          emit motion_changed();
          redraw();
        },
        Qt::QueuedConnection);
  });
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
    lines_ = std::make_unique<StructurePainter>();
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
      uploaded_ = true;
    }
    DrawStyle style;
    style.background = background();
    style.shadows = !moving_ && !coarse_;
    style.table = false;
    if (scene_)
      yarns_->draw(camera_, style, width, height);
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
