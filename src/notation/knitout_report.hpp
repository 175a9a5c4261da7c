// What the pieces of the knitout reader share: the line that is read, and what is said of it.
#pragma once
#include <string>

#include "base/diagnostics.hpp"

namespace loopwright {

struct KnitoutReport {
  Diagnostics& diagnostics;
  int line = 0;

  void error(int column, std::string message) { diagnostics.error({line, column}, std::move(message)); }
  void warning(int column, std::string message) { diagnostics.warning({line, column}, std::move(message)); }
};

}  // namespace loopwright
