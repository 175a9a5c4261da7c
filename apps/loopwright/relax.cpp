// loopwright relax: from a notation or a saved state to equilibrium.
#include <sys/resource.h>

#include <chrono>
#include <iostream>
#include <set>
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

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

RelaxRun relax_watched(const Piece& piece, bool let_go) {
  const InterruptGuard guard;
  ProgressBar bar("relaxing");
  return run_relax(piece, let_go, [&bar](const RelaxProgress& progress, double share) {
    std::ostringstream note;
    note.precision(2);
    note << progress.phase << ", step " << progress.newton_iterations << ", residual " << progress.residual;
    bar.show(share, note.str());
    return !interrupted();
  });
}

// How many of the broken interlacings are those of loops with nothing above to hold them, or nothing below:
// open edges run, in the machine's cloth as here.
int run_at_open_edges(const Fabric& fabric, const InterlacingCheck& check) {
  const std::set<int> broken(check.broken.begin(), check.broken.end());
  std::set<LoopId> held_above, held_below;
  for (std::size_t k = 0; k < fabric.interlacings.size(); ++k)
    if (!broken.contains(static_cast<int>(k))) {
      held_above.insert(fabric.interlacings[k].parent);
      held_below.insert(fabric.interlacings[k].child);
    }
  int run = 0;
  for (const int k : broken) {
    const PlacedInterlacing& lost = fabric.interlacings[static_cast<std::size_t>(k)];
    run += !held_above.contains(lost.child) || !held_below.contains(lost.parent);
  }
  return run;
}

void tell_open_edges(const std::string& file, const Fabric& fabric, const InterlacingCheck& check) {
  const int run = fabric.periodic ? 0 : run_at_open_edges(fabric, check);
  if (run > 0)
    std::cerr << file << ": note: " << run << " of the " << check.expected - check.intact
              << " lost ones are at open edges, where nothing holds the loops: they run, as knitted cloth "
                 "does that is not cast on and bound off\n";
}

// Loops too short to close round the yarn stretch it even where nothing pulls at the cloth.
void tell_if_jammed(const std::string& file, const Fabric& fabric) {
  constexpr double most_strain = 0.003;
  double strain = 0;
  for (const FabricYarn& yarn : fabric.yarns)
    strain = std::max(strain, arc_length(fabric, yarn) / (yarn.segments() * yarn.segment_rest_length) - 1);
  if (fabric.loops.empty() || strain < most_strain) return;
  std::ostringstream line;
  line.precision(2);
  line << file << ": warning: jammed: at rest the yarn is stretched by " << 100 * strain
       << " %, its loops are too short for its thickness; sizes and forces are those of squeezed yarn. Take "
          "longer loops or thinner yarn\n";
  std::cerr << line.str();
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
  if (command.set) {
    if (is_set(piece->state.fabric)) {
      std::cerr << command.file
                << ": error: its yarn is set already; leave out --set, or start from its notation\n";
      return exit_error;
    }
    piece->options.set = *command.set;
  }
  set_thread_count(command.threads);

  const RelaxRun run = relax_watched(*piece, command.let_go);
  const RelaxResult& relaxed = run.result;
  State state = saved_state(run);
  state.texts = piece->state.texts;
  keep_notation(command.file, state);
  write_fabric(command.out, state);

  const Assessment assessment = assess(relaxed.fabric);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::ostringstream line;
  line.precision(3);
  line << command.file << ": " << summary(assessment) << ", " << relaxed.newton_iterations
       << " Newton steps, " << wall_s << " s\n";
  people(command.json) << line.str();
  JsonObject all = results(assessment, relaxed);
  if (run.let_go) tell_curl(command.file, relaxed.fabric, all, people(command.json));
  all.emplace_back("wall_s", wall_s);
  all.emplace_back("peak_memory_mb", peak_memory_mb());
  if (command.modes > 0 && !relaxed.stopped) {
    RelaxOptions at_rest = run.options;
    at_rest.model.plates = relaxed.plates;
    tell_stability(command.file, relaxed.fabric, at_rest, command.modes, all, people(command.json));
  }
  if (!command.json.empty()) write_json(command.json, all);

  bool broken = say_if_broken(command.file, assessment, relaxed.pass_throughs);
  tell_open_edges(command.file, relaxed.fabric, assessment.interlacings);
  if (!relaxed.stopped) tell_if_jammed(command.file, relaxed.fabric);
  if (assessment.linked != run.linked_before) {
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
