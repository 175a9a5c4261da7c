// The mouse in the cloth: turn, pan, zoom, choose a loop, pull a binding point or an edge.
#include <QKeyEvent>
#include <QMouseEvent>
#include <cmath>

#include "cloth_view.hpp"
#include "picking.hpp"

namespace loopwright {
namespace {

MouseButtons buttons_of(const QMouseEvent* event) {
  const Qt::MouseButtons held = event->buttons();
  const Qt::KeyboardModifiers keys = event->modifiers();
  return {held.testFlag(Qt::LeftButton), held.testFlag(Qt::MiddleButton), held.testFlag(Qt::RightButton),
          keys.testFlag(Qt::ShiftModifier), keys.testFlag(Qt::ControlModifier)};
}

// How near to an edge of the cloth a press takes hold of it, in pixels.
constexpr double edge_reach = 12;

}  // namespace

Sight ClothView::sight_at(const QPointF& at) const {
  return line_of_sight(camera_, aspect(), 2 * at.x() / width() - 1, 1 - 2 * at.y() / height());
}

void ClothView::choose_at(const QPointF& at) {
  if (style_ != ClothStyle::yarn) {
    if (!motion_) return;
    const Sight sight = sight_at(at);
    if (const auto mass = motion_->mass_at(sight.from, sight.direction, 2))
      session_.select_at(motion_->letter_at(*mass));
    return;
  }
  if (!drawn_) return;
  const auto picked = yarn_at(*drawn_, repeats_, sight_at(at), fed_);
  if (!picked || picked->loop < 0) {
    session_.select(Selection{});
    return;
  }
  session_.select({drawn_->loops[static_cast<std::size_t>(picked->loop)].at, picked->loop});
}

// Takes hold of a binding point (loop model) or of an edge of the cloth (yarn model).
void ClothView::begin_yarn_pull(const QPointF& at) {
  if (!drawn_ || !session_.moment().relaxed) return;
  const auto picked = yarn_at(*drawn_, repeats_, sight_at(at), fed_);
  if (!picked) return;
  session_.take_hold(picked->yarn, picked->t);
  drag_.held = picked->place;
  drag_.pulls = drag_.pulls_yarn = true;
}

void ClothView::begin_pull(const QPointF& at, bool at_yarn) {
  if (style_ != ClothStyle::yarn) {
    if (!motion_) return;
    const Sight sight = sight_at(at);
    const double reach = 12 * camera_.height / height();
    const auto mass = motion_->mass_at(sight.from, sight.direction, std::max(reach, 1.0));
    if (!mass) return;
    drag_.held = motion_->state().position(*mass);
    motion_->grab(*mass);
    drag_.pulls = true;
    return;
  }
  if (at_yarn) {
    begin_yarn_pull(at);
    return;
  }
  if (!session_.moment().relaxed || !scene_ || camera_.backward.z < 0.5) return;
  const Bounds box = scene_->bounds;
  const Vec3 centre = box.centre();
  struct Edge {
    Vec3 place;
    StretchDirection direction;
    double side;
  };
  const std::array<Edge, 4> edges{{{{box.upper.x, centre.y, centre.z}, StretchDirection::course, 1},
                                   {{box.lower.x, centre.y, centre.z}, StretchDirection::course, -1},
                                   {{centre.x, box.upper.y, centre.z}, StretchDirection::wale, 1},
                                   {{centre.x, box.lower.y, centre.z}, StretchDirection::wale, -1}}};
  const QPointF low = on_screen(box.lower), high = on_screen(box.upper);
  for (const Edge& edge : edges) {
    const QPointF there = on_screen(edge.place);
    const bool along_x = edge.direction == StretchDirection::course;
    const double away = along_x ? std::abs(at.x() - there.x()) : std::abs(at.y() - there.y());
    const bool beside = along_x ? at.y() > high.y() - edge_reach && at.y() < low.y() + edge_reach
                                : at.x() > low.x() - edge_reach && at.x() < high.x() + edge_reach;
    if (away > edge_reach || !beside) continue;
    drag_.pulls = drag_.pulls_edge = true;
    drag_.edge = edge.direction;
    drag_.edge_side = edge.side;
    return;
  }
}

void ClothView::pull(const QPointF& at) {
  if (drag_.pulls_edge) {
    const double scale = camera_.height / height();
    const QPointF way = at - drag_.start;
    const bool course = drag_.edge == StretchDirection::course;
    // an upper or lower edge that first goes sideways shears
    if (!drag_.edge_chosen && !course && std::abs(way.x()) > 1.5 * std::abs(way.y()) &&
        session_.moment().relaxed->fabric.periodic)
      drag_.edge = StretchDirection::shear;
    drag_.edge_chosen = true;
    if (drag_.edge == StretchDirection::shear) {
      const double height = session_.moment().relaxed->fabric.height * repeats_[1];
      emit edge_pulled(drag_.edge, std::clamp(drag_.edge_side * 2 * way.x() * scale / height, -0.5, 0.5));
      return;
    }
    const double moved = drag_.edge_side * (course ? way.x() : -way.y()) * scale;
    const Fabric& rest = session_.moment().relaxed->fabric;
    const double size = (course ? rest.width * repeats_[0] : rest.height * repeats_[1]);
    emit edge_pulled(drag_.edge, std::clamp(2 * moved / size, -0.3, 1.0));
    return;
  }
  if (drag_.pulls_yarn) {
    // as a spring in the hand: a diameter of way is a force of B/d^2
    const QPointF way = at - drag_.start;
    const double scale = camera_.height / height();
    session_.pull(camera_.right() * (way.x() * scale) - camera_.up * (way.y() * scale));
    return;
  }
  if (!motion_) return;
  // the point stays under the mouse, in the plane across the line of sight
  const Sight before = sight_at(drag_.last), now = sight_at(at);
  const auto in_plane = [&](const Sight& sight) {
    const double along =
        dot(drag_.held - sight.from, camera_.backward) / dot(sight.direction, camera_.backward);
    return sight.from + sight.direction * along;
  };
  const Vec3 by = in_plane(now) - in_plane(before);
  drag_.held += by;
  motion_->move_grabbed(by);
  if (playing_) frame_timer_.start();
  redraw();
}

void ClothView::end_pull() {
  if (drag_.pulls_yarn) session_.pull({});
  if (!drag_.pulls_edge && !drag_.pulls_yarn && motion_) {
    motion_->let_go();
    if (playing_) frame_timer_.start();
  }
  drag_.pulls = drag_.pulls_edge = drag_.pulls_yarn = false;
}

void ClothView::mousePressEvent(QMouseEvent* event) {
  drag_ = {};
  drag_.act = mouse_act(habit_, buttons_of(event));
  drag_.start = drag_.last = event->position();
  if (drag_.act == MouseAct::choose)
    begin_pull(event->position(), event->modifiers().testFlag(Qt::ControlModifier));
}

void ClothView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->position(), by = at - drag_.last;
  if (std::hypot(at.x() - drag_.start.x(), at.y() - drag_.start.y()) > 3) drag_.moved = true;
  if (!drag_.moved) return;
  switch (drag_.act) {
    case MouseAct::choose:
      if (drag_.pulls)
        pull(at);
      else
        camera_ = turned_by_mouse(camera_, by.x(), by.y());
      break;
    case MouseAct::turn:
      camera_ = turned_by_mouse(camera_, by.x(), by.y());
      break;
    case MouseAct::pan:
      camera_ = panned_by_mouse(camera_, by.x(), by.y(), height());
      break;
    case MouseAct::zoom:
      camera_ = zoomed_by_mouse(camera_, -by.y() / 20, aspect(), 0, 0);
      break;
    default:
      return;
  }
  drag_.last = at;
  if (!drag_.pulls) moved_by_hand();
}

