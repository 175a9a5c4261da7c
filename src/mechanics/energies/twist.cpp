#include "mechanics/energies/twist.hpp"

#include <cmath>

namespace loopwright {
namespace {

constexpr std::array<SplineWeights, twist_arcs + 1> make_weights() {
  std::array<SplineWeights, twist_arcs + 1> weights{};
  for (std::size_t k = 0; k <= twist_arcs; ++k)
    weights[k] = spline_weights(static_cast<double>(k) / twist_arcs);
  return weights;
}
constexpr std::array<SplineWeights, twist_arcs + 1> end_weights = make_weights();

using Block3 = std::array<double, 9>;

// to += s a b'
void add_dyad(Block3& to, double s, const Vec3& a, const Vec3& b) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) to[static_cast<std::size_t>(3 * r + c)] += s * a[r] * b[c];
}
// to += s [a]x, which takes v to a x v
void add_cross(Block3& to, double s, const Vec3& a) {
  to[1] -= s * a.z, to[2] += s * a.y;
  to[3] += s * a.z, to[5] -= s * a.x;
  to[6] -= s * a.y, to[7] += s * a.x;
}

// An arc from a to b (not of unit length). An end that moves by v sweeps n.v / |end|, n = a x b / s, s =
// |a||b| + a.b: tan(angle / 2) times the way across the arc.
struct Arc {
  Vec3 a, b, n;
  double length_a, length_b, s;
  Arc(const Vec3& from, const Vec3& to)
      : a(from), b(to), length_a(norm(from)), length_b(norm(to)), s(length_a * length_b + dot(from, to)) {
    n = cross(a, b) / s;
  }
};

}  // namespace

ArcEnds arc_ends(const Vec3* points) {
  ArcEnds ends;
  for (std::size_t k = 0; k < ends.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i) ends[k] += end_weights[k].slope[i] * points[i];
  return ends;
}

ArcEnds arc_tangents(const Vec3* points) {
  ArcEnds ends = arc_ends(points);
  for (Vec3& t : ends) t = normalized(t);
  return ends;
}

// tan(area / 2) of a triangle is a.(b x c) / (1 + a.b + b.c + c.a); of two at once, the angles add.
double spherical_area(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double ac = dot(a, c);
  const double over_b = dot(a, cross(b, c)), under_b = 1 + dot(a, b) + dot(b, c) + ac;
  const double over_d = dot(a, cross(c, d)), under_d = 1 + ac + dot(c, d) + dot(d, a);
  return 2 * std::atan2(over_b * under_d + over_d * under_b, under_b * under_d - over_b * over_d);
}

std::array<Vec3, 4> turn_gradient(const ArcEnds& ends) {
  ArcEnds by_end;
  for (std::size_t k = 0; k < twist_arcs; ++k) {
    const Arc arc(ends[k], ends[k + 1]);
    by_end[k] += arc.n / arc.length_a;
    by_end[k + 1] += arc.n / arc.length_b;
  }
  std::array<Vec3, 4> gradient;
  for (std::size_t k = 0; k < ends.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i) gradient[i] += end_weights[k].slope[i] * by_end[k];
  return gradient;
}

std::array<std::array<double, 9>, 10> turn_hessian(const ArcEnds& ends) {
  // Of the forms' own derivatives the symmetric part: the rest cancels where arcs meet.
  std::array<Block3, twist_arcs + 1> on_end{};  // twice the symmetric part
  std::array<Block3, twist_arcs> to_next{};     // the same, by end k and end k + 1
  for (std::size_t k = 0; k < twist_arcs; ++k) {
    const Arc arc(ends[k], ends[k + 1]);
    const double la = arc.length_a, lb = arc.length_b;
    const Vec3 s_a = (lb / la) * arc.a + arc.b, s_b = (la / lb) * arc.b + arc.a;  // ds
    const auto add_own = [&](Block3& to, const Vec3& end, double length, const Vec3& ds) {
      const Vec3 with = ds / (-arc.s * length) - end / (length * length * length);
      add_dyad(to, 1, arc.n, with);
      add_dyad(to, 1, with, arc.n);
    };
    add_own(on_end[k], arc.a, la, s_a);
    add_own(on_end[k + 1], arc.b, lb, s_b);
    add_cross(to_next[k], 1 / (arc.s * la), arc.a);
    add_cross(to_next[k], 1 / (arc.s * lb), arc.b);
    add_dyad(to_next[k], -1 / (arc.s * la), arc.n, s_b);
    add_dyad(to_next[k], -1 / (arc.s * lb), s_a, arc.n);
  }
  std::array<std::array<double, 9>, 10> hessian{};
  for (std::size_t i = 0, at = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j, ++at) {
      Block3& to = hessian[at];
      for (std::size_t k = 0; k < ends.size(); ++k) {
        const double w = 0.5 * end_weights[k].slope[i] * end_weights[k].slope[j];
        for (std::size_t c = 0; c < 9; ++c) to[c] += w * on_end[k][c];
        if (k == twist_arcs) break;
        const double forth = 0.5 * end_weights[k].slope[i] * end_weights[k + 1].slope[j],
                     back = 0.5 * end_weights[k + 1].slope[i] * end_weights[k].slope[j];
        for (std::size_t c = 0; c < 9; ++c)
          to[c] += forth * to_next[k][c] + back * to_next[k][3 * (c % 3) + c / 3];
      }
    }
  return hessian;
}

}  // namespace loopwright
