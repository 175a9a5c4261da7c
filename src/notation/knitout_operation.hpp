// One line of a knitout body: an operation and its arguments.
#pragma once
#include <set>
#include <string>
#include <string_view>

#include "notation/knitout_report.hpp"
#include "notation/program.hpp"
#include "notation/scan.hpp"

namespace loopwright {

/// Reads operations into instructions. Carriers that no header lists are added to the Program as they come.
class KnitoutOperations {
 public:
  KnitoutOperations(Program& program, KnitoutReport& report) : program_(program), report_(report) {}

  /// From here on a carrier that is not in Program::carriers is an error.
  void list_carriers() { list_carriers_ = true; }
  /// `text` is a line without its comment. False if it holds no operation or one that was not understood;
  /// then it is said.
  bool read(std::string_view text, Instruction& instruction);

 private:
  bool read_arguments(WordReader& words, Instruction& instruction);
  bool read_direction(WordReader& words, Direction& direction);
  bool read_needle(WordReader& words, Needle& needle);
  bool read_number(WordReader& words, std::string_view what, double& value);
  bool read_racking(WordReader& words, double& racking);
  bool read_carrier_set(WordReader& words, Instruction& instruction, bool needed);
  bool read_end(WordReader& words);
  bool read_extension(const Word& name, WordReader& words, std::string_view text, Instruction& instruction);
  CarrierId carrier_met(const Word& word);
  bool expected(const WordReader& words, std::string_view what);

  Program& program_;
  KnitoutReport& report_;
  bool list_carriers_ = false;
  std::set<std::string, std::less<>> warned_extensions_;
};

}  // namespace loopwright
