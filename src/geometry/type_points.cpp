#include "geometry/type_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stop.hpp"
#include "geometry/assemble.hpp"
#include "geometry/loop_signs.hpp"
#include "geometry/sinkers.hpp"

namespace loopwright {
namespace {

class LoopPlacer {
 public:
  LoopPlacer(const YarnGraph& graph, const GeometryOptions& options, const Layout& layout,
             const std::vector<LoopSigns>& signs)
      : graph_(graph),
        layout_(layout),
        signs_(signs),
        r_(options.shape_radius()),
        sx_(options.wale_pitch / 8),
        sy_(options.course_pitch / 7) {}

  PlacedLoop place(LoopId id) const {
    const Loop& loop = graph_.loop(id);
    const double first_side = loop.direction == Direction::left ? 1 : -1;
    PlacedLoop placed;
    std::vector<TypePoint>& points = placed.points;
    half(id, first_side, points);
    placed.apex = points.size();
    points.push_back(apex(id));
    std::vector<TypePoint> second;
    half(id, -first_side, second);
    points.insert(points.end(), second.rbegin(), second.rend());
    return placed;
  }

 private:
  TypePoint point(LoopId id, LoopPart part, Vec3 position) const {
    TypePoint p;
    p.position = position;
    p.loop = id;
    p.part = part;
    p.at = graph_.loop(id).at;
    return p;
  }
  // O or P plus an offset in r.
  Vec3 at_lower(LoopId id, double x, double y, double z) const {
    const std::size_t i = id.position();
    const double high = sy_ * layout_.y_scale_lower[i];
    return layout_.from_lower(id, {x * sx_ * layout_.x_scale_lower[i], y * high, z * r_}, 1.5 * high);
  }
  Vec3 at_upper(LoopId id, double x, double y, double z) const {
    const std::size_t i = id.position();
    const double high = sy_ * layout_.y_scale_upper[i];
    return layout_.from_upper(id, {x * sx_ * layout_.x_scale_upper[i], y * high, z * r_}, 1.5 * high);
  }
  // O and P as the loop itself sees them.
  struct Ends {
    Rotation turn;
    Vec3 low, high;
    Vec3 step() const { return high - low; }
    Vec3 in_space(const Vec3& own) const { return turn * own; }
  };
  Ends ends(LoopId id) const {
    const Rotation turn = layout_.turn(id);
    return {turn, turn.transposed(layout_.lower[id.position()]),
            turn.transposed(layout_.upper[id.position()])};
  }
  // A place on a leg between O and P: `across` from their line, at right angles to it, so that leaning loops
  // keep their legs apart.
  Vec3 on_leg(const Ends& loop, double share, double across) const {
    Vec3 along{loop.step().x, loop.step().y, 0};
    along = norm(along) > 1e-9 ? normalized(along) : Vec3{0, 1, 0};
    const Vec3 outward{along.y, -along.x, 0};
    return loop.low + loop.step() * share + outward * (across * sx_);
  }
  // At right angles to the way from O to P, to the front.
  static Vec3 normal(const Ends& loop) {
    const Vec3 step = loop.step();
    const double along = std::hypot(step.x, step.y), length = norm(step);
    if (!(along > 1e-9 * length)) return {0, 0, 1};
    return Vec3{-step.x / along * step.z, -step.y / along * step.z, along} / length;
  }
  double leaning(const Ends& loop) const { return loop.step().x / (8 * sx_); }  // in wales, to the right
  static double steepness(const Ends& loop) {                                   // 1 upright, 0 on its side
    const Vec3 step = loop.step();
    return std::max(step.y, 0.0) / std::max(std::hypot(step.x, step.y), 1e-9);
  }