void ClothView::mouseReleaseEvent(QMouseEvent* event) {
  if (drag_.act == MouseAct::choose && !drag_.moved) choose_at(event->position());
  if (drag_.pulls) end_pull();
  drag_.act = MouseAct::none;
}

void ClothView::mouseDoubleClickEvent(QMouseEvent*) { fit(); }

void ClothView::wheelEvent(QWheelEvent* event) {
  const QPointF at = event->position();
  camera_ = zoomed_by_mouse(camera_, event->angleDelta().y() / 120.0, aspect(), 2 * at.x() / width() - 1,
                            1 - 2 * at.y() / height());
  moved_by_hand();
}

void ClothView::keyPressEvent(QKeyEvent* event) {
  constexpr double turn = 25;  // pixels of the mouse
  const bool shift = event->modifiers().testFlag(Qt::ShiftModifier);
  const auto move = [&](double dx, double dy) {
    camera_ = shift ? panned_by_mouse(camera_, dx, dy, height()) : turned_by_mouse(camera_, dx, dy);
  };
  switch (event->key()) {
    case Qt::Key_Left:
      move(-turn, 0);
      break;
    case Qt::Key_Right:
      move(turn, 0);
      break;
    case Qt::Key_Up:
      move(0, -turn);
      break;
    case Qt::Key_Down:
      move(0, turn);
      break;
    case Qt::Key_Plus:
      camera_ = zoomed_by_mouse(camera_, 1, aspect(), 0, 0);
      break;
    case Qt::Key_Minus:
      camera_ = zoomed_by_mouse(camera_, -1, aspect(), 0, 0);
      break;
    default:
      QOpenGLWidget::keyPressEvent(event);
      return;
  }
  moved_by_hand();
}

}  // namespace loopwright
