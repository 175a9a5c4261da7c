// The loop-scale model as a layout of real programmes: where they come to rest, the width of courses against
// their stitches, the roundness of tubes, and whether the curves are interlaced as the machine knitted.
//   study_loop_scale_layout FILE...
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "geometry/fit_fabric.hpp"
#include "geometry/interlacing.hpp"
#include "loop_scale/relaxed_layout.hpp"
#include "pipeline.hpp"

namespace loopwright {
namespace {

void study(const char* file) {
  Diagnostics diagnostics(file);
  const Knitting knitting = knit(file, {}, diagnostics);
  if (!diagnostics.ok()) {
    std::printf("%s has errors\n", file);
    return;
  }
  const YarnGraph& graph = knitting.graph;
  const auto begin = std::chrono::steady_clock::now();
  const RelaxedLayout layout = relaxed_layout(graph, knitting.program);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto intact = [&](const YarnCurves& curves) {
    return check_interlacings(fit_fabric(curves, graph, layout.model.geometry));
  };
  const InterlacingCheck start = intact(layout.model.curves), end = intact(layout.curves);
  Vec3 low = layout.state.position(0), high = low;
  for (std::size_t i = 0; i < layout.state.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], layout.state.position(i)[c]);
      high[c] = std::max(high[c], layout.state.position(i)[c]);
    }
  const double mm = layout.model.geometry.diameter_mm, l = layout.model.yarn.loop_length;
  std::printf(
      "%s\n  %zu masses, %s after %d steps, %.1f s; %.0f x %.0f x %.0f mm; interlacings %d of %d at the "
      "start, "
      "%d at rest\n",
      file, layout.state.size(), layout.result.settled ? "at rest" : "not at rest", layout.result.steps,
      seconds, (high.x - low.x) * mm, (high.y - low.y) * mm, (high.z - low.z) * mm, start.intact,
      start.expected, end.intact);
  // width over that of as many even stitches
  std::vector<CourseMeasure> courses = course_measures(graph, layout);
  std::erase_if(courses, [](const CourseMeasure& c) { return c.stitches < 3; });
  double least = 1e9, most = 0, mean = 0;
  int ordinary = 0;
  for (const CourseMeasure& c : courses) {
    const double share = c.width / l / (c.stitches - 1) / 0.2456;
    if (share > 1.5) continue;  // on every other needle
    ++ordinary;
    least = std::min(least, share), most = std::max(most, share);
    mean += share;
  }
  std::printf(
      "  %zu courses of 3 stitches and more, %d of them on needles side by side: width over rest width of "
      "their "
      "stitches %.2f to %.2f, mean %.3f\n",
      courses.size(), ordinary, ordinary > 0 ? least : 0, most, ordinary > 0 ? mean / ordinary : 0);
  for (std::size_t k = 0; k < 8 && !courses.empty(); ++k) {
    const CourseMeasure& c = courses[k * (courses.size() - 1) / 7];
    std::printf("    pass %4d: %3d stitches, %6.1f mm wide\n", c.pass, c.stitches, c.width * mm);
  }
  const std::vector<RoundMeasure> rounds = round_measures(graph, layout);
  if (rounds.empty()) return;
  least = 1e9, most = 0;
  for (const RoundMeasure& r : rounds)
    least = std::min(least, r.roundness), most = std::max(most, r.roundness);
  std::printf(
      "  %zu rounds, the middle one of %d loops; enclosed area over a circle's %.2f to %.2f; "
      "%.0f cm^3 enclosed\n",
      rounds.size(), rounds[rounds.size() / 2].loops, least, most,
      enclosed_volume(rounds) * mm * mm * mm * 1e-3);
}

}  // namespace
}  // namespace loopwright

int main(int count, char** files) {
  for (int k = 1; k < count; ++k) loopwright::study(files[k]);
}
