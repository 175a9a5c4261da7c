// What the cloth's picture is made of, built aside: yarn scenes and the loop model.
#include <QMetaObject>
#include <algorithm>
#include <cmath>

#include "base/stop.hpp"
#include "cloth_view.hpp"
#include "knitted_so_far.hpp"
#include "scene_budget.hpp"

namespace loopwright {
namespace {

// Whole repeats that make about the size that the file asks for, and no more than can be drawn quickly.
std::array<int, 2> repeats_for(const Fabric& fabric, const Knitting* knitting) {
  if (!fabric.periodic) return {1, 1};
  const auto enough = [](int wanted, double per_cell) {
    return std::clamp(static_cast<int>(std::lround(wanted / std::max(per_cell, 0.5))), 1, 24);
  };
  int wales = 8, courses = 8;
  if (knitting) {
    const FabricSettings& settings = knitting->program.settings;
    if (settings.size_wales > 0) wales = std::min(settings.size_wales, 16);
    if (settings.size_courses > 0) courses = std::min(settings.size_courses, 16);
  }
  return {enough(wales, fabric.wales), enough(courses, fabric.courses)};
}

// The colours of the segments that are left of a sparse yarn.
template <class Colours>
void keep_every(Colours& colours, int every) {
  Colours kept;
  for (std::size_t k = 0; k < colours.size(); k += static_cast<std::size_t>(every))
    kept.push_back(colours[k]);
  colours = std::move(kept);
}

}  // namespace

void ClothView::take_fabric() {
  if (!session_.fabric()) {
    // scenes of the other document may still come, and are wanted by nobody
    *other_document_ = true;
    other_document_ = std::make_shared<std::atomic<bool>>(false);
    drawn_ = nullptr;
    scene_ = moving_scene_ = nullptr;
    motion_ = nullptr;
    motion_of_ = nullptr;
    follows_ = true;
    redraw();
    return;
  }
  ask_for_scene();
}

// Pixels of a yarn's diameter, in steps: finer meshes are made when the camera comes nearer.
double ClothView::wanted_detail() const {
  const double pixels = height() * devicePixelRatioF() / std::max(camera_.height, 1e-6);
  return std::clamp(std::exp2(std::round(std::log2(std::max(pixels, 1.0)))), 4.0, 32.0);
}

void ClothView::ask_for_scene() {
  const std::shared_ptr<const Fabric> fabric = session_.fabric();
  if (!fabric || style_ != ClothStyle::yarn) {
    redraw();
    return;
  }
  // of a large piece something is drawn at once
  constexpr std::size_t large = 30'000;
  const bool quick = session_.working() || (segments_of(*fabric) > large && drawn_ != fabric);
  SceneOptions options;
  const Knitting* knitting = session_.moment().knitting.get();
  repeats_ = options.repeats = repeats_for(*fabric, knitting);
  detail_ = wanted_detail();
  const double fine = affordable_detail(*fabric, detail_, without_gpu_), coarse = std::min(fine, 8.0);
  const bool occlusion = affords_occlusion(*fabric, fine);
  const bool at_work = quick && (coarse < fine || occlusion || session_.working());
  options.pixels_per_diameter = at_work ? coarse : fine;
  options.look.occlusion = !at_work && occlusion;
  options.look.fuzz = 0;
  const Selection& chosen = session_.selection();
  const std::vector<int> kin = session_.spans_at(chosen.at);
  const std::vector<int> spans = chosen.span >= 0 ? std::vector<int>{chosen.span} : std::vector<int>{};
  const auto relax = session_.moment().options;
  const ModelOptions model = relax ? relax->model : ModelOptions();
  // forces have a meaning in cloth that the yarn model holds
  const bool forces_known = relax != nullptr;
  const ColourBy by = !forces_known && (colour_by_ == ColourBy::tension || colour_by_ == ColourBy::contact)
                          ? ColourBy::yarn
                          : colour_by_;
  const int serial = ++scenes_asked_;
  scene_builder_.start([this, serial, other = other_document_, fabric, options, spans, kin, model, by,
                        at_work, repeats = repeats_](const std::atomic<bool>& cancelled) mutable {
    BuiltScene built;
    built.repeats = repeats;
    built.coarse = at_work;
    // a newer picture of the same cloth does not stop this one: while yarn moves none would be finished
    const StopScope scope(*other);
    try {
      built.colours = cloth_colours(*fabric, model, by, spans, kin);
      options.colours = built.colours.segments;
      if (!cancelled) built.scene = std::make_shared<const YarnScene>(yarn_scene(*fabric, options));
      if (at_work || cancelled) throw Stopped();
      options.pixels_per_diameter = std::min(options.pixels_per_diameter, 6.0);
      const SparseFabric sparse = sparse_fabric(*fabric);
      built.every = sparse.every;
      for (auto& yarn : options.colours) keep_every(yarn, sparse.every);
      options.look.occlusion = options.look.occlusion && sparse.every == 1;
      built.moving = std::make_shared<const YarnScene>(yarn_scene(sparse.fabric, options));
    } catch (const Stopped&) {
      // what there is
    } catch (const std::exception&) {
      built.scene = nullptr;  // the message of the moment says what is wrong with the fabric
    }
    QMetaObject::invokeMethod(
        this,
        [this, serial, other, fabric, built = std::move(built)]() mutable {
          scenes_taken_ = serial;
          if (*other) return;
          drawn_ = fabric;
          show_knitted();
          take_scene(std::move(built));
        },
        Qt::QueuedConnection);
  });
}

void ClothView::show_knitted() {
  const int until = session_.knitted_until();
  const bool all = until < 0 || !drawn_ || !session_.moment().knitting;
  fed_ = all ? std::vector<double>() : fed_until(*drawn_, session_.moment().knitting->graph, until);
  redraw();
}

void ClothView::take_scene(BuiltScene built) {
  if (!built.scene) return;
  scene_ = std::move(built.scene);
  moving_scene_ = std::move(built.moving);
  moving_every_ = built.every;
  colours_ = std::move(built.colours);
  repeats_ = built.repeats;
  coarse_ = built.coarse;
  uploaded_ = false;
  follow();
  // the work ended meanwhile, or the camera is nearer now
  if ((coarse_ && !session_.working()) || (!coarse_ && wanted_detail() != detail_)) ask_for_scene();
  redraw();
}

// The loop model of the knitting that is shown, built aside.
void ClothView::ask_for_motion() {
  if (!session_.working() && coarse_ && scene_ && style_ == ClothStyle::yarn) ask_for_scene();
  const auto knitting = session_.moment().knitting;
  if (style_ == ClothStyle::yarn || !knitting || knitting == motion_of_) return;
  motion_of_ = knitting;
  motion_builder_.start([this, knitting, text = session_.document().text(),
                         suffix = session_.document().suffix()](const std::atomic<bool>&) {
    std::shared_ptr<LoopMotion> motion;
    QString problem;
    try {
      // the piece as the file says it, as `render --style structure` draws it
      Diagnostics diagnostics;
      ClothRequest request;
      request.text = text, request.suffix = suffix;
      motion = std::make_shared<LoopMotion>(knit_text(request, {}, diagnostics), std::vector<PiecePlace>{});
    } catch (const std::exception& fault) {
      problem = QString::fromUtf8(fault.what());
    }
    QMetaObject::invokeMethod(
        this,
        [this, motion, problem] {
          if (!problem.isEmpty()) emit session_.refused(problem);
          motion_ = motion;
          if (motion_ && style_ != ClothStyle::yarn) fit();
          if (playing_) frame_timer_.start();
          emit motion_changed();
          redraw();
        },
        Qt::QueuedConnection);
  });
}

}  // namespace loopwright
