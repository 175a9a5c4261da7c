// The loop-scale model for the commands that show it: animate, and render --style structure.
#pragma once
#include <optional>
#include <string>

#include "commands.hpp"
#include "loop_scale/settle.hpp"
#include "outputs/structure_picture.hpp"

namespace loopwright {

// Options of the model from the words of the command line. Throws std::invalid_argument that says what is
// meant.
LoopModelOptions loop_model_options(const LoopRequest& request);

// From a notation to its loop model; says what is wrong on standard error, nothing if there was an error.
std::optional<LoopModel> read_loop_model(const std::string& file, const LoopRequest& request);

std::optional<StructureStyle> structure_style(const std::string& name);

// One line: how the motion ended and where its energy went.
std::string summary(const LoopModel& model, const NetState& state, const SettleResult& result);

// The picture of --style structure: the start, the stable state, or both with the way between them.
int render_structure(const RenderCommand& command);

}  // namespace loopwright
