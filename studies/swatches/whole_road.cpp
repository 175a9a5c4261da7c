#include "whole_road.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/fit_fabric.hpp"
#include "geometry/mend_crossings.hpp"
#include "outputs/state.hpp"

namespace loopwright {
namespace {

Vec3 head_of(const Fabric& fabric, const LoopSpan& span) {
  return position(fabric, fabric.yarns[static_cast<std::size_t>(span.yarn)], span.apex);
}

// The piece's border: by which of its four sides a loop lies.
struct Sides {
  bool left = false, right = false, bottom = false, top = false;
  bool any() const { return left || right || bottom || top; }
};

std::vector<Sides> sides_of(const YarnGraph& graph) {
  std::map<int, std::pair<double, double>> ends;  // of a pass, its outermost slots
  for (const Loop& loop : graph.loops) {
    const auto [entry, fresh] = ends.try_emplace(loop.pass, loop.slot, loop.slot);
    if (fresh) continue;
    entry->second.first = std::min(entry->second.first, loop.slot);
    entry->second.second = std::max(entry->second.second, loop.slot);
  }
  std::vector<Sides> sides;
  for (const Loop& loop : graph.loops) {
    const auto& [left, right] = ends.at(loop.pass);
    sides.push_back({loop.slot == left, loop.slot == right, loop.pass == ends.begin()->first,
                     loop.pass == ends.rbegin()->first});
  }
  return sides;
}

// The control point that weighs most at a loop's head.
std::size_t head_point(const Fabric& fabric, const LoopSpan& span) {
  const auto& points = fabric.yarns[static_cast<std::size_t>(span.yarn)].control_points;
  return static_cast<std::size_t>(
      std::clamp(static_cast<int>(std::lround(span.apex)) + 1, 0, static_cast<int>(points.size()) - 1));
}

// Held at the heads of its border loops, at this pitch of the wales (d).
Fabric framed(Fabric piece, const std::vector<Sides>& sides, double pitch) {
  for (const LoopSpan& span : piece.loops)
    if (sides[span.loop.position()].any())
      piece.yarns[static_cast<std::size_t>(span.yarn)].held[head_point(piece, span)] = 1;
  const double width = piece.wales * pitch, share = width / piece.width;
  for (FabricYarn& yarn : piece.yarns)
    for (Vec3& p : yarn.control_points) p.x *= share;
  piece.width = width;
  return piece;
}

void let_go(Fabric& piece) {
  for (FabricYarn& yarn : piece.yarns) std::fill(yarn.held.begin(), yarn.held.end(), std::uint8_t{0});
}

// Dead loads that pull with `tension` (B/d^3) outward on the four sides, each shared by its loops alike.
std::vector<Vec3> pull_loads(const Fabric& piece, const std::vector<Sides>& sides, double tension) {
  std::vector<std::size_t> first_point;
  std::size_t points = 0;
  for (const FabricYarn& yarn : piece.yarns) {
    first_point.push_back(points);
    points += yarn.control_points.size();
  }
  Vec3 low{INFINITY, INFINITY, 0}, high{-INFINITY, -INFINITY, 0};
  double left = 0, right = 0, bottom = 0, top = 0;
  for (const LoopSpan& span : piece.loops) {
    const Vec3 head = head_of(piece, span);
    low = {std::min(low.x, head.x), std::min(low.y, head.y), 0};
    high = {std::max(high.x, head.x), std::max(high.y, head.y), 0};
    const Sides& s = sides[span.loop.position()];
    left += s.left, right += s.right, bottom += s.bottom, top += s.top;
  }
  const double across = tension * (high.y - low.y), along = tension * (high.x - low.x);
  std::vector<Vec3> loads(points);
  for (const LoopSpan& span : piece.loops) {
    const Sides& s = sides[span.loop.position()];
    Vec3& load = loads[first_point[static_cast<std::size_t>(span.yarn)] + head_point(piece, span)];
    load.x += (s.right ? across / right : 0) - (s.left ? across / left : 0);
    load.y += (s.top ? along / top : 0) - (s.bottom ? along / bottom : 0);
  }
  return loads;
}

// Distances of the outermost heads in every line of measured loops (lines by one key, places on them by
// another), each for 60 pitches; of all lines and of the middle third.
struct Ruler {
  double mean = 0, middle = 0;
};
Ruler ruler(const std::map<int, std::map<int, Vec3>>& lines, double scale) {
  Ruler result;
  double middle_count = 0;
  std::size_t number = 0;
  for (const auto& [key, places] : lines) {
    const auto first = places.begin(), last = std::prev(places.end());
    const double length = norm(last->second - first->second) * scale / (last->first - first->first);
    result.mean += length / static_cast<double>(lines.size());
    if (3 * number >= lines.size() && 3 * number < 2 * lines.size()) result.middle += length, ++middle_count;
    ++number;
  }
  result.middle /= middle_count;
  return result;
}

WholeSize measure_inner(const RelaxResult& at, const YarnGraph& graph, const LoopSelection& inner) {
  std::map<int, int> rows;
  for (std::size_t i = 0; i < inner.size(); ++i)
    if (inner[i] != 0) rows[graph.loops[i].pass] = 0;
  int row = 0;
  for (auto& [pass, number] : rows) number = row++;
  std::map<int, std::map<int, Vec3>> courses, wales;
  for (const LoopSpan& span : at.fabric.loops) {
    if (inner[span.loop.position()] == 0) continue;
    const Loop& loop = graph.loop(span.loop);
    const int slot = static_cast<int>(std::lround(loop.slot)), course = rows.at(loop.pass);
    courses[course][slot] = wales[slot][course] = head_of(at.fabric, span);
  }
  const Ruler width = ruler(courses, measured_wales * at.fabric.diameter_mm),
              height = ruler(wales, measured_courses * at.fabric.diameter_mm);
  WholeSize size;
  size.width_mm = width.mean, size.middle_width_mm = width.middle;
  size.height_mm = height.mean, size.middle_height_mm = height.middle;
  const InterlacingCheck check = check_interlacings(at.fabric);
  size.interlacings = check.expected, size.interlacings_intact = check.intact;
  size.newton_iterations = at.newton_iterations, size.pass_throughs = at.pass_throughs;
  size.converged = at.converged;
  return size;
}

std::filesystem::path state_path(const WholeWork& work, WholeStage stage) {
  return work.states / (std::string(whole_stage_names[static_cast<std::size_t>(stage)]) + ".h5");
}

}  // namespace

std::vector<WholeSize> relax_whole(const std::filesystem::path& file, const WholeWork& work) {
  const MachineModel& machine = work.machine;
  const Knitting knitting = knit_swatch(file, machine);
  const YarnGraph& graph = knitting.graph;
  const GeometryOptions geometry = make_geometry_options(knitting.program);
  const Fabric first = fit_fabric(cut_window(graph, geometry, mended_piece(graph, geometry),
                                             LoopSelection(graph.loops.size(), 1)),
                                  graph, geometry);
  const LoopSelection inner = measured_loops(graph);
  const std::vector<Sides> sides = sides_of(graph);
  const double d = first.diameter_mm, pitch = 25.4 / machine.gauge_npi / d;

  RelaxOptions usual = relax_options(first, knitting.program, {});
  usual.set = 0;  // set on the machine, see below
  usual.most_iterations = work.most_iterations;
  usual.model.free = {false, false, false};
  // The moss border shows both faces, whatever the pattern.
  usual.model.plates = plates_apart(first, machine.two_layers_mm / d);
  const double force = force_unit_N(usual.model.material, d);

  std::vector<WholeSize> sizes;
  RelaxResult at;
  at.fabric = framed(first, sides, pitch);
  for (const WholeStage stage :
       {WholeStage::on_machine, WholeStage::let_go, WholeStage::pulled, WholeStage::laid_flat}) {
    const double start = now_s();
    RelaxOptions options = usual;
    options.grow_in = stage == WholeStage::on_machine;
    // What comes after a stage moves the cloth by far more than what a loose tolerance leaves.
    options.tolerance = stage == WholeStage::laid_flat ? 2e-3 : 1e-2;
    options.history = at.history;
    if (work.on_progress)
      options.on_progress = [&](const RelaxProgress& progress) {
        work.on_progress(stage, progress);
        return true;
      };
    if (stage == WholeStage::on_machine) {
      options.model.free.height = true;
      options.model.load[1] = first.wales * machine.take_down_N / force;
    }
    if (stage == WholeStage::let_go) {
      at.fabric = set_yarn(std::move(at.fabric), machine.set);
      let_go(at.fabric);
    }
    if (stage == WholeStage::pulled)
      options.model.point_loads =
          pull_loads(at.fabric, sides, machine.hand_pull_N_m * d * 1e-3 / force);
    const std::filesystem::path kept = work.states.empty() ? "" : state_path(work, stage);
    if (!kept.empty() && std::filesystem::exists(kept)) {
      const State state = read_state(kept);
      at.fabric = state.fabric, at.history = state.history;
      at.newton_iterations = static_cast<int>(state.numbers.at("newton_iterations"));
      at.pass_throughs = static_cast<int>(state.numbers.at("pass_throughs"));
      at.converged = state.numbers.at("converged") > 0;
    } else {
      at = relax(at.fabric, options);
      if (!kept.empty() && at.converged) write_state(kept, saved_state(at, options, 1));
    }
    sizes.push_back(measure_inner(at, graph, inner));
    sizes.back().seconds = now_s() - start;
    if (work.on_stage) work.on_stage(stage, sizes.back());
    if (!at.converged) break;
  }
  return sizes;
}

}  // namespace loopwright
