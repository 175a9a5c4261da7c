#include "cloth_job.hpp"

#include <exception>
#include <stdexcept>
#include <utility>

#include "base/stop.hpp"
#include "cloth_file_job.hpp"
#include "moment_teller.hpp"

namespace loopwright {
namespace {

bool wants_repeat(const ClothRequest& request, const Program& program) {
  if (request.window || request.piece == PieceChoice::whole || !program.notation) return false;
  if (request.piece == PieceChoice::repeat) return true;
  const Edges edges = program.settings.edges.value_or(Edges::held);
  return edges == Edges::held || edges == Edges::periodic;
}

class ClothJob {
 public:
  ClothJob(const ClothRequest& request, const std::atomic<bool>& cancelled, const ShowMoment& show)
      : request_(request), cancelled_(cancelled), moments_(show) {}

  void run() {
    Fabric first;
    try {
      const StopScope scope(cancelled_);
      if (!knit()) return;
      first = geometry();
      moment().stage = ClothStage::as_knitted;
      moments_.count(first);
    } catch (const Stopped&) {
      moments_.stop(moment().knitting ? "stopped before there was cloth" : "stopped while reading");
      return;
    }
    moments_.publish(first);
    if (cancelled_ || request_.most_loops == 0 || first.loops.size() > request_.most_loops) return;
    relax_from(std::move(first));
  }

  void fail(const std::string& why) { moments_.fail(why); }

 private:
  ClothMoment& moment() { return moments_.moment(); }

  // notation -> machine -> topology; false after saying that there is nothing to build.
  bool knit() {
    Diagnostics diagnostics(request_.name);
    FabricOptions options;
    Knitting knitting = knit_text(request_, options, diagnostics);
    if (diagnostics.ok() && wants_repeat(request_, knitting.program) &&
        knitting.program.settings.edges != Edges::periodic) {
      // once more as a cell; a notation that does not close into one is shown whole
      Diagnostics of_cell(request_.name);
      options.edges = Edges::periodic;
      Knitting cell = knit_text(request_, options, of_cell);
      if (of_cell.ok()) {
        knitting = std::move(cell);
        diagnostics = std::move(of_cell);
      }
    }
    moment().diagnostics = std::make_shared<const Diagnostics>(diagnostics);
    if (!diagnostics.ok() || knitting.graph.loops.empty()) {
      fail(diagnostics.ok() ? "nothing is knitted yet: write a course, such as the letter g"
                            : "the notation has errors");
      return false;
    }
    piece_.periodic = knitting.program.settings.edges == Edges::periodic;
    piece_.window = request_.window;
    piece_.start_from_cell = true;
    moment().knitting = std::make_shared<const Knitting>(std::move(knitting));
    if (!moment().knitting->program.notation)
      moment().passes = std::make_shared<const KnitoutPasses>(moment().knitting);
    moments_.show();
    return true;
  }

  Fabric geometry() {
    try {
      return first_geometry(*moment().knitting, piece_);
    } catch (const std::invalid_argument&) {
      if (!piece_.periodic || request_.piece == PieceChoice::repeat) throw;
    }
    // no cell: the piece as the file says it
    Diagnostics diagnostics(request_.name);
    FabricOptions options;
    options.edges = Edges::held;
    moment().knitting = std::make_shared<const Knitting>(knit_text(request_, options, diagnostics));
    piece_.periodic = false;
    return first_geometry(*moment().knitting, piece_);
  }

  void relax_from(Fabric first) {
    const RelaxOptions fresh = relax_options(first, moment().knitting->program, piece_);
    if (request_.at_hand && go_on_from_hand(first, fresh)) return;
    RelaxOptions options = fresh;
    moment().options = std::make_shared<const RelaxOptions>(options);
    options.on_progress = [this](const RelaxProgress& progress) {
      moments_.note(progress);
      return !cancelled_;
    };
    if (std::optional<Fabric> started = start_from_relaxed_cell(*moment().knitting, piece_, first, options)) {
      first = std::move(*started);
      moment().fabric = std::make_shared<const Fabric>(first);
    }
    options.on_progress = moments_.watch(first, cancelled_);
    moments_.finish(relax_piece(first, options));
  }

  // False where the cloth at hand is of no use, or did not come to rest.
  bool go_on_from_hand(const Fabric& first, RelaxOptions options) {
    const std::optional<Fabric> started =
        start_from_cloth_at_hand(*request_.at_hand, *moment().knitting, first, options);
    if (!started) return false;
    moment().options = std::make_shared<const RelaxOptions>(options);
    moment().went_on = true;
    moments_.publish(*started);
    options.on_progress = moments_.watch(*started, cancelled_);
    RelaxResult result = relax_piece(*started, options);
    const bool good = result.stopped || (result.converged && result.pass_throughs == 0);
    if (good)
      moments_.finish(std::move(result));
    else
      moment().went_on = false;
    return good;
  }

  const ClothRequest& request_;
  const std::atomic<bool>& cancelled_;
  PieceRequest piece_;
  MomentTeller moments_;
};

}  // namespace

Knitting knit_text(const ClothRequest& request, const FabricOptions& options, Diagnostics& diagnostics) {
  return knit_text(request.text, request.suffix, options, {}, diagnostics);
}

void make_cloth(const ClothRequest& request, const std::atomic<bool>& cancelled, const ShowMoment& show) {
  if (!request.cloth_file.empty()) {
    show_cloth_file(request, cancelled, show);
    return;
  }
  ClothJob job(request, cancelled, show);
  try {
    job.run();
  } catch (const std::bad_alloc&) {
    job.fail("not enough memory for this piece: take a part of it");
  } catch (const std::exception& fault) {
    job.fail(fault.what());
  }
}

}  // namespace loopwright
