#include "piece.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/fit_fabric.hpp"
#include "loop_scale/relaxed_layout.hpp"
#include "machine/run_machine.hpp"
#include "notation/fabric_headers.hpp"
#include "notation/material.hpp"
#include "notation/read_program.hpp"
#include "notation/scan.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

void apply(const StatedHeaders& stated, Program& program, Diagnostics& diagnostics) {
  for (const auto& [name, value] : stated.settings)
    read_fabric_header(name, value, {}, program.settings, diagnostics);
  if (stated.yarn.empty()) return;
  // what is wrong with it is said once, not once a carrier
  Diagnostics said_before;
  bool first = true;
  for (YarnData& yarn : program.yarns)
    read_yarn(stated.yarn, {}, yarn, std::exchange(first, false) ? diagnostics : said_before);
}

// Counts of the runs before this one, if the piece is a state that is gone on with.
void add_earlier_counts(const State& earlier, RelaxResult& result) {
  const auto count = [&earlier](const char* key) {
    const auto found = earlier.numbers.find(key);
    return found == earlier.numbers.end() ? 0 : static_cast<int>(found->second);
  };
  result.newton_iterations += count("newton_iterations");
  result.linear_iterations += count("linear_iterations");
  result.spot_iterations += count("spot_iterations");
  result.pass_throughs += count("pass_throughs");
}

using ShareProgress = std::function<bool(const RelaxProgress&, double)>;

void relax_watched(const Fabric& fabric, const ShareProgress& on_progress, RelaxRun& run) {
  RelaxWatch watch(run.options);
  run.options.on_progress = [&](const RelaxProgress& progress) {
    const double share = watch.share(progress);
    return !on_progress || on_progress(progress, share);
  };
  run.result = relax_piece(fabric, run.options);
  run.radius = watch.radius();
  run.options.on_progress = {};
}

// Goes on without plates, friction keeping its history.
void let_go_of(RelaxRun& run, const ShareProgress& on_progress) {
  const RelaxResult between = std::move(run.result);
  run.let_go = true;
  run.options.grow_in = false;
  run.options.plate_room = -1;
  run.options.model.plates = {};
  run.options.history = between.history;
  relax_watched(between.fabric, on_progress, run);
  add_counts(run.result, between);
}

}  // namespace

Knitting knit_text(std::string_view text, std::string_view suffix, const FabricOptions& options,
                   const StatedHeaders& stated, Diagnostics& diagnostics) {
  Knitting knitting;
  knitting.program = read_program_text(text, suffix, diagnostics, options);
  apply(stated, knitting.program, diagnostics);
  knitting.record = run_machine(knitting.program, diagnostics);
  knitting.graph = build_yarn_graph(knitting.program, knitting.record, diagnostics);
  return knitting;
}

Piece first_piece(const Knitting& knitting, const PieceRequest& request,
                  const std::function<bool(const RelaxProgress&)>& on_progress) {
  Fabric fabric = first_geometry(knitting, request);
  RelaxOptions options = relax_options(fabric, knitting.program, request);
  if (request.start_from_cell) {
    options.on_progress = on_progress;
    if (std::optional<Fabric> started = start_from_relaxed_cell(knitting, request, fabric, options))
      fabric = std::move(*started);
    options.on_progress = {};
  }
  return {saved_state(fabric, options, options.grow_in ? 0 : 1), options};
}

Piece loop_layout_piece(const Knitting& knitting, const PieceRequest& request) {
  const RelaxedLayout layout = relaxed_layout(knitting.graph, knitting.program);
  Fabric fabric = fit_fabric(layout.curves, knitting.graph, layout.model.geometry);
  fabric.name = knitting.program.settings.name;
  const RelaxOptions options = relax_options(fabric, knitting.program, request);
  return {saved_state(fabric, options, 0), options};
}

void keep_notation(State& state, std::string text, std::string suffix) {
  if (first_byte_not_utf8(text) != std::string_view::npos || text.find('\0') != std::string::npos) return;
  state.texts[state_notation] = std::move(text);
  state.texts[state_notation_suffix] = std::move(suffix);
}

Piece piece_of(State state) {
  Piece piece{std::move(state), {}};
  piece.options = relax_options(piece.state);
  return piece;
}

Piece piece_of(const ImportedCurves& imported) {
  return {saved_state(imported.curves.fabric, imported.options, 0), imported.options};
}

double RelaxWatch::share(const RelaxProgress& progress) {
  // the first report at full radius comes before the first step there
  if (progress.radius < 1 || (last_.radius >= 1 && progress.newton_iterations > last_.newton_iterations))
    radius_ = progress.radius;
  last_ = progress;
  if (progress.radius < 1) return 0.5 * progress.radius;
  first_residual_ = std::max(first_residual_, progress.residual);
  const double way = std::log(first_residual_ / tolerance_);
  const double done = std::log(first_residual_ / std::max(progress.residual, tolerance_));
  // the residual goes up and down; the bar only forward
  best_ = std::max(best_, way > 0 ? done / way : 0);
  return grows_ ? 0.5 + 0.5 * best_ : best_;
}

RelaxRun run_relax(const Piece& piece, bool let_go, const ShareProgress& on_progress) {
  RelaxRun run;
  run.linked_before = linking_numbers(piece.state.fabric);
  run.options = piece.options;
  relax_watched(piece.state.fabric, on_progress, run);
  if (let_go && !run.result.fabric.periodic && !run.result.stopped) let_go_of(run, on_progress);
  add_earlier_counts(piece.state, run.result);
  return run;
}

State saved_state(const RelaxRun& run) { return saved_state(run.result, run.options, run.radius); }

JsonObject results(const Assessment& assessment, const State& state) {
  JsonObject all = results(assessment);
  const auto number = [&](const char* key) { return state.numbers.find(key); };
  const auto none = state.numbers.end();
  for (const char* key : {"pass_throughs", "newton_iterations", "linear_iterations", "spot_iterations"})
    if (number(key) != none) all.emplace_back(key, static_cast<long long>(number(key)->second));
  if (number("converged") != none) all.emplace_back("converged", number("converged")->second != 0);
  if (number("residual") != none) all.emplace_back("residual", number("residual")->second);
  return all;
}

bool is_whole(const Assessment& assessment, int pass_throughs) {
  return assessment.interlacings.intact == assessment.interlacings.expected && pass_throughs == 0;
}

Piece elastic_piece(Piece piece) {
  piece.options.model.material.friction = 0;
  piece.options.model.sample_spacing = 0.09;
  piece.options.history.clear();
  return piece;
}

}  // namespace loopwright
