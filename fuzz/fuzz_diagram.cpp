// Whatever bytes come in: a fabric file without errors is written back to the last byte, its diagram can be
// drawn, and any change at a needle is refused or gives text that says the same. The last bytes choose the
// changes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "notation/needle_diagram.hpp"
#include "notation/read_vermiculation.hpp"
#include "notation/write_vermiculation.hpp"
#include "outputs/write_diagram_svg.hpp"

namespace {

using namespace loopwright;

void draw(const Vermiculation& notation) {
  try {
    DiagramOptions options;
    options.wales = 24;
    options.courses = 24;
    if (diagram_svg(needle_diagram(notation, options)).empty()) std::abort();
  } catch (const std::invalid_argument&) {
    // too large
  }
}

void expect_same(const Vermiculation& notation) {
  const std::string text = write_vermiculation(notation);
  Diagnostics diagnostics("written.verm");
  const Vermiculation again = parse_vermiculation(text, diagnostics);
  if (!diagnostics.ok() || !same_notation(again, notation) || write_vermiculation(again) != text)
    std::abort();
}

// As a programme and back it is the same text; with a stitch changed, a text that makes the changed programme
// or says what it leaves out.
void expect_program_comes_back(const std::string& text) {
  Diagnostics diagnostics("fuzz.verm"), lost("fuzz.verm");
  FabricOptions options;
  options.most_instructions = 3'000;
  Program program = read_vermiculation(text, diagnostics, options);
  if (!diagnostics.ok()) return;
  if (write_vermiculation(program, lost) != text) std::abort();
  Instruction& middle = program.instructions[program.instructions.size() / 2];
  if (middle.op != Op::knit) return;
  middle.op = Op::tuck;
  const std::string changed = write_vermiculation(program, lost);
  if (lost.ok() && (read_vermiculation(changed, diagnostics), !diagnostics.ok())) std::abort();
}

void change(Vermiculation& notation, const std::uint8_t* bytes) {
  if (notation.lines.empty()) return;
  const std::size_t line = bytes[0] % notation.lines.size();
  const std::size_t pass = bytes[1] % notation.lines[line].passes.size();
  const NeedlePlace place{line, pass, bytes[2] % 2 == 0 ? Bed::front : Bed::back, bytes[2] / 2 % 16};
  const auto operation = static_cast<NeedleOperation>(bytes[3] % 8);
  std::string refusal;
  switch (bytes[3] / 8 % 8) {
    case 0:
      refusal = insert_line(notation, bytes[1] % (notation.lines.size() + 1), notation.lines[line]);
      break;
    case 1:
      refusal = remove_line(notation, line);
      break;
    case 2:
      refusal = write_on_both_beds(notation, line, pass);
      break;
    case 3:
      refusal = change_racking(notation, line, pass, (bytes[2] - 128) / 16.0);
      break;
    case 4:
      refusal = change_feeder(notation, line, pass, {bytes[2] % 3}, static_cast<Direction>(bytes[1] % 3 - 1));
      break;
    case 5:
      refusal = remove_operation(notation, place);
      break;
    case 6:
      refusal = add_operation(notation, place, operation);
      break;
    default:
      refusal = change_operation(notation, place, operation);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::size_t changes = size > 64 ? 4 : 0;
  const std::string text(reinterpret_cast<const char*>(data), size - 4 * changes);
  Diagnostics diagnostics("fuzz.verm");
  Vermiculation notation = parse_vermiculation(text, diagnostics);
  std::size_t letters = 0;
  for (const CourseLine& line : notation.lines)
    for (const Pass& pass : line.passes) letters += pass.cells.size() + pass.rear.size();
  if (!diagnostics.ok() || letters > 20'000 || notation.lines.size() > 500) return 0;
  if (write_vermiculation(notation) != text) std::abort();
  expect_program_comes_back(text);
  expect_same(notation);
  draw(notation);
  for (std::size_t i = 0; i < changes; ++i) {
    change(notation, data + text.size() + 4 * i);
    expect_same(notation);
  }
  draw(notation);
  return 0;
}
