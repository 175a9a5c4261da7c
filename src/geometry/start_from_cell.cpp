#include "geometry/start_from_cell.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/fit_fabric.hpp"
#include "geometry/interlacing.hpp"

namespace loopwright {
namespace {

using Shift = std::array<int, 2>;

// A loop of the piece and its image in the cell.
struct ImagedSpan {
  std::size_t index = 0;  // of the piece's span, in Fabric::loops
  const LoopSpan* image = nullptr;
  Shift shift{0, 0};      // from where the image lies on the cell's curve
  bool reversed = false;  // the courses run in opposite directions
};

// [yarn of the piece] its loops in order along it. Empty if a loop has no image or a yarn no loop.
std::vector<std::vector<ImagedSpan>> imaged_spans(const Fabric& piece, const Fabric& cell,
                                                  const YarnGraph& graph, const CellRange& range) {
  const std::vector<CellImage> images = cell_images(graph, range);
  std::map<LoopId, const LoopSpan*> cell_spans;
  for (const LoopSpan& s : cell.loops) cell_spans[s.loop] = &s;
  std::vector<std::vector<ImagedSpan>> spans(piece.yarns.size());
  for (std::size_t k = 0; k < piece.loops.size(); ++k) {
    const LoopSpan& s = piece.loops[k];
    const CellImage& image = images[s.loop.position()];
    const auto found = cell_spans.find(image.loop);
    if (!image.loop.valid() || found == cell_spans.end()) return {};
    spans[static_cast<std::size_t>(s.yarn)].push_back(
        {k, found->second, image.shift, graph.loop(s.loop).direction != graph.loop(image.loop).direction});
  }
  for (auto& on_yarn : spans) {
    if (on_yarn.empty()) return {};
    std::sort(on_yarn.begin(), on_yarn.end(), [&](const ImagedSpan& a, const ImagedSpan& b) {
      return piece.loops[a.index].begin < piece.loops[b.index].begin;
    });
  }
  return spans;
}

// Parameter on the cell's yarn of parameter t of the piece's yarn: the same share of the half loop before or
// after the apex.
double imaged_parameter(const LoopSpan& a, const LoopSpan& b, bool reversed, double t) {
  const auto share = [](double from, double to, double at) {
    return to > from ? (at - from) / (to - from) : 0;
  };
  const bool first_half = t < a.apex;
  const double f = first_half ? share(a.begin, a.apex, t) : share(a.apex, a.end, t);
  if (reversed) return first_half ? b.end - f * (b.end - b.apex) : b.apex - f * (b.apex - b.begin);
  return first_half ? b.begin + f * (b.apex - b.begin) : b.apex + f * (b.end - b.apex);
}

// A yarn of the piece as a stretch of one of the cell's endless yarns: segments [begin, end) of it, counted
// on over its periods, at a lattice shift; taken backwards if reversed.
struct Stretch {
  int yarn = 0, begin = 0, end = 0;
  Shift shift{0, 0};
  bool reversed = false;
};

// Periods of the cell's yarn by which loop s is ahead of where its image lies on the curve, given the shift
// of the whole stretch. Nothing if it lies on another image of the yarn.
std::optional<int> turns_of(const FabricYarn& yarn, const ImagedSpan& s, const Shift& base) {
  const Shift ahead{s.shift[0] - base[0], s.shift[1] - base[1]};
  const auto along = yarn.shift[0] != 0 ? std::size_t{0} : std::size_t{1};
  if (yarn.shift[along] == 0) return std::nullopt;
  const int turns = ahead[along] / yarn.shift[along];
  if (turns * yarn.shift[0] != ahead[0] || turns * yarn.shift[1] != ahead[1]) return std::nullopt;
  return turns;
}

std::optional<Stretch> stretch_of(const Fabric& piece, const Fabric& cell, std::size_t piece_yarn,
                                  const std::vector<ImagedSpan>& spans) {
  const ImagedSpan& head = spans.front();
  Stretch stretch{head.image->yarn, 0, 0, head.shift, head.reversed};
  const FabricYarn& yarn = cell.yarns[static_cast<std::size_t>(stretch.yarn)];
  const auto unwrapped = [&](const ImagedSpan& s, double t) {  // turns_of(s) is known to be there
    return *turns_of(yarn, s, stretch.shift) * yarn.segments() +
           imaged_parameter(piece.loops[s.index], *s.image, stretch.reversed, t);
  };
  for (std::size_t k = 0; k < spans.size(); ++k) {
    const ImagedSpan& s = spans[k];
    if (s.image->yarn != stretch.yarn || s.reversed != stretch.reversed || !turns_of(yarn, s, stretch.shift))
      return std::nullopt;
    if (k == 0) continue;
    // The next loop of the piece must be the next loop of the cell's yarn.
    constexpr double rounding = 1e-6;
    const double gap = unwrapped(s, piece.loops[s.index].begin) -
                       unwrapped(spans[k - 1], piece.loops[spans[k - 1].index].end);
    if (std::abs(gap) > rounding) return std::nullopt;
  }
  const double at_start = unwrapped(spans.front(), 0);
  const double at_end = unwrapped(spans.back(), piece.yarns[piece_yarn].segments());
  // Half a loop of the next one goes along at either end: where yarn has slid far, that is where the feet of
  // the border loops are.
  const double more = 0.5 * (head.image->end - head.image->begin);
  stretch.begin = static_cast<int>(std::lround(std::min(at_start, at_end) - more));
  stretch.end = static_cast<int>(std::lround(std::max(at_start, at_end) + more));
  if (stretch.end <= stretch.begin) return std::nullopt;
  return stretch;
}

Vec3 cell_control_point(const Fabric& cell, const Stretch& stretch, int i) {
  return control_point(cell, cell.yarns[static_cast<std::size_t>(stretch.yarn)], i) +
         cell.lattice(stretch.shift[0], stretch.shift[1]);
}

// Control point by control point the cell's yarn; segments become those of the cell, and the piece's spans
// are told where they begin and end now.
void copy_stretch(const Fabric& cell, const Stretch& stretch, const std::vector<ImagedSpan>& spans,
                  FabricYarn& yarn, std::vector<LoopSpan>& loops) {
  const FabricYarn& from = cell.yarns[static_cast<std::size_t>(stretch.yarn)];
  yarn.control_points.clear();
  for (int i = stretch.begin; i < stretch.end + 3; ++i)
    yarn.control_points.push_back(
        cell_control_point(cell, stretch, stretch.reversed ? stretch.end + 2 - (i - stretch.begin) : i));
  yarn.segment_rest_length = from.segment_rest_length;
  yarn.natural_curvature.clear();
  if (!from.natural_curvature.empty()) {
    const int period = from.segments();
    for (int i = stretch.begin; i < stretch.end; ++i) {
      const int segment = stretch.reversed ? stretch.end - 1 - (i - stretch.begin) : i;
      std::array<double, 4> curvature =
          from.natural_curvature[static_cast<std::size_t>(((segment % period) + period) % period)];
      if (stretch.reversed) std::reverse(curvature.begin(), curvature.end());
      yarn.natural_curvature.push_back(curvature);
    }
  }
  const double count = stretch.end - stretch.begin;
  for (const ImagedSpan& s : spans) {
    const double turns = *turns_of(from, s, stretch.shift) * from.segments() - stretch.begin;
    const auto placed = [&](double t) {
      return std::clamp(stretch.reversed ? count - (t + turns) : t + turns, 0.0, count);
    };
    LoopSpan& span = loops[s.index];
    span.begin = placed(stretch.reversed ? s.image->end : s.image->begin);
    span.apex = placed(s.image->apex);
    span.end = placed(stretch.reversed ? s.image->begin : s.image->end);
  }
}

std::vector<SegmentImage> segment_images(const Fabric& cell, const Stretch& stretch) {
  const FabricYarn& yarn = cell.yarns[static_cast<std::size_t>(stretch.yarn)];
  const int period = yarn.segments();
  std::vector<SegmentImage> images;
  for (int k = 0; k < stretch.end - stretch.begin; ++k) {
    const int on_yarn = stretch.reversed ? stretch.end - 1 - k : stretch.begin + k;
    const int segment = ((on_yarn % period) + period) % period, turns = (on_yarn - segment) / period;
    images.push_back({stretch.yarn,
                      segment,
                      {stretch.shift[0] + turns * yarn.shift[0], stretch.shift[1] + turns * yarn.shift[1]}});
  }
  return images;
}

// Places on the cell's yarns at the piece's own parameters.
void sample_anew(const Fabric& piece, const Fabric& cell, const std::vector<ImagedSpan>& spans,
                 FabricYarn& yarn) {
  std::vector<Vec3> places;
  std::size_t at = 0;
  const int segments = yarn.segments();
  for (int k = 0; k <= segments; ++k) {
    while (at + 1 < spans.size() && k >= piece.loops[spans[at + 1].index].begin) ++at;
    const ImagedSpan& s = spans[at];
    const double t = imaged_parameter(piece.loops[s.index], *s.image, s.reversed, k);
    places.push_back(position(cell, cell.yarns[static_cast<std::size_t>(s.image->yarn)], t) +
                     cell.lattice(s.shift[0], s.shift[1]));
  }
  yarn.control_points = open_control_points(places);
}

// Control points that weigh most in a span: control point i weighs most at parameter i - 1.
struct PointRange {
  int first = 0, last = -1;
};
PointRange points_of(const LoopSpan& s, const FabricYarn& yarn) {
  const auto count = static_cast<int>(yarn.control_points.size());
  return {std::clamp(static_cast<int>(std::ceil(s.begin)) + 1, 0, count),
          std::clamp(static_cast<int>(std::floor(s.end)) + 1, -1, count - 1)};
}

// The frame is the outermost ring of loops, held whole in the shape that they have in the cell, with the yarn
// outside them: the piece's inside then has the neighbours that it would have in an endless cloth. (A
// template's few held points would leave border loops half free.)
void hold_border_loops(const Fabric& piece, Fabric& started) {
  std::vector<std::vector<std::uint8_t>> in_loop;
  for (FabricYarn& yarn : started.yarns) {
    yarn.held.assign(yarn.control_points.size(), 0);
    in_loop.push_back(yarn.held);
  }
  for (std::size_t k = 0; k < piece.loops.size(); ++k) {
    const auto y = static_cast<std::size_t>(piece.loops[k].yarn);
    const PointRange before = points_of(piece.loops[k], piece.yarns[y]);
    bool border = false;
    for (int i = before.first; i <= before.last; ++i)
      border = border || piece.yarns[y].held[static_cast<std::size_t>(i)] != 0;
    const PointRange now = points_of(started.loops[k], started.yarns[y]);
    for (int i = now.first; i <= now.last; ++i) {
      in_loop[y][static_cast<std::size_t>(i)] = 1;
      if (border) started.yarns[y].held[static_cast<std::size_t>(i)] = 1;
    }
  }
  for (std::size_t y = 0; y < started.yarns.size(); ++y)
    for (std::size_t i = 0; i < in_loop[y].size(); ++i)
      if (in_loop[y][i] == 0) started.yarns[y].held[i] = 1;
}

}  // namespace

std::optional<StartFromCell> start_from_cell(const Fabric& piece, const Fabric& cell, const YarnGraph& graph,
                                             const CellRange& range) {
  if (piece.periodic || !cell.periodic || !(cell.wales > 0) || !(cell.courses > 0)) return std::nullopt;
  const std::vector<std::vector<ImagedSpan>> spans = imaged_spans(piece, cell, graph, range);
  if (spans.empty()) return std::nullopt;

  std::vector<Stretch> stretches;
  for (std::size_t y = 0; y < spans.size(); ++y)
    if (const std::optional<Stretch> stretch = stretch_of(piece, cell, y, spans[y]))
      stretches.push_back(*stretch);

  StartFromCell start{piece, {}};
  for (std::size_t y = 0; y < spans.size(); ++y) {
    FabricYarn& yarn = start.fabric.yarns[y];
    if (stretches.size() == spans.size()) {
      copy_stretch(cell, stretches[y], spans[y], yarn, start.fabric.loops);
      start.images.push_back(segment_images(cell, stretches[y]));
    } else {
      sample_anew(piece, cell, spans[y], yarn);
    }
  }
  start.fabric.width = piece.wales * cell.width / cell.wales;
  start.fabric.height = piece.courses * cell.height / cell.courses;
  hold_border_loops(piece, start.fabric);
  const InterlacingCheck check = check_interlacings(start.fabric);
  if (check.intact != check.expected) return std::nullopt;
  return start;
}

}  // namespace loopwright
