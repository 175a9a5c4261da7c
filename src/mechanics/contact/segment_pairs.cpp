#include "mechanics/contact/segment_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <tuple>

#include "base/parallel.hpp"
#include "mechanics/contact/pair_input.hpp"

namespace loopwright {
namespace {

constexpr int segments_per_chunk = 4096;

struct ImagedSegment {
  std::int32_t segment;
  std::int8_t m, n;
  SampleBox box;
};

// Samples of one segment with control points q, and the box round them. by_point: weights of all samples, by
// control point.
LOOPWRIGHT_WIDE void place_segment(const Vec3* q,
                                   const std::array<std::array<double, most_contact_samples>, 4>& by_point,
                                   std::size_t count, double* x, double* y, double* z, SampleBox& box) {
  const std::array<double*, 3> places{x, y, z};
  for (std::size_t c = 0; c < 3; ++c) {
    const int d = static_cast<int>(c);
    const std::array<double, 4> at{q[0][d], q[1][d], q[2][d], q[3][d]};
    double* const to = places[c];
    double low = 1e300, high = -1e300;
    std::size_t k = 0;
    if (count >= lanes) {
      Lanes least = Lanes{} + low, most = Lanes{} + high;
      for (; k + lanes <= count; k += lanes) {
        Lanes w0, w1, w2, w3;
        load(&by_point[0][k], w0);
        load(&by_point[1][k], w1);
        load(&by_point[2][k], w2);
        load(&by_point[3][k], w3);
        const Lanes v = w0 * at[0] + w1 * at[1] + w2 * at[2] + w3 * at[3];
        std::memcpy(to + k, &v, sizeof v);
        least = v < least ? v : least;
        most = v > most ? v : most;
      }
      low = std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
      high = std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
    }
    for (; k < count; ++k) {
      to[k] =
          by_point[0][k] * at[0] + by_point[1][k] * at[1] + by_point[2][k] * at[2] + by_point[3][k] * at[3];
      low = std::min(low, to[k]);
      high = std::max(high, to[k]);
    }
    box.low[c] = low;
    box.high[c] = high;
  }
}

bool apart(const SampleBox& a, const SampleBox& b, double range) {
  return squared_distance(a, {0, 0, 0}, b) >= range * range;
}

// Samples of one yarn that are excluded are passed over.
template <bool with_excluded>
LOOPWRIGHT_INLINE double least_squared_distance(const ContactPairInput& p, double beyond2) {
  const double far = beyond2;
  const auto count = static_cast<std::size_t>(p.count);
  Lanes least = Lanes{} + beyond2;
  std::size_t j = 0;
  for (; j + lanes <= count; j += lanes) {
    Lanes x, y, z;
    load(p.b.x + j, x);
    load(p.b.y + j, y);
    load(p.b.z + j, z);
    x += p.image[0];
    y += p.image[1];
    z += p.image[2];
    const Lanes at = Lanes{0, 1, 2, 3} + static_cast<double>(j);
    for (std::size_t i = 0; i < count; ++i) {
      const Lanes dx = p.a.x[i] - x, dy = p.a.y[i] - y, dz = p.a.z[i] - z;
      Lanes d2 = dx * dx + dy * dy + dz * dz;
      if constexpr (with_excluded) {
        const Lanes along = p.arc_offset + (at - static_cast<double>(i)) * p.spacing;
        d2 = (along < 0.0 ? -along : along) < p.excluded ? Lanes{} + far : d2;
      }
      least = d2 < least ? d2 : least;
    }
  }
  double nearest = std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
  for (; j < count; ++j)
    for (std::size_t i = 0; i < count; ++i) {
      const double dx = p.a.x[i] - (p.b.x[j] + p.image[0]), dy = p.a.y[i] - (p.b.y[j] + p.image[1]),
                   dz = p.a.z[i] - (p.b.z[j] + p.image[2]);
      const double along = p.arc_offset + (static_cast<double>(j) - static_cast<double>(i)) * p.spacing;
      if (!with_excluded || std::abs(along) >= p.excluded)
        nearest = std::min(nearest, dx * dx + dy * dy + dz * dz);
    }
  return nearest;
}

// `beyond2` where no distance is less.
LOOPWRIGHT_WIDE double smallest_distance2(const ContactPairInput& p, double beyond2) {
  return p.excluded > 0 ? least_squared_distance<true>(p, beyond2)
                        : least_squared_distance<false>(p, beyond2);
}

// Boxes by coordinate, in the order of the grid's cells.
struct SortedBoxes {
  std::array<std::vector<double>, 3> low, high;
  void resize(std::size_t count) {  // four at a time are read: the last ones lie beyond all range
    for (std::size_t c = 0; c < 3; ++c) {
      low[c].assign(count + lanes, 1e100);
      high[c].assign(count + lanes, 1e100);
    }
  }
  void set(std::size_t k, const SampleBox& box) {
    for (std::size_t c = 0; c < 3; ++c) {
      low[c][k] = box.low[c];
      high[c][k] = box.high[c];
    }
  }
};

// Which of the boxes [begin, end) are nearer to `box` than the root of range2: their numbers go to `found`
// (room for end - begin + 3), how many is returned.
LOOPWRIGHT_WIDE std::size_t near_boxes(const SampleBox& box, const SortedBoxes& boxes, std::size_t begin,
                                       std::size_t end, double range2, std::int32_t* found) {
  std::size_t count = 0;
  for (std::size_t k = begin; k < end; k += lanes) {
    Lanes d2{};
    for (std::size_t c = 0; c < 3; ++c) {
      Lanes low, high;
      load(boxes.low[c].data() + k, low);
      load(boxes.high[c].data() + k, high);
      const Lanes before = low - box.high[c], after = box.low[c] - high;
      Lanes gap = before > after ? before : after;
      gap = gap > 0.0 ? gap : Lanes{};
      d2 += gap * gap;
    }
    for (std::size_t l = 0; l < lanes; ++l) {
      found[count] = static_cast<std::int32_t>(k + l);
      count += d2[l] < range2 && k + l < end ? 1 : 0;
    }
  }
  return count;
}

// Does image (m, n) of the yarn lie on the same endless yarn, and how many turns ahead?
bool turns_ahead(const YarnModel::Yarn& yarn, int m, int n, int& turns) {
  turns = 0;
  if (m == 0 && n == 0) return true;
  if (!yarn.periodic) return false;
  const auto [sm, sn] = yarn.shift;
  turns = sm != 0 ? m / sm : sn != 0 ? n / sn : 0;
  return turns != 0 && turns * sm == m && turns * sn == n;
}

// The pair of a segment and another at its image, but for its distance; false if they lie so close along one
// yarn that they never touch.
bool may_touch(const YarnModel& model, int a, const ImagedSegment& other, SegmentPair& pair) {
  pair.a = a;
  pair.b = other.segment;
  pair.m = other.m;
  pair.n = other.n;
  const YarnModel::Yarn& yarn = model.yarn_of(a);
  int turns = 0;
  if (model.yarn_of_segment[static_cast<std::size_t>(a)] !=
          model.yarn_of_segment[static_cast<std::size_t>(other.segment)] ||
      !turns_ahead(yarn, other.m, other.n, turns))
    return true;
  int ahead = other.segment - a + turns * yarn.segments;
  // a ring: its end lies behind its beginning
  const bool closed = yarn.periodic && yarn.shift == std::array<int, 2>{0, 0};
  if (closed && 2 * ahead > yarn.segments) ahead -= yarn.segments;
  const double excluded = model.excluded * yarn.diameter;
  if ((std::abs(ahead) + 1) * yarn.rest_length <= excluded) return false;
  pair.same_yarn = (std::abs(ahead) - 1) * yarn.rest_length < excluded;
  pair.arc_offset = ahead * yarn.rest_length;
  return true;
}

std::vector<ImagedSegment> imaged_segments(const YarnModel& model, const YarnState& state,
                                           const SamplePlaces& places, double range, SampleBox& whole) {
  std::vector<ImagedSegment> all;
  all.reserve(static_cast<std::size_t>(model.segments));
  whole = {{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (int e = 0; e < model.segments; ++e) {
    all.push_back({e, 0, 0, places.boxes[static_cast<std::size_t>(e)]});
    for (std::size_t c = 0; c < 3; ++c) {
      whole.low[c] = std::min(whole.low[c], all.back().box.low[c]);
      whole.high[c] = std::max(whole.high[c], all.back().box.high[c]);
    }
  }
  if (!model.periodic) return all;
  const int reach_n =
      std::min(100, static_cast<int>(std::ceil((whole.high[1] - whole.low[1] + range) / state.height)));
  const double skewed = reach_n * std::abs(state.skew);
  const int reach_m = std::min(
      100, static_cast<int>(std::ceil((whole.high[0] - whole.low[0] + range + skewed) / state.width)));
  // Only the images after (0, 0): (a, b, image) and (b, a, -image) are the same pair.
  for (int n = -reach_n; n <= reach_n; ++n)
    for (int m = -reach_m; m <= reach_m; ++m) {
      if (m < 0 || (m == 0 && n <= 0)) continue;
      const Vec3 t = state.lattice(m, n);
      for (int e = 0; e < model.segments; ++e) {
        SampleBox box = all[static_cast<std::size_t>(e)].box;
        for (std::size_t c = 0; c < 3; ++c) {
          box.low[c] += t[static_cast<int>(c)];
          box.high[c] += t[static_cast<int>(c)];
        }
        if (!apart(box, whole, range))
          all.push_back({e, static_cast<std::int8_t>(m), static_cast<std::int8_t>(n), box});
      }
    }
  return all;
}

}  // namespace

void expand(const YarnModel& model, const YarnState& state, std::vector<Vec3>& extended) {
  extended.resize(static_cast<std::size_t>(model.extended));
  for (std::size_t k = 0; k < extended.size(); ++k) {
    extended[k] = state.nodes[static_cast<std::size_t>(model.base[k])];
    if (model.image[k][0] != 0 || model.image[k][1] != 0)
      extended[k] += state.lattice(model.image[k][0], model.image[k][1]);
  }
}

void place_samples(const YarnModel& model, const std::vector<Vec3>& extended, SamplePlaces& places) {
  const auto count = static_cast<std::size_t>(model.segments * model.samples);
  places.x.resize(count);
  places.y.resize(count);
  places.z.resize(count);
  places.boxes.resize(static_cast<std::size_t>(model.segments));
  const auto samples = static_cast<std::size_t>(model.samples);
  std::array<std::array<double, most_contact_samples>, 4> by_point{};
  for (std::size_t i = 0; i < samples; ++i)
    for (std::size_t k = 0; k < 4; ++k) by_point[k][i] = model.weights[i][k];
  for (std::size_t e = 0; e < places.boxes.size(); ++e)
    place_segment(extended.data() + model.first[e], by_point, samples, &places.x[e * samples],
                  &places.y[e * samples], &places.z[e * samples], places.boxes[e]);
}

void find_segment_pairs(const YarnModel& model, const YarnState& state, const SamplePlaces& places,
                        double range, std::vector<SegmentPair>& pairs) {
  pairs.clear();
  SampleBox whole;
  const std::vector<ImagedSegment> all = imaged_segments(model, state, places, range, whole);

  // Grid over box centres; two boxes nearer than `range` have centres within range + the largest extent.
  double extent = 0;
  for (int e = 0; e < model.segments; ++e)
    for (std::size_t c = 0; c < 3; ++c)
      extent = std::max(
          extent, all[static_cast<std::size_t>(e)].box.high[c] - all[static_cast<std::size_t>(e)].box.low[c]);
  const double cell = range + extent;
  std::array<double, 3> origin;
  std::array<int, 3> size;
  for (std::size_t c = 0; c < 3; ++c) {
    origin[c] = whole.low[c] - cell;
    const double cells = std::ceil((whole.high[c] - whole.low[c]) / cell) + 3;
    size[c] = static_cast<int>(std::min(cells, 2000.0));
  }
  const auto cell_of = [&](const SampleBox& box, std::array<int, 3>& at) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double place = (0.5 * (box.low[c] + box.high[c]) - origin[c]) / cell;
      at[c] = static_cast<int>(std::clamp(place, 0.0, size[c] - 1.0));
    }
  };
  const auto cell_index = [&](int i, int j, int k) {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(i);
  };
  std::vector<std::int32_t> start(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
                                          static_cast<std::size_t>(size[2]) +
                                      1,
                                  0);
  std::vector<std::size_t> where(all.size());
  for (std::size_t s = 0; s < all.size(); ++s) {
    std::array<int, 3> at;
    cell_of(all[s].box, at);
    where[s] = cell_index(at[0], at[1], at[2]);
    ++start[where[s] + 1];
  }
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<std::int32_t> sorted(all.size()), fill(start.begin(), start.end() - 1);
  for (std::size_t s = 0; s < all.size(); ++s)
    sorted[static_cast<std::size_t>(fill[where[s]]++)] = static_cast<std::int32_t>(s);