  void half(LoopId id, double side, std::vector<TypePoint>& points) const {
    if (graph_.loop(id).kind == LoopKind::tuck) {
      tuck_half(id, side, points);
      return;
    }
    const LoopSigns& sign = signs_[id.position()];
    const Ends own = ends(id);
    const double s = sign.s, c = sign.c, spread = sign.foot_spread;
    const double foot = sign.foot_layer, head = sign.head_layer;
    // Legs that cross others keep clear of them over most of their length; near the binding points only in
    // the direction in which the stitch goes anyway.
    const double low_share = sign.leg_offset * s > 0 ? 0.5 : 0,
                 high_share = sign.leg_offset * c > 0 ? 0.5 : 0;
    points.push_back(point(id, LoopPart::foot, at_lower(id, side * (2.556 + spread), -1.556, sign.foot)));
    points.push_back(point(id, LoopPart::foot, at_lower(id, side * (1 + spread), 0, foot)));
    points.push_back(
        point(id, LoopPart::leg,
              at_lower(id, side * (1.444 + spread), 1.556, sign.lower_leg + low_share * sign.leg_offset)));
    if (std::abs(leaning(own)) > 0.4 && is_flat_lying(own)) {
      flat_legs(id, side, points);
      return;
    }
    // `rise`: how far the leg has come from the side where its feet come out (s, at O) to that where its
    // children find it (c, at P).
    const auto leg = [&](double share, double across, double rise, double more) {
      const double layer = std::abs(foot) > 0 ? foot + (head - foot) * rise : head;
      // in cloth that was moved leaning legs keep farther from what crosses them
      const double bow = !layout_.is_flat() && std::abs(leaning(own)) > 0.4 ? 2.5 : 1.5;
      const double out = (bow * (s * (1 - rise) + c * rise) + layer + sign.leg_offset + more) * r_;
      Vec3 place = on_leg(own, share, side * across);
      if (layout_.is_flat())
        place.z = own.low.z * (1 - rise) + own.high.z * rise + out;
      else
        place += normal(own) * out;
      points.push_back(point(id, LoopPart::leg, own.in_space(place)));
    };
    // A head that was moved or that lies in a stack meets its children's sinkers and the other legs of the
    // stack from the middle of the leg on; there it must be on its children's side already.
    const double lean = leaning(own);
    if (std::abs(lean) > 0.4) {
      const bool lower = side * lean > 0;
      const double steep = steepness(own);
      // Loops that lean side by side are the nearer to each other the more they lean, and so are their legs;
      // the one above lies over the one below near its feet and under it near its head.
      const double width = std::max(steep, 1 - 2 * steep);
      const double aslant = std::clamp(3.6 * (1 - 2 * steep), 0.0, 1.0);
      const double shingle = (lower ? 0.6 : -0.6) * aslant;
      const double near_end = 2 - 1.35 * aslant, far_end = 2 - 1.15 * aslant;
      const double ahead = lean > 0 ? 1 : -1;
      const bool over_head = !lower && sign.early_rise > 0.5 && std::abs(lean) > 1.5;
      if (std::abs(lean) > 1.5 && std::abs(lean) < 2.5 && s * c > 0 && layout_.is_flat()) {
        // Two wales away, on one side: both legs pass those of a loop beside it that goes the same
        // way, and the heads that both were drawn through. The lower one leaves above the middle line, so
        // that it clears those heads, and runs below it toward its own head, under the loop beside; the upper
        // one leaves over its parents' heads and lies over the other where they come to their head.
        if (lower) {
          leg(0.3, -0.6 * width, sign.early_rise, 0.5 * s);
          leg(0.5, 1.2 * width, 1, -0.2 * s);
          leg(0.7, 1.8 * width, 1, -0.8 * s);
        } else {
          points.push_back(point(id, LoopPart::leg,
                                 at_lower(id, ahead, 2.4, sign.lower_leg + low_share * sign.leg_offset)));
          leg(0.42, 1.1 * width, 1, -0.2 * s);
          leg(0.7, 0.8 * width, 1, 1.4 * s);
        }
      } else if (over_head) {
        // The upper leg leaves over its parents' heads before it changes the side.
        points.push_back(point(id, LoopPart::leg, at_lower(id, ahead * 1.3, 3.1, sign.lower_leg + 0.6 * s)));
        leg(0.42, near_end * width, 1, shingle);
        leg(0.7, far_end * width, 1, -shingle);
      } else {
        // A leg that comes out on one side and is wanted on the other changes it before it passes a head
        // beside its parent's, not below that head.
        if (lower && s * c < 0 && has_head_below(id, lean))
          leg(0.3, -0.8 * width, 1, 0);
        else
          leg(0.3, (lower ? far_end : near_end) * width, sign.early_rise, shingle);
        leg(0.5, (layout_.is_flat() ? 2 : 1) * width, 1, 0);
        leg(0.7, (lower ? near_end : far_end) * width, 1, -shingle);
      }
    } else if (graph_.loop(id).head_count > 1) {
      const bool room = own.high.y - own.low.y > 5.5 * sy_;
      if (room) leg(0.35, 1.8, 0.2, 0);
      leg(0.55, 2.1, room ? 1 : 0.7, 0);
    } else {
      leg(0.5, 2, 0.5, 0);
    }
    head_half(id, side, head + high_share * sign.leg_offset, points);
  }

