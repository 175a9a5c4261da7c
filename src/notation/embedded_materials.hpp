// The files of data/materials as CMake built them in (src/notation/stage.cmake writes the definition).
#pragma once
#include <span>
#include <string_view>

namespace loopwright {

struct EmbeddedFile {
  std::string_view name, text;
};
std::span<const EmbeddedFile> embedded_materials();

}  // namespace loopwright