  SortedBoxes boxes;
  boxes.resize(all.size());
  for (std::size_t k = 0; k < sorted.size(); ++k) boxes.set(k, all[static_cast<std::size_t>(sorted[k])].box);

  const double range2 = range * range;
  const auto pairs_of = [&](int a, std::vector<std::int32_t>& found, std::vector<SegmentPair>& to) {
    const SampleBox& box = all[static_cast<std::size_t>(a)].box;
    const std::size_t first_pair = to.size();
    std::array<int, 3> at;
    cell_of(box, at);
    const int i0 = std::max(at[0] - 1, 0), i1 = std::min(at[0] + 1, size[0] - 1);
    for (int k = std::max(at[2] - 1, 0); k <= std::min(at[2] + 1, size[2] - 1); ++k)
      for (int j = std::max(at[1] - 1, 0); j <= std::min(at[1] + 1, size[1] - 1); ++j) {
        // Cells along x lie one behind the other.
        const auto begin = static_cast<std::size_t>(start[cell_index(i0, j, k)]),
                   end = static_cast<std::size_t>(start[cell_index(i1, j, k) + 1]);
        const std::size_t count = near_boxes(box, boxes, begin, end, range2, found.data());
        for (std::size_t f = 0; f < count; ++f) {
          const ImagedSegment& other =
              all[static_cast<std::size_t>(sorted[static_cast<std::size_t>(found[f])])];
          if (other.m == 0 && other.n == 0 && other.segment <= a) continue;
          SegmentPair pair;
          if (!may_touch(model, a, other, pair)) continue;
          pair.distance2 =
              smallest_distance2(pair_input(model, places, pair, state.lattice(pair.m, pair.n)), range2);
          if (pair.distance2 < range2) to.push_back(pair);
        }
      }
    std::sort(to.begin() + static_cast<std::ptrdiff_t>(first_pair), to.end(),
              [](const SegmentPair& p, const SegmentPair& q) {
                return std::tie(p.b, p.m, p.n) < std::tie(q.b, q.m, q.n);
              });
  };
  const int chunks = (model.segments + segments_per_chunk - 1) / segments_per_chunk;
  std::vector<std::vector<SegmentPair>> parts(static_cast<std::size_t>(chunks));
  parallel_chunks(chunks, [&](int c) {
    std::vector<std::int32_t> found(all.size() + lanes);
    const int end = std::min(model.segments, (c + 1) * segments_per_chunk);
    for (int a = c * segments_per_chunk; a < end; ++a) pairs_of(a, found, parts[static_cast<std::size_t>(c)]);
  });
  std::size_t total = 0;
  for (const auto& part : parts) total += part.size();
  // The list outlives the search: what a large piece's has grown too long by is given back.
  if (pairs.capacity() > total + total / 4) std::vector<SegmentPair>().swap(pairs);
  pairs.reserve(total);
  for (auto& part : parts) {
    pairs.insert(pairs.end(), part.begin(), part.end());
    std::vector<SegmentPair>().swap(part);
  }
}

std::vector<SegmentPair> pairs_within(const YarnModel& model, const YarnState& state, double reach,
                                      SamplePlaces& places) {
  std::vector<Vec3> extended;
  expand(model, state, extended);
  place_samples(model, extended, places);
  double thickest = 0;
  for (const YarnModel::Yarn& yarn : model.yarns) thickest = std::max(thickest, yarn.diameter);
  std::vector<SegmentPair> pairs;
  find_segment_pairs(model, state, places, reach * thickest, pairs);
  return pairs;
}

}  // namespace loopwright