  // Whether a loop that leans passes over the head through which its neighbour in the yarn is drawn.
  bool has_head_below(LoopId id, double lean) const {
    const Loop& loop = graph_.loop(id);
    const std::vector<LoopId>& yarn = graph_.yarns[loop.yarn.position()].loops;
    const int beside = loop.order + ((lean > 0) == (loop.direction == Direction::right) ? 1 : -1);
    if (beside < 0 || beside >= static_cast<int>(yarn.size())) return false;
    const Vec3 to =
        layout_.lower[yarn[static_cast<std::size_t>(beside)].position()] - layout_.lower[id.position()];
    const double wales = (lean > 0 ? to.x : -to.x) / (8 * sx_);
    return wales > 0.5 && wales < std::abs(lean) - 0.5 && std::abs(to.y) < 3.5 * sy_;
  }

  // Whether a loop that leans lies flat, as in the chain of a bind-off.
  static bool is_flat_lying(const Ends& own) { return steepness(own) < 0.3; }

  // Whether a loop is drawn through one that stands upright and leans away from where `ahead` points.
  bool meets_parent(LoopId id, double ahead) const {
    const std::vector<LoopId>& parents = graph_.loop(id).parents;
    return std::any_of(parents.begin(), parents.end(), [&](LoopId parent) {
      const Ends of = ends(parent);
      return ahead * leaning(of) < -0.4 && !is_flat_lying(of);
    });
  }

  // A loop that lies flat, as in the chain of a bind-off: head and feet are at one level, and both stand
  // upright on their needles. Its lower leg swings out below the head, its upper leg above the feet; both
  // stay clear of the heads that it was drawn through until they are past them, then they take the layer of
  // its own head.
  void flat_legs(LoopId id, double side, std::vector<TypePoint>& points) const {
    const LoopSigns& sign = signs_[id.position()];
    const std::size_t i = id.position();
    const Ends own = ends(id);
    const double lean = leaning(own), ahead = lean > 0 ? 1 : -1, length = 8 * std::abs(lean);
    const double in = sign.head_layer + sign.c;
    double out = sign.lower_leg + 1.3 * sign.s;
    // a parent whose legs come from where the loop goes: the lower leg passes before them
    if (side * lean > 0 && meets_parent(id, ahead)) out += 1.5 * sign.s;
    const auto leg = [&](double along, double y, double z) {
      const double share = along / length;
      const Vec3 base = own.low + own.step() * share;
      points.push_back(point(id, LoopPart::leg, own.in_space(base + Vec3{0, y * sy_, z * r_})));
    };
    const double wide = sign.head_spread, low = layout_.x_scale_lower[i], high = layout_.x_scale_upper[i];
    if (side * lean > 0) {
      leg((2 + sign.foot_spread) * low, -0.4, out);
      leg((3.4 + sign.foot_spread) * low, -1.7, out);
      leg(length - (3.4 + wide) * high, -1.8, in);
      leg(length, -1.8, in);
      head_half(id, side, sign.head_layer, points);
    } else {
      leg(low, 4.6, out);
      leg((3.4 + sign.foot_spread) * low, 3.8, out);
      leg(length - (3.4 + wide) * high, 2.2, in);
      points.push_back(point(id, LoopPart::leg, at_upper(id, -ahead * (2.8 + wide), 0.4, sign.head_layer)));
      points.push_back(point(id, LoopPart::head,
                             at_upper(id, -ahead * (1.444 + wide), 1.556 + 0.4 * wide,
                                      sign.head_layer - crossing_reach * sign.c)));
    }
  }

