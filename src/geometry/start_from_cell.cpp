#include "geometry/start_from_cell.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/fit_fabric.hpp"
#include "geometry/interlacing.hpp"

namespace loopwright {
namespace {

// A loop of the piece and its image in the cell.
struct ImagedSpan {
  const LoopSpan* span = nullptr;
  const LoopSpan* image = nullptr;
  Vec3 shift;
  bool reversed = false;  // the courses run in opposite directions
};

// Place in the cell of parameter t of the piece's yarn: the same share of the half loop before or after the
// apex.
Vec3 imaged_place(const Fabric& cell, const ImagedSpan& s, double t) {
  const auto share = [](double from, double to, double at) {
    return to > from ? (at - from) / (to - from) : 0;
  };
  const LoopSpan &a = *s.span, &b = *s.image;
  const bool first_half = t < a.apex;
  const double f = first_half ? share(a.begin, a.apex, t) : share(a.apex, a.end, t);
  double at = first_half ? b.begin + f * (b.apex - b.begin) : b.apex + f * (b.end - b.apex);
  if (s.reversed) at = first_half ? b.end - f * (b.end - b.apex) : b.apex - f * (b.apex - b.begin);
  return position(cell, cell.yarns[static_cast<std::size_t>(b.yarn)], at) + s.shift;
}

// The frame is the outermost ring of loops, held whole in the shape that they have in the cell: the piece's
// inside then has the neighbours that it would have in an endless cloth. (A template's few held points would
// leave border loops half free.)
void hold_border_loops(Fabric& fabric) {
  std::vector<std::vector<std::uint8_t>> held;
  for (const FabricYarn& yarn : fabric.yarns) held.push_back(yarn.held);
  for (const LoopSpan& s : fabric.loops) {
    const auto y = static_cast<std::size_t>(s.yarn);
    FabricYarn& yarn = fabric.yarns[y];
    // Control point i weighs most at parameter i - 1.
    const auto count = static_cast<int>(yarn.control_points.size());
    const int first = std::clamp(static_cast<int>(std::ceil(s.begin)) + 1, 0, count);
    const int last = std::clamp(static_cast<int>(std::floor(s.end)) + 1, -1, count - 1);
    bool border = false;
    for (int i = first; i <= last; ++i) border = border || held[y][static_cast<std::size_t>(i)] != 0;
    for (int i = first; border && i <= last; ++i) yarn.held[static_cast<std::size_t>(i)] = 1;
  }
}

}  // namespace

std::optional<Fabric> start_from_cell(const Fabric& piece, const Fabric& cell, const YarnGraph& graph,
                                      const CellRange& range) {
  if (piece.periodic || !cell.periodic || !(cell.wales > 0) || !(cell.courses > 0)) return std::nullopt;
  const std::vector<CellImage> images = cell_images(graph, range);
  std::map<LoopId, const LoopSpan*> cell_spans;
  for (const LoopSpan& s : cell.loops) cell_spans[s.loop] = &s;

  std::vector<std::vector<ImagedSpan>> spans(piece.yarns.size());
  for (const LoopSpan& s : piece.loops) {
    const CellImage& image = images[s.loop.position()];
    const auto found = cell_spans.find(image.loop);
    if (!image.loop.valid() || found == cell_spans.end()) return std::nullopt;
    spans[static_cast<std::size_t>(s.yarn)].push_back(
        {&s, found->second, cell.lattice(image.shift[0], image.shift[1]),
         graph.loop(s.loop).direction != graph.loop(image.loop).direction});
  }

  Fabric started = piece;
  for (std::size_t y = 0; y < piece.yarns.size(); ++y) {
    auto& on_yarn = spans[y];
    if (on_yarn.empty()) return std::nullopt;
    std::sort(on_yarn.begin(), on_yarn.end(),
              [](const ImagedSpan& a, const ImagedSpan& b) { return a.span->begin < b.span->begin; });
    std::vector<Vec3> places;
    std::size_t at = 0;
    for (int k = 0; k <= piece.yarns[y].segments(); ++k) {
      while (at + 1 < on_yarn.size() && k >= on_yarn[at + 1].span->begin) ++at;
      places.push_back(imaged_place(cell, on_yarn[at], k));
    }
    started.yarns[y].control_points = open_control_points(places);
  }
  started.width = piece.wales * cell.width / cell.wales;
  started.height = piece.courses * cell.height / cell.courses;
  hold_border_loops(started);
  const InterlacingCheck check = check_interlacings(started);
  if (check.intact != check.expected) return std::nullopt;
  return started;
}

}  // namespace loopwright
