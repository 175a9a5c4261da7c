// loopwright stretch: a relaxed cell or piece pulled step by step, and what its frame feels.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "base/parallel.hpp"
#include "experiments/stretch.hpp"
#include "files.hpp"
#include "interrupt.hpp"
#include "outputs/write_fabric.hpp"
#include "outputs/write_plot_svg.hpp"
#include "progress_bar.hpp"
#include "stretch_table.hpp"

namespace loopwright {
namespace {

StretchTest stretch_test(const StretchCommand& command) {
  StretchTest test;
  test.direction = stretch_direction_named(command.direction).value_or(StretchDirection::course);
  test.turning_points = command.to;
  test.largest_step = command.step;
  if (!command.load.empty()) {
    test.control = StretchControl::load;
    test.turning_points = command.load;
    test.largest_step = command.load_step.value_or(usual_load_step(command.load));
  }
  test.free_across = !command.held_across;
  return test;
}

Plot plot_of(const StretchCommand& command, const StretchResult& result) {
  Plot plot{command.file + ", " + command.direction + "wise", "strain", "force per length, N/m", {}};
  PlotCurve course{"along the courses", {}, {}}, wale{"along the wales", {}, {}}, shear{"shear", {}, {}};
  for (const StretchPoint& p : result.points) {
    const double strain = command.direction == "wale"    ? p.wale_strain
                          : command.direction == "shear" ? p.shear
                                                         : p.course_strain;
    course.x.push_back(strain), course.y.push_back(p.course_force);
    wale.x.push_back(command.direction == "both" ? p.wale_strain : strain), wale.y.push_back(p.wale_force);
    shear.x.push_back(strain), shear.y.push_back(p.shear_force);
  }
  if (command.direction == "both") plot.title = command.file + ", both ways";
  if (command.direction == "shear") plot.title = command.file + ", shear", plot.curves = {shear};
  if (command.direction != "wale" && command.direction != "shear") plot.curves.push_back(course);
  if (command.direction != "course" && command.direction != "shear") plot.curves.push_back(wale);
  if (command.held_across && command.direction == "course") plot.curves.push_back(wale);
  if (command.held_across && command.direction == "wale") plot.curves.push_back(course);
  return plot;
}

}  // namespace

int run(const StretchCommand& command) {
  if (command.csv.empty() && command.plot.empty() && command.out.empty())
    throw std::invalid_argument("say where the result goes: --csv FILE, --plot FILE.svg or -o STATE");
  if (!command.out.empty()) fabric_format(command.out);
  for (const std::string& file : {command.out, command.csv, command.plot}) require_writable(file);
  const StretchTest test = stretch_test(command);
  std::optional<Piece> piece = read_piece(command.file, command.piece);
  if (!piece) return exit_error;
  if (piece->state.fabric.loops.empty())
    throw std::invalid_argument(command.file + ": a stretch test needs loops, and these are curves without");
  set_thread_count(command.threads);

  const InterruptGuard guard;
  ProgressBar bar("stretching");
  RelaxOptions options = piece->options;
  options.on_progress = [&](const RelaxProgress& progress) {
    std::ostringstream note;
    note << progress.phase << ", step " << progress.newton_iterations;
    bar.show(0, note.str());
    return !interrupted();
  };
  const RelaxResult relaxed = relax_piece(piece->state.fabric, options);
  if (relaxed.stopped) {
    std::cerr << command.file << ": stopped before the test began\n";
    return exit_interrupted;
  }
  if (!relaxed.converged)
    std::cerr << command.file << ": warning: not at rest before the test: " << relaxed.message << '\n';

  double longest = 0;
  for (double from = 0; const double to : test.turning_points) longest += std::abs(to - from), from = to;
  double gone = 0, last = 0;
  const bool loaded = test.control == StretchControl::load;
  const StretchResult result = stretch(relaxed, options, test, [&](const StretchPoint& p) {
    const double now = command.direction == "wale"    ? (loaded ? p.wale_force : p.wale_strain)
                       : command.direction == "shear" ? (loaded ? p.shear_force : p.shear)
                                                      : (loaded ? p.course_force : p.course_strain);
    gone += std::abs(now - last), last = now;
    std::ostringstream note;
    note.precision(3);
    note << (loaded ? "force " : "strain ") << now;
    bar.show(longest > 0 ? gone / longest : 1, note.str());
    return !interrupted();
  });

  if (!command.csv.empty()) write_csv(command.csv, table_of(result.points));
  if (!command.plot.empty()) write_plot_svg(command.plot, plot_of(command, result));
  if (!command.out.empty()) {
    State state = saved_state(result.fabric, options, 1);
    write_fabric(command.out, state);
  }
  int not_at_rest = 0, passed = 0, broken = 0;
  for (const StretchPoint& p : result.points) {
    if (!p.converged) ++not_at_rest;
    if (p.pass_throughs > 0) ++passed;
    if (p.interlacings_intact < p.interlacings) ++broken;
  }
  const StretchPoint& end = result.points.back();
  std::ostringstream line;
  line.precision(3);
  line << command.file << ": " << result.points.size() << " points, at the last course strain "
       << end.course_strain << ", wale strain " << end.wale_strain << ", forces " << end.course_force
       << " and " << end.wale_force << " N/m\n";
  people(command.csv) << line.str();
  if (not_at_rest > 0)
    std::cerr << command.file << ": warning: not at rest at " << not_at_rest << " of " << result.points.size()
              << " points (column converged)\n";
  if (result.stopped) {
    std::cerr << command.file << ": stopped; the points so far are written\n";
    return exit_interrupted;
  }
  if (passed > 0 || broken > 0) {
    std::cerr << command.file << ": error: broken: interlacings are lost at " << std::max(passed, broken)
              << " points (columns pass_throughs, interlacings_intact)\n";
    return exit_error;
  }
  return exit_good;
}

}  // namespace loopwright
