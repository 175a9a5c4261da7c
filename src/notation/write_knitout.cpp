#include "notation/write_knitout.hpp"

#include <algorithm>
#include <array>

#include "notation/fabric_headers.hpp"
#include "notation/material.hpp"
#include "notation/scan.hpp"

namespace loopwright {
namespace {

constexpr std::array<std::string_view, 16> names{"in",   "inhook", "releasehook", "out",  "outhook", "stitch",
                                                 "rack", "pause",  "extension",   "knit", "tuck",    "split",
                                                 "miss", "drop",   "amiss",       "xfer"};

void append_number(std::string& text, double value) { text += written_number(value); }

void append_header(std::string& text, std::string_view name, std::string_view value) {
  text += ";;";
  text += name;
  text += ": ";
  // a value of one line; a header that holds a line end would become an instruction
  for (const char c : value) text += c == '\n' || c == '\r' ? ' ' : c;
  text += '\n';
}

void append_settings(std::string& text, const FabricSettings& settings) {
  for (const std::string_view name : fabric_headers()) {
    const std::string value = fabric_header_value(name, settings);
    // the size is in the needles; held and periodic edges belong to a window, which knitout cannot tell
    const bool told = name != "Size" && (name != "Edges" || settings.edges == Edges::free ||
                                         settings.edges == Edges::bound_off);
    if (told && !value.empty()) append_header(text, (name == "Gauge" ? "" : "X-") + std::string(name), value);
  }
}

// Headers that are written from the Program's own fields, not as they stood.
bool is_written_anew(std::string_view name) {
  if (name.starts_with("X-")) name.remove_prefix(2);
  return name == "Carriers" || name == "Gating" || is_fabric_header(name) || name.starts_with("Yarn-");
}

// What a knitout file says of a carrier's yarn where it is free text, e.g. `Yarn-5: 50-50 Rust`.
std::string yarn_as_it_stood(const Program& program, const std::string& carrier) {
  for (const auto& [name, value] : program.headers) {
    if (name == "Yarn-" + carrier) return value;
  }
  return {};
}

void append_yarns(std::string& text, const Program& program) {
  for (std::size_t i = 0; i < program.yarns.size() && i < program.carriers.size(); ++i) {
    std::string value = yarn_value(program.yarns[i]);
    if (value.empty()) value = yarn_as_it_stood(program, program.carriers[i]);
    if (!value.empty()) append_header(text, "Yarn-" + program.carriers[i], value);
  }
}

void append_instruction(std::string& text, const Program& program, const Instruction& instruction) {
  if (instruction.op == Op::extension) {
    text += instruction.text;
    return;
  }
  text += name_of(instruction.op);
  switch (instruction.op) {
    case Op::rack:
    case Op::stitch:
      text += ' ';
      append_number(text, instruction.value);
      if (instruction.op == Op::rack) break;
      text += ' ';
      append_number(text, instruction.value2);
      break;
    case Op::knit:
    case Op::tuck:
    case Op::miss:
    case Op::split:
      text += instruction.direction == Direction::left ? " -" : " +";
      [[fallthrough]];
    case Op::drop:
    case Op::amiss:
    case Op::xfer:
      text += ' ' + to_string(instruction.needle);
      if (instruction.op == Op::split || instruction.op == Op::xfer)
        text += ' ' + to_string(instruction.target);
      break;
    default:
      break;
  }
  for (const CarrierId id : instruction.carriers) text += ' ' + program.carriers[id.position()];
}

}  // namespace

std::string_view name_of(Op op) { return names[static_cast<std::size_t>(op)]; }

std::string write_knitout(const Program& program) {
  std::string text = ";!knitout-2\n";
  std::string carriers;
  for (const std::string& carrier : program.carriers) carriers += (carriers.empty() ? "" : " ") + carrier;
  append_header(text, "Carriers", carriers);
  append_settings(text, program.settings);
  append_yarns(text, program);
  for (const auto& [name, value] : program.headers) {
    if (!is_written_anew(name)) append_header(text, name, value);
  }
  text.reserve(text.size() + program.instructions.size() * 16);
  auto mark = program.source_marks.begin();
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    append_instruction(text, program, program.instructions[i]);
    if (mark != program.source_marks.end() && mark->first == static_cast<int>(i)) {
      text += " ;!source: " + mark->second;
      ++mark;
    }
    text += '\n';
  }
  return text;
}

}  // namespace loopwright
