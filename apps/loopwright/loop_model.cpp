#include "loop_model.hpp"

#include <charconv>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "files.hpp"
#include "interrupt.hpp"
#include "outputs/image.hpp"

namespace loopwright {
namespace {

PiecePlace known_place(const std::string& name) {
  if (const std::optional<PiecePlace> place = place_named(name)) return *place;
  throw std::invalid_argument("'" + name +
                              "' is no place of a piece: top, bottom, left, right, corner, wale or course");
}

// PLACE or PLACE:cN
Pull parsed_pull(const std::string& text, double ramp_s) {
  Pull pull;
  const std::size_t colon = text.find(':');
  pull.place = known_place(text.substr(0, colon));
  if (colon != std::string::npos) {
    const char *first = text.data() + colon + 1, *last = text.data() + text.size();
    const auto [end, error] = std::from_chars(first, last, pull.force_cN);
    if (error != std::errc() || end != last || !(pull.force_cN > 0))
      throw std::invalid_argument("a pull is PLACE or PLACE:FORCE with the force in cN, not '" + text + "'");
  }
  if (ramp_s > 0) pull.factor = {{0, 0}, {ramp_s, 1}};
  return pull;
}

}  // namespace

LoopModelOptions loop_model_options(const LoopRequest& request) {
  LoopModelOptions options;
  options.law = request.law == "vector" ? SpringLaw::vector : SpringLaw::along;
  options.coupling = request.coupling;
  options.shear = request.shear;
  options.fold = request.fold;
  options.bend = request.bend;
  options.damping = request.damping;
  options.gravity = request.gravity;
  for (const std::string& name : request.clamps) options.clamps.push_back(known_place(name));
  for (const std::string& text : request.pulls) options.pulls.push_back(parsed_pull(text, request.ramp_s));
  if (request.take_down_cN > 0) {
    // as on the machine: the needles hold the top, the rollers pull the bottom
    options.clamps.push_back(PiecePlace::top);
    Pull pull;
    pull.place = PiecePlace::bottom;
    pull.force_cN = request.take_down_cN;
    if (request.ramp_s > 0) pull.factor = {{0, 0}, {request.ramp_s, 1}};
    options.pulls.push_back(pull);
  }
  return options;
}

std::optional<LoopModel> read_loop_model(const std::string& file, const LoopRequest& request) {
  const LoopModelOptions options = loop_model_options(request);
  if (names_a_state(file))
    throw std::invalid_argument(file + ": the loop model is built from a notation, not from a saved state");
  Diagnostics diagnostics(file);
  const Knitting knitting = knit(file, {}, diagnostics);
  std::optional<LoopModel> model;
  if (diagnostics.ok()) {
    try {
      model = build_loop_model(knitting.graph, knitting.program, options);
    } catch (const std::invalid_argument& fault) {
      diagnostics.error({}, fault.what());
    }
  }
  std::cerr << diagnostics;
  return model;
}

std::optional<StructureStyle> structure_style(const std::string& name) {
  if (name == "structure") return StructureStyle::net;
  if (name == "sides") return StructureStyle::sides;
  return std::nullopt;
}

std::string summary(const LoopModel& model, const NetState& state, const SettleResult& result) {
  const Bounds bounds = [&] {
    StructureScene scene;
    scene.points = positions_of(state);
    return bounds_of(scene);
  }();
  const double mm = model.geometry.diameter_mm;
  const Vec3 size = (bounds.upper - bounds.lower) * mm;
  // N d^2/m is 1e-6 diameter_mm^2 N m
  const double joule = 1e-6 * mm * mm;
  const EnergyBalance& balance = result.balance;
  std::ostringstream line;
  line.precision(3);
  line << model.net.mass.size() << " masses, " << model.net.springs.size() << " springs, "
       << (result.settled ? "at rest" : "not at rest") << " after " << state.time << " s, " << result.steps
       << " steps of " << result.step * 1e6 << " us; masses within " << size.x << " x " << size.y << " x "
       << size.z << " mm; energy in uJ: springs " << balance.start.springs * joule * 1e6 << " -> "
       << balance.now.springs * joule * 1e6 << ", kinetic " << balance.now.kinetic * joule * 1e6
       << ", damped away " << balance.dissipated * joule * 1e6 << ", work of loads "
       << balance.work * joule * 1e6 << ", unaccounted " << balance.error() * joule * 1e6;
  return line.str();
}

int render_structure(const RenderCommand& command) {
  const RenderOptions picture = render_options(command.picture, command.out);
  require_writable(command.out);
  const std::optional<LoopModel> model = read_loop_model(command.file, command.loop);
  if (!model) return exit_error;
  const StructureStyle style = *structure_style(command.style);
  NetState state = state_at_rest(model->start);
  StructureScene scene = structure_scene(*model, state, style);
  if (command.moment != "start") {
    NetKernel kernel(model->net);
    SettleOptions options;
    const InterruptGuard guard;
    options.on_check = [](const NetState&, int) { return !interrupted(); };
    options.balance = state.size() < 20'000;
    const SettleResult result = settle(kernel, model->net, state, options);
    std::cout << command.file << ": " << summary(*model, state, result) << '\n';
    if (interrupted()) return exit_interrupted;
    if (command.moment == "stable") {
      scene = structure_scene(*model, state, style);
    } else {
      // start, half way, stable state, side by side
      const double gap = 1.15 * (bounds_of(scene).upper.x - bounds_of(scene).lower.x);
      NetState half = state_at_rest(model->start);
      for (std::size_t i = 0; i < half.size(); ++i) {
        half.x[i] = (half.x[i] + state.x[i]) / 2;
        half.y[i] = (half.y[i] + state.y[i]) / 2;
        half.z[i] = (half.z[i] + state.z[i]) / 2;
      }
      append(scene, structure_scene(*model, half, style, {gap, 0, 0}));
      append(scene, structure_scene(*model, state, style, {2 * gap, 0, 0}));
    }
  }
  add_floor(scene, bounds_of(scene));
  StructureRenderer renderer(picture.width, picture.height);
  const double aspect = static_cast<double>(picture.width) / picture.height;
  write_png(command.out, renderer.draw(scene, fitted_camera(picture.view, bounds_of(scene), aspect, 1.06)));
  return exit_good;
}

}  // namespace loopwright
