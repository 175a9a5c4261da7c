// loopwright animate --model yarn: the yarns of a relaxed piece in motion, held together by one of the
// bindings.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "animate.hpp"
#include "base/parallel.hpp"
#include "dynamics/yarn_motion.hpp"
#include "files.hpp"
#include "interrupt.hpp"
#include "outputs/exchange/write_vtp.hpp"
#include "outputs/image.hpp"
#include "outputs/write_vtk.hpp"
#include "progress_bar.hpp"

namespace loopwright {
namespace {

// What happens to the piece, in its own units.
struct EdgeLoad {
  std::vector<std::uint8_t> held;
  std::vector<Vec3> force;  // empty: none
  Vec3 gravity;
  std::vector<Vec3> target;  // of held points at the end; empty: they stay
};

EdgeLoad load_of(const AnimateCommand& command, const Fabric& fabric, bool framed, const MotionUnits& units) {
  const std::vector<Vec3> place = motion_state(fabric).place;
  EdgeLoad load;
  load.held = spline_model(fabric, {}).held;
  Vec3 low = place.front(), high = place.front();
  for (const Vec3& p : place)
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  // An edge is what lies within a share of a course of the outermost yarn.
  constexpr double edge = 0.7;
  const double course = edge * (high.y - low.y) / std::max(fabric.courses, 1.0);
  const bool hangs = command.loop.gravity || command.loop.take_down_cN > 0;
  if (command.stretch != 0) {
    // All that holds the piece is carried along, as the frame of a stretch test is; its height stays.
    load.target = place;
    for (Vec3& p : load.target) p.x += command.stretch * (p.x - 0.5 * (low.x + high.x));
  } else if (hangs) {
    if (framed)
      throw std::invalid_argument(
          "a piece that hangs needs edges that do not run: write Edges: bound-off in the fabric file, or "
          "pull "
          "this one with --stretch");
    for (std::size_t i = 0; i < place.size(); ++i) load.held[i] = place[i].y > high.y - course ? 1 : 0;
  }
  constexpr double earth = 9.81;
  if (command.loop.gravity) load.gravity = {0, -units.acceleration(earth), 0};
  if (command.loop.take_down_cN > 0) {
    load.force.assign(place.size(), Vec3{});
    const auto at_bottom = [&](const Vec3& p) { return p.y < low.y + course; };
    const auto many = static_cast<double>(std::count_if(place.begin(), place.end(), at_bottom));
    for (std::size_t i = 0; i < place.size(); ++i)
      if (at_bottom(place[i])) load.force[i].y = -command.loop.take_down_cN * 1e-2 / units.force_N / many;
  }
  return load;
}

YarnMotion motion_of(const AnimateCommand& command, const RelaxResult& relaxed, const RelaxOptions& options,
                     const EdgeLoad& load, double drag) {
  const Fabric& fabric = relaxed.fabric;
  const bool contact = command.binding == "contact";
  // Contact holds cloth up as it was relaxed; the other bindings know nothing of shells, and start in the
  // state of repose: every curve is its yarn's natural shape.
  SplineModel model = spline_model(fabric, options.model.material, contact ? 0 : 1, !contact);
  model.held = load.held;
  model.gravity = load.gravity;
  model.drag = drag;
  MotionState state = motion_state(fabric);
  MotionOptions motion_options;
  motion_options.tolerance = 2e-2;  // B/d^2; a loop of plain pushes with about one
  motion_options.constraint_tolerance = 1e-6;
  motion_options.most_newton = contact ? 25 : 10;
  Bindings bindings;
  std::optional<FabricContact> shells;
  // About what the shell of mechanics resists two crossing yarns with, B/d^3.
  constexpr double spring_stiffness = 200;
  if (command.binding == "barycentric")
    bindings = barycentric_bindings(model, state.place, feet(fabric), spring_stiffness);
  if (command.binding == "sliding")
    bindings = sliding_bindings(model, state.place, feet(fabric), options.model.material.friction);
  if (contact) {
    Fabric loose = fabric;  // what the load lets go is free for contact as well
    std::size_t next = 0;
    for (FabricYarn& yarn : loose.yarns)
      for (std::uint8_t& held : yarn.held) held = load.held[next++];
    shells = fabric_contact(loose, options.model, relaxed.history);
  }
  return YarnMotion(std::move(model), std::move(state), std::move(bindings), motion_options,
                    std::move(shells));
}

// As read_piece, with another size than the file's: a window would leave the loops of its frame without the
// interlacings by which they are bound.
std::optional<Piece> piece_of_size(const std::string& file, const std::string& size) {
  const PieceRequest request{.start_from_cell = true};
  if (size.empty() || names_a_state(file)) return read_piece(file, request);
  const WindowSize wanted = parsed_window(size);
  FabricOptions options;
  options.size_wales = wanted.wales;
  options.size_courses = wanted.courses;
  Diagnostics diagnostics(file);
  const Knitting knitting = knit_with(file, options, diagnostics);
  std::cerr << diagnostics;
  if (!diagnostics.ok()) return std::nullopt;
  Fabric fabric = first_geometry(knitting, request);
  RelaxOptions relaxing = relax_options(fabric, knitting.program, request);
  if (std::optional<Fabric> started = start_from_relaxed_cell(knitting, request, fabric, relaxing))
    fabric = std::move(*started);
  return Piece{saved_state(fabric, relaxing, relaxing.grow_in ? 0 : 1), relaxing};
}

struct Moment {
  double time_s = 0;
  Fabric fabric;
};

// An interlacing that was whole at the start and is no more; nothing if there is none.
const PlacedInterlacing* first_lost(const Fabric& fabric, const std::vector<int>& broken_before) {
  for (const int k : check_interlacings(fabric).broken)
    if (!std::binary_search(broken_before.begin(), broken_before.end(), k))
      return &fabric.interlacings[static_cast<std::size_t>(k)];
  return nullptr;
}

// Along the courses.
double extent(const Fabric& fabric) {
  const Bounds bounds = fabric_bounds(fabric, {1, 1});
  return bounds.upper.x - bounds.lower.x;
}

// Where the loop of an interlacing stands in the notation.
SourceLocation place_of(const Fabric& fabric, LoopId loop) {
  for (const LoopSpan& span : fabric.loops)
    if (span.loop == loop) return span.at;
  return {};
}

}  // namespace

int animate_yarn(const AnimateCommand& command) {
  const RenderOptions picture = render_options(command.picture, "frame.png");
  const std::filesystem::path folder = frame_folder(command.out);
  const std::optional<Piece> piece = piece_of_size(command.file, command.size);
  if (!piece) return exit_error;
  set_thread_count(command.threads);
  const MotionUnits units =
      motion_units(piece->state.fabric, piece->options.model.material.reference_bend_N_m2);
  spline_model(piece->state.fabric, piece->options.model.material);  // says at once what cannot move

  const InterruptGuard guard;
  RelaxResult relaxed;
  {
    ProgressBar bar("relaxing");
    RelaxOptions options = piece->options;
    options.on_progress = [&bar](const RelaxProgress& progress) {
      bar.show(0, progress.phase + ", step " + std::to_string(progress.newton_iterations));
      return !interrupted();
    };
    relaxed = relax_piece(piece->state.fabric, options);
  }
  if (relaxed.stopped) return exit_interrupted;

  // Long enough for a small piece to swing and come to rest; viscosity takes its energy in a part of that.
  constexpr double usual_seconds = 0.02, decays = 6;
  const double seconds = command.seconds.value_or(usual_seconds), duration = seconds / units.time_s;
  const EdgeLoad load = load_of(command, relaxed.fabric, piece->options.model.free.width, units);
  YarnMotion motion =
      motion_of(command, relaxed, piece->options, load, decays * command.loop.damping / duration);
  if (!load.force.empty()) motion.set_force(load.force);

  constexpr double longest_step = 25;  // in the yarn's own time: how far a wave of bending runs is a few d
  const int frames = command.frames;
  const double between = duration / (frames - 1);
  const int steps = std::max(1, static_cast<int>(std::ceil(between / longest_step)));
  std::vector<Moment> moments{{0, relaxed.fabric}};
  StepReport all;
  const std::vector<Vec3> from = motion.state().place;
  // Bindings hold a loop's yarn in its loop but see no other yarn, and no step is certified: before one that
  // loses an interlacing the motion stops.
  const bool may_lose = command.binding != "contact";
  std::vector<int> broken_before = check_interlacings(relaxed.fabric).broken;
  std::sort(broken_before.begin(), broken_before.end());
  std::string stopped;  // why, if it did
  const auto start = std::chrono::steady_clock::now();
  {
    ProgressBar bar("moving");
    for (int frame = 1; frame < frames && stopped.empty() && !interrupted(); ++frame) {
      for (int k = 1; k <= steps && stopped.empty() && !interrupted(); ++k) {
        std::vector<Vec3> held;
        if (!load.target.empty()) {
          // The edge is pulled over the first three quarters, then held.
          double share = std::min(1.0, (frame - 1 + static_cast<double>(k) / steps) / (0.75 * (frames - 1)));
          share *= share * (3 - 2 * share);  // without a jerk
          held = from;
          for (std::size_t i = 0; i < held.size(); ++i) held[i] += share * (load.target[i] - from[i]);
        }
        const MotionState before = motion.state();
        const StepReport report = motion.step(between / steps, held);
        all.newton += report.newton;
        all.halvings += report.halvings;
        all.pass_throughs += report.pass_throughs;
        if (!report.converged) all.converged = false;
        if (!may_lose) continue;
        const Fabric moved = with_places(relaxed.fabric, motion.state().place);
        if (const PlacedInterlacing* lost = first_lost(moved, broken_before)) {
          const Fabric last = with_places(relaxed.fabric, before.place);
          std::ostringstream why;
          why.precision(3);
          why << "stopped at " << before.time * units.time_s << " s of " << seconds << " s";
          if (command.stretch != 0)
            why << ", pulled by " << 100 * (extent(last) / extent(relaxed.fabric) - 1) << " %";
          why << ": in the next step the loop of line " << place_of(moved, lost->child).line << ", column "
              << place_of(moved, lost->child).column
              << " would slip out of the loop that it is drawn through. " << command.binding
              << " bindings do not hold it there: pull less or slower, or take --binding contact";
          stopped = why.str();
          moments.push_back({before.time * units.time_s, last});
        }
      }
      if (!stopped.empty()) break;
      moments.push_back(
          {motion.state().time * units.time_s, with_places(relaxed.fabric, motion.state().place)});
      bar.show(static_cast<double>(frame) / frames, std::to_string(all.newton) + " Newton steps");
    }
  }
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  Bounds bounds = fabric_bounds(moments[0].fabric, {1, 1});
  for (const Moment& moment : moments) {
    const Bounds one = fabric_bounds(moment.fabric, {1, 1});
    for (int k = 0; k < 3; ++k) {
      bounds.lower[k] = std::min(bounds.lower[k], one.lower[k]);
      bounds.upper[k] = std::max(bounds.upper[k], one.upper[k]);
    }
  }
  const Camera camera =
      fitted_camera(picture.view, bounds, static_cast<double>(picture.width) / picture.height);
  std::vector<std::pair<double, std::string>> series;
  ProgressBar bar("drawing");
  for (std::size_t k = 0; k < moments.size(); ++k) {
    const int frame = static_cast<int>(k);
    if (!command.no_pictures && !interrupted())
      write_png(folder / frame_name(frame, ".png"), render(moments[k].fabric, camera, picture));
    write_vtp(folder / frame_name(frame, ".vtp"), State{moments[k].fabric, {}, {}});
    series.emplace_back(moments[k].time_s, frame_name(frame, ".vtp"));
    bar.show(static_cast<double>(k + 1) / static_cast<double>(moments.size()));
  }
  write_pvd(folder / "series.pvd", series);

  const InterlacingCheck check = check_interlacings(moments.back().fabric);
  // Only what motion has lost: relaxed cloth may have loops whose heads the check has lost sight of.
  const int lost = check_interlacings(moments.front().fabric).intact - check.intact;
  const MotionEnergy energy = motion.energy();
  const double done = static_cast<double>(moments.size() - 1) * steps;
  std::ostringstream line;
  line.precision(3);
  line << command.file << ": " << series.size() << " frames of " << moments.back().time_s << " s, "
       << command.binding << ", " << all.newton << " Newton steps in " << done << " steps, "
       << 1e6 * wall_s / std::max(1.0, done * static_cast<double>(relaxed.fabric.loops.size()))
       << " us per loop and step; interlacings " << check.intact << " of " << check.expected
       << ", bindings off by " << motion.constraint_error() << " d, kinetic energy " << energy.kinetic
       << " B/d\n";
  std::cout << line.str();
  if (!all.converged) std::cerr << command.file << ": warning: some steps did not come to their tolerance\n";
  if (!stopped.empty()) std::cerr << command.file << ": error: " << stopped << "\n";
  const bool broken = lost > 0 || all.pass_throughs > 0;
  if (broken)
    std::cerr << command.file
              << ": error: broken: interlacings are lost, or yarn may have passed through yarn\n";
  if (interrupted()) return exit_interrupted;
  return broken || !stopped.empty() ? exit_error : exit_good;
}

}  // namespace loopwright
