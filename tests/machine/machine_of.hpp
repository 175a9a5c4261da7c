// Helpers of the machine's tests: run a few lines of knitout.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"

namespace loopwright {

// A programme, what was said of it, and what the machine did.
struct MachineRun {
  Program program;
  Diagnostics diagnostics;
  KnittingRecord record;
};

// `lines` is a knitout body; carriers A, B, C and D. Body line 1 is line 3 of the file.
inline MachineRun machine_of(const std::string& lines) {
  MachineRun run;
  run.program = read_knitout(";!knitout-2\n;;Carriers: A B C D\n" + lines, run.diagnostics);
  run.record = run_machine(run.program, run.diagnostics);
  return run;
}

// The stack that a needle holds at the end, as loop numbers in stack order.
inline std::vector<int> held_on(const KnittingRecord& record, Needle needle) {
  std::vector<int> loops;
  for (const NeedleStack& stack : record.held)
    if (stack.needle == needle)
      for (LoopId id : stack.loops) loops.push_back(id.value);
  return loops;
}

inline std::vector<int> numbers(const std::vector<LoopId>& ids) {
  std::vector<int> out;
  for (LoopId id : ids) out.push_back(id.value);
  return out;
}

// Whether a diagnostic of this severity stands at a line and its message contains `words`.
inline bool says(const Diagnostics& diagnostics, Severity severity, int line, const std::string& words) {
  return std::any_of(diagnostics.list().begin(), diagnostics.list().end(), [&](const Diagnostic& d) {
    return d.severity == severity && d.at.line == line && d.message.find(words) != std::string::npos;
  });
}

inline Needle front(int index) { return {Bed::front, index}; }
inline Needle back(int index) { return {Bed::back, index}; }

}  // namespace loopwright
