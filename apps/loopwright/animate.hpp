// What the two models of `animate` share.
#pragma once
#include <filesystem>
#include <string>

#include "commands.hpp"

namespace loopwright {

std::string frame_name(int frame, const char* suffix);
// Makes the folder; throws std::invalid_argument if it cannot be, FileError if it cannot be written to.
std::filesystem::path frame_folder(const std::string& out);

// --model yarn.
int animate_yarn(const AnimateCommand& command);

}  // namespace loopwright
