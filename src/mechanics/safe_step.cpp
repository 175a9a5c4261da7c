#include "mechanics/safe_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/parallel.hpp"
#include "mechanics/common_motion.hpp"

namespace loopwright {
namespace {

// Two sticks of 0.18 d on yarn bent to a radius of 0.5 d stray by 2 x 0.18^2 / (8 x 0.5) d from it; sticks
// are 0.12 d long by default.
constexpr double bent_away = 0.016;
constexpr double smallest_ratio = 0.05;  // of motion to distance: less than this never cuts a step

// Yarn round a contact sample as a straight stick: its half, and how far that turns in the step.
struct Stick {
  Vec3 half, turn;
};

// The stick of sample k: to the middle between its neighbours in the segment, so that sticks tile the yarn as
// it lies, however stretched it is. n: samples per segment.
Stick stick_of(const SamplePlaces& from, const SamplePlaces& to, std::size_t k, std::size_t n) {
  const auto place = [](const SamplePlaces& p, std::size_t at) { return Vec3{p.x[at], p.y[at], p.z[at]}; };
  const std::size_t i = k % n, before = i > 0 ? k - 1 : k, after = i + 1 < n ? k + 1 : k;
  const double share = 0.5 / static_cast<double>(after - before);
  const Vec3 half = share * (place(from, after) - place(from, before));
  return {half, share * (place(to, after) - place(to, before)) - half};
}

// What bounds the motion of a segment's samples: all move by `mean` and at most `spread` more.
struct SegmentMotion {
  Vec3 mean;
  double spread = 0, half = 0, turn = 0;  // half, turn: the largest of its sticks
};

std::vector<SegmentMotion> segment_motions(const SamplePlaces& from, const SamplePlaces& to, int samples) {
  const auto n = static_cast<std::size_t>(samples);
  std::vector<SegmentMotion> all(from.boxes.size());
  for (std::size_t e = 0; e < all.size(); ++e) {
    SegmentMotion& m = all[e];
    const auto motion = [&](std::size_t k) {
      return Vec3{to.x[k] - from.x[k], to.y[k] - from.y[k], to.z[k] - from.z[k]};
    };
    for (std::size_t k = e * n; k < (e + 1) * n; ++k) {
      m.mean += motion(k) / static_cast<double>(n);
      const Stick stick = stick_of(from, to, k, n);
      m.half = std::max(m.half, squared_norm(stick.half));
      m.turn = std::max(m.turn, squared_norm(stick.turn));
    }
    m.half = std::sqrt(m.half);
    m.turn = std::sqrt(m.turn);
    for (std::size_t k = e * n; k < (e + 1) * n; ++k) m.spread = std::max(m.spread, norm(motion(k) - m.mean));
  }
  return all;
}

// So far apart, and moving so little against each other, that two sticks would not change the verdict: they
// are nearer than their centres by no more than both halves, and move no more than these and both turns.
// ratio: of motion to room, of the worst so far.
struct StickBound {
  double halves = 0, turns = 0, ratio = 0;

