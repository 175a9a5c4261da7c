#include "cloth_job.hpp"

#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>

#include "machine/run_machine.hpp"
#include "notation/read_program.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Counting interlacings costs about as much as a step of a small cell; on the way larger pieces go without.
constexpr std::size_t most_loops_counted_live = 200;

bool wants_repeat(const ClothRequest& request, const Program& program) {
  if (request.window || request.piece == PieceChoice::whole || !program.notation) return false;
  if (request.piece == PieceChoice::repeat) return true;
  const Edges edges = program.settings.edges.value_or(Edges::held);
  return edges == Edges::held || edges == Edges::periodic;
}

class ClothJob {
 public:
  ClothJob(const ClothRequest& request, const std::atomic<bool>& cancelled, const ShowMoment& show)
      : request_(request), cancelled_(cancelled), show_(show) {}

  void run() {
    if (!knit()) return;
    if (cancelled_) return;
    Fabric first = geometry();
    moment_.stage = ClothStage::as_knitted;
    count(first);
    publish(first);
    if (cancelled_ || request_.most_loops == 0 || first.loops.size() > request_.most_loops) return;
    relax_from(std::move(first));
  }

  void fail(const std::string& why) {
    moment_.stage = ClothStage::unusable;
    moment_.message = why;
    moment_.fabric = nullptr;
    show(moment_);
  }

 private:
  void show(ClothMoment moment) {
    moment.seconds = seconds_since(start_);
    last_shown_ = Clock::now();
    show_(std::move(moment));
  }

  void publish(const Fabric& fabric) {
    moment_.fabric = std::make_shared<const Fabric>(fabric);
    show(moment_);
  }

  void count(const Fabric& fabric) { moment_.interlacings = check_interlacings(fabric); }

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
    moment_.interlacings.expected = -1;
    moment_.diagnostics = std::make_shared<const Diagnostics>(diagnostics);
    if (!diagnostics.ok() || knitting.graph.loops.empty()) {
      fail(diagnostics.ok() ? "nothing is knitted yet: write a course, such as the letter g"
                            : "the notation has errors");
      return false;
    }
    piece_.periodic = knitting.program.settings.edges == Edges::periodic;
    piece_.window = request_.window;
    piece_.start_from_cell = true;
    moment_.knitting = std::make_shared<const Knitting>(std::move(knitting));
    show(moment_);
    return true;
  }

  Fabric geometry() {
    try {
      return first_geometry(*moment_.knitting, piece_);
    } catch (const std::invalid_argument&) {
      if (!piece_.periodic || request_.piece == PieceChoice::repeat) throw;
    }
    // no cell: the piece as the file says it
    Diagnostics diagnostics(request_.name);
    FabricOptions options;
    options.edges = Edges::held;
    moment_.knitting = std::make_shared<const Knitting>(knit_text(request_, options, diagnostics));
    piece_.periodic = false;
    return first_geometry(*moment_.knitting, piece_);
  }

  void relax_from(Fabric first) {
    RelaxOptions options = relax_options(first, moment_.knitting->program, piece_);
    moment_.options = std::make_shared<const RelaxOptions>(options);
    options.on_progress = [this](const RelaxProgress& progress) {
      note(progress);
      return !cancelled_;
    };
    if (std::optional<Fabric> started = start_from_relaxed_cell(*moment_.knitting, piece_, first, options)) {
      first = std::move(*started);
      moment_.fabric = std::make_shared<const Fabric>(first);
    }
    // pictures on the way, a few a second
    options.on_progress = [this, &first](const RelaxProgress& progress) {
      note(progress);
      if (progress.state && seconds_since(last_shown_) > seconds_between_moments) {
        const Fabric now = with_state(first, *progress.state);
        if (first.loops.size() <= most_loops_counted_live)
          count(now);
        else
          moment_.interlacings.expected = -1;
        publish(now);
      }
      return !cancelled_;
    };
    finish(relax_piece(first, options));
  }

  void note(const RelaxProgress& progress) {
    moment_.stage = progress.radius < 1 ? ClothStage::growing : ClothStage::relaxing;
    moment_.iterations = progress.newton_iterations;
    moment_.residual = progress.residual;
    moment_.radius = progress.radius;
  }

  void finish(RelaxResult result) {
    result.fabric.name = moment_.fabric->name;
    moment_.stage = result.stopped     ? ClothStage::stopped
                    : result.converged ? ClothStage::at_rest
                                       : ClothStage::not_at_rest;
    moment_.residual = result.residual;
    moment_.iterations = result.newton_iterations;
    moment_.message = result.message;
    count(result.fabric);
    moment_.relaxed = std::make_shared<const RelaxResult>(std::move(result));
    publish(moment_.relaxed->fabric);
  }

  const ClothRequest& request_;
  const std::atomic<bool>& cancelled_;
  const ShowMoment& show_;
  PieceRequest piece_;
  ClothMoment moment_;
  Clock::time_point start_ = Clock::now(), last_shown_ = start_;
};

}  // namespace

Knitting knit_text(const ClothRequest& request, const FabricOptions& options, Diagnostics& diagnostics) {
  Knitting knitting;
  knitting.program = read_program_text(request.text, request.suffix, diagnostics, options);
  knitting.record = run_machine(knitting.program, diagnostics);
  knitting.graph = build_yarn_graph(knitting.program, knitting.record, diagnostics);
  return knitting;
}

void make_cloth(const ClothRequest& request, const std::atomic<bool>& cancelled, const ShowMoment& show) {
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
