// loopwright relax: from a notation or a saved state to equilibrium.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <sstream>

#include "base/parallel.hpp"
#include "experiments/curl.hpp"
#include "files.hpp"
#include "interrupt.hpp"
#include "outputs/image.hpp"
#include "outputs/write_fabric.hpp"
#include "progress_bar.hpp"

namespace loopwright {
namespace {

// Turns the solver's reports into a bar: the first half is growing in, the second half follows the residual
// down to the tolerance on a logarithmic scale. Remembers how far the yarn has grown.
class RelaxWatch {
 public:
  explicit RelaxWatch(const RelaxOptions& options)
      : bar_("relaxing"), tolerance_(options.tolerance), grows_(options.grow_in), radius_(grows_ ? 0 : 1) {}

  bool operator()(const RelaxProgress& progress) {
    // the first report at full radius comes before the first step there
    if (progress.radius < 1 || (last_.radius >= 1 && progress.newton_iterations > last_.newton_iterations))
      radius_ = progress.radius;
    last_ = progress;
    double share = 0.5 * progress.radius;
    if (progress.radius >= 1) {
      first_residual_ = std::max(first_residual_, progress.residual);
      const double way = std::log(first_residual_ / tolerance_);
      const double done = std::log(first_residual_ / std::max(progress.residual, tolerance_));
      // the residual goes up and down; the bar only forward
      best_ = std::max(best_, way > 0 ? done / way : 0);
      share = grows_ ? 0.5 + 0.5 * best_ : best_;
    }
    std::ostringstream note;
    note.precision(2);
    note << progress.phase << ", step " << progress.newton_iterations << ", residual " << progress.residual;
    bar_.show(share, note.str());
    return !interrupted();
  }

  double radius() const { return radius_; }

 private:
  ProgressBar bar_;
  double tolerance_ = 0, first_residual_ = 0, best_ = 0;
  bool grows_ = true;
  double radius_ = 0;
  RelaxProgress last_;
};

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

struct RelaxRun {
  RelaxResult result;
  double radius = 0;
};

RelaxRun relax_watched(const Piece& piece, RelaxOptions options) {
  const InterruptGuard guard;
  RelaxWatch watch(options);
  options.on_progress = [&watch](const RelaxProgress& progress) { return watch(progress); };
  RelaxRun run;
  run.result = relax_piece(piece.state.fabric, options);
  run.radius = watch.radius();
  return run;
}

// Goes on without plates, friction keeping its history.
void let_go(Piece& piece, RelaxRun& run) {
  RelaxOptions& options = piece.options;
  piece.state.fabric = run.result.fabric;
  options.grow_in = false;
  options.plate_room = -1;
  options.model.plates = {};
  options.history = run.result.history;
  const RelaxResult between = std::move(run.result);
  run = relax_watched(piece, options);
  run.result.newton_iterations += between.newton_iterations;
  run.result.linear_iterations += between.linear_iterations;
  run.result.pass_throughs += between.pass_throughs;
}

// Curvatures of cloth that was let go, for people and in 1/mm; a piece too small for them says nothing.
void tell_curl(const std::string& file, const Fabric& fabric, JsonObject& all, std::ostream& out) {
  if (loop_curvatures(fabric).empty()) return;
  const Curl found = curl(fabric);
  all.emplace_back("course_curvature_per_mm", found.course / fabric.diameter_mm);
  all.emplace_back("wale_curvature_per_mm", found.wale / fabric.diameter_mm);
  std::ostringstream line;
  line.precision(2);
  line << file << ": curvature along courses " << found.course / fabric.diameter_mm << ", along wales "
       << found.wale / fabric.diameter_mm << " per mm (toward the face positive), over " << found.loops
       << " loops\n";
  out << line.str();
}

// Counts of the runs before this one, if the piece is a state that is gone on with.
void add_earlier_counts(const State& earlier, RelaxResult& result) {
  const auto count = [&earlier](const char* key) {
    const auto found = earlier.numbers.find(key);
    return found == earlier.numbers.end() ? 0 : static_cast<int>(found->second);
  };
  result.newton_iterations += count("newton_iterations");
  result.linear_iterations += count("linear_iterations");
  result.pass_throughs += count("pass_throughs");
}

}  // namespace

int run(const RelaxCommand& command) {
  const auto start = std::chrono::steady_clock::now();
  // what cannot work is said before the long work
  fabric_format(command.out);
  RenderOptions picture;
  if (!command.render.empty()) picture = render_options(command.picture, command.render);
  for (const std::string& file : {command.out, command.json, command.render}) require_writable(file);

  std::optional<Piece> piece = read_piece(command.file, command.piece);
  if (!piece) return exit_error;
  if (command.most_iterations) piece->options.most_iterations = *command.most_iterations;
  set_thread_count(command.threads);

  const std::vector<LinkedPair> linked_before = linking_numbers(piece->state.fabric);
  RelaxRun run = relax_watched(*piece, piece->options);
  const bool lets_go = command.let_go && !run.result.fabric.periodic && !run.result.stopped;
  if (lets_go) let_go(*piece, run);
  add_earlier_counts(piece->state, run.result);
  const RelaxResult& relaxed = run.result;
  write_fabric(command.out, saved_state(relaxed, piece->options, run.radius));

  const Assessment assessment = assess(relaxed.fabric);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::ostringstream line;
  line.precision(3);
  line << command.file << ": " << summary(assessment) << ", " << relaxed.newton_iterations
       << " Newton steps, " << wall_s << " s\n";
  people(command.json) << line.str();
  JsonObject all = results(assessment, relaxed);
  if (lets_go) tell_curl(command.file, relaxed.fabric, all, people(command.json));
  all.emplace_back("wall_s", wall_s);
  all.emplace_back("peak_memory_mb", peak_memory_mb());
  if (command.modes > 0 && !relaxed.stopped) {
    RelaxOptions at_rest = piece->options;
    at_rest.model.plates = relaxed.plates;
    tell_stability(command.file, relaxed.fabric, at_rest, command.modes, all, people(command.json));
  }
  if (!command.json.empty()) write_json(command.json, all);

  bool broken = say_if_broken(command.file, assessment, relaxed.pass_throughs);
  if (assessment.linked != linked_before) {
    std::cerr << command.file << ": error: broken: rings are linked otherwise than before\n";
    broken = true;
  }
  if (!command.render.empty() && !relaxed.stopped) write_png(command.render, render(relaxed.fabric, picture));
  if (relaxed.stopped) {
    std::cerr << command.file << ": stopped; what was reached is in " << command.out;
    if (names_a_state(command.out))
      std::cerr << ": loopwright relax " << command.out << " -o OUT goes on from there";
    std::cerr << '\n';
    return exit_interrupted;
  }
  if (!relaxed.converged) std::cerr << command.file << ": warning: not at rest: " << relaxed.message << '\n';
  return broken ? exit_error : exit_good;
}

}  // namespace loopwright
