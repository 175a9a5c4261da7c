#include "session.hpp"

#include <QMetaObject>
#include <algorithm>
#include <chrono>

#include "notation/write_vermiculation.hpp"

namespace loopwright {
namespace {

// Read at once, in the thread of the window, up to this size; beyond it the worker's reading must do.
constexpr std::size_t most_bytes_read_at_once = 300'000;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Session::Session(QObject* parent) : QObject(parent) {
  document_.on_change = [this](const Document::Change& change) {
    if (describing_) {
      emit text_changed(static_cast<qsizetype>(change.begin), static_cast<qsizetype>(change.removed),
                        static_cast<qsizetype>(change.inserted), false);
      read_text();
      return;
    }
    emit text_changed(static_cast<qsizetype>(change.begin), static_cast<qsizetype>(change.removed),
                      static_cast<qsizetype>(change.inserted), change.whole);
    if (change.whole) {
      fabric_ = nullptr;
      knitout_ = nullptr;
      at_hand_.reset();
      diagram_ = {};
      selection_ = {};
      moment_ = {};
      emit fabric_changed();
      emit selection_changed();
    }
    read_text();
    if (automatic_ || change.whole) start_cloth(ClothRequest().most_loops, true);
  };
  read_text();  // of the piece that a new window starts with
}

Session::~Session() { worker_.cancel(); }

double Session::working_seconds() const { return working_ ? now_s() - working_since_ : 0; }

void Session::read_text() {
  diagnostics_ = Diagnostics(document_.name());
  notation_ = nullptr;
  diagram_is_current_ = false;
  shown_passes_.clear();
  knit_until(-1);
  const std::string& text = document_.text();
  if (document_.has_fabric_text() && text.size() < most_bytes_read_at_once) {
    const auto notation = std::make_shared<const Vermiculation>(parse_vermiculation(text, diagnostics_));
    if (diagnostics_.ok()) {
      notation_ = notation;
      try {
        diagram_ = needle_diagram(*notation);
        diagram_is_current_ = true;
      } catch (const std::invalid_argument&) {
        diagram_ = {};  // too large for a drawing: the text remains
      }
    }
  }
  emit reading_changed();
}

void Session::choose_piece(PieceChoice piece) {
  if (piece == piece_) return;
  piece_ = piece;
  make_cloth_anew();
}

void Session::set_automatic(bool automatic) {
  automatic_ = automatic;
  if (automatic && !fabric_is_current_) make_cloth_anew();
}

std::size_t Session::passes() const { return knitout_ ? knitout_->diagram().size() : diagram_.passes.size(); }

const DiagramPass& Session::pass(std::size_t p) const {
  return knitout_ ? shown_passes_.pass(knitout_->diagram(), p) : diagram_.passes[p];
}

void Session::knit_until(int instruction) {
  if (instruction == knitted_until_) return;
  knitted_until_ = instruction;
  emit knitted_changed();
}

void Session::make_cloth_anew() { start_cloth(ClothRequest().most_loops, false); }

void Session::relax_whole() { start_cloth(static_cast<std::size_t>(-1), false); }

void Session::start_cloth(std::size_t most_loops, bool from_hand) {
  ClothRequest request;
  if (document_.kind() == DocumentKind::cloth) request.cloth_file = document_.path();
  if (from_hand) request.at_hand = at_hand_;
  request.text = document_.text();
  request.suffix = document_.suffix();
  request.name = document_.name();
  request.piece = piece_;
  request.most_loops = most_loops;
  const int serial = ++serial_;
  stretch_ = nullptr;
  pull_ = nullptr;
  pulled_ = nullptr;
  broken_pass_throughs_ = 0;
  stretch_points_.clear();
  fabric_is_current_ = false;
  working_ = true;
  working_since_ = now_s();
  emit stretch_changed();
  emit moment_changed();
  worker_.start([this, serial, request = std::move(request)](const std::atomic<bool>& cancelled) {
    make_cloth(request, cancelled, [this, serial](ClothMoment moment) {
      QMetaObject::invokeMethod(
          this, [this, serial, moment = std::move(moment)] { take_moment(serial, moment); },
          Qt::QueuedConnection);
    });
    end_work(serial);
  });
}

// From the worker's thread.
void Session::end_work(int serial) {
  QMetaObject::invokeMethod(
      this,
      [this, serial] {
        if (serial != serial_) return;
        working_ = false;
        emit moment_changed();
      },
      Qt::QueuedConnection);
}

void Session::take_moment(int serial, ClothMoment moment) {
  if (serial != serial_) return;  // of a text that is no more
  if (moment.text && moment.text != moment_.text) {
    describing_ = true;
    document_.describe(*moment.text);
    describing_ = false;
  }
  const bool fresh = moment.fabric && moment.fabric != moment_.fabric;
  if (moment.diagnostics && moment.diagnostics != moment_.diagnostics) {
    diagnostics_ = *moment.diagnostics;
    if (moment.stage == ClothStage::unusable && diagnostics_.ok()) diagnostics_.error({}, moment.message);
    if (moment.passes) {
      knitout_ = moment.passes;
      shown_passes_.clear();
      diagram_ = knitout_->diagram().frame();
      diagram_is_current_ = true;
    }
    moment_ = moment;
    emit reading_changed();
  } else if (moment.stage == ClothStage::unusable && diagnostics_.ok()) {
    diagnostics_.error({}, moment.message);
    emit reading_changed();
  }
  moment_ = std::move(moment);
  if (moment_.relaxed) at_rest_ = moment_.interlacings;
  if (moment_.stage == ClothStage::at_rest && moment_.knitting && !moment_.broken())
    at_hand_ = ClothAtHand{moment_.knitting, moment_.relaxed, moment_.options};
  if (fresh) {
    fabric_ = moment_.fabric;
    fabric_is_current_ = true;
    if (selection_.at.line > 0) {
      const std::vector<int> spans = spans_at(selection_.at);
      if (selection_.span >= static_cast<int>(fabric_->loops.size()) ||
          std::find(spans.begin(), spans.end(), selection_.span) == spans.end())
        selection_.span = spans.empty() ? -1 : spans.front();
    }
    emit fabric_changed();
  }
  emit moment_changed();
}

void Session::cancel() { worker_.cancel(); }

bool Session::edit_notation(const QString& what, const std::function<std::string(Vermiculation&)>& edit) {
  if (document_.read_only()) {
    emit refused(
        document_.kind() == DocumentKind::knitout
            ? tr("A knitout file is shown as it is; write a fabric file to change it.")
            : tr("A file of cloth is shown as it is; File > New from this notation opens its notation."));
    return false;
  }
  if (!notation_) {
    emit refused(tr("The text has errors: mend them first, then the diagram can be changed."));
    return false;
  }
  Vermiculation changed = *notation_;
  const std::string problem = edit(changed);
  if (!problem.empty()) {
    emit refused(QString::fromStdString(problem));
    return false;
  }
  change_text(write_vermiculation(changed), what);
  return true;
}

void Session::change_text(const std::string& text, const QString& what, bool joined) {
  document_.change_to(text, what.toStdString(), joined);
}

void Session::undo() { document_.undo(); }
void Session::redo() { document_.redo(); }

std::vector<int> Session::spans_at(SourceLocation at) const {
  std::vector<int> found;
  if (!fabric_ || at.line == 0) return found;
  for (std::size_t i = 0; i < fabric_->loops.size(); ++i)
    if (fabric_->loops[i].at == at) found.push_back(static_cast<int>(i));
  return found;
}

void Session::select(Selection selection) {
  selection_ = selection;
  emit selection_changed();
}

void Session::select_at(SourceLocation at) {
  const std::vector<int> spans = spans_at(at);
  select({at, spans.empty() ? -1 : spans.front()});
}

void Session::stretch_to(StretchDirection direction, double strain) {
  if (!moment_.relaxed || !moment_.options) return;
  try {
    if (!stretch_ || stretch_->direction() != direction) {
      stretch_ = std::make_shared<StretchSession>(*moment_.relaxed, *moment_.options, direction);
      stretch_points_ = {stretch_->point()};
      pull_ = nullptr;
      pulled_ = nullptr;
    }
  } catch (const std::invalid_argument& fault) {
    emit refused(QString::fromUtf8(fault.what()));
    return;
  }
  work_by_hand([this, strain, session = stretch_](int serial, const std::atomic<bool>& cancelled) {
    session->options().on_progress = [&](const RelaxProgress&) { return !cancelled; };
    session->go_to(strain, [&](const StretchPoint& point) {
      if (!session->reached().stopped)
        show_by_hand(
            serial,
            {std::make_shared<const Fabric>(session->reached().fabric), point.pass_throughs, point, {}});
      return !cancelled;
    });
  });
}

void Session::take_hold(int yarn, double t) {
  if (!moment_.relaxed || !moment_.options || stretch_) return;
  // goes on from what an earlier pull left
  const RelaxResult& from = pulled_ ? *pulled_ : *moment_.relaxed;
  pull_ = std::make_shared<PullSession>(from, *moment_.options, yarn, t);
}

void Session::pull(const Vec3& force) {
  if (!pull_) return;
  work_by_hand([this, force, session = pull_](int serial, const std::atomic<bool>& cancelled) {
    double shown = now_s();
    const Fabric start = session->reached().fabric;
    session->options().on_progress = [&](const RelaxProgress& progress) {
      if (progress.state && now_s() - shown > seconds_between_moments) {
        shown = now_s();
        show_by_hand(serial, {std::make_shared<const Fabric>(with_state(start, *progress.state)), 0, {}, {}});
      }
      return !cancelled;
    };
    if (!session->pull(force)) return;  // told to stop: another pull goes on from here
    const auto reached = std::make_shared<const RelaxResult>(session->reached());
    show_by_hand(serial,
                 {std::make_shared<const Fabric>(reached->fabric), reached->pass_throughs, {}, reached});
  });
}

void Session::work_by_hand(const std::function<void(int serial, const std::atomic<bool>& cancelled)>& work) {
  const int serial = ++serial_;
  working_ = true;
  working_since_ = now_s();
  worker_.start([this, serial, work](const std::atomic<bool>& cancelled) {
    try {
      work(serial, cancelled);
    } catch (const std::exception& fault) {
      const QString why = QString::fromUtf8(fault.what());
      QMetaObject::invokeMethod(
          this, [this, why] { emit refused(why); }, Qt::QueuedConnection);
    }
    end_work(serial);
  });
}

// From the worker's thread.
void Session::show_by_hand(int serial, HandMoment moment) {
  const InterlacingCheck check = check_interlacings(*moment.cloth);
  QMetaObject::invokeMethod(
      this,
      [this, serial, moment = std::move(moment), check] {
        if (serial != serial_) return;
        fabric_ = moment.cloth;
        if (moment.pulled) pulled_ = moment.pulled;
        moment_.interlacings = check;
        broken_pass_throughs_ += moment.pass_throughs;
        if (moment.point) {
          stretch_points_.push_back(*moment.point);
          emit stretch_changed();
        }
        emit fabric_changed();
        emit moment_changed();
      },
      Qt::QueuedConnection);
}

void Session::forget_stretch() {
  if ((!stretch_ && !pull_) || !moment_.relaxed) return;
  ++serial_;
  worker_.cancel();
  working_ = false;
  stretch_ = nullptr;
  pull_ = nullptr;
  pulled_ = nullptr;
  broken_pass_throughs_ = 0;
  stretch_points_.clear();
  fabric_ = moment_.fabric;
  moment_.interlacings = at_rest_;
  emit fabric_changed();
  emit stretch_changed();
  emit moment_changed();
}

}  // namespace loopwright
