#include "mechanics/contact/segment_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace loopwright {
namespace {

struct ImagedSegment {
  std::int32_t segment;
  std::int8_t m, n;
  SampleBox box;
};

SampleBox box_of(const SamplePlaces& places, std::size_t begin, std::size_t end) {
  SampleBox box{{places.x[begin], places.y[begin], places.z[begin]},
                {places.x[begin], places.y[begin], places.z[begin]}};
  for (std::size_t k = begin + 1; k < end; ++k) {
    const std::array<double, 3> p{places.x[k], places.y[k], places.z[k]};
    for (std::size_t c = 0; c < 3; ++c) {
      box.low[c] = std::min(box.low[c], p[c]);
      box.high[c] = std::max(box.high[c], p[c]);
    }
  }
  return box;
}

bool apart(const SampleBox& a, const SampleBox& b, double range) {
  for (std::size_t c = 0; c < 3; ++c)
    if (a.low[c] - b.high[c] > range || b.low[c] - a.high[c] > range) return true;
  return false;
}

// Squared distance of those samples of two segments that can touch; `beyond2` where none is less.
double smallest_distance2(const YarnModel& model, const SamplePlaces& p, const SegmentPair& pair,
                          const Vec3& image, double beyond2) {
  const auto i0 = static_cast<std::size_t>(pair.a * model.samples),
             j0 = static_cast<std::size_t>(pair.b * model.samples);
  const auto count = static_cast<std::size_t>(model.samples);
  const SampleBox& box = p.boxes[static_cast<std::size_t>(pair.b)];
  const SampleView others{&p.x[j0], &p.y[j0], &p.z[j0]};
  std::array<double, most_contact_samples> to_box2{}, d2;
  for (std::size_t i = 0; i < count; ++i)
    to_box2[i] = squared_distance(p.x[i0 + i] - image.x, p.y[i0 + i] - image.y, p.z[i0 + i] - image.z, box);
  const YarnModel::Yarn& yarn = model.yarn_of(pair.a);
  const double spacing = yarn.rest_length / model.samples, excluded = model.excluded * yarn.diameter;
  // Neighbours along one yarn: samples closer than this along it do not touch, and are always near.
  const auto along_yarn = [&](std::size_t i, std::size_t j) {
    return std::abs(pair.arc_offset + (static_cast<double>(j) - static_cast<double>(i)) * spacing) < excluded;
  };
  // The sample nearest to the box first: most others then need not be looked at.
  const auto first = static_cast<std::size_t>(
      std::min_element(to_box2.begin(), to_box2.begin() + static_cast<std::ptrdiff_t>(count)) -
      to_box2.begin());
  double nearest = beyond2;
  const auto look_at = [&](std::size_t i) {
    if (to_box2[i] >= nearest) return;
    const double least = squared_distances(p.x[i0 + i] - image.x, p.y[i0 + i] - image.y,
                                           p.z[i0 + i] - image.z, others, count, nearest, d2.data());
    if (!pair.same_yarn) {
      nearest = least;
      return;
    }
    for (std::size_t j = 0; j < count; ++j)
      if (!along_yarn(i, j)) nearest = std::min(nearest, d2[j]);
  };
  look_at(first);
  for (std::size_t i = 0; i < count; ++i)
    if (i != first) look_at(i);
  return nearest;
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
  places.boxes.clear();
  places.boxes.reserve(static_cast<std::size_t>(model.segments));
  std::size_t k = 0;
  for (int e = 0; e < model.segments; ++e) {
    const std::size_t begin = k;
    const Vec3* q = extended.data() + model.first[static_cast<std::size_t>(e)];
    for (std::size_t i = 0; i < static_cast<std::size_t>(model.samples); ++i, ++k) {
      const auto& w = model.weights[i];
      places.x[k] = w[0] * q[0].x + w[1] * q[1].x + w[2] * q[2].x + w[3] * q[3].x;
      places.y[k] = w[0] * q[0].y + w[1] * q[1].y + w[2] * q[2].y + w[3] * q[3].y;
      places.z[k] = w[0] * q[0].z + w[1] * q[1].z + w[2] * q[2].z + w[3] * q[3].z;
    }
    places.boxes.push_back(box_of(places, begin, k));
  }
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
  std::array<int, 3> at;
  for (std::size_t s = 0; s < all.size(); ++s) {
    cell_of(all[s].box, at);
    where[s] = cell_index(at[0], at[1], at[2]);
    ++start[where[s] + 1];
  }
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<std::int32_t> sorted(all.size()), fill(start.begin(), start.end() - 1);
  for (std::size_t s = 0; s < all.size(); ++s)
    sorted[static_cast<std::size_t>(fill[where[s]]++)] = static_cast<std::int32_t>(s);

  const double range2 = range * range;
  for (int a = 0; a < model.segments; ++a) {
    const SampleBox& box = all[static_cast<std::size_t>(a)].box;
    const YarnModel::Yarn& yarn = model.yarn_of(a);
    cell_of(box, at);
    for (int k = std::max(at[2] - 1, 0); k <= std::min(at[2] + 1, size[2] - 1); ++k)
      for (int j = std::max(at[1] - 1, 0); j <= std::min(at[1] + 1, size[1] - 1); ++j)
        for (int i = std::max(at[0] - 1, 0); i <= std::min(at[0] + 1, size[0] - 1); ++i) {
          const std::size_t c = cell_index(i, j, k);
          for (std::int32_t s = start[c]; s < start[c + 1]; ++s) {
            const ImagedSegment& other = all[static_cast<std::size_t>(sorted[static_cast<std::size_t>(s)])];
            if (other.m == 0 && other.n == 0 && other.segment <= a) continue;
            if (apart(box, other.box, range)) continue;
            SegmentPair pair;
            pair.a = a;
            pair.b = other.segment;
            pair.m = other.m;
            pair.n = other.n;
            int turns = 0;
            if (model.yarn_of_segment[static_cast<std::size_t>(a)] ==
                    model.yarn_of_segment[static_cast<std::size_t>(other.segment)] &&
                turns_ahead(yarn, other.m, other.n, turns)) {
              int ahead = other.segment - a + turns * yarn.segments;
              // a ring: its end lies behind its beginning
              const bool closed = yarn.periodic && yarn.shift == std::array<int, 2>{0, 0};
              if (closed && 2 * ahead > yarn.segments) ahead -= yarn.segments;
              const double excluded = model.excluded * yarn.diameter;
              if ((std::abs(ahead) + 1) * yarn.rest_length <= excluded) continue;
              pair.same_yarn = (std::abs(ahead) - 1) * yarn.rest_length < excluded;
              pair.arc_offset = ahead * yarn.rest_length;
            }
            pair.distance2 = smallest_distance2(model, places, pair, state.lattice(other.m, other.n), range2);
            if (pair.distance2 < range2) pairs.push_back(pair);
          }
        }
  }
  std::sort(pairs.begin(), pairs.end(), [](const SegmentPair& p, const SegmentPair& q) {
    return std::tie(p.a, p.b, p.m, p.n) < std::tie(q.a, q.b, q.m, q.n);
  });
  // The list outlives the search: what a large piece's has grown too long by is given back.
  if (pairs.capacity() > pairs.size() + pairs.size() / 4) pairs.shrink_to_fit();
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
