#include "cloth_file_job.hpp"

#include <limits>
#include <sstream>

#include "moment_teller.hpp"
#include "outputs/exchange/curve_file.hpp"
#include "outputs/write_fabric.hpp"
#include "piece.hpp"

namespace loopwright {
namespace {

bool names_state(const std::filesystem::path& file) {
  try {
    return fabric_format(file) == FabricFormat::state;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

std::string lines_of(const Fabric& fabric) {
  std::ostringstream text;
  text.precision(4);
  text << "; " << fabric.loops.size() << " loops, " << fabric.yarns.size()
       << (fabric.periodic ? " yarns in a cell that repeats" : " yarns") << "; yarn diameter "
       << fabric.diameter_mm << " mm\n";
  return text.str();
}

// What a state says of itself, as lines of comment.
std::string described(const State& state, const std::string& name) {
  std::ostringstream text;
  text.precision(6);
  text << "; " << name << ": a saved state, without its notation\n" << lines_of(state.fabric);
  if (!state.fabric.name.empty()) text << "; name: " << state.fabric.name << '\n';
  for (const auto& [key, value] : state.texts) text << "; " << key << ": " << value << '\n';
  for (const auto& [key, value] : state.numbers) text << "; " << key << ": " << value << '\n';
  return text.str();
}

std::string described(const ImportedCurves& imported, const std::string& name) {
  std::ostringstream text;
  text.precision(4);
  const CurveFabric& curves = imported.curves;
  text << "; " << name << ": curves of another program\n" << lines_of(curves.fabric);
  if (curves.diameter_guessed)
    text << "; the file does not say the yarn's diameter: the distance that 95 % of it\n; keep from other "
            "curves is taken\n";
  text << "; loops are not known, so no interlacing can be counted\n; Cloth > Relax (F6) brings the yarn to "
          "rest, the ends of open yarns held\n";
  return text.str();
}

class ClothFileJob {
 public:
  ClothFileJob(const ClothRequest& request, const std::atomic<bool>& cancelled, const ShowMoment& show)
      : request_(request), cancelled_(cancelled), moments_(show) {}

  void run() {
    moments_.moment().diagnostics = std::make_shared<const Diagnostics>(request_.name);
    moments_.moment().stage = ClothStage::as_saved;
    const std::optional<Piece> piece = names_state(request_.cloth_file) ? state() : curves();
    if (!piece || cancelled_) return;
    const bool asked = request_.most_loops == std::numeric_limits<std::size_t>::max();
    const bool small = piece->state.fabric.loops.size() <= request_.most_loops && request_.most_loops > 0;
    // at rest already: a step or none says so again
    const bool rests = number(piece->state, "converged") == 1 && number(piece->state, "radius") == 1;
    if (asked || (!piece->state.fabric.loops.empty() && (small || rests))) relax_on(*piece);
  }

  void fail(const std::string& why) { moments_.fail(why); }

 private:
  static double number(const State& state, const char* key) {
    const auto found = state.numbers.find(key);
    return found == state.numbers.end() ? 0 : found->second;
  }

  std::optional<Piece> state() {
    State state = read_state(request_.cloth_file);
    ClothMoment& moment = moments_.moment();
    const auto notation = state.texts.find(state_notation);
    moment.text = std::make_shared<const std::string>(
        notation != state.texts.end() ? notation->second : described(state, request_.name));
    moment.pass_throughs = static_cast<int>(number(state, "pass_throughs"));
    moments_.count(state.fabric);
    moment.residual = number(state, "residual");
    std::optional<Piece> piece;
    const Fabric fabric = state.fabric;
    try {
      piece = piece_of(std::move(state));
      moment.options = std::make_shared<const RelaxOptions>(piece->options);
    } catch (const std::invalid_argument& missing) {
      Diagnostics diagnostics(request_.name);
      diagnostics.warning({}, std::string(missing.what()) + " (it is shown and cannot go on relaxing)");
      moment.diagnostics = std::make_shared<const Diagnostics>(diagnostics);
    }
    show(fabric);
    return piece;
  }

  std::optional<Piece> curves() {
    Diagnostics diagnostics(request_.name);
    const ImportedCurves imported = import_curves(request_.cloth_file, {}, diagnostics);
    const Fabric& fabric = imported.curves.fabric;
    if (imported.curves.diameter_guessed)
      diagnostics.warning({}, "the yarn's diameter is not said; " + std::to_string(fabric.diameter_mm) +
                                  " mm is taken, the distance that 95 % of it keep from other curves");
    ClothMoment& moment = moments_.moment();
    moment.diagnostics = std::make_shared<const Diagnostics>(diagnostics);
    moment.text = std::make_shared<const std::string>(described(imported, request_.name));
    moments_.count(fabric);
    // the data of some yarn, as the file knows none: forces would be those of another
    show(fabric);
    return piece_of(imported);
  }

  void show(const Fabric& fabric) {
    if (!moments_.moment().broken())
      moments_.moment().measured = std::make_shared<const Measurements>(measure(fabric));
    moments_.publish(fabric);
  }

  void relax_on(const Piece& piece) {
    ClothMoment& moment = moments_.moment();
    moment.options = std::make_shared<const RelaxOptions>(piece.options);
    const auto watch = moments_.watch(piece.state.fabric, cancelled_);
    RelaxRun run =
        run_relax(piece, false, [&](const RelaxProgress& progress, double) { return watch(progress); });
    moment.linked_anew = linking_numbers(run.result.fabric) != run.linked_before;
    moments_.finish(std::move(run.result));
  }

  const ClothRequest& request_;
  const std::atomic<bool>& cancelled_;
  MomentTeller moments_;
};

}  // namespace

bool names_cloth(const std::filesystem::path& file) { return names_state(file) || names_curves(file); }

void show_cloth_file(const ClothRequest& request, const std::atomic<bool>& cancelled,
                     const ShowMoment& show) {
  ClothFileJob job(request, cancelled, show);
  try {
    job.run();
  } catch (const std::bad_alloc&) {
    job.fail("not enough memory for this file");
  } catch (const std::exception& fault) {
    job.fail(fault.what());
  }
}

}  // namespace loopwright
