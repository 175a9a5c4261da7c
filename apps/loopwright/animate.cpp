// loopwright animate: the motion of the loop-scale model from its start to the stable state, as pictures and
// as a VTK time series; the yarn model's is in animate_yarn.cpp.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

#include "animate.hpp"
#include "base/parallel.hpp"
#include "files.hpp"
#include "interrupt.hpp"
#include "loop_model.hpp"
#include "outputs/image.hpp"
#include "outputs/write_vtk.hpp"
#include "progress_bar.hpp"

namespace loopwright {

std::string frame_name(int frame, const char* suffix) {
  std::string number = std::to_string(frame);
  return "frame_" + std::string(4 - std::min<std::size_t>(number.size(), 4), '0') + number + suffix;
}

std::filesystem::path frame_folder(const std::string& out) {
  std::filesystem::path folder(out);
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (!std::filesystem::is_directory(folder))
    throw std::invalid_argument(out + ": cannot make this folder: " + fault.message());
  require_writable((folder / "series.pvd").string());
  return folder;
}

namespace {

// How long until nothing moves that could be seen: a run that keeps nothing.
double visible_time(const LoopModel& model) {
  NetKernel kernel(model.net);
  NetState state = state_at_rest(model.start);
  SettleOptions options;
  options.tolerance = 1e-4;
  options.on_check = [](const NetState&, int) { return !interrupted(); };
  settle(kernel, model.net, state, options);
  return std::max(state.time, 10 * kernel.stable_step());
}

Bounds joined(const Bounds& a, const Bounds& b) {
  Bounds both = a;
  for (int i = 0; i < 3; ++i) {
    both.lower[i] = std::min(a.lower[i], b.lower[i]);
    both.upper[i] = std::max(a.upper[i], b.upper[i]);
  }
  return both;
}

}  // namespace

int run(const AnimateCommand& command) {
  if (command.model == "yarn") return animate_yarn(command);
  const RenderOptions picture = render_options(command.picture, "frame.png");
  const StructureStyle style = structure_style(command.style).value_or(StructureStyle::net);
  const std::optional<LoopModel> model = read_loop_model(command.file, command.loop);
  if (!model) return exit_error;
  set_thread_count(command.threads);
  const std::filesystem::path folder = frame_folder(command.out);

  const InterruptGuard guard;
  const double seconds = command.seconds.value_or(visible_time(*model));
  const int frames = command.frames;
  NetKernel kernel(model->net);
  const double between = seconds / std::max(frames - 1, 1);
  const int steps = std::max(1, static_cast<int>(std::ceil(between / (0.5 * kernel.stable_step()))));
  SettleResult result;
  result.step = between / steps;

  // The motion first, so that all pictures have one camera that sees all of it.
  std::vector<NetState> moments{state_at_rest(model->start)};
  result.balance.start = result.balance.now = kernel.energy(moments[0]);
  {
    ProgressBar bar("moving");
    for (int frame = 1; frame < frames && !interrupted(); ++frame) {
      NetState state = moments.back();
      advance_with_balance(kernel, result.step, steps, state, result.balance);
      result.steps += steps;
      moments.push_back(std::move(state));
      bar.show(static_cast<double>(frame) / frames, "");
    }
  }
  Bounds bounds = bounds_of(structure_scene(*model, moments[0], style));
  for (const NetState& state : moments)
    bounds = joined(bounds, bounds_of(structure_scene(*model, state, style)));
  StructureScene floor;
  add_floor(floor, bounds);
  bounds = joined(bounds, bounds_of(floor));

  std::vector<std::pair<double, std::string>> series;
  std::optional<StructureRenderer> renderer;
  if (!command.no_pictures) renderer.emplace(picture.width, picture.height);
  const Camera camera =
      fitted_camera(picture.view, bounds, static_cast<double>(picture.width) / picture.height);
  ProgressBar bar("drawing");
  for (std::size_t k = 0; k < moments.size() && !interrupted(); ++k) {
    const int frame = static_cast<int>(k);
    if (renderer) {
      StructureScene scene = structure_scene(*model, moments[k], style);
      append(scene, floor);
      write_png(folder / frame_name(frame, ".png"), renderer->draw(scene, camera));
    }
    write_vtp(folder / frame_name(frame, ".vtp"), *model, moments[k]);
    series.emplace_back(moments[k].time, frame_name(frame, ".vtp"));
    bar.show(static_cast<double>(k + 1) / static_cast<double>(moments.size()), "");
  }
  write_pvd(folder / "series.pvd", series);

  // whether the last frame is the stable state
  NetState last = moments.back();
  SettleOptions look;
  look.tolerance = 3e-4;
  look.most_steps = 0;
  result.settled = settle(kernel, model->net, last, look).settled;
  std::cout << command.file << ": " << series.size() << " frames, " << summary(*model, moments.back(), result)
            << '\n';
  return interrupted() ? exit_interrupted : exit_good;
}

}  // namespace loopwright
