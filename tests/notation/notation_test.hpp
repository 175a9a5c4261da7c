// What the tests of this stage share: reading text, and saying what a reader said.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "notation/read_knitout.hpp"
#include "notation/read_program.hpp"
#include "notation/read_vermiculation.hpp"
#include "notation/write_knitout.hpp"

namespace loopwright {

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline std::string said(const Diagnostics& diagnostics) {
  std::ostringstream out;
  out << diagnostics;
  return out.str();
}

inline std::filesystem::path corpus() {
  const char* folder = std::getenv("LOOPWRIGHT_CORPUS");
  return folder ? folder : LOOPWRIGHT_CORPUS_DEFAULT;
}

inline std::filesystem::path source_dir() { return LOOPWRIGHT_SOURCE_DIR; }

// The program's instructions in words, e.g. "knit + f0 A", separated by "; ".
inline std::string listing(const Program& program, std::size_t first = 0, std::size_t count = 100000) {
  std::ostringstream out;
  for (std::size_t i = first; i < program.instructions.size() && i < first + count; ++i) {
    const Instruction& each = program.instructions[i];
    out << (i > first ? "; " : "") << name_of(each.op);
    if (each.op == Op::rack) out << ' ' << each.value;
    if (each.direction != Direction::none) out << (each.direction == Direction::right ? " +" : " -");
    if (each.op >= Op::knit) out << ' ' << to_string(each.needle);
    if (each.op == Op::xfer || each.op == Op::split) out << ' ' << to_string(each.target);
    for (const CarrierId id : each.carriers) out << ' ' << program.carriers[id.position()];
  }
  return out.str();
}

}  // namespace loopwright