  bool harmless(double distance2, double motion2) const {
    return distance2 > 9 * halves * halves &&
           std::sqrt(motion2) + turns <= ratio * (std::sqrt(distance2) - halves - bent_away);
  }
};

// Those of another segment's samples that are not harmless to one at `place`, which goes to `moved`: their
// numbers go to `found` (room for four more than there are samples), how many is returned.
LOOPWRIGHT_WIDE std::size_t suspects(const StickBound& bound, const Vec3& place, const Vec3& moved,
                                     const SampleView& from, const SampleView& to, std::size_t count,
                                     std::uint8_t* found) {
  const double least2 = 9 * bound.halves * bound.halves, nearer = bound.halves + bent_away;
  std::size_t n = 0, j = 0;
  for (; j + lanes <= count; j += lanes) {
    Lanes x, y, z, tx, ty, tz;
    load(from.x + j, x);
    load(from.y + j, y);
    load(from.z + j, z);
    load(to.x + j, tx);
    load(to.y + j, ty);
    load(to.z + j, tz);
    const Lanes dx = place.x - x, dy = place.y - y, dz = place.z - z;
    const Lanes rx = (moved.x - tx) - dx, ry = (moved.y - ty) - dy, rz = (moved.z - tz) - dz;
    const Lanes distance2 = dx * dx + dy * dy + dz * dz, motion2 = rx * rx + ry * ry + rz * rz;
    Lanes distance, motion;
    square_root(distance2, distance);
    square_root(motion2, motion);
    const Lanes left = bound.ratio * (distance - nearer) - (motion + bound.turns);
    const auto safe = (distance2 > least2) & (left >= 0.0);
    for (std::size_t l = 0; l < lanes; ++l) {
      found[n] = static_cast<std::uint8_t>(j + l);
      n += safe[l] == 0 ? 1 : 0;
    }
  }
  for (; j < count; ++j) {
    const Vec3 d = place - Vec3{from.x[j], from.y[j], from.z[j]};
    found[n] = static_cast<std::uint8_t>(j);
    if (!bound.harmless(squared_norm(d), squared_norm(moved - Vec3{to.x[j], to.y[j], to.z[j]} - d))) ++n;
  }
  return n;
}

// Distance of two sticks with centres apart by d: points d + s a - t b, s and t in [-1, 1]. Alternating
// closest points find the minimum of this convex function; a few rounds give it well within a hundredth.
double stick_distance2(const Vec3& d, const Vec3& a, const Vec3& b) {
  const double aa = squared_norm(a), bb = squared_norm(b), ab = dot(a, b), da = dot(d, a), db = dot(d, b);
  const double det = aa * bb - ab * ab;
  double s = det > 1e-9 * aa * bb ? std::clamp((ab * db - bb * da) / det, -1.0, 1.0) : 0, t = 0;
  for (int round = 0; round < 3; ++round) {
    t = bb > 0 ? std::clamp((db + s * ab) / bb, -1.0, 1.0) : 0;
    s = aa > 0 ? std::clamp((t * ab - da) / aa, -1.0, 1.0) : 0;
  }
  return squared_norm(d + s * a - t * b);
}

// Control points that move beyond the common motion by more than `limit`.
std::vector<FarNode> far_nodes(const CommonMotion& common, double limit) {
  const double most = *std::max_element(common.left.begin(), common.left.end()),
               beside = std::max(0.0, common.loose - most);  // what the common motion itself is unsure of
  std::vector<FarNode> far;
  for (std::size_t i = 0; i < common.left.size(); ++i)
    if (common.left[i] + beside > limit)
      far.push_back({static_cast<std::int32_t>(i), (common.left[i] + beside) / limit});
  return far;
}

}  // namespace

SafeStep safe_step(const YarnModel& model, const Assembly& assembly, const YarnState& state,
                   const YarnState& target, double range, double outer_diameter, double share,
                   bool list_causes) {
  std::vector<Vec3> extended;
  SamplePlaces from, to;
  expand(model, state, extended);
  place_samples(model, extended, from);
  expand(model, target, extended);
  place_samples(model, extended, to);

  const std::vector<SegmentMotion> motions = segment_motions(from, to, model.samples);

  const auto& pairs = assembly.pairs();
  constexpr int pairs_per_chunk = 4096;
  const int chunks = static_cast<int>((pairs.size() + pairs_per_chunk - 1) / pairs_per_chunk);
  struct Worst {
    double ratio2 = smallest_ratio * smallest_ratio, gap2 = std::numeric_limits<double>::infinity();
    int a = -1, b = -1;
    std::vector<NearPair> near;
  };
  std::vector<Worst> worst(static_cast<std::size_t>(chunks));
  parallel_chunks(chunks, [&](int c) {
    const std::size_t begin = static_cast<std::size_t>(c) * pairs_per_chunk,
                      end = std::min(pairs.size(), begin + pairs_per_chunk);
    Worst& w = worst[static_cast<std::size_t>(c)];
    std::array<Stick, most_contact_samples> other_sticks;
    const auto examine = [&](std::size_t k, double most_motion2) {
      const SegmentPair& pair = pairs[k];
      const Vec3 image = state.lattice(pair.m, pair.n), moved_image = target.lattice(pair.m, pair.n) - image;
      const YarnModel::Yarn& yarn = model.yarn_of(pair.a);
      const double spacing = yarn.rest_length / model.samples;
      const auto i0 = static_cast<std::size_t>(pair.a * model.samples),
                 j0 = static_cast<std::size_t>(pair.b * model.samples);
      const auto count = static_cast<std::size_t>(model.samples);
      const SegmentMotion &one_motion = motions[static_cast<std::size_t>(pair.a)],
                          &other_motion = motions[static_cast<std::size_t>(pair.b)];
      const SampleBox& other_box = from.boxes[static_cast<std::size_t>(pair.b)];
      const double halves = one_motion.half + other_motion.half, turns = one_motion.turn + other_motion.turn;
      // Where all near pairs are wanted, none of them may hide behind a worse one.
      const double most_known2 = list_causes ? share * share : std::numeric_limits<double>::infinity();
      const auto bound = [&] {
        return StickBound{halves, turns, std::sqrt(std::min(w.ratio2, most_known2))};
      };
      double ratio2 = 0;  // of this pair
      StickBound known = bound();
      if (known.harmless(pair.distance2, most_motion2)) return;
      const SampleView others{&from.x[j0], &from.y[j0], &from.z[j0]},
          moved_others{&to.x[j0], &to.y[j0], &to.z[j0]};
      std::array<std::uint8_t, most_contact_samples + lanes> suspect;
      bool has_other_sticks = false;
      for (std::size_t i = 0; i < count; ++i) {
        const Vec3 place = Vec3{from.x[i0 + i], from.y[i0 + i], from.z[i0 + i]} - image,
                   moved = Vec3{to.x[i0 + i], to.y[i0 + i], to.z[i0 + i]} - image - moved_image;
        const double sample_motion = norm(moved - place - other_motion.mean) + other_motion.spread;
        if (known.harmless(squared_distance(place.x, place.y, place.z, other_box),
                           sample_motion * sample_motion))
          continue;
        const std::size_t found = suspects(known, place, moved, others, moved_others, count, suspect.data());
        if (found == 0) continue;
        const Stick one = stick_of(from, to, i0 + i, count);
        for (std::size_t f = 0; f < found; ++f) {
          const std::size_t j = suspect[f];
          if (pair.same_yarn && std::abs(pair.arc_offset + (static_cast<double>(j) - static_cast<double>(i)) *
                                                               spacing) < model.excluded * yarn.diameter)
            continue;
          if (!has_other_sticks)
            for (std::size_t l = 0; l < count; ++l) other_sticks[l] = stick_of(from, to, j0 + l, count);
          has_other_sticks = true;
          const Stick& other = other_sticks[j];
          const Vec3 apart = place - Vec3{others.x[j], others.y[j], others.z[j]},
                     apart_then = moved - Vec3{moved_others.x[j], moved_others.y[j], moved_others.z[j]};
          const double motion = norm(apart_then - apart) + norm(one.turn) + norm(other.turn);
          const double gap2 = stick_distance2(apart, one.half, other.half);
          w.gap2 = std::min(w.gap2, gap2);
          // Yarn bends away from its sticks: see `bent_away`. Below twice that half the gap is left for it.
          const double gap = std::sqrt(gap2), room = std::max(std::max(gap - bent_away, 0.5 * gap), 1e-9);
          const double room2 = room * room;
          ratio2 = std::max(ratio2, motion * motion / room2);
          if (motion * motion > w.ratio2 * room2) {
            w.ratio2 = motion * motion / room2;
            w.a = pair.a;
            w.b = pair.b;
            known = bound();
          }
        }
      }
      if (list_causes && ratio2 > share * share) w.near.push_back({pair.a, pair.b, std::sqrt(ratio2)});
    };
    // The pair with the most motion for its distance goes first. It is nearly always the worst, and most
    // others are then seen to be harmless at once.
    std::vector<double> most_motion2(end - begin);
    std::size_t first = begin;
    double first_share = -1;
    for (std::size_t k = begin; k < end; ++k) {
      const SegmentPair& pair = pairs[k];
      const SegmentMotion &one = motions[static_cast<std::size_t>(pair.a)],
                          &other = motions[static_cast<std::size_t>(pair.b)];
      const Vec3 moved_image = target.lattice(pair.m, pair.n) - state.lattice(pair.m, pair.n);
      const double motion = norm(one.mean - moved_image - other.mean) + one.spread + other.spread;
      most_motion2[k - begin] = motion * motion;
      if (pair.same_yarn || !(motion * motion > first_share * pair.distance2)) continue;
      first = k;
      first_share = motion * motion / pair.distance2;
    }
    if (begin < end) examine(first, most_motion2[first - begin]);
    for (std::size_t k = begin; k < end; ++k)
      if (k != first) examine(k, most_motion2[k - begin]);
  });

  SafeStep result;
  double ratio2 = smallest_ratio * smallest_ratio;
  for (const Worst& w : worst) result.surely_apart = result.surely_apart && w.gap2 > bent_away * bent_away;
  for (Worst& w : worst) {
    result.near.insert(result.near.end(), w.near.begin(), w.near.end());
    if (w.ratio2 > ratio2) {
      ratio2 = w.ratio2;
      result.worst_a = w.a;
      result.worst_b = w.b;
    }
  }
  result.pair_ratio = std::sqrt(ratio2);
  // Pairs outside the list stay outside contact: each of the two may move by less than half of what parts
  // them from it.
  const double loose_limit = 0.45 * (range - outer_diameter);
  if (result.pair_ratio > share) result.scale = share / result.pair_ratio;
  const CommonMotion common = common_motion(model, state, target, range, loose_limit / result.scale);
  result.loose_motion = common.loose;
  if (list_causes) result.far = far_nodes(common, loose_limit);
  if (result.loose_motion * result.scale > loose_limit) result.scale = loose_limit / result.loose_motion;
  const double far_ratio = common.far_ratio(range);
  if (far_ratio * result.scale > 0.9) result.scale = 0.9 / far_ratio;
  return result;
}

}  // namespace loopwright
