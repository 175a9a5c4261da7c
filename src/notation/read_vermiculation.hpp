// The fabric file reader (.verm): vermiculation letters to a Program. The grammar is in docs/notation.md.
#pragma once
#include <string_view>

#include "notation/vermiculation.hpp"

namespace loopwright {

/// parse_vermiculation and compile_vermiculation in one.
Program read_vermiculation(std::string_view text, Diagnostics& diagnostics,
                           const FabricOptions& options = {});

}  // namespace loopwright