  // From the crossing of the upper leg with the child's foot to the crossing of the head with the child's
  // leg.
  void head_half(LoopId id, double side, double upper_leg_layer, std::vector<TypePoint>& points) const {
    const LoopSigns& sign = signs_[id.position()];
    const double c = sign.c, wide = sign.head_spread, head = sign.head_layer;
    points.push_back(
        point(id, LoopPart::leg,
              at_upper(id, side * (2.556 + wide), -1.556, upper_leg_layer + crossing_reach * c)));
    points.push_back(point(id, LoopPart::leg, at_upper(id, side * (3 + wide), 0, head)));
    points.push_back(
        point(id, LoopPart::head,
              at_upper(id, side * (1.444 + wide), 1.556 + 0.4 * wide, head - crossing_reach * c)));
  }
  TypePoint apex(LoopId id) const {
    const LoopSigns& sign = signs_[id.position()];
    return point(id, LoopPart::head,
                 at_upper(id, 0, 3 + 0.4 * sign.head_spread, sign.head_layer - 1.5 * sign.c));
  }

  // Whether a tuck lies on the legs of a loop that was drawn through others: not in a cast-on.
  bool lies_on_stitch(LoopId tuck) const {
    const Loop& loop = graph_.loop(tuck);
    if (loop.children.empty()) return true;
    const std::vector<LoopId>& stack = graph_.loop(loop.children.front()).parents;
    return std::any_of(stack.begin(), stack.end(),
                       [&](LoopId id) { return graph_.loop(id).kind != LoopKind::tuck; });
  }

  // A tuck's feet pass through nothing: they stand wide, outside the legs of the loop that the tuck lies on,
  // if any, and always below its head, however much the loops round it were pulled up.
  void tuck_half(LoopId id, double side, std::vector<TypePoint>& points) const {
    const double wide = lies_on_stitch(id) ? 3.3 : 2.6;
    const LoopSigns& sign = signs_[id.position()];
    const double c = sign.c, s = sign.s, head = sign.head_layer;
    const Rotation turn = layout_.turn(id);
    Vec3 foot = turn.transposed(at_lower(id, side * (wide + 0.1), -1.5, -1.2 * s));
    const Vec3 upper_leg = turn.transposed(at_upper(id, side * wide, -1.556, head + 0.7 * c));
    foot.y = std::min(foot.y, upper_leg.y - 2 * sy_);
    Vec3 leg = foot + (upper_leg - foot) * 0.45;
    leg.z = (foot.z + upper_leg.z) / 2 - 0.3 * s * r_;
    points.push_back(point(id, LoopPart::foot, turn * foot));
    points.push_back(point(id, LoopPart::leg, turn * leg));
    points.push_back(point(id, LoopPart::leg, turn * upper_leg));
    points.push_back(point(id, LoopPart::leg, at_upper(id, side * wide, 0, head)));
    points.push_back(
        point(id, LoopPart::head, at_upper(id, side * (wide - 1.7), 1.7, head - crossing_reach * c)));
  }

  const YarnGraph& graph_;
  const Layout& layout_;
  const std::vector<LoopSigns>& signs_;
  double r_, sx_, sy_;
};

}  // namespace

PlacedPiece place_type_points(const YarnGraph& graph, const GeometryOptions& options) {
  const Layout flat = lay_out(graph, options);
  return place_type_points(graph, options, flat, flat);
}

PlacedPiece place_type_points(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                              Layout moved) {
  PlacedPiece piece;
  piece.layout = std::move(moved);
  const std::vector<LoopSigns> signs = loop_signs(graph, flat, options.shape_radius());
  const LoopPlacer placer(graph, options, piece.layout, signs);
  piece.loops.reserve(graph.loops.size());
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    stop_if_told();
    piece.loops.push_back(placer.place(LoopId(i)));
  }
  place_sinkers(graph, options, signs, flat, piece);
  return piece;
}

double rest_length_of(const Loop& loop, const PlacedSinker& before, const PlacedSinker& after,
                      const GeometryOptions& options) {
  const double own = loop.kind == LoopKind::tuck ? options.tuck_length : options.loop_length;
  return own + (before.extra_length + after.extra_length) / 2;
}

YarnCurves build_yarn_curves(const YarnGraph& graph, const GeometryOptions& options) {
  const PlacedPiece piece = place_type_points(graph, options);
  return assemble_runs(graph, options, piece, whole_yarns(graph));
}

YarnCurves build_yarn_curves(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                             Layout moved) {
  const PlacedPiece piece = place_type_points(graph, options, flat, std::move(moved));
  return assemble_runs(graph, options, piece, whole_yarns(graph));
}

}  // namespace loopwright
