#include "knitted_so_far.hpp"

#include <algorithm>
#include <cmath>

namespace loopwright {

std::vector<double> fed_until(const Fabric& fabric, const YarnGraph& graph, int instruction) {
  std::vector<double> fed(fabric.yarns.size(), 0);
  for (const LoopSpan& span : fabric.loops) {
    double& of = fed[static_cast<std::size_t>(span.yarn)];
    if (graph.loop(span.loop).instruction <= instruction) of = std::max(of, span.end);
  }
  return fed;
}

std::optional<std::vector<YarnRenderer::Run>> runs_until(const YarnScene& scene, const Fabric& fabric,
                                                         const std::vector<double>& fed, int every) {
  if (fed.size() != scene.parts.size() || fed.empty()) return std::nullopt;
  std::vector<YarnRenderer::Run> runs;
  for (std::size_t y = 0; y < fed.size(); ++y) {
    const YarnPart& part = scene.parts[y];
    const auto segments = static_cast<std::uint32_t>(std::ceil(fed[y] / every - 1e-9));
    if (segments == 0) continue;
    const bool whole = segments >= static_cast<std::uint32_t>(fabric.yarns[y].segments() / every);
    runs.push_back({part.first, whole ? part.count : std::min(part.count, segments * part.per_segment)});
  }
  return runs;
}

}  // namespace loopwright
